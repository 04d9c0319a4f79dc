/* What must hold in a soak: nothing trips, nothing drifts, everything is counted. */
#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>

#include "agv/names.h"
#include "agv/recorder.h"
#include "agv/state.h"
#include "campaign/soak/soak_internal.h"
#include "text/units.h"

/* A status frame waits for others; a late step of 20 ms is one of the disturbances. */
enum { STATUS_LATE_MS = 30, STATUS_AGAIN_MS = 4, WAITING_MAX = 8 };

/* Safe commands of INIT that the controller has already when STANDBY comes; they wait for a few frames of others. */
enum { HANDED_OVER_MS = 4 };

__attribute__((format(printf, 2, 3))) static void soak_break(soak_t *soak, const char *format, ...) {
    soak_state_t *state = &soak->state;
    if (state->broken[0] != '\0') {
        return;
    }
    va_list arguments;
    va_start(arguments, format);
    (void)vsnprintf(state->broken, sizeof state->broken, format, arguments);
    va_end(arguments);
}

static const char *present_row(const soak_t *soak) {
    return (soak->state.row < SOAK_ROW_COUNT) ? SOAK_ROWS[soak->state.row].name : "nothing";
}

static void on_state(soak_t *soak, uint64_t t_ms, const agv_event_t *event) {
    soak_state_t *state = &soak->state;
    const bool well = (event->b == AGV_STATE_STANDBY) || (event->b == AGV_STATE_ACTIVE);

    if (state->ready && !well) {
        const char *reason = agv_fault_name((agv_fault_t)event->c);
        soak_break(soak, "%s at %" PRIu64 " ms, because of %s, in: %s", agv_state_name((agv_state_t)event->b), t_ms,
                   (reason != NULL) ? reason : "nothing", present_row(soak));
    }
    if (!state->ready && (event->b == AGV_STATE_STANDBY)) {
        state->ready = true;
        state->ready_ms = t_ms;
        state->ticks_before = state->ticks + 1; /* the event is reported after its tick */
        scenario_testbed_view_t view;
        scenario_testbed_view(&soak->testbed, &view);
        state->feeds_before = view.feeds;
    }
}

static void on_event(void *ctx, const session_event_t *event) {
    soak_t *soak = ctx;
    const agv_event_t *recorded = &event->recorded;
    if (event->is_led) {
        return;
    }
    if (recorded->kind == AGV_EVENT_STATE) {
        on_state(soak, event->t_ms, recorded);
    } else if ((recorded->kind == AGV_EVENT_FAULT) && (recorded->c != 0)) {
        if (recorded->b == AGV_CLASS_WARN) {
            soak->state.warnings++;
        } else if (soak->state.ready) {
            soak_break(soak, "%s at %" PRIu64 " ms, in: %s", agv_fault_name((agv_fault_t)recorded->a), event->t_ms,
                       present_row(soak));
        }
    }
}

/** Whether it is the one before again, as that one may have been discarded with what waited (FSM-2). */
static bool is_again(const soak_state_t *state, uint64_t t_ms) {
    return state->status_seen && (t_ms - state->status_last_ms <= STATUS_AGAIN_MS);
}

/** The status frame keeps its slots: no drift, none lost. */
static void check_slot(soak_t *soak, uint64_t t_ms) {
    soak_state_t *state = &soak->state;

    state->status_frames++;
    const uint64_t slot_ms = state->status_ms + (state->status_frames * SOAK_STATUS_MS);
    /* The first one may have waited itself. */
    if ((t_ms + STATUS_LATE_MS < slot_ms) || (t_ms > slot_ms + STATUS_LATE_MS)) {
        soak_break(soak, "drift: status frame %" PRIu64 " at %" PRIu64 " ms, its slot is %" PRIu64 " ms, in: %s",
                   state->status_frames, t_ms, slot_ms, present_row(soak));
    } else if ((t_ms > slot_ms) && (t_ms - slot_ms > state->status_late_ms)) {
        state->status_late_ms = (uint32_t)(t_ms - slot_ms);
    }
}

/** The status frame keeps its slots and counts; one that was discarded is missing in the count, once. */
static void check_status(soak_t *soak, uint64_t t_us, const hal_can_frame_t *frame) {
    soak_state_t *state = &soak->state;
    const uint64_t t_ms = t_us / US_PER_MS;
    const uint8_t steps = (uint8_t)(frame->data[3] - state->status_counter);

    if (!state->status_seen) {
        state->status_seen = true;
        state->status_ms = t_ms;
    } else if (is_again(state, t_ms)) {
        state->status_again++;
    } else {
        check_slot(soak, t_ms);
    }
    if ((state->status_last_ms != 0) && (steps != 1) && (steps != 2)) {
        soak_break(soak, "the status frame at %" PRIu64 " ms carries the counter %u, the last one %u", t_ms,
                   frame->data[3], state->status_counter);
    }
    state->status_counter = frame->data[3];
    state->status_last_ms = t_ms;
}

static void on_frame(void *ctx, uint64_t t_us, hal_can_side_t side, int from, const hal_can_frame_t *frame) {
    soak_t *soak = ctx;

    if (from != SCENARIO_FROM_SUPERVISOR) {
        soak->state.wire_others++;
        return;
    }
    soak->state.wire_own++;
    if ((side == HAL_CAN_VEHICLE) && (frame->id == SOAK_STATUS_ID)) {
        check_status(soak, t_us, frame);
    } else if (!soak->gateway && soak->state.ready && (t_us > (soak->state.ready_ms + HANDED_OVER_MS) * US_PER_MS)) {
        soak_break(soak, "%03" PRIX32 "h sent at %" PRIu64 " us", frame->id, t_us);
    }
}

scenario_watch_t soak_watch(soak_t *soak) {
    return (scenario_watch_t){.on_event = on_event, .on_frame = on_frame, .ctx = soak};
}

void soak_check_tick(soak_t *soak) {
    scenario_testbed_view_t view;
    scenario_testbed_view(&soak->testbed, &view);
    if (!view.is_halted) {
        soak->state.ticks++;
    }
    if (soak->state.ready && !view.output_closed) {
        soak_break(soak, "the output is open at %" PRIu64 " ms, in: %s", soak->state.t_ms, present_row(soak));
    }
}

static void check_count(soak_t *soak, const char *what, uint64_t counted, uint64_t seen, uint32_t may_wait) {
    const uint32_t ahead = (uint32_t)counted - (uint32_t)seen; /* counters of the supervisor have 32 bits, and wrap */
    if (ahead > may_wait) {
        soak_break(soak, "%s: counted %" PRIu32 ", seen %" PRIu32 " (both modulo 2^32), at %" PRIu64 " ms", what,
                   (uint32_t)counted, (uint32_t)seen, soak->state.t_ms);
    }
}

/** Frames that the supervisor handed over and took back (TOP-2: at the end of an engagement). */
static uint64_t count_purged(const soak_t *soak) {
    uint64_t purged = 0;
    for (unsigned side = 0; side < HAL_CAN_SIDES; side++) {
        sim_bus_stats_t stats;
        scenario_testbed_bus_stats(&soak->testbed, (hal_can_side_t)side, &stats);
        purged += stats.purged;
    }
    return purged;
}

void soak_check_counters(soak_t *soak) {
    const soak_state_t *state = &soak->state;
    const agv_supervisor_t *supervisor = &scenario_testbed_session(&soak->testbed)->supervisor;
    const agv_counters_t *counters = agv_supervisor_counters(supervisor);
    scenario_testbed_view_t view;

    scenario_testbed_view(&soak->testbed, &view);
    if (view.is_halted) {
        return; /* frames wait: the next time */
    }
    check_count(soak, "frames received", counters->received, state->wire_others + state->delivered, 0);
    check_count(soak, "frames received, by the port", view.received, state->wire_others + state->delivered, 0);
    check_count(soak, "frames sent", counters->sent, state->wire_own + count_purged(soak), WAITING_MAX);
    check_count(soak, "warnings", counters->warnings, state->warnings, 0);
    check_count(soak, "refused by the gate", counters->gate_refused, 0, 0);
    check_count(soak, "watchdog resets", view.bites, 0, 0);
    check_count(soak, "feeds of the watchdog", (uint64_t)view.feeds - state->feeds_before,
                state->ticks - state->ticks_before, 0);
    check_count(soak, "the supervisor's clock", agv_supervisor_tick_ms(supervisor), soak->start_ms + view.t_ms, 0);
    const uint64_t slots = (state->t_ms - state->status_ms) / SOAK_STATUS_MS;
    check_count(soak, "status frames", slots + 1, state->status_frames, 2);
}
