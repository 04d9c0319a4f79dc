#include "why/why_table.h"

#include <stddef.h>

#include "agv/codec.h"

#define AGV_SETTING_NONE WHY_NO_SETTING

static const why_row_t explained_rows[AGV_FAULT_COUNT] = {
#define WHY(fault, kind_, message_, setting_, unit_, byte_, mask_)                                                     \
    [AGV_FAULT_##fault] = {.kind = WHY_##kind_,                                                                        \
                           .message = AGV_MSG_##message_,                                                              \
                           .setting = AGV_SETTING_##setting_,                                                          \
                           .unit = (unit_),                                                                            \
                           .byte = (byte_),                                                                            \
                           .mask = (mask_)},
#include "why/why_table.def"
#undef WHY
};

/* Every fault has its row: a fault that is added to fault_table.def needs one here. */
enum {
#define WHY(fault, kind, message, setting, unit, byte, mask) WHY_ROW_OF_##fault,
#include "why/why_table.def"
#undef WHY
    WHY_ROWS
};
_Static_assert((int)WHY_ROWS == AGV_FAULT_COUNT, "a fault has no row in why_table.def");

const char *why_kind_name(why_kind_t kind) {
    static const char *const names[WHY_KINDS] = {
        [WHY_SILENCE] = "silence", [WHY_STUCK] = "stuck",         [WHY_BIT] = "bit",
        [WHY_SCORE] = "score",     [WHY_VALUE] = "value",         [WHY_BUDGET] = "budget",
        [WHY_MODE] = "mode",       [WHY_INTRUSION] = "intrusion", [WHY_BUS] = "bus",
        [WHY_VEHICLE] = "vehicle", [WHY_HARDWARE] = "hardware",   [WHY_OWN] = "own"};
    return names[kind];
}

const why_row_t *why_row(agv_fault_t fault) {
    return &explained_rows[fault];
}

agv_message_t why_compared_with(agv_fault_t fault) {
    switch (fault) {
    case AGV_FAULT_STEERING_DEVIATION:
        return AGV_MSG_STEERING_COMMAND;
    case AGV_FAULT_THROTTLE_DEVIATION:
        return AGV_MSG_THROTTLE_COMMAND;
    case AGV_FAULT_GEAR_DEVIATION:
        return AGV_MSG_GEAR_COMMAND;
    case AGV_FAULT_AUTOPILOT_OFF_IGNORED:
        return AGV_MSG_TURN_SIGNAL_COMMAND;
    case AGV_FAULT_THROTTLE_IN_PARK:
        return AGV_MSG_GEAR_STATUS;
    case AGV_FAULT_SPEED_IMPLAUSIBLE:
        return AGV_MSG_VEHICLE_STATUS;
    case AGV_FAULT_MODE_NONE:
        return AGV_MSG_WHEEL_SPEED;
    default:
        return AGV_MSG_NONE;
    }
}
