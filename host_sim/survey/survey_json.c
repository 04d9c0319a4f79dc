#include <stdio.h>
#include <stdlib.h>

#include "common/json_build.h"
#include "survey/survey_result.h"
#include "text/units.h"

static json_t *load_json(const survey_result_t *result) {
    static const char *const sides[HAL_CAN_SIDES] = {"vehicle", "ai"};
    const uint64_t us = observation_us(&result->observation);
    const uint32_t bit_rate = (uint32_t)result->request->bit_rate;
    json_t *array = json_array();
    for (size_t side = 0; side < HAL_CAN_SIDES; side++) {
        const bus_load_t *load = &result->observation.loads[side];
        if (load->bits > 0) {
            json_t *object = json_object();
            json_put(object, "side", json_string(sides[side]));
            json_put(object, "bit_rate", json_uint(bit_rate));
            json_put(object, "least_pct", json_real(bus_load_percent(load->bits, us, bit_rate)));
            json_put(object, "most_pct", json_real(bus_load_percent(load->stuffed_bits, us, bit_rate)));
            json_put(object, "busiest_second_pct",
                     json_real(bus_load_percent(bus_load_busiest(load), US_PER_S, bit_rate)));
            json_add(array, object);
        }
    }
    return array;
}

static json_t *id_sets_json(const survey_result_t *result) {
    static const char *const names[] = {[AGV_ID_SET_HEADING] = "heading", [AGV_ID_SET_TABLE] = "table"};
    const uint32_t messages[2] = {AGV_MSG_TURN_SIGNAL_COMMAND, AGV_MSG_VEHICLE_STATUS};
    json_t *object = json_object();
    for (uint32_t id_set = 0; id_set < sizeof names / sizeof names[0]; id_set++) {
        uint64_t counts[2];
        observation_set_counts(&result->observation, id_set, counts);
        json_t *set_object = json_object();
        for (size_t i = 0; i < 2; i++) {
            char id[8];
            (void)snprintf(id, sizeof id, "%03X", agv_message_id(messages[i], id_set));
            json_put(set_object, id, json_uint(counts[i]));
        }
        json_put(object, names[id_set], set_object);
    }
    json_put(object, "used", json_string(names[result->config.id_set]));
    return object;
}

static json_t *interfaces_json(const observation_t *observation) {
    json_t *array = json_array();
    for (uint32_t i = 0; i < observation->interface_count; i++) {
        json_add(array, json_string(observation->interfaces[i]));
    }
    return array;
}

static json_t *unknown_json(const survey_result_t *result) {
    const double seconds = s_of_us(observation_us(&result->observation));
    json_t *array = json_array();
    for (size_t i = 0; traffic_at(result->traffic, i) != NULL; i++) {
        const traffic_id_t *entry = traffic_at(result->traffic, i);
        if (entry->message == TRAFFIC_UNKNOWN) {
            json_t *object = traffic_id_json(entry);
            json_put(object, "per_s", (seconds > 0.0) ? json_real((double)entry->count / seconds) : json_null());
            json_put(object, "length_min", json_integer((entry->count > 0) ? entry->length_min : 0));
            json_put(object, "length_max", json_integer(entry->length_max));
            json_add(array, object);
        }
    }
    return array;
}

static json_t *not_heard_json(const survey_result_t *result) {
    json_t *array = json_array();
    for (uint32_t message = 0; message < AGV_MSG_COUNT; message++) {
        const traffic_id_t *entry = traffic_message(result->traffic, message);
        if ((entry == NULL) || (entry->count == 0)) {
            json_add(array, json_string(signals_message_name(message)));
        }
    }
    return array;
}

static json_t *words_json(const candidate_t *candidate, bool is_for) {
    json_t *array = json_array();
    for (size_t i = 0; i < candidate->count; i++) {
        const verdict_t verdict = candidate->criteria[i].verdict;
        if (((verdict == VERDICT_FOR) || (verdict == VERDICT_DECIDES)) == is_for) {
            json_add(array, json_string(candidate->criteria[i].text));
        }
    }
    return array;
}

/** The messages that were not received: the identifiers that may carry them, the best one first. */
static json_t *candidates_json(const survey_result_t *result) {
    json_t *array = json_array();
    for (uint32_t message = 0; message < AGV_MSG_COUNT; message++) {
        const identify_message_t *found = &result->found.of[message];
        json_t *candidates = json_array();
        for (size_t i = 0; i < found->count; i++) {
            const candidate_t *candidate = &found->candidates[i];
            char id[8];
            (void)snprintf(id, sizeof id, "%03X", candidate->id);
            json_t *object = json_object();
            json_put(object, "id", json_string(id));
            json_put(object, "for", words_json(candidate, true));
            json_put(object, "against", words_json(candidate, false));
            json_add(candidates, object);
        }
        if (!found->is_missing) {
            json_decref(candidates);
            continue;
        }
        json_t *object = json_object();
        json_put(object, "message", json_string(signals_message_name(message)));
        json_put(object, "setting", json_string(agv_setting_info((uint16_t)(AGV_SETTING_ID + message))->name));
        json_put(object, "proposed", json_boolean(found->is_assigned));
        json_put(object, "identifiers", candidates);
        json_add(array, object);
    }
    return array;
}

bool survey_print_json(const survey_result_t *result) {
    const observation_t *observation = &result->observation;
    const traffic_totals_t totals = traffic_totals(result->traffic);
    json_t *root = json_object();
    json_put(root, "source", json_text(result->source.name));
    json_put(root, "format", (result->source.format[0] != '\0') ? json_string(result->source.format) : json_null());
    json_put(root, "interfaces", interfaces_json(observation));
    json_put(root, "more_interfaces", json_boolean(observation->more_interfaces));
    json_put(root, "first_us", json_uint(observation->first_us));
    json_put(root, "duration_ms", json_real(ms_of_us(observation_us(observation))));
    json_put(root, "frames", json_uint(observation->frames));
    json_put(root, "error_frames", json_uint(totals.error));
    json_put(root, "lost_frames", json_uint(observation->lost));
    json_put(root, "skipped_lines", json_uint(result->source.skipped_lines));
    json_put(root, "backward_stamps", json_uint(observation->backward_stamps));
    json_put(root, "engaged_ms", json_real(ms_of_us(totals.engaged_us)));
    json_put(root, "engagements", json_uint(totals.engagements));
    json_put(root, "load", load_json(result));
    json_put(root, "id_sets", id_sets_json(result));
    json_put(root, "messages", traffic_messages_json(result->traffic));
    json_put(root, "not_heard", not_heard_json(result));
    json_put(root, "unknown", unknown_json(result));
    json_put(root, "candidates", candidates_json(result));
    json_put(root, "proposal", proposal_json(&result->proposal));
    char *text = json_dumps(root, JSON_INDENT(2) | JSON_REAL_PRECISION(15));
    json_decref(root);
    if (text == NULL) {
        return report("out of memory");
    }
    (void)printf("%s\n", text);
    free(text);
    return true;
}
