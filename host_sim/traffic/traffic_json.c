#include <stdio.h>

#include "common/json_build.h"
#include "text/units.h"
#include "traffic/traffic.h"

enum { MEDIAN = 500, P999 = 999, WORD_BITS = 32, CHOICES = 256 };

/** A time in milliseconds with three decimals. */
static json_t *ms_of(uint64_t us) {
    return json_real(ms_of_us(us));
}

static json_t *gaps_json(const gaps_t *gaps) {
    if (gaps->count == 0) {
        return json_null();
    }
    json_t *object = json_object();
    json_put(object, "min", ms_of(gaps->shortest_us));
    json_put(object, "median", ms_of(gaps_quantile_us(gaps, MEDIAN)));
    json_put(object, "p99_9", ms_of(gaps_quantile_us(gaps, P999)));
    json_put(object, "max", ms_of(gaps->longest_us));
    json_put(object, "max_at_ms", ms_of(gaps->longest_at_us));
    return object;
}

static json_t *counter_json(const counter_use_t *use) {
    if (use == NULL) {
        return json_null();
    }
    json_t *object = json_object();
    json_put(object, "counts", json_string(counter_use_word(counter_use_kind(use))));
    json_put(object, "steps", json_integer((json_int_t)use->steps));
    json_put(object, "other_steps", json_integer((json_int_t)use->other_steps));
    json_put(object, "repeats", json_integer((json_int_t)use->repeats));
    json_put(object, "longest_without_change_ms", ms_of(use->longest_us));
    return object;
}

/** The words and invalid values of a choice that were seen. */
static json_t *words_json(uint32_t message, size_t index, const traffic_range_t *range) {
    json_t *words = json_array();
    for (uint32_t raw = 0; raw < CHOICES; raw++) {
        if (((range->words[raw / WORD_BITS] >> (raw % WORD_BITS)) & 1) != 0) {
            char text[SIGNALS_VALUE_SIZE];
            signals_raw_text(text, message, index, raw);
            json_add(words, json_string(text));
        }
    }
    return words;
}

static json_t *range_json(uint32_t message, size_t index, const traffic_range_t *range) {
    const signal_info_t *info = signals_info(message, index);
    json_t *object = json_object();
    json_put(object, "name", json_string(info->name));
    json_put(object, "unit", json_string(info->unit));
    if ((info->kind == SIGNAL_CHOICE) || (info->kind == SIGNAL_FLAG)) {
        json_put(object, "seen", words_json(message, index, range));
    } else if (range->valid > 0) {
        const signal_value_t lowest = {.scaled = range->lowest};
        const signal_value_t highest = {.scaled = range->highest};
        json_put(object, "min", json_real(signals_number(info, &lowest)));
        json_put(object, "max", json_real(signals_number(info, &highest)));
    }
    json_put(object, "invalid", json_integer((json_int_t)range->invalid));
    return object;
}

static json_t *alarm_json(const signal_info_t *info, const traffic_range_t *range) {
    json_t *object = json_object();
    json_put(object, "name", json_string(info->name));
    json_put(object, "first_ms", ms_of(range->set_at_us));
    json_put(object, "frames", json_integer((json_int_t)range->set));
    return object;
}

static void add_signals(json_t *object, const traffic_id_t *entry) {
    json_t *values = json_array();
    json_t *alarms = json_array();
    for (size_t i = 0; i < signals_count(entry->message); i++) {
        const signal_info_t *info = signals_info(entry->message, i);
        if (info->kind != SIGNAL_ALARM) {
            json_add(values, range_json(entry->message, i, &entry->ranges[i]));
        } else if (entry->ranges[i].set > 0) {
            json_add(alarms, alarm_json(info, &entry->ranges[i]));
        }
    }
    json_put(object, "values", values);
    json_put(object, "alarms", alarms);
}

static void add_deadline(json_t *object, const traffic_watch_t *watch) {
    if (watch == NULL) {
        json_put(object, "deadline_ms", json_null());
        json_put(object, "margin_ms", json_null());
        return;
    }
    const double deadline_ms = (double)watch->deadline_ms;
    json_put(object, "deadline_ms", json_integer((json_int_t)watch->deadline_ms));
    json_put(object, "deadline_setting", json_string(agv_setting_info(watch->setting)->name));
    json_put(object, "deadline_counts", json_string((watch->when == TRAFFIC_ENGAGED) ? "engaged" : "always"));
    json_put(object, "deadline_gap_ms", gaps_json(&watch->gaps));
    json_put(object, "margin_ms",
             (watch->gaps.count > 0) ? json_real(deadline_ms - ms_of_us(watch->gaps.longest_us)) : json_null());
    json_put(object, "late", json_integer((json_int_t)watch->late));
    json_put(object, "first_late_ms", (watch->late > 0) ? ms_of(watch->late_at_us) : json_null());
}

json_t *traffic_id_json(const traffic_id_t *entry) {
    char id[12];
    json_t *object = json_object();
    (void)snprintf(id, sizeof id, entry->is_extended ? "%08X" : "%03X", entry->id);
    json_put(object, "id", json_string(id));
    json_put(object, "side", json_string((entry->side == HAL_CAN_AI) ? "ai" : "vehicle"));
    const bool is_known = entry->message != TRAFFIC_UNKNOWN;
    json_put(object, "name", is_known ? json_string(signals_message_name(entry->message)) : json_null());
    json_put(object, "count", json_integer((json_int_t)entry->count));
    json_put(object, "malformed", json_integer((json_int_t)entry->malformed));
    json_put(object, "first_ms", ms_of(entry->first_us));
    json_put(object, "last_ms", ms_of(entry->last_us));
    json_put(object, "gap_ms", gaps_json(&entry->gaps));
    if (is_known) {
        add_deadline(object, entry->watch);
        json_put(object, "counter", counter_json(entry->counter));
        add_signals(object, entry);
    }
    return object;
}

json_t *traffic_messages_json(const traffic_t *traffic) {
    json_t *array = json_array();
    for (size_t i = 0; traffic_at(traffic, i) != NULL; i++) {
        const traffic_id_t *entry = traffic_at(traffic, i);
        if (entry->message != TRAFFIC_UNKNOWN) {
            json_add(array, traffic_id_json(entry));
        }
    }
    return array;
}
