#!/usr/bin/env bats
# The way from a test program to a result, on the target: what must not pass there does not.
load ../../support/helper

# planted NAME TEXT: it fails on the target, and says this
planted() {
    build target "$1"
    fails_with "$2" ctest --test-dir "$ROOT/build/target" -C planted -R "^$1\$" -V
}

@test "target: an expectation that does not hold" {
    planted planted_failure "test_that_fails:FAIL: Expected 1 Was 2"
}

@test "target: a program that hangs" {
    planted planted_hang "Subprocess killed"
}

@test "target: a program that crashes" {
    planted planted_crash "the processor faulted"
}

@test "target: a program without a test, and one that is switched off" {
    planted planted_empty "contains no tests"
    planted planted_ignored "test_that_is_switched_off:IGNORE"
}

@test "target: a test that passes on the host alone" {
    build target planted_differs
    build host planted_differs
    local host=$BATS_TEST_TMPDIR/host target=$BATS_TEST_TMPDIR/target
    ctest --test-dir "$ROOT/build/host" -C planted -R '^(planted_differs|test_state)$' -V >"$host"
    ctest --test-dir "$ROOT/build/target" -C planted -R '^(planted_differs|test_state)$' -V >"$target" || true
    fails_with "planted_differs test_that_differs: on the host PASS, on the target FAIL" \
        "$ROOT/tests/proofs/target/compare.py" "$host" "$target"
}

@test "target: a test function that is missing there" {
    local host=$BATS_TEST_TMPDIR/host target=$BATS_TEST_TMPDIR/target
    ctest --test-dir "$ROOT/build/host" -R '^test_state$' -V >"$host"
    ctest --test-dir "$ROOT/build/target" -R '^test_state$' -V >"$target"
    passes "$ROOT/tests/proofs/target/compare.py" "$host" "$target"
    sed -i '0,/:PASS/{/:PASS/d}' "$target"
    fails_with "on the host PASS, on the target not there" "$ROOT/tests/proofs/target/compare.py" "$host" "$target"
}

@test "target: instructions counted by the computer's clock" {
    build target cost_ordinary
    fails_with "1000 instructions were counted as" "$ROOT/tests/proofs/target/emulate" "$ROOT/build/target/bin/cost_ordinary"
}
