/* Steering held by the supervisor: it must not move (H2). */
#include <stdlib.h>

#include "hazard.h"

enum { NEW_HOLD_MS = 300, FRESH_MS = 60, TOLERANCE_DDEG = 50, CENTRE_DDEG = 9000 };

static bool is_near(int32_t a_ddeg, int32_t b_ddeg) {
    return abs(a_ddeg - b_ddeg) <= TOLERANCE_DDEG;
}

static bool is_fresh(const hazard_t *hazard) {
    const hazard_message_t *measured = &hazard->messages[AGV_MSG_STEERING_STATUS];
    return measured->has_valid && (hazard->t_ms - measured->valid_ms <= FRESH_MS);
}

/** Whether the angle is one that may be held. */
static bool may_be_held(const hazard_t *hazard, int32_t held_ddeg) {
    const hazard_hold_t *hold = &hazard->hold;

    return is_near(held_ddeg, hold->start_ddeg) || is_near(held_ddeg, hold->measured_ddeg) ||
           (hold->has_trip && (is_near(held_ddeg, hold->trip_ddeg[0]) || is_near(held_ddeg, hold->trip_ddeg[1]))) ||
           (hold->has_first && is_near(held_ddeg, hold->first_ddeg));
}

void hazard_hold_frame(hazard_t *hazard, const hal_can_frame_t *frame) {
    hazard_hold_t *hold = &hazard->hold;
    const uint16_t value = (uint16_t)(frame->data[0] | ((uint32_t)frame->data[1] << 8u));
    const int32_t held_ddeg = (int32_t)value - CENTRE_DDEG;

    if (hazard->gateway && hazard_was_sent(hazard, AGV_MSG_STEERING_COMMAND, value)) {
        return; /* passed on: after a reset the safe commands may have ended already */
    }
    if ((hold->last_ms == 0u) || (hazard->t_ms - hold->last_ms > NEW_HOLD_MS)) {
        hold->start_ddeg = hazard_angle_ddeg(hazard);
        hold->measured_ddeg = is_fresh(hazard) ? hazard_measured_ddeg(hazard) : hold->start_ddeg;
        hold->is_wrong = false;
    }
    hold->last_ms = hazard->t_ms;
    if (!may_be_held(hazard, held_ddeg)) {
        hold->is_wrong = true;
        hold->wrong_ddeg = held_ddeg;
    }
}

/** The steering went where the supervisor had it go. */
void hazard_hold_tick(hazard_t *hazard) {
    const hazard_hold_t *hold = &hazard->hold;

    if (!hold->is_wrong || (hazard->t_ms - hold->last_ms > NEW_HOLD_MS)) {
        return;
    }
    const int32_t now_ddeg = hazard_angle_ddeg(hazard);
    const bool closer = abs(now_ddeg - hold->wrong_ddeg) < abs(hold->start_ddeg - hold->wrong_ddeg);
    if (closer && !is_near(now_ddeg, hold->start_ddeg)) {
        hazard_found(hazard, HAZARD_STEERING, "the supervisor steers to another angle");
    }
}
