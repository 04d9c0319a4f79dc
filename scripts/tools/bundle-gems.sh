#!/usr/bin/env bash
# Install the gems of Gemfile.lock (Unity and CMock) into the build tree: build/gems/vendor is where the build finds them.
# Called by the build and by scripts/test; does nothing if they are installed.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
gems=$root/build/gems

export BUNDLE_GEMFILE=$root/Gemfile
export BUNDLE_PATH=$gems
export BUNDLE_APP_CONFIG=$gems/config # nothing is written outside the build tree
export BUNDLE_FROZEN=true             # exactly the versions of the lock file
export BUNDLE_SILENCE_ROOT_WARNING=true

if ! command -v bundle >/dev/null; then
    echo "bundle-gems: 'bundle' is missing: run ./scripts/install-deps" >&2
    exit 1
fi

mkdir -p "$gems"
exec 9>"$gems/.lock"
flock 9 # several build trees share the gems
if [[ $gems/.complete -nt $root/Gemfile.lock ]]; then
    exit 0
fi
bundle install --quiet
# The path of a gem holds versions of Ruby and of the gem; the link does not.
ln -sfn "$(bundle info --path ceedling)/vendor" "$gems/vendor"
touch "$gems/.complete"
