#include "why/why_table.h"

#include <stddef.h>

#include "agv/codec.h"

#define AGV_SETTING_NONE WHY_NO_SETTING

static const why_row_t rows[AGV_FAULT_COUNT] = {
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
_Static_assert((int)WHY_ROWS == (int)AGV_FAULT_COUNT, "a fault has no row in why_table.def");

const char *why_kind_name(why_kind_t kind) {
    static const char *const names[WHY_KINDS] = {
        [WHY_SILENCE] = "silence", [WHY_STUCK] = "stuck",         [WHY_BIT] = "bit",
        [WHY_SCORE] = "score",     [WHY_VALUE] = "value",         [WHY_BUDGET] = "budget",
        [WHY_MODE] = "mode",       [WHY_INTRUSION] = "intrusion", [WHY_BUS] = "bus",
        [WHY_VEHICLE] = "vehicle", [WHY_HARDWARE] = "hardware",   [WHY_OWN] = "own"};
    return names[kind];
}

const why_row_t *why_row(agv_fault_t fault) {
    return &rows[fault];
}
