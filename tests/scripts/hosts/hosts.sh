# Several hosts, each a network namespace of its own, on one switch that loses and delays what the test says. Sourced
# after live.sh, never run.
# shellcheck shell=bash disable=SC2034,SC2154

fleet_url="udpm://239.255.76.67:7667?ttl=1"
declare -A host_of
switch_in= switch_out=

# make_hosts NAME...: hosts 10.7.0.1, 10.7.0.2, ... with a route for multicast, and a switch between them.
make_hosts() {
  local name n=0
  for name in "$@"; do
    unshare -n sleep $((900 * slower)) &
    pids[host_$name]=$!
    host_of[$name]=$!
    ((++n))
    within 10 has_own_network "${host_of[$name]}" || return 1
    ip link add name "port_$name" type veth peer name eth0 netns "${host_of[$name]}"
    ip link set "port_$name" up
    on "$name" ip link set lo up
    on "$name" ip address add "10.7.0.$n/24" dev eth0
    on "$name" ip link set eth0 up
    on "$name" ip route add 224.0.0.0/4 dev eth0
    on "$name" sh -c "echo 16000000 >/proc/sys/net/ipv4/ipfrag_high_thresh; echo 1 >/proc/sys/net/ipv4/ipfrag_time"
  done
  coproc switch { exec "$BIN/lossy_switch" "${@/#/port_}"; }
  pids[switch]=$switch_PID
  exec {switch_in}>&"${switch[1]}" {switch_out}<&"${switch[0]}"
}
has_own_network() { [[ $(readlink "/proc/$1/ns/net" 2>/dev/null) != "$(readlink /proc/self/ns/net)" ]]; }

# on NAME COMMAND...: on that host.
on() {
  local name=$1
  shift
  nsenter --net="/proc/${host_of[$name]}/ns/net" "$@"
}

# start_on HOST NAME COMMAND...: as start.
start_on() {
  local host=$1 name=$2
  shift 2
  start "$name" env LCM_DEFAULT_URL="$fleet_url" nsenter --net="/proc/${host_of[$host]}/ns/net" "$@"
}

# switch_does ORDER...: the switch has done it; what it answers is in switch_said.
switch_does() {
  echo "$*" >&"$switch_in"
  read -r -t 10 switch_said <&"$switch_out"
}
