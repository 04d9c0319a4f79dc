#!/usr/bin/env bats
# The budgets of flash, RAM and stack, and what the core must not use.
load ../support/helper

setup() {
    cd "$BATS_TEST_TMPDIR" || exit
}

# What is planted has to be the only thing that is over a limit.
no_limit=(--max-flash 1000000 --max-ram 1000000 --max-stack 1000000)

# graph NAME: compile NAME.c from standard input for its call graph
graph() {
    cat >"$1.c"
    arm-none-eabi-gcc -mcpu=cortex-m4 -mthumb -Os -fcallgraph-info=su -c "$1.c" -o "$1.o"
}

@test "size: flash over its limit" {
    passes "$ROOT/scripts/tools/size.py" "${no_limit[@]}"
    fails_with "over the limit" "$ROOT/scripts/tools/size.py" "${no_limit[@]}" --max-flash 100
}

# Objects of another name: none of them found is no 0 bytes.
@test "size: a map without the core" {
    cp -r "$ROOT/build/cortex-m" build
    sed -i 's/libagv_core/libother/g' build/size_image.map
    fails_with "nothing of the core is in size_image.map" "$ROOT/scripts/tools/size.py" "${no_limit[@]}" --build "$PWD/build"
}

@test "size: RAM over its limit" {
    fails_with "over the limit" "$ROOT/scripts/tools/size.py" "${no_limit[@]}" --max-ram 10
}

@test "size: stack over its limit" {
    fails_with "allowed are 8" "$ROOT/scripts/tools/size.py" "${no_limit[@]}" --max-stack 8
}

@test "size: an image without the supervisor" {
    mkdir bin
    echo 'int main(void) { return 0; }' >main.c
    arm-none-eabi-gcc -nostartfiles -Wl,--entry=main main.c -o bin/size_image
    fails_with "not in the image: agv_supervisor_start" "$ROOT/scripts/tools/size.py" --build "$PWD"
}

@test "size: a core that uses the heap" {
    mkdir bin
    cp "$ROOT/build/cortex-m/bin/size_image" bin
    printf '#include <stdlib.h>\nvoid *f(void);\nvoid *f(void) { return malloc(1); }\n' >heap.c
    arm-none-eabi-gcc -mcpu=cortex-m4 -mthumb -c heap.c -o heap.o
    arm-none-eabi-ar rc libagv_core_cortex-m4.a heap.o
    fails_with "the core uses malloc" "$ROOT/scripts/tools/size.py" --build "$PWD"
}

# Shows: INT-1
@test "stack: recursion" {
    graph recursion <<<'int g(int n); int f(int n); int f(int n) { return g(n) + 1; } int g(int n) { return f(n) * 3; }'
    fails_with "recursion: " "$ROOT/scripts/tools/stack-depth.py" recursion.ci --entry f
}

@test "stack: a call through a pointer" {
    graph pointer <<<'int f(int (*g)(void)); int f(int (*g)(void)) { return g() + 1; }'
    fails_with "calls through a pointer" "$ROOT/scripts/tools/stack-depth.py" pointer.ci --entry f
}

@test "stack: recursion through a pointer" {
    graph table <<<'void f(int n); static void h(int n) { f(n); } static void (*const table[])(int) = {h, h};
        void f(int n) { table[n & 1](n); }'
    fails_with "recursion: " "$ROOT/scripts/tools/stack-depth.py" table.ci --objects table.o --entry f
}

@test "stack: a frame without a fixed size" {
    graph vla <<<'void g(char *p); void f(int n); void f(int n) { char a[n]; g(a); }'
    fails_with "not fixed" "$ROOT/scripts/tools/stack-depth.py" vla.ci --entry f
}

@test "stack: the frames along the deepest path are added up" {
    graph chain <<<'void x(char *p); void h(void); void f(void);
        __attribute__((noinline)) void h(void) { char a[100]; x(a); } void f(void) { char a[40]; x(a); h(); }'
    passes "$ROOT/scripts/tools/stack-depth.py" chain.ci --entry f
    [[ $output == *"f > h"* ]]
    depth=$(awk '/^stack/ { print $2 }' <<<"$output")
    ((depth >= 140 && depth <= 180))
}
