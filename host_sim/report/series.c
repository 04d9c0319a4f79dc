#include "report/series.h"

#include <stdlib.h>
#include <string.h>

#include "agv/codec.h"
#include "agv/recorder.h"
#include "agv/state.h"
#include "report/series_internal.h"
#include "text/units.h"

series_t *series_new(const agv_config_t *config) {
    series_t *series = calloc(1, sizeof *series);
    if (series != NULL) {
        series_reader_init(&series->reader, config);
        series_overview_init(&series->overview);
        series->due_us = UINT64_MAX;
    }
    return series;
}

void series_free(series_t *series) {
    if (series != NULL) {
        for (size_t i = 0; i < series->detail_count; i++) {
            free(series->details[i].frames);
        }
        free(series);
    }
}

static void change(series_t *series, series_lane_t lane, const series_change_t *to) {
    series_changes_t *changes = &series->lanes[lane];
    if (changes->count < SERIES_CHANGES_MAX) {
        changes->changes[changes->count] = *to;
        changes->count++;
    } else {
        changes->left_out++;
    }
    changes->last = *to;
}

/** A lane's value; nothing when it is the old one. */
static void set(series_t *series, series_lane_t lane, uint64_t t_us, uint8_t value) {
    const series_changes_t *changes = &series->lanes[lane];
    if ((changes->count == 0) || (changes->last.a != value) || (changes->last.c != 0)) {
        const series_change_t to = {.t_us = t_us, .a = value};
        change(series, lane, &to);
    }
}

/** The lane was not heard for long: it has no value from some time on. */
static void lose(series_t *series, series_lane_t lane, uint64_t t_us) {
    const series_changes_t *changes = &series->lanes[lane];
    if ((changes->count > 0) && (changes->last.c == 0) && (t_us - changes->seen_us > SERIES_LOST_US)) {
        const series_change_t to = {.t_us = changes->seen_us + SERIES_LOST_US, .c = 1};
        change(series, lane, &to);
    }
}

/** The value of a lane that a message repeats. */
static void hear(series_t *series, series_lane_t lane, uint64_t t_us, uint8_t value) {
    lose(series, lane, t_us);
    set(series, lane, t_us, value);
    series->lanes[lane].seen_us = t_us;
}

static uint8_t mode_of(uint8_t flags) {
    const bool manual = (flags & AGV_VCU_FLAG_MANUAL) != 0;
    const bool autopilot = (flags & AGV_VCU_FLAG_AUTOPILOT) != 0;
    if (manual) {
        return autopilot ? SERIES_MODE_BOTH : SERIES_MODE_MANUAL;
    }
    return autopilot ? SERIES_MODE_AUTOPILOT : SERIES_MODE_NEITHER;
}

static void set_lanes(series_t *series, agv_message_t message, const series_frame_t *frame) {
    if (message == AGV_MSG_VEHICLE_STATUS) {
        hear(series, SERIES_LANE_MODE, frame->t_us, mode_of(frame->data[6]));
    } else if (message == AGV_MSG_GEAR_STATUS) {
        hear(series, SERIES_LANE_GEAR, frame->t_us, frame->data[0]);
    } else if (message == AGV_MSG_GEAR_COMMAND) {
        hear(series, frame->sent ? SERIES_LANE_GEAR_SENT : SERIES_LANE_GEAR_COMMAND, frame->t_us, frame->data[0]);
    }
}

/** Copy what the ring has of a detail. Without memory it stays without frames. */
static void keep(series_t *series, series_detail_t *detail) {
    const uint64_t next = series->ring_next;
    uint64_t first = next;
    while ((first > 0) && (next - first < SERIES_RING_FRAMES) &&
           (series->ring[(first - 1) % SERIES_RING_FRAMES].t_us >= detail->from_us)) {
        first--;
    }
    detail->is_kept = true;
    detail->frames = malloc(((size_t)(next - first) + 1) * sizeof *detail->frames);
    if (detail->frames == NULL) {
        return;
    }
    for (; (first < next) && (series->ring[first % SERIES_RING_FRAMES].t_us <= detail->to_us); first++) {
        detail->frames[detail->count] = series->ring[first % SERIES_RING_FRAMES];
        detail->count++;
    }
}

/** Keep the details whose time is over. */
static void keep_until(series_t *series, uint64_t t_us) {
    series->due_us = UINT64_MAX;
    for (size_t i = 0; i < series->detail_count; i++) {
        series_detail_t *detail = &series->details[i];
        if (!detail->is_kept && (detail->to_us < t_us)) {
            keep(series, detail);
        } else if (!detail->is_kept && (detail->to_us < series->due_us)) {
            series->due_us = detail->to_us;
        }
    }
}

static void take(series_t *series, hal_can_side_t side, const hal_can_frame_t *frame, uint64_t t_us, bool sent) {
    if (t_us > series->due_us) {
        keep_until(series, t_us);
    }
    series_frame_t *kept = &series->ring[series->ring_next % SERIES_RING_FRAMES];
    *kept = (series_frame_t){.t_us = t_us,
                             .id = frame->id,
                             .side = (uint8_t)side,
                             .flags = frame->flags,
                             .length = frame->length,
                             .sent = sent};
    memcpy(kept->data, frame->data, sizeof kept->data);
    series->ring_next++;
    series->end_us = t_us;
    const agv_message_t message = series_message(&series->reader, kept);
    if (message == AGV_MSG_NONE) {
        return;
    }
    series_step_t *step = series_overview_at(&series->overview, t_us);
    const series_values_t values = series_values(message, kept);
    series_overview_values(step, &values);
    uint64_t gap_us = 0;
    if (!sent && series_ages_frame(&series->reader, &series->ages, message, kept, &gap_us)) {
        series_overview_gap(step, message, gap_us);
    }
    set_lanes(series, message, kept);
}

void series_frame(series_t *series, hal_can_side_t side, const hal_can_frame_t *frame, uint64_t t_us) {
    take(series, side, frame, t_us, false);
}

void series_sent(series_t *series, hal_can_side_t side, const hal_can_frame_t *frame, uint64_t t_us) {
    take(series, side, frame, t_us, true);
}

static void add_detail(series_t *series, uint64_t trip_us) {
    if (series->detail_count < SERIES_DETAILS_MAX) {
        series_detail_t *detail = &series->details[series->detail_count];
        series->detail_count++;
        detail->trip_us = trip_us;
        detail->from_us = (trip_us > SERIES_BEFORE_US) ? trip_us - SERIES_BEFORE_US : 0;
        detail->to_us = trip_us + SERIES_AFTER_US;
        series->due_us = (detail->to_us < series->due_us) ? detail->to_us : series->due_us;
    }
}

static void take_recorded(series_t *series, uint64_t t_us, const agv_event_t *event) {
    const series_change_t to = {
        .t_us = t_us, .missing = event->missing, .kind = event->kind, .a = event->a, .b = event->b, .c = event->c};
    switch ((agv_event_kind_t)event->kind) {
    case AGV_EVENT_STATE:
        change(series, SERIES_LANE_STATE, &to);
        if (event->b == AGV_STATE_TRIPPED) {
            add_detail(series, t_us);
        }
        break;
    case AGV_EVENT_FAULT:
        change(series, SERIES_LANE_FAULT, &to);
        break;
    case AGV_EVENT_OUTPUT:
        set(series, SERIES_LANE_OUTPUT, t_us, event->a);
        break;
    default:
        change(series, SERIES_LANE_NOTE, &to);
        break;
    }
}

/** A fault that changes too often may fill half of its lane: the other half is for the other faults. */
static bool is_too_often(const series_t *series, const session_event_t *event) {
    return event->is_left_out && (series->lanes[SERIES_LANE_FAULT].count >= SERIES_CHANGES_MAX / 2);
}

void series_event(void *ctx, const session_event_t *event) {
    series_t *series = ctx;
    const uint64_t t_us = event->t_ms * US_PER_MS;
    if (event->is_led) {
        set(series, SERIES_LANE_LED, t_us, (uint8_t)event->led_code);
    } else if (is_too_often(series, event)) {
        series->lanes[SERIES_LANE_FAULT].left_out++;
    } else {
        take_recorded(series, t_us, &event->recorded);
    }
}

void series_end(series_t *series, uint64_t end_us) {
    const uint64_t t_us = (end_us > series->end_us) ? end_us : series->end_us;
    series->end_us = t_us;
    for (size_t i = 0; i < series->detail_count; i++) {
        series_detail_t *detail = &series->details[i];
        detail->to_us = (detail->to_us < t_us) ? detail->to_us : t_us;
    }
    keep_until(series, UINT64_MAX);
    for (int lane = SERIES_LANE_MODE; lane <= SERIES_LANE_GEAR_SENT; lane++) {
        lose(series, (series_lane_t)lane, t_us);
    }
    series_step_t *step = series_overview_at(&series->overview, t_us);
    for (size_t i = 0; i < AGV_MSG_COUNT; i++) {
        if (series->ages.heard[i]) {
            series_overview_gap(step, (agv_message_t)i, t_us - series->ages.last_us[i]);
        }
    }
}

uint64_t series_end_us(const series_t *series) {
    return series->end_us;
}

/** When the operator's reset ended a trip. @return UINT64_MAX: it did not end */
static uint64_t trip_end_us(const series_t *series, uint64_t trip_us) {
    const series_changes_t *states = &series->lanes[SERIES_LANE_STATE];
    for (size_t i = 0; i < states->count; i++) {
        if ((states->changes[i].t_us > trip_us) && (states->changes[i].b == AGV_STATE_STANDBY)) {
            return states->changes[i].t_us;
        }
    }
    return UINT64_MAX;
}

uint64_t series_output_opened_us(const series_t *series, uint64_t trip_us) {
    const series_changes_t *output = &series->lanes[SERIES_LANE_OUTPUT];
    const uint64_t end_us = trip_end_us(series, trip_us);
    bool is_open = true;
    for (size_t i = 0; (i < output->count) && (output->changes[i].t_us < end_us); i++) {
        const series_change_t *change = &output->changes[i];
        if ((change->t_us / US_PER_MS >= trip_us / US_PER_MS) && (change->a == 0) && !is_open) {
            return change->t_us;
        }
        is_open = change->a == 0;
    }
    return is_open ? 0 : UINT64_MAX;
}

const series_frame_t *series_frames(const series_t *series, uint64_t t_us, size_t *count) {
    const series_detail_t *found = NULL;
    for (size_t i = 0; i < series->detail_count; i++) {
        const series_detail_t *detail = &series->details[i];
        if ((detail->trip_us <= t_us) && (t_us <= detail->to_us)) {
            found = detail;
        }
    }
    *count = (found != NULL) ? found->count : 0;
    return (found != NULL) ? found->frames : NULL;
}
