# What the tests of others' readers share: the npm packages of the test's folder, in the build folder. Sourced, never run.
# shellcheck shell=bash
# shellcheck source=SCRIPTDIR/../../scripts/lib.sh
source "$(dirname "${BASH_SOURCE[0]}")/../scripts/lib.sh"

node_tests=$(cd "$(dirname "$0")" && pwd)
modules=${BUILD:?}/foreign_$(basename "$node_tests")
for tool in node npm; do command -v "$tool" >/dev/null || skip "$tool is not installed"; done

# Node finds packages beside the files that use them, so the tests run from a copy. One test at a time makes it.
mkdir -p "$modules"
exec 9>"$modules.lock"
flock 9
if ! cmp -s "$node_tests/package-lock.json" "$modules/package-lock.json" || [[ ! -d $modules/node_modules ]]; then
  cp "$node_tests"/package*.json "$modules"
  (cd "$modules" && npm ci --no-audit --no-fund --ignore-scripts \
    --fetch-retries=1 --fetch-retry-mintimeout=1000 --fetch-retry-maxtimeout=2000 >npm.log 2>&1) || {
    rm "$modules/package-lock.json"
    skip "npm cannot fetch the readers: $(head -n 1 "$modules/npm.log")"
  }
fi
# Only what has changed: another test may be reading them.
cp -u "$node_tests"/*.js "$modules"
exec 9>&-
