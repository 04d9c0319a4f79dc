#include "campaign/campaign_check.h"

#include <stdlib.h>
#include <string.h>

#include "agv/recorder.h"
#include "agv/state.h"
#include "text/units.h"

/* What is safe is written out here by hand, from the requirements: nothing of the supervisor's gate is used. */
enum {
    GEAR_P = 0x08,

    IN_FLIGHT_US = 4000,  /* a frame that is in the controller when the output closes */
    BEAT_GAP_US = 250000, /* 43Fh every 100 ms, half a cycle later after an answer */
    EPS_MODE_BYTE = 3,
    HELD_TOLERANCE_DDEG = 50, /* between a measured angle and what the EPS sent last */
    CENTRE_DDEG = 9000,
    SIGNALS_BYTES = 7,
};
static const uint8_t SAFE_SIGNALS[SIGNALS_BYTES] = {0x00, 0x00, 0x00, 0x00, 0x70, 0x00, 0x00};

const char *campaign_break_name(campaign_break_t broken) {
    static const char *const names[CAMPAIGN_BREAKS] = {"",
                                                       "NOT_READY",
                                                       "FALSE_TRIP",
                                                       "LATE",
                                                       "UNSAFE_FRAME",
                                                       "NOT_LATCHED",
                                                       "WRONG_REASON",
                                                       "FALSE_CONFIRM",
                                                       "NEVER_SETTLED"};
    return names[broken];
}

void campaign_check_init(campaign_check_t *check, const campaign_plan_t *plan, const scenario_testbed_t *testbed) {
    memset(check, 0, sizeof *check);
    check->plan = plan;
    check->testbed = testbed;
    check->cause_us = (uint64_t)plan->cause_ms * US_PER_MS;
    check->first_safe_us = CAMPAIGN_NEVER;
    check->confirmed_us = CAMPAIGN_NEVER;
    check->opened_us = CAMPAIGN_NEVER;
    check->closed_us = CAMPAIGN_NEVER;
    check->reason = -1;
}

static void note_break(campaign_check_t *check, campaign_break_t broken, uint64_t t_us) {
    if (check->broken == CAMPAIGN_SOUND) {
        check->broken = broken;
        check->broken_us = t_us;
    }
}

static scenario_testbed_view_t look(const campaign_check_t *check) {
    scenario_testbed_view_t view;
    scenario_testbed_view(check->testbed, &view);
    return view;
}

static agv_message_t message_of(const campaign_check_t *check, const hal_can_frame_t *frame) {
    return scenario_testbed_message(check->testbed, frame->id);
}

bool campaign_is_safe_command(agv_message_t message, const hal_can_frame_t *frame) {
    switch (message) {
    case AGV_MSG_GEAR_COMMAND:
        return frame->data[0] == GEAR_P;
    case AGV_MSG_THROTTLE_COMMAND:
        return frame->data[0] == 0;
    case AGV_MSG_TURN_SIGNAL_COMMAND:
        return memcmp(frame->data, SAFE_SIGNALS, sizeof SAFE_SIGNALS) == 0;
    default:
        return false;
    }
}

/** The angle of the steering, as 067h counts it. */
static int32_t measured_ddeg(const campaign_check_t *check) {
    return look(check).vehicle.angle_ddeg + CENTRE_DDEG;
}

static uint16_t angle_of(const hal_can_frame_t *frame) {
    return (uint16_t)(frame->data[0] | ((uint32_t)frame->data[1] << 8));
}

static bool is_between(int32_t ddeg, int32_t a_ddeg, int32_t b_ddeg) {
    const int32_t low = (a_ddeg < b_ddeg) ? a_ddeg : b_ddeg;
    const int32_t high = (a_ddeg < b_ddeg) ? b_ddeg : a_ddeg;
    return (ddeg >= low - HELD_TOLERANCE_DDEG) && (ddeg <= high + HELD_TOLERANCE_DDEG);
}

/** 065h: the angle at which the steering was, and always the same. */
static bool is_held_angle(campaign_check_t *check, const hal_can_frame_t *frame) {
    const uint16_t angle = angle_of(frame);
    if (!check->holds) {
        check->holds = true;
        check->held = angle;
        return is_between(angle, check->angle_ddeg, check->held_later ? measured_ddeg(check) : check->angle_ddeg);
    }
    return angle == check->held;
}

/** An EPS that comes to angle control after the trip: the angle to hold is one since then. */
static void hear_eps(campaign_check_t *check, const hal_can_frame_t *frame) {
    const bool takes = frame->data[EPS_MODE_BYTE] == AGV_EPS_MODE_ANGLE;
    if (takes && !check->eps_takes_angles && check->held_later) {
        check->angle_ddeg = measured_ddeg(check);
    }
    check->eps_takes_angles = takes;
}

static bool may_be_sent(campaign_check_t *check, agv_message_t message, const hal_can_frame_t *frame, bool in_init) {
    if (message == AGV_MSG_STEERING_COMMAND) {
        return !in_init && is_held_angle(check, frame);
    }
    return campaign_is_safe_command(message, frame);
}

static void check_before(campaign_check_t *check, uint64_t t_us, agv_message_t message, const hal_can_frame_t *frame) {
    if (check->closed_us == CAMPAIGN_NEVER) {
        if (!may_be_sent(check, message, frame, true)) {
            check->broken_frame = *frame;
            note_break(check, CAMPAIGN_UNSAFE_FRAME, t_us);
        }
        return;
    }
    /* The AI computer of a campaign never commands P or autopilot off; throttle 0 until it sees that it is engaged. */
    const bool passed =
        check->plan->gateway && ((message == AGV_MSG_THROTTLE_COMMAND) || !campaign_is_safe_command(message, frame));
    if (!passed && (t_us > check->closed_us + IN_FLIGHT_US)) {
        note_break(check, CAMPAIGN_FALSE_TRIP, t_us);
    }
}

/** The safe commands go on. Where they cannot (bus-off after collisions with the other sender), the output is open. */
static void check_beat(campaign_check_t *check, uint64_t t_us) {
    if ((t_us - check->last_beat_us > BEAT_GAP_US) && look(check).output_closed) {
        note_break(check, CAMPAIGN_NOT_LATCHED, t_us);
    }
}

/**
 * With an engagement, throttle 0 of an AI computer that has not seen it yet is passed on: only after a trip it counts.
 */
static bool is_reaction(const campaign_check_t *check, agv_message_t message, const hal_can_frame_t *frame) {
    return campaign_is_safe_command(message, frame) && ((check->plan->engagement == NULL) || (check->reason >= 0));
}

static void check_after(campaign_check_t *check, uint64_t t_us, agv_message_t message, const hal_can_frame_t *frame) {
    if ((check->first_safe_us == CAMPAIGN_NEVER) && is_reaction(check, message, frame)) {
        check->first_safe_us = t_us;
        check->last_beat_us = t_us;
    }
    if (check->first_safe_us == CAMPAIGN_NEVER) {
        return; /* the frame that was in the controller, or the held angle, which goes first */
    }
    if (!may_be_sent(check, message, frame, false)) {
        check->broken_frame = *frame;
        note_break(check, CAMPAIGN_UNSAFE_FRAME, t_us);
    }
    if (message == AGV_MSG_TURN_SIGNAL_COMMAND) {
        check_beat(check, t_us);
        check->last_beat_us = t_us;
    }
}

static void on_frame(void *ctx, uint64_t t_us, hal_can_side_t side, int from, const hal_can_frame_t *frame) {
    campaign_check_t *check = ctx;
    if ((from != SCENARIO_FROM_SUPERVISOR) && (message_of(check, frame) == check->plan->row->message)) {
        check->heard_us = t_us;
    }
    if (message_of(check, frame) == AGV_MSG_EPS_STATUS) {
        hear_eps(check, frame);
    }
    if ((from != SCENARIO_FROM_SUPERVISOR) || (side != HAL_CAN_VEHICLE)) {
        return;
    }
    if (frame->id == look(check).status_frame_id) {
        return; /* it commands nothing */
    }
    const agv_message_t message = message_of(check, frame);
    if ((check->closed_us == CAMPAIGN_NEVER) && look(check).output_closed) {
        check->closed_us = t_us;
    }
    if ((t_us < check->cause_us) && !campaign_has_flag(check, CAMPAIGN_START)) {
        check_before(check, t_us, message, frame);
    } else {
        check_after(check, t_us, message, frame);
    }
}

static uint64_t now_us(const campaign_check_t *check) {
    return look(check).now_us;
}

/** Whether the row's message stayed away: its frames may be late on a slow bus that is full. */
static bool is_silent(const campaign_check_t *check) {
    const agv_message_t message = check->plan->row->message;
    const uint64_t two_cycles_us = (uint64_t)agv_message_cycle_ms(message) * 2 * US_PER_MS;
    return (message != AGV_MSG_NONE) && (now_us(check) - check->heard_us > two_cycles_us);
}

static void on_state(campaign_check_t *check, uint64_t t_ms, const agv_event_t *event) {
    if (check->state_count < CAMPAIGN_STATES_MAX) {
        check->states[check->state_count] = (campaign_state_t){t_ms, event->b, event->c};
        check->state_count++;
    }
    if ((event->b == AGV_STATE_TRIPPED) && (check->reason < 0)) {
        check->reason = event->c;
        check->silent = is_silent(check);
        check->held_later = !check->eps_takes_angles;
        check->angle_ddeg =
            (check->plan->row->fault == AGV_FAULT_STEERING_ANGLE_INVALID) ? check->reported_ddeg : measured_ddeg(check);
    }
    if (event->b != AGV_STATE_SAFE) {
        return;
    }
    check->confirmed_us = (check->confirmed_us == CAMPAIGN_NEVER) ? now_us(check) : check->confirmed_us;
    const scenario_testbed_view_t view = look(check);
    const bool parked = (view.vehicle.gear == AGV_GEAR_P) && !view.vehicle.autopilot;
    if (!parked && !campaign_has_flag(check, CAMPAIGN_LIES)) {
        note_break(check, CAMPAIGN_FALSE_CONFIRM, now_us(check));
    }
}

static void on_event(void *ctx, const session_event_t *event) {
    campaign_check_t *check = ctx;
    if (event->is_led) {
        return;
    }
    if (event->recorded.kind == AGV_EVENT_STATE) {
        on_state(check, event->t_ms, &event->recorded);
    }
    if ((event->recorded.kind == AGV_EVENT_FAULT) && (event->recorded.c != 0)) {
        check->raised = check->raised || (event->recorded.a == (uint8_t)check->plan->row->fault);
        check->bus_off = check->bus_off || (event->recorded.a == AGV_FAULT_BUS_OFF);
    }
}

scenario_watch_t campaign_check_watch(campaign_check_t *check) {
    return (scenario_watch_t){.on_event = on_event, .on_frame = on_frame, .ctx = check};
}

/** Everything has to be as planned when the cause comes. */
static void check_readiness(campaign_check_t *check) {
    const campaign_plan_t *plan = check->plan;
    check->engaged = look(check).vehicle.autopilot;
    const bool as_planned = (check->engaged == plan->engaged) || (plan->engagement != NULL);
    if ((plan->cause_ms != 0) && (!check->was_closed || !as_planned)) {
        note_break(check, CAMPAIGN_NOT_READY, check->cause_us);
    }
}

/** When the output changed within this millisecond; it is looked at after it. */
static uint64_t changed_us(const campaign_check_t *check, uint64_t t_ms) {
    return (t_ms * US_PER_MS) + check->plan->tick_phase_us;
}

void campaign_check_tick(campaign_check_t *check, uint64_t t_ms) {
    const bool closed = look(check).output_closed;
    const campaign_plan_t *plan = check->plan;
    const uint64_t step_ms = plan->cause_ms - (campaign_has_flag(check, CAMPAIGN_LATER) ? plan->number : 0);

    if (closed && !check->was_closed) {
        if (check->opened_us != CAMPAIGN_NEVER) {
            note_break(check, CAMPAIGN_NOT_LATCHED, t_ms * US_PER_MS);
        }
        check->closed_us = (check->closed_us == CAMPAIGN_NEVER) ? changed_us(check, t_ms) : check->closed_us;
    }
    if (!closed && check->was_closed) {
        if (t_ms < step_ms) {
            note_break(check, CAMPAIGN_FALSE_TRIP, t_ms * US_PER_MS);
        }
        check->opened_us = (check->opened_us == CAMPAIGN_NEVER) ? changed_us(check, t_ms) : check->opened_us;
    }
    check->was_closed = closed;
    if (t_ms + 1 == step_ms) {
        check_readiness(check);
    }
    if (t_ms == plan->steps_ms) {
        check->reported_ddeg = measured_ddeg(check);
    }
}

static void check_bound(campaign_check_t *check) {
    const uint64_t reaction_us = campaign_has_flag(check, CAMPAIGN_BY_OUTPUT) ? check->opened_us : check->first_safe_us;
    if ((reaction_us == CAMPAIGN_NEVER) || (reaction_us > check->cause_us + check->plan->bound_us)) {
        note_break(check, CAMPAIGN_LATE, check->cause_us + check->plan->bound_us);
    }
}

/** A node whose counter stands is lost instead of stuck when its frames stay away, too (SUP-2). */
static bool is_lost_instead(const campaign_check_t *check) {
    switch (check->plan->row->fault) {
    case AGV_FAULT_VCU_HEARTBEAT_STUCK:
        return check->silent && (check->reason == AGV_FAULT_VCU_HEARTBEAT_LOST);
    case AGV_FAULT_EPS_HEARTBEAT_STUCK:
        return check->silent && (check->reason == AGV_FAULT_EPS_HEARTBEAT_LOST);
    case AGV_FAULT_AI_HEARTBEAT_STUCK:
        return check->silent && (check->reason == AGV_FAULT_AI_HEARTBEAT_LOST);
    default:
        return false;
    }
}

static bool is_wrong_reason(const campaign_check_t *check) {
    const bool right = (check->reason == (int)check->plan->row->first) && check->raised;
    return !right && !is_lost_instead(check);
}

void campaign_check_finish(campaign_check_t *check) {
    const campaign_plan_t *plan = check->plan;
    const uint64_t end_us = ((uint64_t)plan->duration_ms + 1) * US_PER_MS;

    check_bound(check);
    if (is_wrong_reason(check)) {
        note_break(check, CAMPAIGN_WRONG_REASON, end_us);
    }
    if (check->first_safe_us != CAMPAIGN_NEVER) {
        check_beat(check, end_us);
    }
    if ((check->confirmed_us == CAMPAIGN_NEVER) && check->was_closed) {
        note_break(check, CAMPAIGN_NEVER_SETTLED, end_us);
    }
}
