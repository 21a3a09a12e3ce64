# Pieces that the scripts share. Sourced, never run.
# shellcheck shell=bash disable=SC2034

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
program=$(basename "$0")

# The services that scripts/services runs, in the order of services/README.md. The first three are for
# robots that have the mirror scanner, the next one for those that have another 3D laser, the last one for robots of a
# fleet.
scanner_services=(laser_driver mirror_monitor cloud_assembler)
adapter_services=(cloud_adapter)
fleet_services=(relay)
services=("${scanner_services[@]}" "${adapter_services[@]}" localiser mapper octomap_export grid_export obstacle_detector viewer
  "${fleet_services[@]}")

say() { echo "$program: $*" >&2; }

fail() {
  say "$*"
  exit 1
}

# The comment at the head of a script is its help.
help_if_asked() {
  case ${1:-} in
    -h | --help)
      sed -n '2,/^[^#]/ s/^# \{0,1\}//p' "$0"
      exit 0
      ;;
  esac
}

# Folder for what outlives a process: maps, recordings, tables. common/system/state_folder.h names the same one.
state_folder() {
  local folder=${STATE_DIRECTORY:-}
  [[ -n $folder ]] || folder=${XDG_STATE_HOME:+$XDG_STATE_HOME/voxlist}
  [[ -n $folder ]] || folder=${HOME:?no folder for data: set XDG_STATE_HOME, or HOME}/.local/state/voxlist
  mkdir -p "$folder" || fail "cannot make $folder; set XDG_STATE_HOME to a folder of your own"
  echo "$folder"
}

# Folder for locks, sockets and logs of running services; common/service/run_folder.h names the same one.
run_folder() {
  local folder=${VOXLIST_RUN_DIR:-}
  if [[ -z $folder ]]; then
    folder=${XDG_RUNTIME_DIR:+$XDG_RUNTIME_DIR/voxlist}
    folder=${folder:-/tmp/voxlist-$EUID}
  fi
  [[ -d $folder ]] || mkdir -m 700 "$folder" || fail "cannot make $folder; set VOXLIST_RUN_DIR to a folder of your own"
  [[ -O $folder ]] || fail "$folder belongs to another user; set VOXLIST_RUN_DIR to a folder of your own"
  echo "$folder"
}

# The settings of the services that run, or ran last; else those that come with them.
settings_in_use() {
  local file
  for file in "$(run_folder)/robot.toml" "$root/services/robot.toml" /etc/voxlist/robot.toml; do
    [[ ! -e $file ]] || { echo "$file" && return; }
  done
}

# read_bus CONFIG: sets lcm_url and prefix as the services with these settings have them; of "" as those in use. Sets
# lasers to "|NAME" for each channel of cloud_adapter's sensors, and desk to the program voxlist, or to nothing.
read_bus() {
  local config=${1:-$(settings_in_use)} told
  lcm_url=${LCM_DEFAULT_URL:-udpm://239.255.76.67:7667?ttl=0}
  prefix=
  lasers=
  desk=${VOXLIST_BIN_DIR:-$root/build/bin}/voxlist
  [[ -x $desk ]] || desk=$(command -v voxlist) || desk=
  if [[ -n $desk ]]; then
    told=$("$desk" bus ${config:+--config "$config"}) || exit 1
    lcm_url=$(sed -n 's/^url //p' <<<"$told")
    prefix=$(sed -n 's/^prefix //p' <<<"$told")
    lasers=$(sed -n 's/^laser /|/p' <<<"$told" | tr -d '\n')
  elif [[ -n ${1:-} ]] || grep -Eqs '^[[:space:]]*(bus\.)?(url|prefix)[[:space:]]*=' "$config"; then
    fail "$config cannot be read without the program voxlist; scripts/build makes it"
  fi
  # Tools of LCM get a buffer that holds whole scans: with LCM's own default most large messages are lost.
  if [[ $lcm_url == udpm://* && $lcm_url != *recv_buf_size=* ]]; then
    [[ $lcm_url == *\?* ]] && lcm_url+='&' || lcm_url+='?'
    lcm_url+=recv_buf_size=8000000
  fi
}

# find_parts LOG: sets parts to the files of a recording, in their order: LOG, else LOG.00, LOG.01, ... Tells which
# are missing.
find_parts() {
  local file next=0
  parts=()
  if [[ -e $1 ]]; then
    parts=("$1")
    return
  fi
  for file in "$1".[0-9][0-9] "$1".[0-9][0-9][0-9]; do
    [[ -e $file ]] || continue
    while ((next < 10#${file##*.})); do
      say "$(printf '%s.%02d' "$1" $next) is not there, its messages are missing"
      ((++next))
    done
    ((++next))
    parts+=("$file")
  done
}
