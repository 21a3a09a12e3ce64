# Pieces that the scripts share. Sourced, never run.
# shellcheck shell=bash disable=SC2034

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
program=$(basename "$0")

# The services that scripts/services runs, in the order of services/README.md. The first three are for
# robots that have the mirror scanner.
scanner_services=(laser_driver mirror_monitor cloud_assembler)
services=("${scanner_services[@]}" localiser mapper octomap_export obstacle_detector)

# Tools of LCM get a buffer that holds whole scans: with LCM's own default most large messages are lost.
lcm_url=${LCM_DEFAULT_URL:-udpm://239.255.76.67:7667?ttl=0&recv_buf_size=8000000}

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
