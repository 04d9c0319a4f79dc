#!/usr/bin/env bats
# Layers, format, clang-tidy, shellcheck: each on a planted violation.
load ../support/helper

setup() {
    cd "$BATS_TEST_TMPDIR" || exit
}

# A copy of the sources, in which the layers are right.
copy_sources() {
    mkdir -p firmware
    cp -R "$ROOT"/firmware/{include,src} firmware/
    cp -R "$ROOT/hal" hal
    passes "$ROOT/scripts/tools/check-layers.sh" "$PWD"
}

# plant FILE LINE MESSAGE
plant() {
    copy_sources
    mkdir -p "$(dirname "$1")"
    echo "$2" >>"$1"
    fails_with "$3" "$ROOT/scripts/tools/check-layers.sh" "$PWD"
}

@test "layers: an operating system's header in the core" {
    plant firmware/src/base/codec.c '#include <pthread.h>' 'firmware/ includes something other'
}

@test "layers: a port's header in the core" {
    plant firmware/include/agv/codec.h '#include "hal_sim/sim_bus.h"' 'firmware/ includes something other'
}

@test "layers: a library's header in the core" {
    plant firmware/src/base/codec.c '#include "yaml.h"' 'firmware/ includes something other'
}

@test "layers: a header that is in no room" {
    plant firmware/src/base/codec.c '#include "base/planted.h"' 'firmware/ includes something other'
}

@test "layers: a header without its room" {
    plant firmware/src/base/codec.c '#include "timers.h"' 'firmware/ includes something other'
}

@test "layers: a private header in a public one" {
    plant firmware/include/agv/codec.h '#include "base/timers.h"' 'firmware/ includes something other'
}

@test "layers: a source outside of the rooms" {
    plant firmware/src/planted.c '#include "agv/codec.h"' 'lies in no room'
}

@test "layers: the memory of a supervisor in a module" {
    plant firmware/src/decide/hold.c '#include "supervisor/core.h"' 'knows the memory of a supervisor'
}

@test "layers: what the supervisor's sources share in a module" {
    plant firmware/src/supervisor/planted.c '#include "supervisor/supervisor_internal.h"' 'knows the memory of a supervisor'
}

@test "layers: a private header in a port" {
    plant hal/sim/planted.c '#include "base/timers.h"' 'a header of firmware/src in'
}

@test "layers: a private header in the host program" {
    plant host_sim/io/planted.c '#include "decide/fault_monitor.h"' 'a header of firmware/src in'
}

@test "layers: a private header in the firmware's program" {
    plant firmware/zephyr/src/planted.c '#include "../../src/observe/mode.h"' 'a header of firmware/src in'
}

@test "layers: a private header in a test that is not to look inside" {
    plant tests/integration/planted.c '#include "observe/mode.h"' 'a header of firmware/src in'
}

@test "layers: a platform #ifdef in the core" {
    plant firmware/src/base/codec.c '#ifdef __linux__' 'a platform #if'
}

@test "layers: a platform #if defined behind another one" {
    plant firmware/src/base/codec.c '#if defined(AGV_X) && defined(CONFIG_ARM)' 'a platform #if'
}

@test "layers: a header of the core in a port" {
    plant hal/sim/planted.c '#include "agv/protocol.h"' 'the HAL includes headers of the core'
}

@test "layers: a port's header in the contract" {
    plant hal/include/hal/can.h '#include <linux/can.h>' 'hal/include includes something other'
}

@test "layers: a frame that leaves past the gate" {
    plant firmware/src/base/codec.c 'bool x(void) { return hal_can_send(0, HAL_CAN_VEHICLE, 0); }' 'past the gate'
}

@test "layers: the firmware's program that sends by itself" {
    plant firmware/zephyr/src/planted.c 'bool x(void) { return hal_can_send(0, HAL_CAN_VEHICLE, 0); }' 'past the gate'
}

@test "layers: the firmware's program that uses a driver" {
    plant firmware/zephyr/src/planted.c '#include <zephyr/drivers/can.h>' 'goes past the port'
}

@test "layers: nothing to check" {
    mkdir -p firmware/include firmware/src hal/include
    fails_with "nothing to check" "$ROOT/scripts/tools/check-layers.sh" "$PWD"
}

@test "format: a badly formatted file" {
    command -v clang-format-19 || skip "no clang-format-19"
    printf 'int main(void) {\n    return 0;\n}\n' >good.c
    printf 'int main(void)\n{ return 0; }\n' >bad.c
    passes "$ROOT/scripts/tools/check-format.sh" "$PWD/good.c"
    fails_with "bad.c:1" "$ROOT/scripts/tools/check-format.sh" "$PWD/bad.c"
}

write_right_program() {
    printf 'int main(void) {\n    return 0;\n}\n' >"$1"
}

write_suspicious_program() {
    printf 'int main(int argc, char **argv) {\n    (void)argv;\n    if (argc = 1) {\n        return 1;\n    }\n    return 0;\n}\n' >"$1"
}

@test "clang-tidy: a suspicious line" {
    command -v clang-tidy-19 || skip "no clang-tidy-19"
    write_right_program good.c
    write_suspicious_program bad.c
    passes "$ROOT/scripts/tools/check-tidy.sh" "$PWD/good.c"
    fails_with "bugprone-assignment-in-if-condition" "$ROOT/scripts/tools/check-tidy.sh" "$PWD/bad.c"
}

@test "clang-tidy: a suspicious line in a file that was right before" {
    command -v clang-tidy-19 || skip "no clang-tidy-19"
    write_right_program changes.c
    passes "$ROOT/scripts/tools/check-tidy.sh" --changed "$PWD/changes.c"
    write_suspicious_program changes.c
    for _ in 1 2; do
        fails_with "bugprone-assignment-in-if-condition" "$ROOT/scripts/tools/check-tidy.sh" --changed "$PWD/changes.c"
    done
}

@test "shellcheck: a name that is not quoted" {
    printf '#!/bin/sh\necho "%s"\n' "\$1" >good
    printf '#!/bin/sh\necho %s\n' "\$1" >bad
    passes "$ROOT/scripts/tools/check-shell.sh" "$PWD/good"
    fails_with SC2086 "$ROOT/scripts/tools/check-shell.sh" "$PWD/bad"
}
