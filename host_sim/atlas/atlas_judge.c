#include "atlas/atlas_judge.h"

#include <stddef.h>

#include "agv/state.h"

/* What the wire and the vehicle may add: a frame of others on the way, a cycle of the VCU that looks at its gear box. */
enum {
    FRAME_TOLERANCE_US = 30000,
    SILENT_TOLERANCE_US =
        400000, /* the longest of these faults: a hang of 251 ms, until the watchdog has restarted it */
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

atlas_weakness_t atlas_judge(const atlas_case_t *of, const atlas_outcome_t *pair, const atlas_outcome_t *first,
                             const atlas_outcome_t *second) {
    const int32_t frame_us = atlas_case_is_silent_twice(of) ? SILENT_TOLERANCE_US : FRAME_TOLERANCE_US;
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
    if (is_late(pair->safe_us, first->safe_us, second->safe_us, frame_us)) {
        return ATLAS_LATE_FRAME;
    }
    if (is_late(pair->open_us, first->open_us, second->open_us, OUTPUT_TOLERANCE_US)) {
        return ATLAS_LATE_OUTPUT;
    }
    return is_late(pair->stop_us, first->stop_us, second->stop_us, STOP_TOLERANCE_US) ? ATLAS_LATE_STOP : ATLAS_SOUND;
}

const char *atlas_known_reason(const atlas_case_t *of, atlas_weakness_t weakness) {
    static const char hangs[] = "a supervisor that hangs does not answer";
    static const struct {
        agv_fault_t first;
        agv_fault_t second;
        atlas_weakness_t weakness;
        const char *reason;
    } known[] = {
        {AGV_FAULT_STEP_OVERRUN, AGV_FAULT_FOREIGN_COMMAND_SENDER, ATLAS_HAZARD, hangs},
        {AGV_FAULT_FOREIGN_COMMAND_SENDER, AGV_FAULT_STEP_OVERRUN, ATLAS_HAZARD, hangs},
        {AGV_FAULT_MODE_FLAPPING, AGV_FAULT_AUTOPILOT_OFF_IGNORED, ATLAS_LATE_FRAME,
         "the second fault hides the changes of the mode, and the last engagement has its grace time"},
    };
    for (size_t i = 0; i < sizeof known / sizeof known[0]; i++) {
        if ((of->first->fault == known[i].first) && (of->second->fault == known[i].second) &&
            (weakness == known[i].weakness)) {
            return known[i].reason;
        }
    }
    return NULL;
}
