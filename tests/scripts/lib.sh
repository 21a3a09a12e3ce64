# What the tests of the scripts share. Sourced, never run.
# shellcheck shell=bash disable=SC2034

scripts=$(cd "$(dirname "${BASH_SOURCE[0]}")/../../scripts" && pwd)
work=$(mktemp -d /tmp/voxlist_test.XXXXXX)
export VOXLIST_RUN_DIR=$work/run XDG_STATE_HOME=$work/state
[[ -z ${BIN:-} ]] || export VOXLIST_BIN_DIR=$BIN # where the scripts look for programs
trap 'rm -rf "$work"' EXIT

skip() {
  echo "skipped: $*"
  exit 77
}

# check CLAIM COMMAND...: the command must succeed.
check() {
  local claim=$1
  shift
  if "$@" >"$work/output" 2>&1; then
    echo "ok: $claim"
  else
    echo "FAILED: $claim"
    cat "$work/output"
    exit 1
  fi
}

# says PATTERN COMMAND...: what the command writes must match, whatever its exit code.
says() {
  local pattern=$1 output
  shift
  output=$("$@" 2>&1) || true
  echo "$output"
  grep -Eq -- "$pattern" <<<"$output"
}

# fails COMMAND...: it must not succeed.
fails() { ! "$@"; }

# How many times slower the programs are than a release's: those with a sanitizer.
slower=${SLOWER:-1}

# within SECONDS COMMAND...: it must succeed before that time is over; slower programs have more.
within() {
  local end=$((${EPOCHREALTIME/./} + $1 * slower * 1000000))
  shift
  until "$@"; do
    ((${EPOCHREALTIME/./} < end)) || return 1
    sleep 0.05
  done
}

private_network() { "$scripts/netns" true 2>/dev/null; }
