#!/usr/bin/env bats
# Conditions that MC/DC would not see, planted in a core of one function.
load ../support/helper

setup() {
    command -v clang-19 >/dev/null || skip "there is no clang-19"
    cd "$BATS_TEST_TMPDIR" || exit
    mkdir -p firmware/src firmware/include hal/include tests/proofs/mcdc
    echo "# none" >tests/proofs/mcdc/exceptions
    core 'if ((a > 1) && (b > 1)) { a = 0; } return !(a || (b == 3));'
    passes "$ROOT/scripts/tools/check-conditions.py" --root "$PWD"
    [[ $output == "2 decisions of several conditions"* ]]
}

# core BODY: the source of the core
core() {
    printf '#include <stdbool.h>\nbool f(int a, int b, bool c);\nbool f(int a, int b, bool c) {\n%s\n}\n' "$1" \
        >firmware/src/f.c
}

# hidden WHAT BODY
hidden() {
    core "$2"
    fails_with "firmware/src/f.c:4: $1" "$ROOT/scripts/tools/check-conditions.py" --root "$PWD"
}

@test "conditions: comparisons below a bitwise operator" {
    hidden "a condition below '&'" 'return (a > 1) & (b > 1);'
    hidden "a condition below '|'" 'return (unsigned)(a > 1) | (unsigned)b;'
}

@test "conditions: a bool below a bitwise assignment" {
    hidden "a condition below '|='" 'int x = a; x |= c; return x > b;'
    hidden "a condition below '&='" 'int x = a; x &= (b > 1) ? 1 : 0; return x > b;'
}

@test "conditions: an if in an if" {
    hidden "an if in an if" 'if (a > 1) { if (b > 1) { return true; } } return c;'
}

@test "conditions: an arm of a conditional expression" {
    hidden "a condition in an arm" 'return (a > 1) ? (b > 1) : false;'
}

@test "conditions: an exception needs its reason, and something to except" {
    core 'return (a > 1) & c;'
    echo 'firmware/src/f.c: return (a > 1) & c;' >tests/proofs/mcdc/exceptions
    fails_with "has no reason" "$ROOT/scripts/tools/check-conditions.py" --root "$PWD"
    echo '    both are always looked at' >>tests/proofs/mcdc/exceptions
    passes "$ROOT/scripts/tools/check-conditions.py" --root "$PWD"
    core 'return (a > 1) && c && (b > 1);'
    fails_with "is not needed" "$ROOT/scripts/tools/check-conditions.py" --root "$PWD"
}
