# shellcheck shell=bash
# shellcheck disable=SC2154 # $work is the folder of who sources this
# What the proofs share that run a program on the simulated port: it is built once more, with mistakes in the core.

# Compile a program of tests/proofs. compile SOURCE CORE-FOLDER OUTPUT
compile() {
    ${CC:-cc} -std=c11 -O2 -w -I"$2" -Ifirmware/include -Ihal/include -Ihal/forward/include -Ihal/sim/include -Itests/support \
        "$2"/*/*.c hal/forward/*.c hal/sim/src/*.c tests/support/{testbed,rules,oracle,traffic}.c \
        tests/support/{testbed_state,part,harm}.c "$1" -o "$3"
}

# A copy of the core with texts replaced. plant FOLDER [ROOM/FILE OLD NEW]...
plant() {
    local folder=$1 text
    shift
    rm -rf "$folder"
    cp -r firmware/src "$folder"
    while (($# > 0)); do
        text=$(<"$folder/$1")
        [[ $text == *"$2"* ]] || die "'$2' is not in $1 any more"
        printf '%s\n' "${text//"$2"/"$3"}" >"$folder/$1"
        shift 3
    done
}

# The planted program must fail and say why. expect_found NAME WHAT TEXT PROGRAM OPTION...
expect_found() {
    local name=$1 what=$2 text=$3 said
    shift 3
    if timeout 600 "$@" >"$work/$name.log" 2>&1; then
        die "not found: $what"
    fi
    said=$(grep -m 1 -E "HARM: .*($text)" "$work/$name.log") || die "not for the right reason: $what ($work/$name.log)"
    echo "found: $what: ${said#HARM: }"
    caught=$((caught + 1))
}

# Shards of a program, as many as there are processors. The sums of the last lines' numbers. run_shards PROGRAM
run_shards() {
    local i jobs pids=() status=0
    jobs=$(nproc)
    for ((i = 0; i < jobs; i++)); do
        "$1" --shard "$i/$jobs" "${@:2}" >"$work/shard$i.log" 2>&1 &
        pids+=($!)
    done
    for i in "${!pids[@]}"; do
        wait "${pids[i]}" || status=1
    done
    for ((i = 0; i < jobs; i++)); do
        cat "$work/shard$i.log"
    done
    return "$status"
}

# The last lines of all shards as one: each number the sum, but for the first, which all have in common.
add_up() {
    local i logs=()
    for ((i = 0; i < $(nproc); i++)); do
        logs+=("$work/shard$i.log")
    done
    tail -q -n 1 "${logs[@]}" | awk '
        { for (i = 1; i <= NF; i++) {
              word[i] = $i
              if ($i ~ /^[0-9]+$/) { sum[i] = (i == 1) ? $i : sum[i] + $i } } }
        END { for (i = 1; i <= NF; i++) { printf "%s%s", (i in sum) ? sum[i] : word[i], (i < NF) ? " " : "\n" } }'
}
