#include "campaign/campaign_plan.h"

#include <inttypes.h>
#include <string.h>

#include "agv/names.h"
#include "campaign/campaign_steps.h"
#include "common/prng.h"
#include "text/units.h"

enum {

    ENGAGE_MS = 1500,
    SETTLED_MS = 700,
    SPAN_MS = 2500,
    START_SPAN_MS = 100,
    TICK_SPAN_US = 1000,
    LATE_AI_MS = 800
};

/** A cause that comes with an engagement: so long before or after it at most. */
enum { BEFORE_MS = 50, AFTER_MS = 500 };

/** After the reaction: brakes and gear box, or P at standstill (3 s), and a while in which nothing may come undone. */
enum { AFTERWARDS_MS = 1500, AFTER_STANDSTILL_MS = 4500, AFTER_STALL_MS = 3000 };

/** The driver. */
enum { THROTTLE_MIN_PCT = 5, STEER_MAX_DEG = 30, DRIVE_MS = 1000 };

/** What kind of vehicle and supervisor. */
static void choose_kind(campaign_plan_t *plan, uint64_t *state) {
    static const uint32_t bitrates[] = {125000, 250000, 500000};
    const uint32_t flags = plan->row->flags;
    const bool engaged_in_gear = (plan->engagement != NULL) && ((flags & CAMPAIGN_IN_GEAR) != 0);
    const bool shared = ((flags & CAMPAIGN_SHARED) != 0) || engaged_in_gear;
    const bool gateway = prng_toss(state, 2) && !shared;
    const bool manual = prng_toss(state, 4);

    plan->bitrate = bitrates[prng_draw(state, 0, 2)];
    plan->gateway = ((flags & CAMPAIGN_GATEWAY) != 0) || gateway;
    plan->table_ids = prng_toss(state, 4);
    plan->park_guard = !prng_toss(state, 4);
    plan->at_standstill = prng_toss(state, 4) && ((flags & CAMPAIGN_AT_ONCE_P) == 0);
    plan->engaged = ((flags & CAMPAIGN_ENGAGED) != 0) || (((flags & CAMPAIGN_MANUAL) == 0) && !manual);
    plan->bunched = prng_toss(state, 2);
    plan->tick_phase_us = prng_toss(state, 2) ? 0 : (uint16_t)prng_draw(state, 0, TICK_SPAN_US - 1);
    plan->clock_start_ms = (uint32_t)prng_next(state);
    plan->number = prng_draw(state, plan->row->lowest, plan->row->highest);
    /* Without a valid configuration the built-in identifiers apply. */
    plan->renumbered = prng_toss(state, 8) && (plan->row->fault > AGV_FAULT_CONFIG_INVALID);
}

/** The cause comes under way, or is there from the start on. @return from the cause to the decision at the latest */
static uint32_t choose_moment(campaign_plan_t *plan, uint64_t *state, const agv_config_t *config) {
    const uint32_t flags = plan->row->flags;
    const uint32_t under_way_ms = ENGAGE_MS + SETTLED_MS + prng_draw(state, 0, SPAN_MS);

    plan->steps_ms = ((flags & CAMPAIGN_START) != 0) ? 0 : under_way_ms;
    plan->cause_ms = plan->steps_ms + (((flags & CAMPAIGN_LATER) != 0) ? plan->number : 0);
    return campaign_decision_ms(plan->row, config);
}

/** The cause comes shortly before or after an engagement, which it waits for. */
static uint32_t choose_engagement(campaign_plan_t *plan, uint64_t *state, const agv_config_t *config) {
    const uint32_t shift_ms = prng_draw(state, 0, BEFORE_MS + AFTER_MS);

    plan->engage_ms = ENGAGE_MS + prng_draw(state, 0, START_SPAN_MS - 1);
    plan->steps_ms = plan->engagement->never_seen ? 0 : plan->engage_ms - BEFORE_MS + shift_ms;
    plan->cause_ms = (plan->steps_ms > plan->engage_ms) ? plan->steps_ms : plan->engage_ms;
    return campaign_engaged_decision_ms(plan->row, plan->engagement, config);
}

static void choose_times(campaign_plan_t *plan, uint64_t *state, const agv_config_t *config) {
    const uint32_t flags = plan->row->flags;
    const uint32_t decision_ms =
        (plan->engagement != NULL) ? choose_engagement(plan, state, config) : choose_moment(plan, state, config);

    plan->bound_us = (decision_ms * (uint32_t)US_PER_MS) + campaign_wire_us(plan->bitrate);
    uint32_t afterwards_ms = ((flags & CAMPAIGN_NO_WIRE) != 0) ? AFTER_STALL_MS : AFTERWARDS_MS;
    afterwards_ms = plan->at_standstill ? (uint32_t)AFTER_STANDSTILL_MS : afterwards_ms;
    plan->duration_ms = plan->cause_ms + (plan->bound_us / US_PER_MS) + afterwards_ms;
}

/** Every identifier is a setting. Their order, which is the priority on the wire, stays the same. */
static void add_identifiers(campaign_plan_t *plan) {
    for (uint32_t m = 0; m < AGV_MSG_COUNT; m++) {
        text_add(&plan->head, "  id_%s: 0x%03X\n", agv_message_name((agv_message_t)m),
                 agv_message_id(m, plan->table_ids ? AGV_ID_SET_TABLE : AGV_ID_SET_HEADING) + 1);
    }
}

static void add_kind(campaign_plan_t *plan) {
    text_t *text = &plan->head;
    const campaign_row_t *row = plan->row;
    const char *name = agv_fault_name(row->fault);

    text_add(text, "name: campaign of seed %" PRIu64 ", run %" PRIu64 "\nshows: [%s]\n", plan->seed, plan->run, name);
    text_add(text, "topology: %s\nid_set: %s\n", plan->gateway ? "gateway" : "shared",
             plan->table_ids ? "table" : "heading");
    text_add(text, "bitrate: %" PRIu32 "\nclock_start_ms: %" PRIu32 "\ntick_phase_us: %u\n%s", plan->bitrate,
             plan->clock_start_ms, plan->tick_phase_us, row->top);
    text_add(text, "config:\n  park: %s\n", plan->at_standstill ? "at_standstill" : "at_once");
    campaign_settings(text, row);
    if (plan->renumbered) {
        add_identifiers(plan);
    }
}

/** When nodes and messages begin. In a bunch they fall together again and again; else each has its own phase. */
static void add_phases(campaign_plan_t *plan, uint64_t *state) {
    text_t *text = &plan->head;
    const bool at_start = (plan->row->flags & CAMPAIGN_START) != 0;
    const uint32_t together_ms = prng_draw(state, 0, 9);
    const uint32_t span_ms = (plan->bunched || at_start) ? 0 : (uint32_t)START_SPAN_MS - 1;

    text_add(text, "vehicle:\n  park_guard: %s\n", plan->park_guard ? "true" : "false");
    text_add(text, "  vcu_starts_ms: %" PRIu32 "\n", prng_draw(state, 0, span_ms));
    text_add(text, "  eps_starts_ms: %" PRIu32 "\n", prng_draw(state, 0, span_ms));
    text_add(text, "  ai_starts_ms: %" PRIu32 "\n",
             prng_draw(state, 0, span_ms) + (((plan->row->flags & CAMPAIGN_LATE_AI) != 0) ? LATE_AI_MS : 0));
    text_add(text, "  phases_ms: {");
    for (int m = 0; m < AGV_MSG_COUNT; m++) {
        const uint32_t cycle_ms = agv_message_cycle_ms((agv_message_t)m);
        const uint32_t own_ms = prng_draw(state, 0, cycle_ms - 1);
        const uint32_t near_ms = together_ms + (prng_toss(state, 4) ? 1 : 0);
        text_add(text, "%s%s: %" PRIu32, (m > 0) ? ", " : "", agv_message_name((agv_message_t)m),
                 plan->bunched ? near_ms : own_ms);
    }
    text_add(text, "}\n");
}

/** The steps that make the vehicle drive before the cause. @return throttle */
static uint32_t add_driver(campaign_plan_t *plan, uint64_t *state) {
    const uint32_t throttle_pct = prng_draw(state, THROTTLE_MIN_PCT, CAMPAIGN_THROTTLE_MAX_PCT);
    const int steer_deg = (int)prng_draw(state, 0, 2 * STEER_MAX_DEG) - STEER_MAX_DEG;

    text_add(&plan->head, "  - {at_ms: %d, ai: drive, gear: D, throttle_pct: %" PRIu32 ", steer_deg: %d}\n", DRIVE_MS,
             throttle_pct, steer_deg);
    return throttle_pct;
}

static void add_drive(campaign_plan_t *plan, uint64_t *state) {
    text_t *text = &plan->head;
    const uint32_t throttle_pct = add_driver(plan, state);
    const uint32_t engage_ms = ENGAGE_MS + prng_draw(state, 0, START_SPAN_MS - 1);

    if (plan->engaged) {
        text_add(text, "  - {at_ms: %" PRIu32 ", operator: engage}\n", engage_ms);
    } else {
        text_add(text, "  - {at_ms: %" PRIu32 ", operator: drive, gear: D, throttle_pct: %" PRIu32 "}\n", engage_ms,
                 throttle_pct);
    }
}

static void add_cause(campaign_plan_t *plan, uint64_t *state) {
    const campaign_values_t values = {.number = plan->number, .gateway = plan->gateway, .table_ids = plan->table_ids};
    campaign_step_t steps[CAMPAIGN_STEPS_MAX];
    const uint32_t alternative = prng_draw(state, 0, campaign_alternatives(plan->row) - 1);
    const size_t count = campaign_steps(plan->row, alternative, plan->steps_ms, &values, steps);

    for (size_t i = 0; i < count; i++) {
        text_add(&plan->head, "  - {at_ms: %" PRIu32 ", %s}\n", steps[i].at_ms, steps[i].words);
    }
}

/** Driven by remote control, then an engagement and the cause, in their order. */
static void add_engaged_steps(campaign_plan_t *plan, uint64_t *state) {
    const bool first = plan->steps_ms < DRIVE_MS;
    const bool last = plan->steps_ms > plan->engage_ms;

    if (first) {
        add_cause(plan, state);
    }
    const uint32_t throttle_pct = add_driver(plan, state);
    text_add(&plan->head, "  - {at_ms: %d, operator: drive, gear: D, throttle_pct: %" PRIu32 "}\n", DRIVE_MS,
             throttle_pct);
    if (!first && !last) {
        add_cause(plan, state);
    }
    text_add(&plan->head, "  - {at_ms: %" PRIu32 ", operator: engage}\n", plan->engage_ms);
    if (last) {
        add_cause(plan, state);
    }
}

static void add_steps(campaign_plan_t *plan, uint64_t *state) {
    text_add(&plan->head, "steps:\n");
    if (plan->engagement != NULL) {
        add_engaged_steps(plan, state);
        return;
    }
    add_drive(plan, state);
    add_cause(plan, state);
}

/** Choose the fault to cause. */
static void choose_row(campaign_plan_t *plan, uint64_t *state, const campaign_causes_t *causes) {
    const size_t count = causes->newly_engaged ? CAMPAIGN_ENGAGEMENT_COUNT : CAMPAIGN_ROW_COUNT;
    const uint32_t any = prng_draw(state, 0, (uint32_t)count - 1);

    plan->row = causes->newly_engaged ? campaign_row(CAMPAIGN_ENGAGEMENTS[any].fault) : &CAMPAIGN_ROWS[any];
    plan->row = (causes->only != NULL) ? causes->only : plan->row;
    plan->engagement = causes->newly_engaged ? campaign_engagement(plan->row->fault) : NULL;
}

void campaign_plan_make(campaign_plan_t *plan, uint64_t seed, uint64_t run, const campaign_causes_t *causes) {
    uint64_t state = seed;
    agv_config_t config;

    state = prng_next(&state) ^ run;
    agv_config_defaults(&config);
    memset(plan, 0, sizeof *plan);
    plan->seed = seed;
    plan->run = run;
    choose_row(plan, &state, causes);
    choose_kind(plan, &state);
    choose_times(plan, &state, &config);
    add_kind(plan);
    add_phases(plan, &state);
    text_add(&plan->head, "duration_ms: %" PRIu32 "\n", plan->duration_ms);
    if ((plan->row->flags & CAMPAIGN_START) == 0) {
        add_steps(plan, &state);
    }
}
