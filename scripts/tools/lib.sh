# shellcheck shell=bash
# What the scripts share. Source it.
set -euo pipefail
ROOT=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
SCRIPT=$(readlink -f "$0")
export LC_ALL=C.UTF-8
PATH=$PATH:/usr/sbin:/sbin # an ordinary user of Debian does not have kmod, tc and debootstrap in it

# Lines on standard error, and out. A proof goes by the name of its folder.
die() {
    local name=${0%/run}
    name=${name##*/}
    echo "${name%.*}: $*" >&2
    exit 1
}

# help_of ARGUMENT...: for --help, the comment at the top of the script, and out
help_of() {
    [[ ${1:-} == --help ]] || return 0
    sed -n '2,/^[^#]/s/^# \{0,1\}//p' "$SCRIPT" | grep -v '^shellcheck'
    exit
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
