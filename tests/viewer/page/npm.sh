# What the tests of the page share: npm's packages, in the build folder. Sourced, never run.
# shellcheck shell=bash
# shellcheck source=SCRIPTDIR/../../scripts/lib.sh
source "$(dirname "${BASH_SOURCE[0]}")/../../scripts/lib.sh"

page_tests=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
modules=${BUILD:?}/page_test
for tool in node npm; do command -v "$tool" >/dev/null || skip "$tool is not installed"; done

# Node finds packages beside the files that use them, so the tests run from a copy.
mkdir -p "$modules"
if ! cmp -s "$page_tests/package-lock.json" "$modules/package-lock.json" || [[ ! -d $modules/node_modules ]]; then
  cp "$page_tests"/package*.json "$modules"
  (cd "$modules" && npm ci --no-audit --no-fund --ignore-scripts \
    --fetch-retries=1 --fetch-retry-mintimeout=1000 --fetch-retry-maxtimeout=2000 >npm.log 2>&1) || {
    rm "$modules/package-lock.json"
    skip "npm cannot fetch playwright-core and typescript: $(head -n 1 "$modules/npm.log")"
  }
fi
