#include "campaign/campaign_judge.h"

#include <stdlib.h>
#include <string.h>

#include "agv/recorder.h"
#include "agv/state.h"
#include "common/units.h"

/* What is safe is written out here by hand, from the requirements: nothing of the supervisor's gate is used. */
enum {
    GEAR_P = 0x08,

    IN_FLIGHT_US = 4000,      /* a frame that is in the controller when the output closes */
    BEAT_GAP_US = 250000,     /* 43Fh every 100 ms, half a cycle later after an answer */
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

void campaign_judge_init(campaign_judge_t *judge, const campaign_plan_t *plan, const scenario_world_t *world) {
    memset(judge, 0, sizeof *judge);
    judge->plan = plan;
    judge->world = world;
    judge->cause_us = (uint64_t)plan->cause_ms * US_PER_MS;
    judge->first_safe_us = CAMPAIGN_NEVER;
    judge->confirmed_us = CAMPAIGN_NEVER;
    judge->opened_us = CAMPAIGN_NEVER;
    judge->closed_us = CAMPAIGN_NEVER;
    judge->reason = -1;
}

static void is_broken(campaign_judge_t *judge, campaign_break_t broken, uint64_t t_us) {
    if (judge->broken == CAMPAIGN_SOUND) {
        judge->broken = broken;
        judge->broken_us = t_us;
    }
}

static scenario_world_view_t look(const campaign_judge_t *judge) {
    scenario_world_view_t view;
    scenario_world_view(judge->world, &view);
    return view;
}

static bool is_like(const campaign_judge_t *judge, uint32_t flag) {
    return (judge->plan->row->flags & flag) != 0u;
}

static agv_message_t message_of(const campaign_judge_t *judge, const hal_can_frame_t *frame) {
    return scenario_world_message(judge->world, frame->id);
}

/** A command that takes the drive away. (065h, which holds the steering, is not counted as one.) */
static bool is_safe_command(agv_message_t message, const hal_can_frame_t *frame) {
    switch (message) {
    case AGV_MSG_GEAR_COMMAND:
        return frame->data[0] == GEAR_P;
    case AGV_MSG_THROTTLE_COMMAND:
        return frame->data[0] == 0u;
    case AGV_MSG_TURN_SIGNAL_COMMAND:
        return memcmp(frame->data, SAFE_SIGNALS, sizeof SAFE_SIGNALS) == 0;
    default:
        return false;
    }
}

static uint16_t angle_of(const hal_can_frame_t *frame) {
    return (uint16_t)(frame->data[0] | ((uint32_t)frame->data[1] << 8u));
}

/** 065h: the angle at which the steering was, and always the same. */
static bool is_held_angle(campaign_judge_t *judge, const hal_can_frame_t *frame) {
    const uint16_t angle = angle_of(frame);
    if (!judge->holds) {
        judge->holds = true;
        judge->held = angle;
        return abs((int32_t)angle - judge->angle_ddeg) <= HELD_TOLERANCE_DDEG;
    }
    return angle == judge->held;
}

static bool may_be_sent(campaign_judge_t *judge, agv_message_t message, const hal_can_frame_t *frame, bool in_init) {
    if (message == AGV_MSG_STEERING_COMMAND) {
        return !in_init && is_held_angle(judge, frame);
    }
    return is_safe_command(message, frame);
}

static void judge_before(campaign_judge_t *judge, uint64_t t_us, agv_message_t message, const hal_can_frame_t *frame) {
    if (judge->closed_us == CAMPAIGN_NEVER) {
        if (!may_be_sent(judge, message, frame, true)) {
            judge->broken_frame = *frame;
            is_broken(judge, CAMPAIGN_UNSAFE_FRAME, t_us);
        }
        return;
    }
    /* The AI computer of a campaign never commands P or autopilot off; throttle 0 until it sees that it is engaged. */
    const bool passed =
        judge->plan->gateway && ((message == AGV_MSG_THROTTLE_COMMAND) || !is_safe_command(message, frame));
    if (!passed && (t_us > judge->closed_us + IN_FLIGHT_US)) {
        is_broken(judge, CAMPAIGN_FALSE_TRIP, t_us);
    }
}

/** The safe commands go on. Where they cannot (bus-off after collisions with the other sender), the output is open. */
static void judge_beat(campaign_judge_t *judge, uint64_t t_us) {
    if ((t_us - judge->last_beat_us > BEAT_GAP_US) && look(judge).output_closed) {
        is_broken(judge, CAMPAIGN_NOT_LATCHED, t_us);
    }
}

/** The angle of the steering, as 067h counts it. */
static int32_t measured_ddeg(const campaign_judge_t *judge) {
    return look(judge).vehicle.angle_ddeg + CENTRE_DDEG;
}

/** With an engagement, throttle 0 of an AI computer that has not seen it yet is passed on: only after a trip it counts. */
static bool is_reaction(const campaign_judge_t *judge, agv_message_t message, const hal_can_frame_t *frame) {
    return is_safe_command(message, frame) && ((judge->plan->engagement == NULL) || (judge->reason >= 0));
}

static void judge_after(campaign_judge_t *judge, uint64_t t_us, agv_message_t message, const hal_can_frame_t *frame) {
    if ((judge->first_safe_us == CAMPAIGN_NEVER) && is_reaction(judge, message, frame)) {
        judge->first_safe_us = t_us;
        judge->last_beat_us = t_us;
    }
    if (judge->first_safe_us == CAMPAIGN_NEVER) {
        return; /* the frame that was in the controller, or the held angle, which goes first */
    }
    if (!may_be_sent(judge, message, frame, false)) {
        judge->broken_frame = *frame;
        is_broken(judge, CAMPAIGN_UNSAFE_FRAME, t_us);
    }
    if (message == AGV_MSG_TURN_SIGNAL_COMMAND) {
        judge_beat(judge, t_us);
        judge->last_beat_us = t_us;
    }
}

static void on_frame(void *ctx, uint64_t t_us, hal_can_side_t side, int from, const hal_can_frame_t *frame) {
    campaign_judge_t *judge = ctx;
    if ((from != SCENARIO_FROM_SUPERVISOR) || (side != HAL_CAN_VEHICLE)) {
        return;
    }
    if (frame->id == look(judge).status_frame_id) {
        return; /* it commands nothing */
    }
    const agv_message_t message = message_of(judge, frame);
    if ((judge->closed_us == CAMPAIGN_NEVER) && look(judge).output_closed) {
        judge->closed_us = t_us;
    }
    if ((t_us < judge->cause_us) && !is_like(judge, CAMPAIGN_START)) {
        judge_before(judge, t_us, message, frame);
    } else {
        judge_after(judge, t_us, message, frame);
    }
}

static uint64_t now_us(const campaign_judge_t *judge) {
    return look(judge).now_us;
}

static void on_state(campaign_judge_t *judge, uint64_t t_ms, const agv_event_t *event) {
    if (judge->state_count < CAMPAIGN_STATES_MAX) {
        judge->states[judge->state_count] = (campaign_state_t){t_ms, event->b, event->c};
        judge->state_count++;
    }
    if ((event->b == (uint8_t)AGV_STATE_TRIPPED) && (judge->reason < 0)) {
        judge->reason = event->c;
        judge->angle_ddeg =
            (judge->plan->row->fault == AGV_FAULT_STEERING_ANGLE_INVALID) ? judge->told_ddeg : measured_ddeg(judge);
    }
    if (event->b != (uint8_t)AGV_STATE_SAFE) {
        return;
    }
    judge->confirmed_us = (judge->confirmed_us == CAMPAIGN_NEVER) ? now_us(judge) : judge->confirmed_us;
    const scenario_world_view_t view = look(judge);
    const bool parked = (view.vehicle.gear == (uint8_t)AGV_GEAR_P) && !view.vehicle.autopilot;
    if (!parked && !is_like(judge, CAMPAIGN_LIES)) {
        is_broken(judge, CAMPAIGN_FALSE_CONFIRM, now_us(judge));
    }
}

static void on_event(void *ctx, const session_event_t *event) {
    campaign_judge_t *judge = ctx;
    if (event->is_led) {
        return;
    }
    if (event->recorded.kind == (uint8_t)AGV_EVENT_STATE) {
        on_state(judge, event->t_ms, &event->recorded);
    }
    if ((event->recorded.kind == (uint8_t)AGV_EVENT_FAULT) && (event->recorded.c != 0u)) {
        judge->raised = judge->raised || (event->recorded.a == (uint8_t)judge->plan->row->fault);
        judge->bus_off = judge->bus_off || (event->recorded.a == (uint8_t)AGV_FAULT_BUS_OFF);
    }
}

scenario_watch_t campaign_judge_watch(campaign_judge_t *judge) {
    return (scenario_watch_t){.on_event = on_event, .on_frame = on_frame, .ctx = judge};
}

/** Everything has to be as planned when the cause comes. */
static void judge_readiness(campaign_judge_t *judge) {
    const campaign_plan_t *plan = judge->plan;
    judge->engaged = look(judge).vehicle.autopilot;
    const bool as_planned = (judge->engaged == plan->engaged) || (plan->engagement != NULL);
    if ((plan->cause_ms != 0u) && (!judge->was_closed || !as_planned)) {
        is_broken(judge, CAMPAIGN_NOT_READY, judge->cause_us);
    }
}

/** When the output changed within this millisecond; it is looked at after it. */
static uint64_t changed_us(const campaign_judge_t *judge, uint64_t t_ms) {
    return (t_ms * US_PER_MS) + judge->plan->tick_phase_us;
}

void campaign_judge_tick(campaign_judge_t *judge, uint64_t t_ms) {
    const bool closed = look(judge).output_closed;
    const campaign_plan_t *plan = judge->plan;
    const uint64_t step_ms = plan->cause_ms - (is_like(judge, CAMPAIGN_LATER) ? plan->number : 0u);

    if (closed && !judge->was_closed) {
        if (judge->opened_us != CAMPAIGN_NEVER) {
            is_broken(judge, CAMPAIGN_NOT_LATCHED, t_ms * US_PER_MS);
        }
        judge->closed_us = (judge->closed_us == CAMPAIGN_NEVER) ? changed_us(judge, t_ms) : judge->closed_us;
    }
    if (!closed && judge->was_closed) {
        if (t_ms < step_ms) {
            is_broken(judge, CAMPAIGN_FALSE_TRIP, t_ms * US_PER_MS);
        }
        judge->opened_us = (judge->opened_us == CAMPAIGN_NEVER) ? changed_us(judge, t_ms) : judge->opened_us;
    }
    judge->was_closed = closed;
    if (t_ms + 1u == step_ms) {
        judge_readiness(judge);
    }
    if (t_ms == plan->steps_ms) {
        judge->told_ddeg = measured_ddeg(judge);
    }
}

static void judge_bound(campaign_judge_t *judge) {
    const uint64_t reaction_us = is_like(judge, CAMPAIGN_BY_OUTPUT) ? judge->opened_us : judge->first_safe_us;
    if ((reaction_us == CAMPAIGN_NEVER) || (reaction_us > judge->cause_us + judge->plan->bound_us)) {
        is_broken(judge, CAMPAIGN_LATE, judge->cause_us + judge->plan->bound_us);
    }
}

void campaign_judge_finish(campaign_judge_t *judge) {
    const campaign_plan_t *plan = judge->plan;
    const uint64_t end_us = ((uint64_t)plan->duration_ms + 1u) * US_PER_MS;

    judge_bound(judge);
    if ((judge->reason != (int)plan->row->first) || !judge->raised) {
        is_broken(judge, CAMPAIGN_WRONG_REASON, end_us);
    }
    if (judge->first_safe_us != CAMPAIGN_NEVER) {
        judge_beat(judge, end_us);
    }
    if ((judge->confirmed_us == CAMPAIGN_NEVER) && judge->was_closed) {
        is_broken(judge, CAMPAIGN_NEVER_SETTLED, end_us);
    }
}
