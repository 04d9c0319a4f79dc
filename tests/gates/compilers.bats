#!/usr/bin/env bats
# Warnings are errors in all three compilers, and the sanitizers are on.
load ../support/helper

@test "a warning stops gcc" {
    fails_with "-Werror=conversion" cmake --build "$ROOT/build/host" --target planted_warning
}

@test "a warning stops clang" {
    passes cmake --preset host-clang -S "$ROOT"
    fails_with "-Werror,-Wimplicit-int-conversion" cmake --build "$ROOT/build/host-clang" --target planted_warning
}

@test "a warning stops the Arm compiler" {
    fails_with "-Werror=conversion" cmake --build "$ROOT/build/cortex-m" --target planted_warning
}

@test "the sanitizers catch a heap overflow" {
    build sanitize planted_heap_overflow
    fails_with "heap-buffer-overflow" "$ROOT/build/sanitize/bin/planted_heap_overflow"
}

@test "the sanitizers catch a signed overflow" {
    build sanitize planted_signed_overflow
    fails_with "signed integer overflow" "$ROOT/build/sanitize/bin/planted_signed_overflow"
}

@test "the sanitizers catch a leak" {
    build sanitize planted_leak
    fails_with "detected memory leaks" "$ROOT/build/sanitize/bin/planted_leak"
}
