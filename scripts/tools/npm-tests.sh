#!/usr/bin/env bash
# Install the packages of tests/web/package-lock.json into the build tree: build/npm/node_modules is where the tests find
# them. Does nothing if they are installed.
# shellcheck source=lib.sh
. "$(dirname "${BASH_SOURCE[0]}")/lib.sh"

command -v npm >/dev/null || die "'npm' is missing: run ./scripts/install-deps"
mkdir -p "$ROOT/build/npm"
cd "$ROOT/build/npm"
exec 9>.lock
flock 9
if [[ .complete -nt $ROOT/tests/web/package-lock.json ]]; then
    exit 0
fi
cp "$ROOT"/tests/web/package{,-lock}.json .
npm ci --no-audit --no-fund --ignore-scripts --loglevel=error
touch .complete
