/* The expectations of a skeleton: what a run of it showed, with some room around each time. */
#include <inttypes.h>

#include "agv/codec.h"
#include "agv/names.h"
#include "skeleton/skeleton_plan.h"

/** Room around a time, and the steps that times after an event are rounded up to. */
enum { ROOM_MS = 5, ROUND_MS = 10, SAFE_FRAME_MS = 5 };

/** After some event, rounded up. */
static uint32_t rounded(uint32_t ms) {
    return ((ms / ROUND_MS) + 1) * (uint32_t)ROUND_MS;
}

/** The step or event that a change of state counts from; NULL: the start of the run. */
static const char *anchor_of(const skeleton_plan_t *plan, const skeleton_seen_t *seen, const skeleton_change_t *change,
                             uint32_t *since_ms) {
    const bool is_early = (plan->engage_ms > plan->cause_ms) && (change->t_ms >= plan->engage_ms);
    if ((change->to == AGV_STATE_TRIPPED) && (change->t_ms == seen->trip_ms) && (change->t_ms >= plan->cause_ms)) {
        *since_ms = change->t_ms - (is_early ? plan->engage_ms : plan->cause_ms);
        return is_early ? "engages" : "fault";
    }
    if (seen->has_tripped && (change->t_ms > seen->trip_ms)) {
        *since_ms = change->t_ms - seen->trip_ms;
        return "trip";
    }
    if ((change->to == AGV_STATE_ACTIVE) && (plan->engage_ms != 0) && (change->t_ms >= plan->engage_ms) &&
        (is_early || (change->t_ms < plan->cause_ms))) {
        *since_ms = change->t_ms - plan->engage_ms;
        return "engages";
    }
    return NULL;
}

static void add_time(text_t *text, const skeleton_plan_t *plan, const skeleton_seen_t *seen,
                     const skeleton_change_t *change) {
    uint32_t since_ms = 0;
    const char *anchor = anchor_of(plan, seen, change, &since_ms);

    if (anchor != NULL) {
        text_add(text, "after: %s, within: %" PRIu32 "ms}\n", anchor, rounded(since_ms));
    } else if (change->t_ms == 0) {
        text_add(text, "at_ms: 0}\n");
    } else {
        text_add(text, "at_ms: [%" PRIu32 ", %" PRIu32 "]}\n", change->t_ms - (uint32_t)ROOM_MS,
                 change->t_ms + (uint32_t)ROOM_MS);
    }
}

static void add_states(text_t *text, const skeleton_plan_t *plan, const skeleton_seen_t *seen) {
    text_add(text, "  states:\n");
    for (size_t i = 0; i < seen->count; i++) {
        const skeleton_change_t *change = &seen->changes[i];
        const char *reason = agv_fault_name((agv_fault_t)change->reason);
        if (!change->is_output) {
            text_add(text, "    - {to: %s, ", agv_state_name((agv_state_t)change->to));
            if (reason != NULL) {
                text_add(text, "reason: %s, ", reason);
            }
            add_time(text, plan, seen, change);
        }
    }
}

static void add_outputs(text_t *text, const skeleton_plan_t *plan, const skeleton_seen_t *seen) {
    bool any = false;
    for (size_t i = 0; i < seen->count; i++) {
        const skeleton_change_t *change = &seen->changes[i];
        if (change->is_output) {
            text_add(text, "%s    - {closed: %s, ", any ? "" : "  safety_output:\n",
                     (change->to != 0) ? "true" : "false");
            add_time(text, plan, seen, change);
            any = true;
        }
    }
}

void skeleton_expect(text_t *text, const skeleton_plan_t *plan, const skeleton_seen_t *seen) {
    add_states(text, plan, seen);
    if (seen->gear_p_came) {
        text_add(
            text,
            "  frames:\n"
            "    - {message: gear_command, bytes: \"08 00 00 00 00 00 00 00\", side: vehicle, after: trip, within: "
            "%dms}\n",
            SAFE_FRAME_MS);
    }
    add_outputs(text, plan, seen);
    text_add(text, "  faults:\n    - {name: %s, class: trip, after: fault, within: %" PRIu32 "ms}\n",
             agv_fault_name((agv_fault_t)seen->reason), rounded(seen->trip_ms - plan->cause_ms));
    if ((seen->end.gear == AGV_GEAR_P) && !seen->end.autopilot && (seen->end.speed_mm_s == 0)) {
        text_add(text, "  vehicle:\n    - {at_ms: %" PRIu32 ", gear: P, mode: manual, speed_mm_s: 0}\n",
                 plan->duration_ms);
    }
}

/* --- the run --- */

static void note_change(skeleton_seen_t *seen, const session_event_t *event, bool is_output) {
    const agv_event_t *recorded = &event->recorded;
    if (seen->count < SKELETON_CHANGES_MAX) {
        seen->changes[seen->count] = (skeleton_change_t){
            .is_output = is_output,
            .to = is_output ? recorded->a : recorded->b,
            .reason = is_output ? (uint8_t)AGV_FAULT_NONE : recorded->c,
            .t_ms = (uint32_t)event->t_ms,
        };
        seen->count++;
    }
}

static void on_event(void *ctx, const session_event_t *event) {
    skeleton_seen_t *seen = ctx;
    const agv_event_t *recorded = &event->recorded;

    if (event->is_led) {
        return;
    }
    if (recorded->kind == AGV_EVENT_OUTPUT) {
        const bool opens_at_start = (recorded->a == 0) && (event->t_ms == 0);
        if (!opens_at_start) {
            note_change(seen, event, true);
        }
    } else if (recorded->kind == AGV_EVENT_STATE) {
        note_change(seen, event, false);
        if ((recorded->b == AGV_STATE_TRIPPED) && !seen->has_tripped) {
            seen->has_tripped = true;
            seen->reason = recorded->c;
            seen->trip_ms = (uint32_t)event->t_ms;
        }
    } else {
        return;
    }
}

/** A run and what is seen of it. */
typedef struct {
    skeleton_seen_t *seen;
    uint32_t gear_id;
} watching_t;

static void on_frame(void *ctx, uint64_t t_us, hal_can_side_t side, int from, const hal_can_frame_t *frame) {
    watching_t *watching = ctx;
    skeleton_seen_t *seen = watching->seen;
    const uint64_t t_ms = t_us / 1000;

    if ((from == SCENARIO_FROM_SUPERVISOR) && (side == HAL_CAN_VEHICLE) && seen->has_tripped &&
        (frame->id == watching->gear_id) && (frame->length == AGV_DLC) && (frame->data[0] == AGV_GEAR_P) &&
        (t_ms >= seen->trip_ms) && (t_ms <= seen->trip_ms + (uint32_t)SAFE_FRAME_MS)) {
        seen->gear_p_came = true;
    }
}

bool skeleton_play(scenario_run_t *run, const text_t *text, const agv_config_t *config, skeleton_seen_t *seen) {
    const scenario_options_t options = {.config = *config, .topology = -1, .id_set = -1};

    *seen = (skeleton_seen_t){.count = 0};
    if (!scenario_read_text(&run->scenario, "skeleton", text->bytes, &options)) {
        return false;
    }
    watching_t watching = {seen, run->scenario.ids.of[AGV_MSG_GEAR_COMMAND]};
    const scenario_watch_t watches[] = {{.on_event = on_event, .ctx = seen}, {.on_frame = on_frame, .ctx = &watching}};
    (void)scenario_run(run, watches, sizeof watches / sizeof watches[0], NULL);
    scenario_testbed_vehicle(&run->testbed, &seen->end);
    return true;
}
