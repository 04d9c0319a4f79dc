# shellcheck shell=bash
# Common part of the proofs by frama-c WP. Source it after proof.sh.
work=${work:?}

# The provers of this computer, independent of its user's configuration, into $provers.
prepare() {
    local name
    for name in frama-c why3; do
        command -v "$name" >/dev/null || die "needs $name (scripts/install-deps verify)"
    done
    mkdir -p "$work"
    export WHY3CONFIG=$work/why3.conf
    rm -f "$WHY3CONFIG"
    why3 config detect >"$work/detect.log" 2>&1 || true
    provers=
    for name in z3 cvc4 cvc5 alt-ergo; do
        if grep -qiE "^name = \"$name\"" "$WHY3CONFIG" 2>/dev/null; then
            provers+=${provers:+,}$name
        fi
    done
    [[ -n $provers ]] || die "why3 finds no prover: install z3 and cvc4"
}

# nothing_assumed FILE...: the files must not contain assumptions that are not proven
nothing_assumed() {
    local hit
    if hit=$(grep -nEi '\b(admit|axiom|assume|import)\b|\\false' "$@"); then
        echo "taken for granted: $hit"
        return 1
    fi
}

# frama_c LOG ARGUMENT...: succeeds if all goals are proven; sets goals to their number
frama_c() {
    local log=$1
    shift
    frama-c "$@" >"$log" 2>&1 || return
    goals=$(sed -n 's/^\[wp\] Proved goals: *\([0-9]*\) *\/ *\([0-9]*\)$/\1 \2/p' "$log")
    [[ -n $goals && ${goals% *} == "${goals#* }" && ${goals% *} != 0 ]]
}

# not_proven LOG: what a log says of goals that are not proven
not_proven() {
    grep -A3 -E '^\[wp\] \[(Failed|Timeout|Unknown)|rror' "$1" || true
    die "not proven: $1"
}
