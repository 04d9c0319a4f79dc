#include "report/series_lines.h"

#include "common/json_build.h"
#include "report/series_internal.h"

/** A line of a signal as it is written: the points at which it changes. */
typedef struct {
    json_t *t;
    json_t *lo;
    json_t *hi;
    uint64_t last_t; /* of the last point, in units */
    uint64_t seen_us;
    int32_t last_lo;
    int32_t last_hi;
    bool heard;
    bool is_range; /* lo and hi differ somewhere */
} line_t;

static const char *const signal_names[SERIES_SIGNALS] = {
    [SERIES_WHEEL_LEFT] = "wheel_left",
    [SERIES_WHEEL_RIGHT] = "wheel_right",
    [SERIES_VCU_SPEED] = "vcu_speed",
    [SERIES_THROTTLE_COMMAND] = "throttle_command",
    [SERIES_THROTTLE_SENT] = "throttle_sent",
    [SERIES_THROTTLE_STATUS] = "throttle_status",
    [SERIES_STEERING_COMMAND] = "steering_command",
    [SERIES_STEERING_SENT] = "steering_sent",
    [SERIES_STEERING_STATUS] = "steering_status",
};

json_t *series_units(uint64_t t_us) {
    return json_uint(t_us / SERIES_UNIT_US);
}

void series_append_time(json_t *array, uint64_t *last, uint64_t t_us) {
    const uint64_t t = t_us / SERIES_UNIT_US;
    json_add(array, json_uint(t - *last));
    *last = t;
}

static void line_begin(line_t *line) {
    *line = (line_t){.t = json_array(), .lo = json_array(), .hi = json_array()};
}

static void line_lost(line_t *line, uint64_t t_us) {
    series_append_time(line->t, &line->last_t, t_us);
    json_add(line->lo, json_null());
    json_add(line->hi, json_null());
    line->heard = false;
}

/** A value from @p t_us on. @param patience_us after how long without a value the signal is lost */
static void line_point(line_t *line, uint64_t t_us, int32_t lo, int32_t hi, uint64_t patience_us) {
    if (line->heard && (t_us - line->seen_us > patience_us)) {
        line_lost(line, line->seen_us + patience_us);
    }
    line->seen_us = t_us;
    if (line->heard && (line->last_lo == lo) && (line->last_hi == hi)) {
        return;
    }
    series_append_time(line->t, &line->last_t, t_us);
    json_add(line->lo, json_integer(lo));
    json_add(line->hi, json_integer(hi));
    line->is_range = line->is_range || (lo != hi);
    line->heard = true;
    line->last_lo = lo;
    line->last_hi = hi;
}

/** The lines as an object, without those that have no point. */
static json_t *lines_json(line_t *lines, uint64_t end_us, uint64_t patience_us) {
    json_t *object = json_object();
    for (size_t i = 0; i < SERIES_SIGNALS; i++) {
        line_t *line = &lines[i];
        if (line->heard && (end_us - line->seen_us > patience_us)) {
            line_lost(line, line->seen_us + patience_us);
        }
        json_t *entry = json_object();
        const bool is_used = json_array_size(line->t) > 0;
        json_put(entry, "t", line->t);
        json_put(entry, "lo", line->lo);
        if (line->is_range) {
            json_put(entry, "hi", line->hi);
        } else {
            json_decref(line->hi);
        }
        if (is_used) {
            json_put(object, signal_names[i], entry);
        } else {
            json_decref(entry);
        }
    }
    return object;
}

static json_t *span_json(uint64_t from_us, uint64_t to_us) {
    json_t *object = json_object();
    json_put(object, "from", series_units(from_us));
    json_put(object, "to", series_units(to_us));
    return object;
}

static json_t *overview_signals(const series_overview_t *overview) {
    line_t lines[SERIES_SIGNALS];
    const uint64_t patience_us = (2 * overview->step_us > SERIES_LOST_US) ? 2 * overview->step_us : SERIES_LOST_US;
    for (size_t i = 0; i < SERIES_SIGNALS; i++) {
        line_begin(&lines[i]);
    }
    for (size_t at = 0; at < overview->count; at++) {
        const series_step_t *step = &overview->steps[at];
        for (size_t i = 0; i < SERIES_SIGNALS; i++) {
            if (step->lowest[i] != SERIES_NO_VALUE) {
                line_point(&lines[i], at * overview->step_us, step->lowest[i], step->highest[i], patience_us);
            }
        }
    }
    return lines_json(lines, overview->count * overview->step_us, patience_us);
}

static json_t *overview_gaps(const series_overview_t *overview, uint64_t end_us) {
    json_t *gaps = json_array();
    for (size_t message = 0; message < AGV_MSG_COUNT; message++) {
        json_t *t = json_array();
        json_t *gap = json_array();
        uint64_t last = 0;
        for (size_t at = 0; at < overview->count; at++) {
            const uint32_t longest = overview->steps[at].gap[message];
            const uint64_t step_end_us = (at + 1) * overview->step_us;
            if (longest != 0) {
                series_append_time(t, &last, (step_end_us < end_us) ? step_end_us : end_us);
                json_add(gap, json_uint(longest));
            }
        }
        json_t *line = json_object();
        json_put(line, "t", t);
        json_put(line, "gap", gap);
        json_add(gaps, line);
    }
    return gaps;
}

json_t *series_overview_json(const series_t *series) {
    json_t *object = span_json(0, series->end_us);
    json_put(object, "step", series_units(series->overview.step_us));
    json_put(object, "signals", overview_signals(&series->overview));
    json_put(object, "gaps", overview_gaps(&series->overview, series->end_us));
    return object;
}

static json_t *detail_signals(const series_t *series, const series_detail_t *detail) {
    line_t lines[SERIES_SIGNALS];
    for (size_t i = 0; i < SERIES_SIGNALS; i++) {
        line_begin(&lines[i]);
    }
    for (size_t at = 0; at < detail->count; at++) {
        const series_frame_t *frame = &detail->frames[at];
        const agv_message_t message = series_message(&series->reader, frame);
        if (message != AGV_MSG_NONE) {
            const series_values_t values = series_values(message, frame);
            for (uint8_t i = 0; i < values.count; i++) {
                line_point(&lines[values.signal[i]], frame->t_us, values.value[i], values.value[i], SERIES_LOST_US);
            }
        }
    }
    return lines_json(lines, detail->to_us, SERIES_LOST_US);
}

/** A point of a gap line: negative for a frame that did not renew its message. */
static void append_gap(json_t *line, uint64_t *last, uint64_t t_us, uint64_t gap_us, bool is_new) {
    const json_int_t gap = (json_int_t)((gap_us + (SERIES_UNIT_US / 2)) / SERIES_UNIT_US);
    series_append_time(json_object_get(line, "t"), last, t_us);
    json_add(json_object_get(line, "gap"), json_integer(is_new ? gap : -gap));
}

static json_t *gap_line(void) {
    json_t *line = json_object();
    json_put(line, "t", json_array());
    json_put(line, "gap", json_array());
    return line;
}

static json_t *detail_gaps(const series_t *series, const series_detail_t *detail) {
    json_t *gaps = json_array();
    uint64_t last[AGV_MSG_COUNT] = {0};
    series_ages_t ages = {.heard = {false}};
    for (size_t message = 0; message < AGV_MSG_COUNT; message++) {
        json_add(gaps, gap_line());
    }
    for (size_t at = 0; at < detail->count; at++) {
        const series_frame_t *frame = &detail->frames[at];
        const agv_message_t message = series_message(&series->reader, frame);
        if ((message != AGV_MSG_NONE) && !frame->sent) {
            uint64_t gap_us = 0;
            const bool is_new = series_ages_frame(&series->reader, &ages, message, frame, &gap_us);
            append_gap(json_array_get(gaps, (size_t)message), &last[message], frame->t_us, gap_us, is_new);
        }
    }
    for (size_t message = 0; message < AGV_MSG_COUNT; message++) {
        if (ages.heard[message]) { /* the gap that is open at the end */
            append_gap(json_array_get(gaps, message), &last[message], detail->to_us,
                       detail->to_us - ages.last_us[message], false);
        }
    }
    return gaps;
}

json_t *series_details_json(const series_t *series) {
    json_t *details = json_array();
    for (size_t i = 0; i < series->detail_count; i++) {
        const series_detail_t *detail = &series->details[i];
        if (detail->count > 0) {
            json_t *object = span_json(detail->frames[0].t_us, detail->to_us);
            json_put(object, "trip", series_units(detail->trip_us));
            json_put(object, "step", json_uint(0));
            json_put(object, "signals", detail_signals(series, detail));
            json_put(object, "gaps", detail_gaps(series, detail));
            json_add(details, object);
        }
    }
    return details;
}
