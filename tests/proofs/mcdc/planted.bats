#!/usr/bin/env bats
# MC/DC of a small core that is made here: all is shown, until something is planted. Last, of the core itself.
load ../../support/helper

setup() {
    cd "$BATS_TEST_TMPDIR" || exit
    mkdir -p firmware/src firmware/include tests/proofs/mcdc build/bin build/profile
    cat >firmware/src/limit.c <<'C'
#include <stdbool.h>
bool both(int a, int b);
bool both(int a, int b) {
    return (a > 1) && (b > 1);
}
C
    echo "# none" >tests/proofs/mcdc/exclusions
    tests_of 'both(2, 2) + both(1, 2) + both(2, 1)'
    passes judge
}

judge() {
    "$ROOT/tests/proofs/mcdc/check-mcdc.py" --root "$PWD" --build "$PWD/build"
}

# tests_of EXPRESSION: compile the core and a test of it, run it, and leave what clang needs in build/.
tests_of() {
    rm -rf build/profile
    printf '#include <stdbool.h>\nbool both(int a, int b);\nint main(void) {\n    return (%s) > 9;\n}\n' "$1" >main.c
    clang-19 -c -fprofile-instr-generate -fcoverage-mapping -fcoverage-mcdc "$PWD/firmware/src/limit.c" -o build/limit.o
    clang-19 -fprofile-instr-generate main.c build/limit.o -o build/bin/one
    LLVM_PROFILE_FILE=build/profile/one.profraw build/bin/one
}

@test "mcdc: a condition whose effect no test shows, though every branch is taken" {
    tests_of 'both(2, 2) + both(1, 2)'
    fails_with "firmware/src/limit.c:4: condition 2 is not covered" judge
}

@test "mcdc: a function that no test calls" {
    tests_of '0'
    fails_with "line is not covered" judge
}

@test "mcdc: an exclusion has a reason, is needed, and is one of a hundred" {
    echo 'condition 2 firmware/src/limit.c: (a > 1) && (b > 1)' >tests/proofs/mcdc/exclusions
    fails_with "has no reason" judge
    echo '    nobody has two of them' >>tests/proofs/mcdc/exclusions
    fails_with "this exclusion is not needed" judge
    tests_of 'both(2, 2) + both(1, 2)'
    fails_with "1 conditions of 2 are excluded: more than 1 %" judge
}

@test "mcdc: a source that no test was linked with" {
    echo 'int other;' >firmware/src/other.c
    fails_with "other.c is not in the report" judge
}

@test "mcdc: the core without the tests of the recorder" {
    fails_with "condition 2 is not covered: !is_valid(event) ||" "$ROOT/tests/proofs/mcdc/check-mcdc.py" --without test_recorder
}

@test "mcdc: the core without the tests of damaged memory" {
    fails_with "condition 2 is not covered: (supervisor->seal == " "$ROOT/tests/proofs/mcdc/check-mcdc.py" --without test_supervisor_inside
}
