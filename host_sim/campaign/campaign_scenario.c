#include "campaign/campaign_scenario.h"

#include <inttypes.h>

#include "agv/names.h"
#include "agv/state.h"
#include "text/units.h"

enum { READY_FROM_MS = 500, READY_TO_MS = 1499, ENGAGED_TO_MS = 1700, BEAT_MS = 250 };

static uint32_t bound_ms(const campaign_plan_t *plan) {
    return plan->cause_ms + (plan->bound_us / US_PER_MS) + 1;
}

static void add_state(text_t *text, agv_state_t to, int reason, uint32_t from_ms, uint32_t to_ms) {
    text_add(text, "    - {to: %s, ", agv_state_name(to));
    if ((reason >= 0) && (reason < AGV_FAULT_COUNT)) {
        text_add(text, "reason: %s, ", agv_fault_name((agv_fault_t)reason));
    }
    text_add(text, "at_ms: [%" PRIu32 ", %" PRIu32 "]}\n", from_ms, to_ms);
}

/** After the trip: as seen, as far as it may be. */
static void add_later_states(text_t *text, const campaign_check_t *check) {
    bool tripped = false;

    for (size_t i = 0; i < check->state_count; i++) {
        const campaign_state_t *seen = &check->states[i];
        const bool latched = (seen->to == AGV_STATE_TRIPPED) || (seen->to == AGV_STATE_SAFE);
        const bool false_confirm = (check->broken == CAMPAIGN_FALSE_CONFIRM) && (seen->to == AGV_STATE_SAFE);
        if (tripped && latched && !false_confirm) {
            add_state(text, (agv_state_t)seen->to, seen->reason, (uint32_t)seen->t_ms, (uint32_t)seen->t_ms);
        }
        tripped = tripped || (seen->to == AGV_STATE_TRIPPED);
    }
    if (check->broken == CAMPAIGN_NEVER_SETTLED) {
        add_state(text, AGV_STATE_SAFE, -1, check->plan->cause_ms, check->plan->duration_ms);
    }
}

/** Between the first engagement and the trip: as seen. */
static void add_changes(text_t *text, const campaign_check_t *check) {
    static const size_t first_changes = 3; /* INIT, STANDBY, ACTIVE */

    for (size_t i = first_changes; i < check->state_count; i++) {
        const campaign_state_t *seen = &check->states[i];
        if (seen->to == AGV_STATE_TRIPPED) {
            return;
        }
        add_state(text, (agv_state_t)seen->to, -1, (uint32_t)seen->t_ms, (uint32_t)seen->t_ms);
    }
}

static void add_states(text_t *text, const campaign_check_t *check) {
    const campaign_plan_t *plan = check->plan;
    uint32_t latest_ms = bound_ms(plan);

    text_add(text, "  states:\n");
    if (!campaign_has_flag(check, CAMPAIGN_START)) {
        add_state(text, AGV_STATE_INIT, -1, 0, 0);
        add_state(text, AGV_STATE_STANDBY, -1, READY_FROM_MS, READY_TO_MS);
        if (plan->engaged && ((plan->engagement == NULL) || !plan->engagement->never_seen)) {
            add_state(text, AGV_STATE_ACTIVE, -1, READY_TO_MS + 1, ENGAGED_TO_MS);
        }
    }
    if (campaign_has_flag(check, CAMPAIGN_AGAIN)) {
        add_changes(text, check);
    }
    add_state(text, AGV_STATE_TRIPPED, (int)plan->row->first, plan->cause_ms, latest_ms);
    add_later_states(text, check);
}

static void add_output(text_t *text, const campaign_check_t *check) {
    const campaign_plan_t *plan = check->plan;

    text_add(text, "  safety_output:%s\n", campaign_has_flag(check, CAMPAIGN_NO_OUTPUT) ? " []" : "");
    if (campaign_has_flag(check, CAMPAIGN_NO_OUTPUT)) {
        return;
    }
    text_add(text, "    - {closed: true, at_ms: [%d, %d]}\n", READY_FROM_MS, READY_TO_MS);
    if (campaign_has_flag(check, CAMPAIGN_BY_OUTPUT)) {
        text_add(text, "    - {closed: false, at_ms: [%" PRIu32 ", %" PRIu32 "]}\n", plan->cause_ms, bound_ms(plan));
    } else if ((check->opened_us != CAMPAIGN_NEVER) && (check->broken != CAMPAIGN_FALSE_TRIP)) {
        text_add(text, "    - {closed: false, at_ms: %" PRIu64 "}\n", check->opened_us / US_PER_MS);
    }
}

static void add_frames(text_t *text, const campaign_check_t *check) {
    static const char *const safe =
        "    - {message: throttle_command, side: vehicle, bytes: \"00 00 00 00 00 00 00 00\", at_ms: ";
    const campaign_plan_t *plan = check->plan;

    text_add(text, "  frames:\n");
    if (!campaign_has_flag(check, CAMPAIGN_BY_OUTPUT)) {
        text_add(text, "%s[%" PRIu32 ", %" PRIu32 "]}\n", safe, plan->cause_ms, bound_ms(plan));
    }
    text_add(text, "%s[%" PRIu32 ", %" PRIu32 "]}\n", safe, plan->duration_ms - (uint32_t)BEAT_MS, plan->duration_ms);
    if (check->broken == CAMPAIGN_UNSAFE_FRAME) {
        const hal_can_frame_t *frame = &check->broken_frame;
        const uint64_t at_ms = check->broken_us / US_PER_MS;
        text_add(text, "  never:\n    - {id: %03" PRIX32 "h, side: vehicle, bytes: \"", frame->id);
        for (uint8_t i = 0; i < frame->length; i++) {
            text_add(text, "%s%02X", (i > 0) ? " " : "", frame->data[i]);
        }
        text_add(text, "\", at_ms: [%" PRIu64 ", %" PRIu64 "]}\n", at_ms, at_ms);
    }
}

void campaign_scenario_write(text_t *text, const campaign_check_t *check) {
    const campaign_plan_t *plan = check->plan;

    if (check->broken != CAMPAIGN_SOUND) {
        text_add(text, "# %s at %" PRIu64 ".%03" PRIu64 " ms\n", campaign_break_name(check->broken),
                 check->broken_us / US_PER_MS, check->broken_us % US_PER_MS);
    }
    text_add(text, "%sexpect:\n", plan->head.bytes);
    add_states(text, check);
    add_frames(text, check);
    add_output(text, check);
    if (!campaign_has_flag(check, CAMPAIGN_START) && (plan->engagement == NULL)) {
        const uint32_t later_ms = campaign_has_flag(check, CAMPAIGN_LATER) ? plan->number : 0;
        text_add(text, "  vehicle:\n    - {at_ms: %" PRIu32 ", mode: %s}\n", plan->cause_ms - later_ms - 1,
                 plan->engaged ? "autopilot" : "manual");
    }
}
