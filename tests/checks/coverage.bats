#!/usr/bin/env bats
# Coverage of a small core that is made here: everything is covered, until a fault is seeded.
load ../support/helper

setup() {
    cd "$BATS_TEST_TMPDIR" || exit
    mkdir -p firmware/src firmware/include build
    cat >firmware/src/limit.c <<'C'
int limit(int value);
int limit(int value) {
    if (value > 9) value = 9;
    return value;
}
C
    cat >main.c <<'C'
int limit(int value);
int main(void) {
    return limit(1) + limit(10) == 10 ? 0 : 1;
}
C
    measure
    passes "$ROOT/scripts/tools/check-coverage.sh" "$PWD" "$PWD/build"
}

# Compile, run, and leave what gcov needs in build/.
measure() {
    rm -f build/*
    gcc --coverage -O0 -c firmware/src/limit.c -o build/limit.o
    gcc --coverage main.c build/limit.o -o build/main
    build/main
}

@test "a function that no test calls fails the gate" {
    printf 'int unused(void);\nint unused(void) {\n    return 1;\n}\n' >>firmware/src/limit.c
    measure
    fails_with "coverage is below 100 %" "$ROOT/scripts/tools/check-coverage.sh" "$PWD" "$PWD/build"
}
