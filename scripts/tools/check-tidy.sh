#!/usr/bin/env bash
# clang-tidy 19 over the C files that ship: the core, the ports for hosts, the host program (not tests and benchmarks).
# usage: check-tidy [--changed] [FILE...]
#   --changed: not again what it found nothing in before, to the last byte
#   FILE: one that is not part of the build is compiled by itself, as C11
# shellcheck source=lib.sh
. "$(dirname "${BASH_SOURCE[0]}")/lib.sh"
build=$ROOT/build/host-clang
changed=0
if [[ ${1:-} == --changed ]]; then
    changed=1
    shift
fi
if (($# == 0)) || [[ ! -f $build/compile_commands.json ]]; then
    cmake --preset host-clang -S "$ROOT" >&2
fi

# built: the files of the build, as its database names them
built() { sed -nE 's|^ *"file": "(.*\.c)",?$|\1|p' "$build/compile_commands.json" | sort -u; }

if (($# > 0)); then
    mapfile -t files < <(realpath -- "$@")
else
    mapfile -t files < <(built | grep -E "^$ROOT/(firmware|hal|host_sim)/")
fi
if ((${#files[@]} == 0)); then
    die "nothing to check"
fi

# What the answer depends on.
state() {
    clang-tidy-19 --version
    cat "$0" "$ROOT/.clang-tidy" "$build/compile_commands.json"
    find "$ROOT"/{firmware,hal,host_sim} -name '*.h' -o -name '*.def' | sort | xargs cat "${files[@]}"
}

if ((changed)); then
    sum=$(state | sha256sum)
    passed=$build/clang-tidy/${sum%% *}
    if [[ -f $passed ]]; then
        echo "no findings: the files are unchanged since the last check"
        exit
    fi
fi
# The analyzer stops exploring a function after so many steps: eight times faster than with its default of 225000.
analyzer=(-Xclang -analyzer-config -Xclang max-nodes=30000)
tidy=(clang-tidy-19 --config-file="$ROOT/.clang-tidy" --quiet "${analyzer[@]/#/--extra-arg=}")

# check FILE...: with the options of the build where all are part of it. For any other file clang-tidy would take the
# options of the file in the build whose path looks most like it, a test's with its runner among them.
check() {
    if [[ -n $(comm -23 <(printf '%s\n' "$@" | sort) <(built)) ]]; then
        "${tidy[@]}" "$@" -- -std=c11
    else
        printf '%s\0' "$@" | xargs -0 -n 4 -P "$(nproc)" "${tidy[@]}" -p "$build"
    fi
}

check "${files[@]}" 2>&1 | sed -E '/^\[[0-9]+\/|^[0-9]+ warnings? generated|^Suppressed /d'
if ((changed)); then
    mkdir -p "${passed%/*}"
    touch "$passed"
fi
