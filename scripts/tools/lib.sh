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
    find "$ROOT"/{firmware,hal,host_sim,bench,tests} -name '*.[ch]' | sort
}
