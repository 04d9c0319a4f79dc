#!/usr/bin/env bats
# Traceability of a small project that is made here: every row has its test, until something is planted.
load ../support/helper

setup() {
    cd "$BATS_TEST_TMPDIR" || exit
    mkdir -p docs firmware/include/agv tests/unit host_sim/scenarios/bus tests/proofs/x
    {
        for row in SUP-1 FSM-1 TOP-1 TIM-1 INT-1 LED-1; do
            echo "| $row | text | host |"
            echo "/* $row */" >>firmware/include/agv/x.h
        done
        echo '<!-- traceability: made by scripts/tools/traceability.py --markdown -->'
        echo '<!-- end of traceability -->'
    } >docs/requirements.md
    {
        echo '<!-- levels of evidence: made by scripts/tools/traceability.py --markdown -->'
        echo '<!-- end of traceability -->'
    } >docs/safety-manual.md
    printf '#!/bin/bash\n# proves\n# Shows: SUP-1\n' >tests/proofs/x/run
    echo '| P1 | text |' >docs/protocol.md
    echo 'AGV_FAULT(BUS_OFF, TRIP, 14, FIXED)' >firmware/include/agv/fault_table.def
    echo 'agv_add_unit_test(NAME test_x SOURCES test_x.c)' >tests/unit/CMakeLists.txt
    printf '/* Shows: SUP-1, FSM-1, TOP-1, TIM-1,\n   INT-1 */\nTEST_CASE(1)\nvoid test_x(int n) {\n}\n' >tests/unit/test_x.c
    printf '# Shows: P1\ndef test_y():\n    pass\n' >tests/test_y.py
    printf 'shows: [LED-1, BUS_OFF]\n' >host_sim/scenarios/bus/bus_off.yaml
    trace --markdown
    passes trace --check
}

trace() {
    "$ROOT/scripts/tools/traceability.py" --root "$PWD" "$@"
}

@test "a requirement without a test" {
    sed -i 's/^| SUP-1 .*/&\n| SUP-2 | text | host |/' docs/requirements.md
    fails_with "no test shows SUP-2" trace
}

@test "a fault without a test" {
    echo 'AGV_FAULT(TX_STALLED, TRIP, 14, FIXED)' >>firmware/include/agv/fault_table.def
    fails_with "no test shows TX_STALLED" trace
}

@test "a protocol decision without a test" {
    echo '| P2 | text |' >>docs/protocol.md
    fails_with "no test shows P2" trace
}

@test "rows that got lost" {
    sed -i '/^| SUP-1 /d' docs/requirements.md
    fails_with "are not all there" trace
}

@test "a tag that names no row" {
    sed -i 's/BUS_OFF/BUS_OF/' host_sim/scenarios/bus/bus_off.yaml
    fails_with "BUS_OF, which is no row" trace
}

@test "a tag that stands above no test" {
    printf '/* Shows: SUP-1 */\nstatic int helper;\n' >>tests/unit/test_x.c
    fails_with "stands above no test" trace
}

@test "a test that is not built" {
    : >tests/unit/CMakeLists.txt
    fails_with "is not built" trace
}

@test "a ztest: one that names no row, one that is not built" {
    mkdir -p tests/ports/zephyr/z/src
    echo 'add_agv_test(src/test_z.c)' >tests/ports/zephyr/z/CMakeLists.txt
    printf '/* Shows: SUP-1 */\nZTEST(z, test_z) {\n}\n' >tests/ports/zephyr/z/src/test_z.c
    trace --markdown
    passes trace --check
    grep -q '| SUP-1 | emulated target, host, native_sim |' docs/requirements.md
    sed -i 's/SUP-1/SUP-9/' tests/ports/zephyr/z/src/test_z.c
    fails_with "test_z shows SUP-9, which is no row" trace
    : >tests/ports/zephyr/z/CMakeLists.txt
    fails_with "is not built" trace
}

@test "a scenario that does not say what it shows" {
    echo 'name: x' >host_sim/scenarios/bus/other.yaml
    fails_with "does not say what it shows" trace
}

@test "a table that is out of date" {
    sed -i 's/test_x(int/test_renamed(int/' tests/unit/test_x.c
    passes trace
    fails_with "out of date" trace --check
}

@test "a requirement that no code names" {
    sed -i '/FSM-1/d' firmware/include/agv/x.h
    fails_with "no code names FSM-1" trace --check
}

@test "a level of evidence that no test has" {
    sed -i 's/^| TOP-1 | text | host |/| TOP-1 | text | host, native_sim |/' docs/requirements.md
    fails_with "TOP-1 claims native_sim, and no test there shows it" trace --check
}

@test "a requirement without a level of evidence" {
    sed -i 's/^| TOP-1 | text | host |/| TOP-1 | text | surely |/' docs/requirements.md
    fails_with "TOP-1 has no level of evidence" trace --check
}

@test "a proof that does not say what it shows, or names no row" {
    sed -i 's/SUP-1/SUP-7/' tests/proofs/x/run
    fails_with "shows SUP-7, which is no row" trace --check
    sed -i '/Shows/d' tests/proofs/x/run
    fails_with "does not say what it shows" trace --check
}

@test "a table of evidence that is out of date" {
    sed -i '/Shows/s/SUP-1/FSM-1/' tests/proofs/x/run
    fails_with "safety-manual.md is out of date" trace --check
}
