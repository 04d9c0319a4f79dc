#!/usr/bin/env bats
# What the analyzers of the sources must say of a small core that is made here.
load ../../support/helper

setup() {
    cd "$BATS_TEST_TMPDIR" || exit
    mkdir -p firmware/src firmware/include hal/include tests/proofs/static
    echo "# none" >tests/proofs/static/deviations
    core 'return a;'
    passes "$ROOT/tests/proofs/static/check-misra.py" --root "$PWD"
}

# core BODY: the source of the core
core() {
    printf '#include <stdint.h>\nuint32_t f(uint32_t a);\nuint32_t f(uint32_t a)\n{\n    %s\n}\n' "$1" >firmware/src/f.c
}

# found RULE BODY
found() {
    core "$2"
    fails_with "firmware/src/f.c:5: $1: " "$ROOT/tests/proofs/static/check-misra.py" --root "$PWD"
}

@test "static: MISRA: an if without braces, an assignment in an expression" {
    found 15.6 'if (a > 1u) a = 0u; return a;'
    found 13.4 'uint32_t b; return (b = a);'
}

@test "static: MISRA: an if, else if without else, a loop that is left in two places" {
    found 15.7 'if (a > 1u) { a = 0u; } else if (a > 0u) { a = 2u; } return a;'
    found 15.4 'while (a > 1u) { a--; if (a == 7u) { break; } if (a == 9u) { break; } } return a;'
}

@test "static: cppcheck: an index behind an array" {
    found arrayIndexOutOfBounds 'uint8_t b[4] = {0u, 0u, 0u, 0u}; b[4] = 1u; return a + b[0];'
}

@test "static: cppcheck: what was never set" {
    found uninitvar 'uint32_t b; return a + b;'
}

@test "static: a deviation needs its reason, its place, and something to deviate from" {
    core 'if (a > 1u) a = 0u; return a;'
    echo '15.6 firmware/src/f.c: if (a > 1u) a = 0u; return a;' >tests/proofs/static/deviations
    fails_with "has no reason" "$ROOT/tests/proofs/static/check-misra.py" --root "$PWD"
    echo '    a line that people write so' >>tests/proofs/static/deviations
    passes "$ROOT/tests/proofs/static/check-misra.py" --root "$PWD"
    core 'return a;'
    fails_with "is not needed" "$ROOT/tests/proofs/static/check-misra.py" --root "$PWD"
    printf '15.6 everywhere\n    a line that people write so\n' >tests/proofs/static/deviations
    fails_with "is not advisory" "$ROOT/tests/proofs/static/check-misra.py" --root "$PWD"
}

# analyzed TEXT SOURCE: gcc -fanalyzer as in the proof
analyzed() {
    printf '#include <stdlib.h>\nvoid f(size_t n);\n%s\n' "$2" >leak.c
    fails_with "$1" gcc -std=c11 -O1 -fanalyzer -Wall -Wextra -Werror -c leak.c -o leak.o
}

@test "static: gcc -fanalyzer: a block that nobody frees, a block freed twice" {
    printf 'int f(int n);\nint f(int n) { return n; }\n' >fine.c
    passes gcc -std=c11 -O1 -fanalyzer -Wall -Wextra -Werror -c fine.c -o fine.o
    analyzed analyzer-malloc-leak 'void f(size_t n) { char *p = malloc(n); if (p != NULL) { p[0] = 1; } }'
    analyzed analyzer-double-free 'void g(char *p); void g(char *p) { free(p); free(p); }'
}
