#!/usr/bin/env bats
# install-deps says in one line what to do where it can do nothing, and the test command what it does not take.
load ../support/helper

# A PATH with these commands only.
only() {
    mkdir -p "$BATS_TEST_TMPDIR/bin"
    local name
    for name in bash env dirname "$@"; do
        command -v "$name" >/dev/null || continue # no sudo, for one
        ln -sf "$(command -v "$name")" "$BATS_TEST_TMPDIR/bin/"
    done
}

@test "another distribution: one line that says what to install" {
    only
    fails_with "neither Debian nor Ubuntu: install the like of" env PATH="$BATS_TEST_TMPDIR/bin" "$ROOT/scripts/install-deps" demo
    [[ ${#lines[@]} -eq 1 ]]
}

@test "no network: one line that says so" {
    only mkdir apt-cache sed tail sudo
    # Nothing is installed here, and nothing can be fetched.
    printf '#!/bin/sh\nexit 1\n' >"$BATS_TEST_TMPDIR/bin/dpkg-query"
    printf '#!/bin/sh\necho "Could not resolve host" >&2\nexit 100\n' >"$BATS_TEST_TMPDIR/bin/apt-get"
    chmod +x "$BATS_TEST_TMPDIR/bin/dpkg-query" "$BATS_TEST_TMPDIR/bin/apt-get"
    fails_with "is there a network" env PATH="$BATS_TEST_TMPDIR/bin" "$ROOT/scripts/install-deps" demo
}

@test "a word that it does not know" {
    fails_with "neither demo nor vcan nor test" "$ROOT/scripts/install-deps" everything
}

@test "the test command takes no arguments" {
    fails_with "it takes no arguments, not 'all'" "$ROOT/scripts/test" all
    [[ ${#lines[@]} -eq 1 ]]
}
