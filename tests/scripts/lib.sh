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
    uniq "$work/output"
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

# raw_room FOLDER N: what a laser that tells each point's time sees, N times a second apart, of a room of 8 x 6 m in which
# its robot stands; with odometry.csv.
raw_room() {
  local scan
  mkdir -p "$1"
  for ((scan = 0; scan < $2; ++scan)); do
    awk -v n=3000 'BEGIN {
      print "ply\nformat ascii 1.0\nelement vertex " n
      print "property float x\nproperty float y\nproperty float z\nproperty float time\nend_header"
      for (i = 0; i < n; ++i) {
        a = i * 6.2831853 / n; c = cos(a); s = sin(a)
        x = (c < 0 ? -c : c) / 4; y = (s < 0 ? -s : s) / 3; r = 1 / (x > y ? x : y)
        print r * c, r * s, (i % 16) * 0.1 - 0.7, 0.1 * i / n
      }
    }' >"$1/$((1700000000 + scan)).5.ply"
  done
  awk -v n="$2" 'BEGIN {
    print "utime_us,x_m,y_m,yaw_rad"
    for (i = 0; i < 50 * (n + 1); ++i) printf "%.0f,0,0,0\n", 1700000000000000 + i * 20000
  }' >"$1/odometry.csv"
}
