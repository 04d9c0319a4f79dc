#!/usr/bin/env bats
# A unit test that fails, is switched off, or is none, fails the run.
load ../support/helper

# The whole way: the program is built, run by ctest, and counted.
planted_test() {
    build host "$1"
    log=$BATS_TEST_TMPDIR/log
    run ctest --test-dir "$ROOT/build/host" -C planted -R "^$1\$" -V
    echo "$output" | tee "$log"
    [[ $status -ne 0 && $output == *"$2"* ]]
    read -r _ failed < <("$ROOT/scripts/tools/count-tests.py" "$log")
    [[ $failed -eq 1 ]]
}

@test "an expectation that does not hold fails the run" {
    planted_test planted_failure "Expected 1 Was 2"
}

@test "a test that is switched off fails the run" {
    planted_test planted_ignored "test_that_is_switched_off:IGNORE"
}

@test "a program without a test fails the run" {
    planted_test planted_empty "contains no tests"
}

@test "calls in the wrong order across two mocks fail the run" {
    planted_test planted_wrong_order "Called earlier than expected"
}

@test "an expected call that does not come fails the run" {
    planted_test planted_missing_call "Called fewer times than expected"
}

@test "the build refuses to mock anything but the HAL contract" {
    passes cmake --preset host -S "$ROOT" -B "$BATS_TEST_TMPDIR/build" -DAGV_PLANTED_MOCK=hal/led.h
    fails_with "cannot be mocked" cmake --preset host -S "$ROOT" -B "$BATS_TEST_TMPDIR/build" -DAGV_PLANTED_MOCK=agv/codec.h
}

@test "a crash counts as a failure" {
    printf '7: Test command: x\n1/1 Test #7: test_x .....***Exception: SegFault  0.01 sec\n' >"$BATS_TEST_TMPDIR/log"
    [[ $("$ROOT/scripts/tools/count-tests.py" "$BATS_TEST_TMPDIR/log") == "0 1" ]]
}
