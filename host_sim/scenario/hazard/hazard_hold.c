/* Steering held by the supervisor: it must not move (H2). */
#include <stdlib.h>

#include "scenario/hazard/hazard.h"

enum { NEW_HOLD_MS = 300, FRESH_MS = 150, IN_FLIGHT_MS = 20, TOLERANCE_DDEG = 50, CENTRE_DDEG = 9000 };
enum { OUT_OF_DATE_MS = 2000, UNTAKEN_MAX = 2 };

static bool is_near(int32_t a_ddeg, int32_t b_ddeg) {
    return abs(a_ddeg - b_ddeg) <= TOLERANCE_DDEG;
}

static bool is_within(const hazard_range_t *range, int32_t ddeg) {
    return (ddeg >= range->low_ddeg - TOLERANCE_DDEG) && (ddeg <= range->high_ddeg + TOLERANCE_DDEG);
}

static void extend_range(hazard_range_t *range, int32_t ddeg) {
    range->low_ddeg = (ddeg < range->low_ddeg) ? ddeg : range->low_ddeg;
    range->high_ddeg = (ddeg > range->high_ddeg) ? ddeg : range->high_ddeg;
}

/** After a trip, what an EPS that takes no angle measures may be wrong. */
static void forget_measured(hazard_t *hazard) {
    hazard->hold.first.any = false;
    hazard->hold.before.any = false;
    hazard->hold.measured_count = 0;
}

/** Both mode bits: manual may end as late as they become MODE_INVALID. */
static void add_first(const hazard_t *hazard, hazard_first_t *first, int32_t angle_ddeg) {
    if (!first->any) {
        *first = (hazard_first_t){.range = {angle_ddeg, angle_ddeg}, .since_ms = hazard->t_ms, .any = true};
    }
    if (hazard->t_ms - first->since_ms <= (uint64_t)hazard->config->mode_invalid_ms + FRESH_MS) {
        extend_range(&first->range, angle_ddeg);
    }
}

void hazard_hold_measured(hazard_t *hazard, int32_t angle_ddeg) {
    hazard_hold_t *hold = &hazard->hold;
    const uint32_t at = hold->measured_count % HAZARD_ANGLES;

    hold->measured_ddeg[at] = angle_ddeg;
    hold->measured_ms[at] = hazard->t_ms;
    hold->measured_count++;
    if (hazard->view.is_off) {
        hold->first.any = false; /* one without power measures nothing */
    } else if (hazard->trip.tripped && hazard_eps_takes_no_angle(hazard)) {
        forget_measured(hazard);
    } else {
        add_first(hazard, &hold->first, angle_ddeg);
        add_first(hazard, &hold->perhaps, angle_ddeg);
    }
}

/** The real angle, and those that 067h lately carried. */
static hazard_range_t range_now(const hazard_t *hazard, uint32_t within_ms) {
    const hazard_hold_t *hold = &hazard->hold;
    hazard_range_t range = {hazard_angle_ddeg(hazard), hazard_angle_ddeg(hazard)};

    for (uint32_t i = 0; (i < HAZARD_ANGLES) && (i < hold->measured_count); i++) {
        if (hazard->t_ms - hold->measured_ms[i] <= within_ms) {
            extend_range(&range, hold->measured_ddeg[i]);
        }
    }
    return range;
}

/**
 * Whether a slew limit may go on from the last 065h. In the grace time it may not when the last two came while the EPS was not
 * in angle control: the operator may have steered since.
 */
static bool continues(const hazard_t *hazard) {
    return hazard->is_commanded[AGV_MSG_STEERING_COMMAND] &&
           ((hazard->untaken < UNTAKEN_MAX) || !hazard_eps_in_angle_control(hazard) || !hazard->mode.graced ||
            (hazard->t_ms - hazard->mode.engaged_ms >= hazard->config->engaged_grace_ms));
}

/** Limits give an angle between the real steering angle, the last command, the commands of the AI computer, and the centre. */
bool hazard_hold_is_limited(const hazard_t *hazard, uint16_t value) {
    const hazard_recent_t *recent = &hazard->recent[AGV_MSG_STEERING_COMMAND];
    hazard_range_t range = range_now(hazard, FRESH_MS);

    if (hazard->config->steering_fast_max_ddeg != 0) {
        extend_range(&range, 0);
    }
    if (continues(hazard)) {
        extend_range(&range, (int32_t)hazard->commanded[AGV_MSG_STEERING_COMMAND] - CENTRE_DDEG);
    }
    for (uint32_t i = 0; (i < HAZARD_RECENT) && (i < recent->next); i++) {
        if (hazard->t_ms - recent->at_ms[i] <= (uint64_t)hazard->config->steering_command_timeout_ms + FRESH_MS) {
            extend_range(&range, (int32_t)recent->value[i] - CENTRE_DDEG);
        }
    }
    return is_within(&range, (int32_t)value - CENTRE_DDEG);
}

static void trip_now(hazard_t *hazard, uint32_t within_ms) {
    hazard_hold_t *hold = &hazard->hold;

    hold->at_trip = range_now(hazard, within_ms);
    hold->has_trip = true;
    hold->trip_ms = hazard->t_ms;
    hold->is_dropped = false;
    hold->first.any = false;
    hold->perhaps.any = false;
    hold->before.any = false;
    hold->kept_until_ms = 0;
}

/** A command that leaves now may be so old: the transmitter may have taken nothing before, or the supervisor hung. */
static uint32_t age_ms(const hazard_t *hazard) {
    const uint64_t waited_ms = hazard->t_ms - hazard->trip.free_ms;
    const uint64_t most_ms = hazard->config->tx_stalled_ms;
    return (uint32_t)FRESH_MS + (uint32_t)((waited_ms < most_ms) ? waited_ms : most_ms);
}

void hazard_hold_trip(hazard_t *hazard) {
    /* An open output without a safe command: the trip came when the first frame did not leave. */
    trip_now(hazard, hazard->closed ? age_ms(hazard) : (uint32_t)FRESH_MS + hazard->config->tx_stalled_ms);
}

/** Manual was reported, or the EPS took no angle: it may have turned, and what it measured before is out of date. */
void hazard_hold_drop(hazard_t *hazard) {
    hazard_hold_t *hold = &hazard->hold;

    if (hold->has_trip && !hold->is_dropped) {
        hold->is_dropped = true;
        hold->dropped_ms = hazard->t_ms;
    }
    if (hold->kept_until_ms > hazard->t_ms + IN_FLIGHT_MS) {
        hold->kept_until_ms = hazard->t_ms + IN_FLIGHT_MS;
    }
}

/** An angle that was not sent for so long is out of date: it is not held again. */
static uint64_t in_date_ms(const hazard_t *hazard) {
    return (uint64_t)OUT_OF_DATE_MS + hazard->config->tx_stalled_ms + FRESH_MS;
}

/** The angle of the trip may have been dropped; a frame that was in the controller then may still leave. */
static bool is_of_trip(const hazard_t *hazard, int32_t held_ddeg) {
    const hazard_hold_t *hold = &hazard->hold;

    return hold->has_trip && (hazard->t_ms - hold->trip_ms <= in_date_ms(hazard)) &&
           (!hold->is_dropped || (hazard->t_ms - hold->dropped_ms <= IN_FLIGHT_MS)) &&
           is_within(&hold->at_trip, held_ddeg);
}

/** A supervisor that restarts trips again, and holds the angle that it then measures. */
void hazard_hold_anew(hazard_t *hazard) {
    trip_now(hazard, FRESH_MS);
}

static bool is_in_date(const hazard_t *hazard, const hazard_first_t *first) {
    return first->any && (hazard->t_ms - first->since_ms <= in_date_ms(hazard));
}

/** A supervisor that detects a flipped bit trips again, too. If it does not detect it, it still holds the angle of before. */
void hazard_hold_perhaps_anew(hazard_t *hazard) {
    hazard_hold_t *hold = &hazard->hold;
    const hazard_range_t before = hold->at_trip;
    const hazard_first_t first = hold->first;
    const bool is_held = hold->has_trip && !hold->is_dropped && (hazard->t_ms - hold->trip_ms <= in_date_ms(hazard));

    trip_now(hazard, FRESH_MS);
    if (is_held) {
        extend_range(&hold->at_trip, before.low_ddeg);
        extend_range(&hold->at_trip, before.high_ddeg);
    }
    if (is_in_date(hazard, &first)) {
        extend_range(&hold->at_trip, first.range.low_ddeg);
        extend_range(&hold->at_trip, first.range.high_ddeg);
    }
}

static bool is_of_first(const hazard_t *hazard, const hazard_first_t *first, int32_t held_ddeg) {
    return is_in_date(hazard, first) && is_within(&first->range, held_ddeg);
}

/** Whether the angle is one that may be held. */
static bool may_be_held(const hazard_t *hazard, int32_t held_ddeg) {
    const hazard_hold_t *hold = &hazard->hold;
    const bool is_kept = (held_ddeg + CENTRE_DDEG == (int32_t)hold->kept) && (hazard->t_ms <= hold->kept_until_ms);

    return is_kept || is_within(&hold->now, held_ddeg) || is_of_trip(hazard, held_ddeg) ||
           is_of_first(hazard, &hold->first, held_ddeg) || is_of_first(hazard, &hold->perhaps, held_ddeg) ||
           is_of_first(hazard, &hold->before, held_ddeg);
}

/** A right angle may be sent again, until it is out of date or manual is reported. */
static void allow_again(hazard_t *hazard, uint16_t value) {
    if (!hazard->mode.manual) {
        hazard->hold.kept = value;
        hazard->hold.kept_until_ms = hazard->t_ms + in_date_ms(hazard);
    }
}

/** Passed on for the AI computer: after a reset the safe commands may have ended already. */
static bool is_passed_on(const hazard_t *hazard, uint16_t value) {
    const bool may_pass = hazard->mode.autopilot || (hazard->config->gateway_in_manual == AGV_IN_MANUAL_ALL);
    const bool is_limited = hazard->limits_steering && hazard_reset_was_asked(hazard) && may_pass;

    return hazard->gateway && (is_limited || hazard_was_sent(hazard, AGV_MSG_STEERING_COMMAND, value));
}

void hazard_hold_frame(hazard_t *hazard, const hal_can_frame_t *frame) {
    hazard_hold_t *hold = &hazard->hold;
    const uint16_t value = (uint16_t)(frame->data[0] | ((uint32_t)frame->data[1] << 8));
    const int32_t held_ddeg = (int32_t)value - CENTRE_DDEG;

    if (is_passed_on(hazard, value)) {
        if (may_be_held(hazard, held_ddeg)) {
            allow_again(hazard, value); /* the held angle may be that of the AI computer */
        }
        return;
    }
    if ((hold->last_ms == 0) || (hazard->t_ms - hold->last_ms > NEW_HOLD_MS) || (value != hold->value) ||
        (hold->last_ms < hazard->mode.handback_ms)) {
        hold->now = range_now(hazard, age_ms(hazard));
        hold->is_wrong = false;
    }
    hold->last_ms = hazard->t_ms;
    hold->value = value;
    if (may_be_held(hazard, held_ddeg)) {
        allow_again(hazard, value);
    } else {
        if (!hold->is_wrong) {
            hold->start_ddeg = hazard_angle_ddeg(hazard); /* what a right angle moved before does not count */
        }
        hold->is_wrong = true;
        hold->wrong_ddeg = held_ddeg;
    }
}

/** In bus-off the supervisor hears no EPS, drops the angle, and takes one after it. One that hangs does not notice. */
static void follow_hearing(hazard_t *hazard) {
    hazard_hold_t *hold = &hazard->hold;
    const bool is_deaf = !hazard_is_hearing(hazard) && !hazard->view.is_halted;

    if (hold->was_deaf && !is_deaf) {
        hold->first.since_ms = hazard->t_ms;
    }
    hold->was_deaf = is_deaf;
}

/** The EPS perhaps takes no angle: the supervisor drops the one that it took after the last such time, or still has it. */
static void drop_perhaps(hazard_t *hazard) {
    hazard_first_t *perhaps = &hazard->hold.perhaps;
    hazard_first_t *before = &hazard->hold.before;

    if (perhaps->any) {
        const hazard_range_t range = is_in_date(hazard, before) ? before->range : perhaps->range;
        *before = *perhaps;
        extend_range(&before->range, range.low_ddeg);
        extend_range(&before->range, range.high_ddeg);
        perhaps->any = false;
    }
}

/** The steering went where the supervisor had it go. */
void hazard_hold_tick(hazard_t *hazard) {
    const hazard_hold_t *hold = &hazard->hold;

    follow_hearing(hazard);
    if (hazard->trip.tripped && hazard_eps_takes_no_angle(hazard)) {
        hazard_hold_drop(hazard);
        forget_measured(hazard);
    }
    if (hazard_eps_perhaps_takes_none(hazard)) {
        drop_perhaps(hazard);
    }
    if (!hold->is_wrong || (hazard->t_ms - hold->last_ms > NEW_HOLD_MS)) {
        return;
    }
    const int32_t now_ddeg = hazard_angle_ddeg(hazard);
    const bool closer = abs(now_ddeg - hold->wrong_ddeg) < abs(hold->start_ddeg - hold->wrong_ddeg);
    if (closer && !is_near(now_ddeg, hold->start_ddeg)) {
        hazard_found(hazard, HAZARD_STEERING, "the supervisor steers to another angle");
    }
}
