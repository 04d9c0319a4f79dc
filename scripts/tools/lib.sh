# shellcheck shell=bash
# What the scripts share. Source it.
set -euo pipefail
ROOT=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
export LC_ALL=C.UTF-8

# Lines on standard error, and out. A proof goes by the name of its folder.
die() {
    local name=${0%/run}
    name=${name##*/}
    echo "${name%.*}: $*" >&2
    exit 1
}

headline() {
    printf '\n== %s\n' "$*"
}

# The newest of two programs, or nothing: newest clang-format-19 clang-format
first_of() {
    local name
    for name in "$@"; do
        if command -v "$name"; then
            return
        fi
    done
}

# All C files of this project, in every folder that has some.
c_files() {
    find "$ROOT"/{firmware,hal,host_sim,bench,tests,web} -name '*.[ch]' | sort
}

# Runs of unit and integration tests with other start times of the clock are left out: they reach no other code.
CORE_TESTS=(-L '^(unit|integration)$' -E '_wrap_in_')

# build_core_tests PRESET: their programs, and nothing else of this build; configured before
build_core_tests() {
    local programs
    mapfile -t programs < <(ctest --preset "$1" -N "${CORE_TESTS[@]}" | sed -nE 's/^ *Test +#[0-9]+: (\w+)$/\1/p')
    cmake --build --preset "$1" --target "${programs[@]}"
}
