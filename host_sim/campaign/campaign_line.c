/* Reads the lines of a campaign's results. Every key must be there, no other key, and each value in its range. */
#include "campaign/campaign_line.h"

#include <string.h>

#include "agv/names.h"
#include "cli/random_options.h"
#include "common/report.h"

typedef bool fits_fn(const json_t *value);

/** A key that has to be there. */
typedef struct {
    const char *name;
    fits_fn *fits; /**< of NULL: false */
} key_line_t;

static bool is_within(const json_t *value, json_int_t lowest, json_int_t highest) {
    return json_is_integer(value) && (json_integer_value(value) >= lowest) && (json_integer_value(value) <= highest);
}

static bool is_format(const json_t *value) {
    return is_within(value, 1, 1);
}

static bool is_count(const json_t *value) {
    return is_within(value, 1, INT64_MAX);
}

static bool is_not_negative(const json_t *value) {
    return is_within(value, 0, INT64_MAX);
}

static bool is_shard(const json_t *value) {
    return is_within(value, 1, (json_int_t)SHARDS_MAX);
}

static bool is_figure(const json_t *value) {
    return is_within(value, 0, INT32_MAX);
}

static bool is_time(const json_t *value) {
    return is_figure(value) || json_is_null(value);
}

static bool is_flag(const json_t *value) {
    return json_is_boolean(value);
}

static bool is_text(const json_t *value, const char *text) {
    return json_is_string(value) && (strcmp(json_string_value(value), text) == 0);
}

static bool is_version(const json_t *value) {
    return is_text(value, HOST_SIM_VERSION);
}

static bool is_topology(const json_t *value) {
    return is_text(value, "shared") || is_text(value, "gateway");
}

static bool is_id_set(const json_t *value) {
    return is_text(value, "heading") || is_text(value, "table");
}

static bool is_park(const json_t *value) {
    return is_text(value, "at_once") || is_text(value, "at_standstill");
}

static bool is_mode(const json_t *value) {
    return is_text(value, "autopilot") || is_text(value, "manual");
}

static const campaign_row_t *row_of(const json_t *value) {
    return json_is_string(value) ? campaign_row(agv_fault_from_name(json_string_value(value))) : NULL;
}

static bool is_caused(const json_t *value) {
    return row_of(value) != NULL;
}

static bool is_caused_or_null(const json_t *value) {
    return is_caused(value) || json_is_null(value);
}

static bool is_reason(const json_t *value) {
    return json_is_null(value) ||
           (json_is_string(value) && (agv_fault_from_name(json_string_value(value)) != AGV_FAULT_NONE));
}

static bool is_null(const json_t *value) {
    return json_is_null(value);
}

static bool is_break(const json_t *value) {
    bool known = json_is_null(value);
    for (int broken = (int)CAMPAIGN_SOUND + 1; broken < CAMPAIGN_BREAKS; broken++) {
        known = known || is_text(value, campaign_break_name((campaign_break_t)broken));
    }
    return known;
}

/** @return NULL: no error; else what is wrong, for a message */
static const char *find_error(const json_t *object, const key_line_t *keys, size_t count) {
    for (size_t i = 0; i < count; i++) {
        if (!keys[i].fits(json_object_get(object, keys[i].name))) {
            return keys[i].name;
        }
    }
    return (json_object_size(object) == count) ? NULL : "number of keys";
}

static int64_t number(const json_t *object, const char *key) {
    return (int64_t)json_integer_value(json_object_get(object, key));
}

bool campaign_line_part(const char *path, size_t line, const json_t *object, campaign_part_t *part) {
    static const key_line_t keys[] = {{"campaign", is_format},      {"version", is_version},    {"runs", is_count},
                                      {"seed", is_not_negative},    {"shard", is_shard},        {"shards", is_shard},
                                      {"fault", is_caused_or_null}, {"newly_engaged", is_flag}, {"planted", is_null}};
    const char *wrong = find_error(object, keys, sizeof keys / sizeof keys[0]);
    if (wrong == NULL) {
        *part = (campaign_part_t){.runs = (uint64_t)number(object, "runs"),
                                  .seed = (uint64_t)number(object, "seed"),
                                  .shard = (uint32_t)number(object, "shard"),
                                  .shards = (uint32_t)number(object, "shards"),
                                  .causes = {.only = row_of(json_object_get(object, "fault")),
                                             .newly_engaged = json_is_true(json_object_get(object, "newly_engaged"))}};
        wrong = (part->shard > part->shards) ? "shard" : NULL;
    }
    return (wrong == NULL) ||
           report_at(path, line,
                     "no results of a campaign of host_sim " HOST_SIM_VERSION ": its '%s' is missing or wrong", wrong);
}

static int32_t time_of(const json_t *object, const char *key) {
    const json_t *value = json_object_get(object, key);
    return json_is_null(value) ? CAMPAIGN_NO_TIME : (int32_t)json_integer_value(value);
}

bool campaign_line_run(const char *path, size_t line, const json_t *object, uint64_t *run, campaign_sample_t *sample) {
    static const key_line_t keys[] = {
        {"run", is_not_negative}, {"fault", is_caused},         {"topology", is_topology}, {"id_set", is_id_set},
        {"bitrate", is_figure},   {"park_guard", is_flag},      {"park", is_park},         {"mode", is_mode},
        {"bunched", is_flag},     {"tick_phase_us", is_figure}, {"cause_ms", is_figure},   {"bound_us", is_figure},
        {"safe_us", is_time},     {"confirmed_us", is_time},    {"opened_us", is_time},    {"bus_off", is_flag},
        {"reason", is_reason},    {"broken", is_break}};
    const char *wrong = find_error(object, keys, sizeof keys / sizeof keys[0]);
    if (wrong != NULL) {
        return report_at(path, line, "not a result of a campaign: its '%s' is missing or wrong", wrong);
    }
    *run = (uint64_t)number(object, "run");
    *sample = (campaign_sample_t){.row = (uint8_t)(row_of(json_object_get(object, "fault")) - CAMPAIGN_ROWS),
                                  .broken = json_is_string(json_object_get(object, "broken")),
                                  .safe_us = time_of(object, "safe_us"),
                                  .confirmed_us = time_of(object, "confirmed_us"),
                                  .opened_us = time_of(object, "opened_us")};
    return true;
}
