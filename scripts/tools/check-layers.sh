#!/usr/bin/env bash
# The layers: firmware/ is portable and knows the HAL's contract only, a port knows the contract only, and one file of the
# core sends. Inside firmware/src: a source includes headers of its room and of others by "<room>/<file>.h", and the memory
# of a supervisor (core.h) is known to supervisor*.c alone. usage: check-layers [ROOT]
# shellcheck source=lib.sh
. "$(dirname "${BASH_SOURCE[0]}")/lib.sh"
cd "${1:-$ROOT}" || exit

found=0
# $1: the message; standard input: the offending lines, empty if there are none
report() {
    local lines
    lines=$(cat)
    if [[ -n $lines ]]; then
        printf '%s:\n%s\n' "$1" "$lines" >&2
        found=1
    fi
}

core=(firmware/include firmware/src)
if [[ -z $(find "${core[@]}" hal/include -name '*.[ch]') ]]; then
    die "nothing to check in $PWD"
fi

# Headers of a freestanding C11 implementation, and string.h.
standard='<(limits|stdalign|stdbool|stddef|stdint|string)\.h>'

# Private headers and tables, as they are included: |"<room>/<file>.h"|... of those that exist, each dot escaped.
private=$(cd firmware/src && find . -mindepth 2 \( -name '*.h' -o -name '*.def' \) -printf '|"%P"' | sed 's/\./\\./g')
report 'firmware/ includes something other than C headers, "agv/...", "hal/..." and, in src, "<room>/<file>.h"' < <(
    grep -rnE '^\s*#\s*include' firmware/src --include='*.[ch]' --include='*.def' |
        grep -vE "include ($standard|\"(agv|hal)/[a-z0-9_]+\.(h|def)\"$private)" || true
    grep -rnE '^\s*#\s*include' firmware/include --include='*.[ch]' --include='*.def' |
        grep -vE "include ($standard|\"(agv|hal)/[a-z0-9_]+\.(h|def)\")"
)

report 'a source of firmware/src is not in a folder of a module group' < <(find firmware/src -maxdepth 1 -name '*.[ch]')

# A room includes itself and those before it. $1: the folder of the rooms; then the rooms in order
check_order() {
    local root=$1 order=("${@:2}") i later
    report "rooms of $root without a place in the order, or in the order and not there" < <(
        comm -3 <(printf '%s\n' "${order[@]%%/*}" | sort -u) <(cd "$root" && find . -mindepth 2 -name '*.[ch]' | cut -d/ -f2 | sort -u)
    )
    for ((i = 0; i < ${#order[@]}; i++)); do
        later=$(printf '|%s' "${order[@]:i+1}")
        report "$root/${order[i]} includes a later room of ${order[*]}" < <(
            [[ $later == '|' ]] || grep -rnE --exclude-dir=commands "^\s*#\s*include\s+\"(${later#|})/" "$root/${order[i]}" || true
        )
    done
}
check_order firmware/src base keep observe decide transmit supervisor
if [[ -d host_sim ]]; then
    check_order host_sim text common session io logs traffic why cli config report analysis vehicle scenario ui survey recorder \
        replay campaign hunt atlas skeleton monitor live cli/commands
fi

report 'only firmware/src/supervisor/supervisor*.[ch] may access the memory of a supervisor' < <(
    grep -rnE '^\s*#\s*include\s+"([^"]*/)?(core|supervisor_internal)\.h"' firmware hal --include='*.[ch]' |
        grep -v '^firmware/src/supervisor/supervisor'
)

# Programs and ports know agv/... and hal/...; tests that look inside have their folder in $insiders.
insiders='^tests/(unit/|proofs/(explorer|bit-flips|gate|eva|unbounded)/|support/gate_oracle\.h:)'
rooms=$(find firmware/src -mindepth 1 -maxdepth 1 -type d -printf '|%f')
outside=()
for folder in hal host_sim firmware/zephyr bench tests; do
    if [[ -d $folder ]]; then
        outside+=("$folder")
    fi
done
report 'a program, a port or a test of something else includes a header of firmware/src' < <(
    grep -rnE "^\s*#\s*include\s+\"([^\"]*/)?(${rooms#|})/[a-z0-9_]+\.(h|def)\"" "${outside[@]}" \
        --include='*.[ch]' | grep -vE "$insiders"
)

# Preprocessor conditions may only use include guards, X-macros and __cplusplus.
report 'a platform #if in the portable part' < <(
    grep -rnE '^\s*#\s*(if|ifdef|ifndef|elif)\b' "${core[@]}" hal/include --include='*.[ch]' |
        grep -vE '#\s*(if|ifdef|ifndef|elif)\s+(!?defined\(?)?\s*(AGV_|HAL_|__cplusplus)[A-Z0-9_]*\)?\s*(/\*.*)?$'
)

report 'the HAL includes headers of the core' < <(
    grep -rnE '^\s*#\s*include\s+"agv/' hal --include='*.[ch]'
)

report 'hal/include includes something other than C headers and "hal/..."' < <(
    grep -rnE '^\s*#\s*include' hal/include --include='*.[ch]' |
        grep -vE "include ($standard|\"hal/[a-z0-9_]+\.h\")"
)

report 'a frame bypasses the gate (INT-4): only gate.c may call hal_can_send' < <(
    grep -rnE '\bhal_can_send\s*\(' firmware --include='*.c' | grep -v '^firmware/src/transmit/gate\.c:'
)

# firmware/zephyr is a program: it may use core, port and Zephyr, but not drivers, which belong to the port.
report 'firmware/zephyr bypasses the port and uses a driver' < <(
    if [[ -d firmware/zephyr ]]; then
        grep -rnE '^\s*#\s*include\s+<zephyr/(drivers|task_wdt|fs|storage)/' firmware/zephyr --include='*.[ch]'
    fi
)

exit "$found"
