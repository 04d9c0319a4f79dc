#include "atlas/atlas_judge.h"

#include <stddef.h>

#include "agv/state.h"

/* What the wire and the vehicle may add: a frame of others on the way, a cycle of the VCU that looks at its gear box. */
enum {
    FRAME_TOLERANCE_US = 30000,
    SILENT_TOLERANCE_US =
        400000, /* a hang of 251 ms, until the watchdog has restarted it: longer than the others but one */
    STALLED_TOLERANCE_US = 1600000, /* TX_STALLED: frames wait for 1500 ms */
    OUTPUT_TOLERANCE_US = 30000,
    STOP_TOLERANCE_US = 200000
};

const char *atlas_weakness_name(atlas_weakness_t weakness) {
    static const char *const names[ATLAS_WEAKNESSES] = {"",           "NOT_READY",   "HAZARD",   "NOT_LATCHED",
                                                        "LATE_FRAME", "LATE_OUTPUT", "LATE_STOP"};
    return names[weakness];
}

/** It ends in the safe state, or has never left INIT, in which the output is open and the same commands are sent. */
static bool ends_safe(const atlas_outcome_t *outcome) {
    return (outcome->state == AGV_STATE_TRIPPED) || (outcome->state == AGV_STATE_SAFE) ||
           ((outcome->state == AGV_STATE_INIT) && (outcome->open_us == 0));
}

/** Later than in the half in which it comes last. */
static bool is_late(int32_t pair_us, int32_t first_us, int32_t second_us, int32_t tolerance_us) {
    const int32_t last_us = (first_us > second_us) ? first_us : second_us;
    return (last_us != ATLAS_NEVER) && (pair_us - tolerance_us > last_us);
}

static int32_t frame_tolerance_us(const atlas_case_t *of) {
    if (!atlas_case_is_silent_twice(of)) {
        return FRAME_TOLERANCE_US;
    }
    return (of->second->fault == AGV_FAULT_TX_STALLED) ? STALLED_TOLERANCE_US : SILENT_TOLERANCE_US;
}

atlas_weakness_t atlas_judge(const atlas_case_t *of, const atlas_outcome_t *pair, const atlas_outcome_t *first,
                             const atlas_outcome_t *second) {
    const bool over_in_init = (of->state == ATLAS_INIT) && (pair->state == AGV_STATE_STANDBY);

    if (!pair->ready) {
        return ATLAS_NOT_READY;
    }
    if ((pair->hazard != HAZARD_NONE) && (first->hazard == HAZARD_NONE) && (second->hazard == HAZARD_NONE)) {
        return ATLAS_HAZARD;
    }
    if (!ends_safe(pair) && !over_in_init && (ends_safe(first) || ends_safe(second))) {
        return ATLAS_NOT_LATCHED;
    }
    if (is_late(pair->safe_us, first->safe_us, second->safe_us, frame_tolerance_us(of))) {
        return ATLAS_LATE_FRAME;
    }
    if (is_late(pair->open_us, first->open_us, second->open_us, OUTPUT_TOLERANCE_US)) {
        return ATLAS_LATE_OUTPUT;
    }
    return is_late(pair->stop_us, first->stop_us, second->stop_us, STOP_TOLERANCE_US) ? ATLAS_LATE_STOP : ATLAS_SOUND;
}

#define HANGS "a supervisor that hangs does not answer"
#define HIDES "the second fault hides the first one, and an engagement has its grace time"
#define QUIET "there is no 43Fh to override, and the next frame of the cycle cannot leave"
#define ENDS "the wheel speed of the second fault ends the first one"

enum { IN_MANUAL_OR_ENGAGED = ATLAS_IN(ATLAS_STANDBY) | ATLAS_IN(ATLAS_ACTIVE) };

static const struct {
    agv_fault_t first;
    agv_fault_t second; /**< AGV_FAULT_NONE: each that takes the supervisor from the bus */
    uint32_t states;    /**< ATLAS_IN() */
    atlas_weakness_t weakness;
    const char *reason;
} KNOWN[] = {
    {AGV_FAULT_STEP_OVERRUN, AGV_FAULT_FOREIGN_COMMAND_SENDER, IN_MANUAL_OR_ENGAGED, ATLAS_HAZARD, HANGS},
    {AGV_FAULT_FOREIGN_COMMAND_SENDER, AGV_FAULT_STEP_OVERRUN, IN_MANUAL_OR_ENGAGED, ATLAS_HAZARD, HANGS},
    {AGV_FAULT_MODE_FLAPPING, AGV_FAULT_AUTOPILOT_OFF_IGNORED, ATLAS_IN(ATLAS_ACTIVE), ATLAS_LATE_FRAME, HIDES},
    {AGV_FAULT_MODE_NONE, AGV_FAULT_AUTOPILOT_OFF_IGNORED, ATLAS_IN(ATLAS_ACTIVE), ATLAS_LATE_FRAME, HIDES},
    {AGV_FAULT_AI_HEARTBEAT_LOST, AGV_FAULT_NONE, ATLAS_IN(ATLAS_TRIPPED), ATLAS_LATE_FRAME, QUIET},
    {AGV_FAULT_WRONG_ID_SET, AGV_FAULT_NONE, ATLAS_IN(ATLAS_TRIPPED), ATLAS_LATE_FRAME, QUIET},
    {AGV_FAULT_SPEED_IMPLAUSIBLE, AGV_FAULT_VEHICLE_NOT_STOPPING, ATLAS_IN(ATLAS_STANDBY), ATLAS_NOT_LATCHED, ENDS},
};

static bool is_known(size_t i, const atlas_case_t *of, atlas_weakness_t weakness) {
    const bool is_second = (KNOWN[i].second == of->second->fault) ||
                           ((KNOWN[i].second == AGV_FAULT_NONE) && atlas_case_silences(of->second));
    return (KNOWN[i].first == of->first->fault) && is_second && ((KNOWN[i].states & ATLAS_IN(of->state)) != 0) &&
           (KNOWN[i].weakness == weakness);
}

const char *atlas_known_reason(const atlas_case_t *of, atlas_weakness_t weakness) {
    for (size_t i = 0; i < sizeof KNOWN / sizeof KNOWN[0]; i++) {
        if (is_known(i, of, weakness)) {
            return KNOWN[i].reason;
        }
    }
    return NULL;
}
