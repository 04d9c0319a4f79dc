#!/usr/bin/env bats
# scripts/tools/stack-depth.py on small call graphs.
load ../support/helper

setup() {
    cd "$BATS_TEST_TMPDIR" || exit
}

# graph NAME: compile NAME.c from standard input for its call graph
graph() {
    cat >"$1.c"
    arm-none-eabi-gcc -mcpu=cortex-m4 -mthumb -Os -fcallgraph-info=su -c "$1.c" -o "$1.o"
}

# Shows: INT-1
@test "stack: recursion" {
    graph recursion <<<'int g(int n); int f(int n); int f(int n) { return g(n) + 1; } int g(int n) { return f(n) * 3; }'
    fails_with "recursion: " "$ROOT/scripts/tools/stack-depth.py" recursion.ci --entry f
}

@test "stack: recursion through a pointer" {
    graph table <<<'void f(int n); static void h(int n) { f(n); } static void (*const table[])(int) = {h, h};
        void f(int n) { table[n & 1](n); }'
    fails_with "recursion: " "$ROOT/scripts/tools/stack-depth.py" table.ci --objects table.o --entry f
}

@test "stack: the frames along the deepest path are added up" {
    graph chain <<<'void x(char *p); void h(void); void f(void);
        __attribute__((noinline)) void h(void) { char a[100]; x(a); } void f(void) { char a[40]; x(a); h(); }'
    passes "$ROOT/scripts/tools/stack-depth.py" chain.ci --entry f
    [[ $output == *"f > h"* ]]
    depth=$(awk '/^stack/ { print $2 }' <<<"$output")
    ((depth >= 140 && depth <= 180))
}
