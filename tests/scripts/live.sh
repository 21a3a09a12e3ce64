# What the tests share that run the real services: a private network, every process known by its name.
# Sourced, never run.
# shellcheck shell=bash disable=SC2034,SC2317
declare -F check >/dev/null || source "$(dirname "${BASH_SOURCE[0]}")/lib.sh"

private_network || skip "no private network namespaces on this machine"
if [[ -z ${VOXLIST_NETNS:-} ]]; then
  "$scripts/netns" "$0"
  exit
fi
unset LCM_DEFAULT_URL

cd "$work" || exit
declare -A pids
at_exit() { :; }
trap 'at_exit; { kill -KILL "${pids[@]}"; wait; } 2>/dev/null || true; rm -rf "$work"' EXIT

# start NAME COMMAND...: runs in the background; what it says is in NAME.log.
start() {
  local name=$1
  shift
  "$@" >"$work/$name.log" 2>&1 &
  pids[$name]=$!
}

# end_well NAME...: each ends when it is asked to, and with exit code 0.
end_well() {
  local name code=0
  for name in "$@"; do
    kill -TERM "${pids[$name]}"
    wait "${pids[$name]}" || code=1
    unset "pids[$name]"
  done
  return $code
}

# Settings of a localiser in slower programs: no cloud is dropped, and each waits for the mapper's word on the one before.
patience() { ((slower == 1)) || printf '[localiser]\nmap_wait_s = 10.0\nmax_waiting_clouds = 100\n'; }

still_run() {
  local name
  for name in "$@"; do kill -0 "${pids[$name]}" || return 1; done
}

# start_watch: what is heard is in watch.log from here on.
start_watch() { start watch "$BIN/bus_watch" $((600 * slower)); }

# start_chain: what is heard is in watch.log, too; localiser and mapper have agreed on a map. The other two of the chain
# only listen, and start after that: octomap_export asks the mapper as well, and its answer is none to the localiser.
start_chain() {
  start_watch
  start_services localiser mapper
  within 20 has_answered || return 1
  start_services octomap_export obstacle_detector
  within 20 heard "HEALTH obstacle_detector" && within 20 heard "HEALTH octomap_export"
}
start_services() {
  local name
  for name in "$@"; do start "$name" "$BIN/$name" --config "$work/robot.toml"; done
}
end_chain() { end_well localiser mapper octomap_export obstacle_detector; }

# What bus_watch has heard (a pattern that matches from after the time): whether; how often; the time in
# ms of the first one since a time.
has_answered() { heard "MAP_UPDATE [0-9]+ [0-9]+ [1-9]"; }
heard() { grep -Eq -- "^[0-9]+ $1" "$work/watch.log"; }
times_heard() { grep -Ec -- "^[0-9]+ $1" "$work/watch.log" || true; }
heard_times() { (($(times_heard "$2") >= $1)); }
first_heard_ms() { awk -v since="$1" -v what="^[0-9]+ $2" '$1 >= since && $0 ~ what { print $1; exit }' "$work/watch.log"; }
heard_since() { [[ -n $(first_heard_ms "$1" "$2") ]]; }

now_ms() { echo $((${EPOCHREALTIME/./} / 1000)); }
