#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "agv/codec.h"
#include "agv/names.h"
#include "agv/recorder.h"
#include "common/missing.h"
#include "report/series.h"
#include "report/series_internal.h"

enum { UNIT_US = 100, TEXT_SIZE = 256 };

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

static const char *const lane_names[SERIES_LANES] = {
    [SERIES_LANE_STATE] = "state",
    [SERIES_LANE_MODE] = "mode",
    [SERIES_LANE_GEAR] = "gear",
    [SERIES_LANE_GEAR_COMMAND] = "gear_command",
    [SERIES_LANE_GEAR_SENT] = "gear_sent",
    [SERIES_LANE_OUTPUT] = "output",
    [SERIES_LANE_LED] = "led",
};

static void set(json_t *object, const char *key, json_t *value) {
    (void)json_object_set_new(object, key, value);
}

static void append(json_t *array, json_t *value) {
    (void)json_array_append_new(array, value);
}

static json_t *number(uint64_t value) {
    return json_integer((json_int_t)value);
}

static json_t *units(uint64_t t_us) {
    return number(t_us / UNIT_US);
}

static json_t *text_or_null(const char *text) {
    return (text != NULL) ? json_string(text) : json_null();
}

/** Append a time as the difference to the one before. */
static void append_time(json_t *array, uint64_t *last, uint64_t t_us) {
    const uint64_t t = t_us / UNIT_US;
    append(array, number(t - *last));
    *last = t;
}

static void line_begin(line_t *line) {
    *line = (line_t){.t = json_array(), .lo = json_array(), .hi = json_array()};
}

static void line_lost(line_t *line, uint64_t t_us) {
    append_time(line->t, &line->last_t, t_us);
    append(line->lo, json_null());
    append(line->hi, json_null());
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
    append_time(line->t, &line->last_t, t_us);
    append(line->lo, json_integer(lo));
    append(line->hi, json_integer(hi));
    line->is_range = line->is_range || (lo != hi);
    line->heard = true;
    line->last_lo = lo;
    line->last_hi = hi;
}

/** The lines as an object, without those that have no point. */
static json_t *lines_json(line_t *lines, uint64_t end_us, uint64_t patience_us) {
    json_t *object = json_object();
    for (size_t i = 0u; i < (size_t)SERIES_SIGNALS; i++) {
        line_t *line = &lines[i];
        if (line->heard && (end_us - line->seen_us > patience_us)) {
            line_lost(line, line->seen_us + patience_us);
        }
        json_t *entry = json_object();
        const bool is_used = json_array_size(line->t) > 0u;
        set(entry, "t", line->t);
        set(entry, "lo", line->lo);
        if (line->is_range) {
            set(entry, "hi", line->hi);
        } else {
            json_decref(line->hi);
        }
        if (is_used) {
            set(object, signal_names[i], entry);
        } else {
            json_decref(entry);
        }
    }
    return object;
}

static json_t *span_json(uint64_t from_us, uint64_t to_us) {
    json_t *object = json_object();
    set(object, "from", units(from_us));
    set(object, "to", units(to_us));
    return object;
}

static json_t *overview_signals(const series_overview_t *overview) {
    line_t lines[SERIES_SIGNALS];
    const uint64_t patience_us = (2u * overview->step_us > SERIES_LOST_US) ? 2u * overview->step_us : SERIES_LOST_US;
    for (size_t i = 0u; i < (size_t)SERIES_SIGNALS; i++) {
        line_begin(&lines[i]);
    }
    for (size_t at = 0u; at < overview->count; at++) {
        const series_step_t *step = &overview->steps[at];
        for (size_t i = 0u; i < (size_t)SERIES_SIGNALS; i++) {
            if (step->lowest[i] != SERIES_NO_VALUE) {
                line_point(&lines[i], at * overview->step_us, step->lowest[i], step->highest[i], patience_us);
            }
        }
    }
    return lines_json(lines, overview->count * overview->step_us, patience_us);
}

static json_t *overview_gaps(const series_overview_t *overview, uint64_t end_us) {
    json_t *gaps = json_array();
    for (size_t message = 0u; message < (size_t)AGV_MSG_COUNT; message++) {
        json_t *t = json_array();
        json_t *gap = json_array();
        uint64_t last = 0u;
        for (size_t at = 0u; at < overview->count; at++) {
            const uint32_t longest = overview->steps[at].gap[message];
            const uint64_t step_end_us = (at + 1u) * overview->step_us;
            if (longest != 0u) {
                append_time(t, &last, (step_end_us < end_us) ? step_end_us : end_us);
                append(gap, number(longest));
            }
        }
        json_t *line = json_object();
        set(line, "t", t);
        set(line, "gap", gap);
        append(gaps, line);
    }
    return gaps;
}

static json_t *overview_json(const series_t *series) {
    json_t *object = span_json(0u, series->end_us);
    set(object, "step", units(series->overview.step_us));
    set(object, "signals", overview_signals(&series->overview));
    set(object, "gaps", overview_gaps(&series->overview, series->end_us));
    return object;
}

static json_t *detail_signals(const series_t *series, const series_detail_t *detail) {
    line_t lines[SERIES_SIGNALS];
    for (size_t i = 0u; i < (size_t)SERIES_SIGNALS; i++) {
        line_begin(&lines[i]);
    }
    for (size_t at = 0u; at < detail->count; at++) {
        const series_frame_t *frame = &detail->frames[at];
        const agv_message_t message = series_message(&series->reader, frame);
        if (message != AGV_MSG_NONE) {
            const series_values_t values = series_values(message, frame);
            for (uint8_t i = 0u; i < values.count; i++) {
                line_point(&lines[values.signal[i]], frame->t_us, values.value[i], values.value[i], SERIES_LOST_US);
            }
        }
    }
    return lines_json(lines, detail->to_us, SERIES_LOST_US);
}

/** A point of a gap line: negative for a frame that did not renew its message. */
static void append_gap(json_t *line, uint64_t *last, uint64_t t_us, uint64_t gap_us, bool is_new) {
    const json_int_t gap = (json_int_t)((gap_us + (UNIT_US / 2u)) / UNIT_US);
    append_time(json_object_get(line, "t"), last, t_us);
    append(json_object_get(line, "gap"), json_integer(is_new ? gap : -gap));
}

static json_t *gap_line(void) {
    json_t *line = json_object();
    set(line, "t", json_array());
    set(line, "gap", json_array());
    return line;
}

static json_t *detail_gaps(const series_t *series, const series_detail_t *detail) {
    json_t *gaps = json_array();
    uint64_t last[AGV_MSG_COUNT] = {0};
    series_ages_t ages = {.heard = {false}};
    for (size_t message = 0u; message < (size_t)AGV_MSG_COUNT; message++) {
        append(gaps, gap_line());
    }
    for (size_t at = 0u; at < detail->count; at++) {
        const series_frame_t *frame = &detail->frames[at];
        const agv_message_t message = series_message(&series->reader, frame);
        if ((message != AGV_MSG_NONE) && !frame->sent) {
            uint64_t gap_us = 0u;
            const bool is_new = series_ages_frame(&series->reader, &ages, message, frame, &gap_us);
            append_gap(json_array_get(gaps, (size_t)message), &last[message], frame->t_us, gap_us, is_new);
        }
    }
    for (size_t message = 0u; message < (size_t)AGV_MSG_COUNT; message++) {
        if (ages.heard[message]) { /* the gap that is open at the end */
            append_gap(json_array_get(gaps, message), &last[message], detail->to_us,
                       detail->to_us - ages.last_us[message], false);
        }
    }
    return gaps;
}

static json_t *details_json(const series_t *series) {
    json_t *details = json_array();
    for (size_t i = 0u; i < series->detail_count; i++) {
        const series_detail_t *detail = &series->details[i];
        if (detail->count > 0u) {
            json_t *object = span_json(detail->frames[0].t_us, detail->to_us);
            set(object, "trip", units(detail->trip_us));
            set(object, "step", number(0u));
            set(object, "signals", detail_signals(series, detail));
            set(object, "gaps", detail_gaps(series, detail));
            append(details, object);
        }
    }
    return details;
}

static json_t *messages_json(const series_t *series) {
    static const char *const senders[] = {"AI computer", "VCU", "EPS"};
    json_t *messages = json_array();
    for (uint32_t i = 0u; i < (uint32_t)AGV_MSG_COUNT; i++) {
        const agv_message_t message = (agv_message_t)i;
        const bool is_command = i < AGV_COMMAND_COUNT;
        const bool is_of_eps = (message == AGV_MSG_STEERING_STATUS) || (message == AGV_MSG_EPS_STATUS) ||
                               (message == AGV_MSG_STEERING_POSITION);
        char id[8];
        (void)snprintf(id, sizeof id, "%03X", (unsigned)series->reader.ids.of[i]);
        json_t *object = json_object();
        set(object, "name", text_or_null(agv_message_name(message)));
        set(object, "id", json_string(id));
        set(object, "sender", json_string(senders[is_command ? 0 : (is_of_eps ? 2 : 1)]));
        set(object, "cycle", number(agv_message_cycle_ms(i)));
        set(object, "deadline", number(series_deadline_ms(&series->reader.config, message)));
        set(object, "heartbeat", json_boolean(series_counter_at(message) >= 0));
        set(object, "command", json_boolean(is_command));
        set(object, "heard", json_boolean(series->ages.heard[i]));
        append(messages, object);
    }
    return messages;
}

static json_t *gear_json(uint8_t gear) {
    char text[8];
    switch (gear) {
    case AGV_GEAR_P:
        return json_string("P");
    case AGV_GEAR_R:
        return json_string("R");
    case AGV_GEAR_N:
        return json_string("N");
    case AGV_GEAR_D:
        return json_string("D");
    default:
        (void)snprintf(text, sizeof text, "%02Xh", gear);
        return json_string(text);
    }
}

static json_t *value_json(size_t lane, const series_change_t *change) {
    static const char *const modes[] = {[SERIES_MODE_NEITHER] = "neither",
                                        [SERIES_MODE_MANUAL] = "manual",
                                        [SERIES_MODE_AUTOPILOT] = "autopilot",
                                        [SERIES_MODE_BOTH] = "both"};
    switch ((series_lane_t)lane) {
    case SERIES_LANE_STATE:
        return text_or_null(agv_state_name((agv_state_t)change->b));
    case SERIES_LANE_MODE:
        return (change->c == 0u) ? json_string(modes[change->a]) : json_null();
    case SERIES_LANE_OUTPUT:
        return json_string((change->a != 0u) ? "closed" : "open");
    case SERIES_LANE_LED:
        return json_integer((int8_t)change->a);
    default:
        return (change->c == 0u) ? gear_json(change->a) : json_null();
    }
}

static json_t *lanes_json(const series_t *series) {
    json_t *lanes = json_object();
    for (size_t lane = 0u; lane < (size_t)SERIES_LANE_FAULT; lane++) {
        const series_changes_t *changes = &series->lanes[lane];
        json_t *object = json_object();
        json_t *t = json_array();
        json_t *v = json_array();
        uint64_t last = 0u;
        for (size_t i = 0u; i < changes->count; i++) {
            append_time(t, &last, changes->changes[i].t_us);
            append(v, value_json(lane, &changes->changes[i]));
        }
        set(object, "t", t);
        set(object, "v", v);
        set(lanes, lane_names[lane], object);
    }
    return lanes;
}

static json_t *faults_json(const series_changes_t *faults) {
    json_t *array = json_array();
    for (size_t i = 0u; i < faults->count; i++) {
        const series_change_t *change = &faults->changes[i];
        json_t *entry = json_array();
        append(entry, units(change->t_us));
        append(entry, text_or_null(agv_fault_name((agv_fault_t)change->a)));
        append(entry, text_or_null(agv_class_name((agv_fault_class_t)change->b)));
        append(entry, json_integer((change->c != 0u) ? 1 : 0));
        append(array, entry);
    }
    return array;
}

static json_t *notes_json(const series_changes_t *notes) {
    json_t *array = json_array();
    for (size_t i = 0u; i < notes->count; i++) {
        const series_change_t *change = &notes->changes[i];
        char missing[MISSING_TEXT_SIZE];
        char text[TEXT_SIZE];
        const char *what = (change->kind != (uint8_t)AGV_EVENT_RESET) ? "still in INIT"
                           : (change->a != 0u)                        ? "reset accepted"
                                                                      : "reset refused";
        if (change->kind == (uint8_t)AGV_EVENT_CRASH) {
            what = "the run before was ended by its port";
        }
        (void)snprintf(text, sizeof text, "%s%s%s", what, (change->missing != 0u) ? ", missing: " : "",
                       missing_text(change->missing, missing));
        json_t *entry = json_array();
        append(entry, units(change->t_us));
        append(entry, json_string(text));
        append(array, entry);
    }
    return array;
}

json_t *series_json(const series_t *series) {
    json_t *object = json_object();
    uint64_t left_out = 0u;
    for (size_t lane = 0u; lane < (size_t)SERIES_LANES; lane++) {
        left_out += series->lanes[lane].left_out;
    }
    set(object, "end", units(series->end_us));
    set(object, "unit_us", number(UNIT_US));
    set(object, "messages", messages_json(series));
    set(object, "lanes", lanes_json(series));
    set(object, "faults", faults_json(&series->lanes[SERIES_LANE_FAULT]));
    set(object, "notes", notes_json(&series->lanes[SERIES_LANE_NOTE]));
    set(object, "left_out", number(left_out));
    set(object, "overview", overview_json(series));
    set(object, "details", details_json(series));
    return object;
}
