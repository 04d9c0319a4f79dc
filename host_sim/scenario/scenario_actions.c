/* The words of steps. To add an action: a row here. To add a parameter: a bit in the header and a row of
 * scenario_parameters.c. */
#include "scenario/scenario_actions.h"

#include <string.h>

#define COUNT(array) (sizeof(array) / sizeof(array)[0])
#define BITS_OF_BYTE 8u
#define BITS_OF_VALUE 32u

const yaml_word_t SCENARIO_ACTORS[] = {{"vcu", ACTOR_VCU},     {"eps", ACTOR_EPS},
                                       {"ai", ACTOR_AI},       {"operator", ACTOR_OPERATOR},
                                       {"bus", ACTOR_BUS},     {"supervisor", ACTOR_SUPERVISOR},
                                       {"board", ACTOR_BOARD}, {NULL, ACTOR_NONE}};

static const scenario_action_row_t ACTIONS[] = {
    {ACTOR_NONE, "start", true, true, VEHICLE_DO_START, 0, 0},
    {ACTOR_NONE, "stop", true, false, VEHICLE_DO_STOP, 0, 0},
    {ACTOR_NONE, "restart", true, true, VEHICLE_DO_RESTART, P_OFF_MS, 0},
    {ACTOR_NONE, "freeze_counter", true, true, VEHICLE_DO_FREEZE, 0, 0},
    {ACTOR_NONE, "run_counter", true, false, VEHICLE_DO_UNFREEZE, 0, 0},
    {ACTOR_NONE, "lag", true, true, VEHICLE_DO_LAG, P_BY_MS, 0},
    {ACTOR_NONE, "repeat", true, true, VEHICLE_DO_REPEAT, P_TIMES, 0},
    {ACTOR_NONE, "garbage", true, true, VEHICLE_DO_GARBAGE, P_KIND, 0},
    {ACTOR_NONE, "recover", true, true, VEHICLE_DO_RECOVER, 0, 0},
    {ACTOR_NONE, "mute", true, true, VEHICLE_DO_MUTE, P_MESSAGE, P_FRAMES | P_EVERY_FRAMES},
    {ACTOR_NONE, "unmute", true, false, VEHICLE_DO_UNMUTE, P_MESSAGE, 0},
    {ACTOR_NONE, "send_every", true, true, VEHICLE_DO_PERIOD, P_MESSAGE | P_EVERY_MS, 0},
    {ACTOR_NONE, "delay", true, true, VEHICLE_DO_DELAY, P_MESSAGE | P_BY_MS, 0},
    {ACTOR_NONE, "set", true, true, VEHICLE_DO_PATCH, P_FIELD | P_VALUE, P_FRAMES | P_EVERY_FRAMES},
    {ACTOR_NONE, "set_bytes", true, true, VEHICLE_DO_PATCH, P_MESSAGE | P_BYTES, P_FRAMES | P_EVERY_FRAMES},
    {ACTOR_NONE, "freeze_field", true, true, VEHICLE_DO_HOLD, P_FIELD, P_FRAMES | P_EVERY_FRAMES},
    {ACTOR_NONE, "unset", true, false, VEHICLE_DO_UNPATCH, P_MESSAGE, 0},
    {ACTOR_VCU, "ignore", true, true, VEHICLE_DO_IGNORE, P_MESSAGE, 0},
    {ACTOR_VCU, "obey", true, false, VEHICLE_DO_IGNORE, P_MESSAGE, 0},
    {ACTOR_VCU, "ramp_throttle", true, true, VEHICLE_DO_VCU_RAMP, P_PCT_S, 0},
    {ACTOR_VCU, "roll", true, true, VEHICLE_DO_VCU_ROLL, 0, P_SPEED},
    {ACTOR_VCU, "hold", true, false, VEHICLE_DO_VCU_ROLL, 0, 0},
    {ACTOR_VCU, "refuse_park", true, true, VEHICLE_DO_VCU_REFUSE_PARK, 0, 0},
    {ACTOR_VCU, "take_park", true, false, VEHICLE_DO_VCU_REFUSE_PARK, 0, 0},
    {ACTOR_VCU, "be_sloppy", true, true, VEHICLE_DO_VCU_SLOPPY, 0, 0},
    {ACTOR_VCU, "be_strict", true, false, VEHICLE_DO_VCU_SLOPPY, 0, 0},
    {ACTOR_AI, "drive", true, true, VEHICLE_DO_AI_DRIVE, P_GEAR | P_THROTTLE, P_STEER},
    {ACTOR_AI, "idle", true, false, VEHICLE_DO_AI_IDLE, 0, 0},
    {ACTOR_AI, "be_stubborn", true, true, VEHICLE_DO_AI_STUBBORN, 0, 0},
    {ACTOR_AI, "be_obedient", true, false, VEHICLE_DO_AI_STUBBORN, 0, 0},
    {ACTOR_AI, "ask_autopilot_off", true, true, VEHICLE_DO_AI_AUTOPILOT_OFF, 0, 0},
    {ACTOR_AI, "ask_nothing", true, false, VEHICLE_DO_AI_AUTOPILOT_OFF, 0, 0},
    {ACTOR_AI, "weave", true, true, VEHICLE_DO_AI_WEAVE, P_STEER | P_EVERY_MS, 0},
    {ACTOR_AI, "stop_weaving", true, false, VEHICLE_DO_AI_WEAVE, 0, 0},
    {ACTOR_EPS, "ignore", true, true, VEHICLE_DO_IGNORE, P_MESSAGE, 0},
    {ACTOR_EPS, "obey", true, false, VEHICLE_DO_IGNORE, P_MESSAGE, 0},
    {ACTOR_EPS, "hunt", true, true, VEHICLE_DO_EPS_HUNT, P_STEER | P_EVERY_MS, 0},
    {ACTOR_EPS, "stop_hunting", true, false, VEHICLE_DO_EPS_HUNT, 0, 0},
    {ACTOR_EPS, "stick", true, true, VEHICLE_DO_EPS_STUCK, 0, 0},
    {ACTOR_EPS, "unstick", true, false, VEHICLE_DO_EPS_STUCK, 0, 0},
    {ACTOR_OPERATOR, "engage", true, true, VEHICLE_DO_ENGAGE, 0, 0},
    {ACTOR_OPERATOR, "disengage", true, false, VEHICLE_DO_DISENGAGE, 0, 0},
    {ACTOR_OPERATOR, "press", true, true, VEHICLE_DO_BUTTON, P_BUTTON, 0},
    {ACTOR_OPERATOR, "release", true, false, VEHICLE_DO_BUTTON, P_BUTTON, 0},
    {ACTOR_OPERATOR, "drive", true, true, VEHICLE_DO_REMOTE_DRIVE, P_GEAR | P_THROTTLE, 0},
    {ACTOR_OPERATOR, "steer", true, true, VEHICLE_DO_HAND_STEER, P_STEER, 0},
    {ACTOR_OPERATOR, "lose_remote_signal", true, false, VEHICLE_DO_REMOTE_SIGNAL, 0, 0},
    {ACTOR_OPERATOR, "regain_remote_signal", true, true, VEHICLE_DO_REMOTE_SIGNAL, 0, 0},
    {ACTOR_OPERATOR, "lose_remote_power", true, false, VEHICLE_DO_REMOTE_POWER, 0, 0},
    {ACTOR_OPERATOR, "regain_remote_power", true, true, VEHICLE_DO_REMOTE_POWER, 0, 0},
    {ACTOR_BUS, "send", true, true, VEHICLE_DO_SEND, P_BYTES,
     P_ID | P_MESSAGE | P_SIDE | P_KIND | P_EVERY_MS | P_TIMES},
    {ACTOR_BUS, "stop_sending", true, false, VEHICLE_DO_STOP_SENDING, 0, 0},
    {ACTOR_BUS, "destroy", false, true, SCENARIO_CORRUPT_FRAMES, P_FRAMES, P_SIDE},
    {ACTOR_BUS, "deliver", false, true, SCENARIO_DELIVER, P_BYTES | P_KIND, P_ID | P_MESSAGE | P_SIDE},
    {ACTOR_SUPERVISOR, "restart", false, true, SCENARIO_RESTART, P_CAUSE, P_OFF_MS},
    {ACTOR_SUPERVISOR, "hang", false, true, SCENARIO_HANG, P_FOR_MS, 0},
    {ACTOR_SUPERVISOR, "bus_off", false, true, SCENARIO_BUS_OFF, 0, P_SIDE},
    {ACTOR_SUPERVISOR, "stall_tx", false, true, SCENARIO_TX_STALL, 0, P_SIDE},
    {ACTOR_SUPERVISOR, "free_tx", false, false, SCENARIO_TX_STALL, 0, P_SIDE},
    {ACTOR_SUPERVISOR, "swallow_tx", false, true, SCENARIO_TX_SWALLOW, 0, P_SIDE},
    {ACTOR_SUPERVISOR, "pass_tx", false, false, SCENARIO_TX_SWALLOW, 0, P_SIDE},
    {ACTOR_SUPERVISOR, "fill_queue", false, true, SCENARIO_QUEUE_FULL, 0, P_SIDE},
    {ACTOR_SUPERVISOR, "free_queue", false, false, SCENARIO_QUEUE_FULL, 0, P_SIDE},
    {ACTOR_SUPERVISOR, "overrun", false, true, SCENARIO_OVERRUN, 0, P_SIDE},
    {ACTOR_SUPERVISOR, "error_passive", false, true, SCENARIO_ERROR_PASSIVE, 0, P_SIDE},
    {ACTOR_SUPERVISOR, "error_active", false, false, SCENARIO_ERROR_PASSIVE, 0, P_SIDE},
    {ACTOR_SUPERVISOR, "corrupt_latch", false, true, SCENARIO_CORRUPT_LATCH, 0, 0},
    {ACTOR_SUPERVISOR, "flip_bit", false, true, SCENARIO_FLIP_BIT, P_BIT, 0},
    {ACTOR_BOARD, "weld_contact", false, true, SCENARIO_CONTACT_WELDED, 0, 0},
    {ACTOR_BOARD, "stick_contact", false, true, SCENARIO_CONTACT_STUCK, 0, 0},
    {ACTOR_BOARD, "repair_contact", false, true, SCENARIO_CONTACT_WORKS, 0, 0},
    {ACTOR_BOARD, "invert_feedback", false, true, SCENARIO_FEEDBACK_INVERTED, 0, 0},
    {ACTOR_BOARD, "restore_feedback", false, false, SCENARIO_FEEDBACK_INVERTED, 0, 0},
    {ACTOR_BOARD, "open_emergency_stop", false, true, SCENARIO_STOP_OPEN, 0, 0},
    {ACTOR_BOARD, "close_emergency_stop", false, false, SCENARIO_STOP_OPEN, 0, 0},
    {ACTOR_BOARD, "press", false, true, SCENARIO_BUTTON, 0, 0},
    {ACTOR_BOARD, "release", false, false, SCENARIO_BUTTON, 0, 0},
    {ACTOR_BOARD, "bounce", false, true, SCENARIO_BUTTON_BOUNCES, P_PATTERN, 0},
    {ACTOR_BOARD, "slow_clock", false, true, SCENARIO_CLOCK, P_PERMILLE, 0},
    {ACTOR_BOARD, "fast_clock", false, false, SCENARIO_CLOCK, P_PERMILLE, 0},
    {ACTOR_BOARD, "right_clock", false, true, SCENARIO_CLOCK, 0, 0},
    {ACTOR_BOARD, "fail_test", false, true, SCENARIO_TEST_FAILS, P_PART, 0},
};

static const scenario_field_row_t FIELDS[] = {
    {"speed", ACTOR_VCU, AGV_MSG_VEHICLE_STATUS, 0, 2, 0xFFu, 0},
    {"alarms", ACTOR_VCU, AGV_MSG_VEHICLE_STATUS, 4, 1, 0xFFu, 0},
    {"level2_alarms", ACTOR_VCU, AGV_MSG_VEHICLE_STATUS, 5, 1, 0xFFu, 0},
    {"mode_bits", ACTOR_VCU, AGV_MSG_VEHICLE_STATUS, 6, 1, 0xC0u, 6},
    {"counter", ACTOR_VCU, AGV_MSG_VEHICLE_STATUS, 7, 1, 0xFFu, 0},
    {"gear", ACTOR_VCU, AGV_MSG_GEAR_STATUS, 0, 1, 0xFFu, 0},
    {"throttle", ACTOR_VCU, AGV_MSG_THROTTLE_STATUS, 0, 1, 0xFFu, 0},
    {"left_speed", ACTOR_VCU, AGV_MSG_WHEEL_SPEED, 0, 4, 0xFFu, 0},
    {"right_speed", ACTOR_VCU, AGV_MSG_WHEEL_SPEED, 4, 4, 0xFFu, 0},
    {"faults", ACTOR_EPS, AGV_MSG_EPS_STATUS, 7, 1, 0xFFu, 0},
    {"mode", ACTOR_EPS, AGV_MSG_EPS_STATUS, 3, 1, 0xFFu, 0},
    {"angle", ACTOR_EPS, AGV_MSG_STEERING_STATUS, 2, 2, 0xFFu, 0},
    {"counter", ACTOR_EPS, AGV_MSG_STEERING_STATUS, 0, 1, 0xFFu, 0},
    {"gear", ACTOR_AI, AGV_MSG_GEAR_COMMAND, 0, 1, 0xFFu, 0},
    {"throttle", ACTOR_AI, AGV_MSG_THROTTLE_COMMAND, 0, 1, 0xFFu, 0},
    {"angle", ACTOR_AI, AGV_MSG_STEERING_COMMAND, 0, 2, 0xFFu, 0},
    {"counter", ACTOR_AI, AGV_MSG_TURN_SIGNAL_COMMAND, 7, 1, 0xFFu, 0},
};

const scenario_action_row_t *scenario_action(size_t number) {
    return (number < COUNT(ACTIONS)) ? &ACTIONS[number] : NULL;
}

const scenario_field_row_t *scenario_field(size_t number) {
    return (number < COUNT(FIELDS)) ? &FIELDS[number] : NULL;
}

bool scenario_action_is_of(const scenario_action_row_t *row, scenario_actor_t actor) {
    return (row->actor == actor) || ((row->actor == ACTOR_NONE) && (actor <= ACTOR_AI));
}

uint32_t scenario_field_highest(const scenario_field_row_t *row) {
    return (row->size > 1) ? UINT32_MAX >> (BITS_OF_VALUE - (BITS_OF_BYTE * row->size))
                           : (uint32_t)row->mask >> row->shift;
}

const scenario_action_row_t *scenario_find_action(scenario_actor_t actor, const char *word) {
    for (size_t i = 0; i < COUNT(ACTIONS); i++) {
        const scenario_action_row_t *row = &ACTIONS[i];
        if (scenario_action_is_of(row, actor) && (strcmp(row->word, word) == 0)) {
            return row;
        }
    }
    return NULL;
}

const scenario_field_row_t *scenario_find_field(scenario_actor_t actor, const char *name) {
    for (size_t i = 0; i < COUNT(FIELDS); i++) {
        if ((FIELDS[i].actor == actor) && (strcmp(FIELDS[i].name, name) == 0)) {
            return &FIELDS[i];
        }
    }
    return NULL;
}
