#!/usr/bin/env bats
# The firmware's settings as Kconfig, and its tests without a workspace: each on a planted mistake.
load ../support/helper

setup() {
    cd "$BATS_TEST_TMPDIR" || exit
    mkdir -p firmware/include/agv firmware/zephyr/src
    cp "$ROOT"/firmware/include/agv/{config_settings,message_table,fault_table}.def firmware/include/agv/
    cp "$ROOT/firmware/zephyr/Kconfig.settings" firmware/zephyr/
    cp "$ROOT/firmware/zephyr/src/kconfig_settings.def" firmware/zephyr/src/
    passes settings
}

settings() {
    "$ROOT/scripts/tools/kconfig.py" --root "$PWD" --check
}

@test "kconfig: a range that was changed in the core" {
    sed -i 's/^AGV_SETTING(reset_hold_ms, 1000, 500,/AGV_SETTING(reset_hold_ms, 1000, 400,/' firmware/include/agv/config_settings.def
    fails_with "Kconfig.settings is out of date" settings
}

@test "kconfig: a range that was changed by hand" {
    sed -i 's/range 500 10000/range 0 10000/' firmware/zephyr/Kconfig.settings
    fails_with "Kconfig.settings is out of date" settings
}

@test "kconfig: a setting that the firmware does not hand on" {
    sed -i '/reset_hold_ms/d' firmware/zephyr/src/kconfig_settings.def
    fails_with "kconfig_settings.def is out of date" settings
}

@test "kconfig: an identifier that was changed in the core" {
    sed -i 's/^AGV_STATUS(GEAR_STATUS, gear_status, 0x0A3/AGV_STATUS(GEAR_STATUS, gear_status, 0x0A4/' \
        firmware/include/agv/message_table.def
    fails_with "Kconfig.settings is out of date" settings
}

@test "kconfig: a fault that may be weakened now" {
    sed -i 's/^AGV_FAULT(BUS_OFF, TRIP, 14, FIXED)/AGV_FAULT(BUS_OFF, TRIP, 14, NONE)/' firmware/include/agv/fault_table.def
    fails_with "Kconfig.settings is out of date" settings
}

@test "kconfig: a row that it does not understand" {
    echo 'AGV_SETTING(x_ms, DEFAULT, 30, 500, "ms", "a gap")' >>firmware/include/agv/config_settings.def
    fails_with "a row that is not understood" settings
}

@test "zephyr-test: without a workspace" {
    unset ZEPHYR_BASE
    fails_with "there is no Zephyr workspace" "$ROOT/scripts/zephyr-test"
}
