# shellcheck shell=bash
# Common part of tests/proofs/*/run. Source it, define `prove` and `seeded`, and end with: proof "$@"
# prove: exit status 0 if the proof holds; its last line has the figures. seeded: exit status 0 if each seeded fault was
# found.
# shellcheck source=../../scripts/tools/lib.sh
. "$(dirname "${BASH_SOURCE[0]}")/../../scripts/tools/lib.sh"
here=$(dirname "$(readlink -f "$0")")
here=${here#"$ROOT"/}
cd "$ROOT" || exit
seed=tests/proofs/seed.py
work=$ROOT/build/proof/$(basename "$here")
mkdir -p "$work" build/log

proof() {
    help_of "$@"
    if [[ ${1:-} == --seeded ]]; then
        seeded
    else
        prove "$@"
    fi
}

# build PRESET TARGET...: prints the end of the log after a failure
build() {
    { cmake --preset "$1" && cmake --build --preset "$1" --target "${@:2}"; } >"$work/build-$1.log" 2>&1 ||
        { tail -n 25 "$work/build-$1.log" && die "the preset $1 does not build: $work/build-$1.log"; }
}

# build_host CHECKER...: builds the programs with the seeded faults of these checkers
build_host() {
    local checker programs=()
    for checker in "$@"; do
        mapfile -t -O "${#programs[@]}" programs < <("$seed" list "$checker" | sed "s/|.*//; s/^/seeded_${checker}_/")
    done
    build host "${programs[@]}"
}

# each_seeded CHECKER FUNCTION: runs FUNCTION NAME ARGUMENTS TEXT for each seeded fault of the checker
each_seeded() {
    local lines name arguments text
    lines=$("$seed" rows "$1") || die "the seeded faults of $1 cannot be read"
    while IFS=$'\t' read -r name arguments text; do
        "$2" "$name" "$arguments" "$text"
    done <<<"$lines"
}

# each_shard FUNCTION ARGUMENT...: runs FUNCTION I ARGUMENT... for each processor I, from 1, beside each other. Exit status 1 if
# one of them fails.
each_shard() {
    local i jobs pids=() status=0
    jobs=$(nproc)
    for ((i = 1; i <= jobs; i++)); do
        "$1" "$i" "${@:2}" &
        pids+=($!)
    done
    for i in "${pids[@]}"; do
        wait "$i" || status=1
    done
    return "$status"
}

shard_of_program() {
    "$2" --shard "$(($1 - 1))/$(nproc)" "${@:3}" >"$work/shard$1.log" 2>&1
}

# Shards of a program, as many as there are processors, into $work/shard*.log. run_shards PROGRAM OPTION...
run_shards() {
    local status=0
    rm -f "$work"/shard*.log
    each_shard shard_of_program "$@" || status=1
    cat "$work"/shard*.log
    return "$status"
}

# The last lines of all shards as one line: each number is the sum, except the first one, which is the same in all.
add_up() {
    tail -q -n 1 "$work"/shard*.log | awk '
        { for (i = 1; i <= NF; i++) {
              word[i] = $i
              if ($i ~ /^[0-9]+$/) { sum[i] = (i == 1) ? $i : sum[i] + $i } } }
        END { for (i = 1; i <= NF; i++) { printf "%s%s", (i in sum) ? sum[i] : word[i], (i < NF) ? " " : "\n" } }'
}
