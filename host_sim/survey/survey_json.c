#include <stdio.h>
#include <stdlib.h>

#include "common/units.h"
#include "survey/survey_result.h"

static void set(json_t *object, const char *key, json_t *value) {
    (void)json_object_set_new(object, key, value);
}

static json_t *integer(uint64_t value) {
    return json_integer((json_int_t)value);
}

static json_t *load_json(const survey_result_t *result) {
    static const char *const sides[HAL_CAN_SIDES] = {"vehicle", "ai"};
    const uint64_t us = observation_us(&result->observation);
    const uint32_t bit_rate = (uint32_t)result->request->bit_rate;
    json_t *array = json_array();
    for (size_t side = 0u; side < (size_t)HAL_CAN_SIDES; side++) {
        const bus_load_t *load = &result->observation.loads[side];
        if (load->bits > 0u) {
            json_t *object = json_object();
            set(object, "side", json_string(sides[side]));
            set(object, "bit_rate", integer(bit_rate));
            set(object, "least_pct", json_real(bus_load_percent(load->bits, us, bit_rate)));
            set(object, "most_pct", json_real(bus_load_percent(load->stuffed_bits, us, bit_rate)));
            set(object, "busiest_second_pct", json_real(bus_load_percent(bus_load_busiest(load), US_PER_S, bit_rate)));
            (void)json_array_append_new(array, object);
        }
    }
    return array;
}

static json_t *id_sets_json(const survey_result_t *result) {
    static const char *const names[] = {[AGV_ID_SET_HEADING] = "heading", [AGV_ID_SET_TABLE] = "table"};
    const uint32_t messages[2] = {AGV_MSG_TURN_SIGNAL_COMMAND, AGV_MSG_VEHICLE_STATUS};
    json_t *object = json_object();
    for (uint32_t id_set = 0u; id_set < sizeof names / sizeof names[0]; id_set++) {
        uint64_t counts[2];
        observation_set_counts(&result->observation, id_set, counts);
        json_t *set_object = json_object();
        for (size_t i = 0u; i < 2u; i++) {
            char id[8];
            (void)snprintf(id, sizeof id, "%03X", agv_message_id(messages[i], id_set));
            set(set_object, id, integer(counts[i]));
        }
        set(object, names[id_set], set_object);
    }
    set(object, "used", json_string(names[result->config.id_set]));
    return object;
}

static json_t *interfaces_json(const observation_t *observation) {
    json_t *array = json_array();
    for (uint32_t i = 0u; i < observation->interface_count; i++) {
        (void)json_array_append_new(array, json_string(observation->interfaces[i]));
    }
    return array;
}

static json_t *unknown_json(const survey_result_t *result) {
    const double seconds = (double)observation_us(&result->observation) / (double)US_PER_S;
    json_t *array = json_array();
    for (size_t i = 0u; traffic_at(result->traffic, i) != NULL; i++) {
        const traffic_id_t *entry = traffic_at(result->traffic, i);
        if (entry->message == TRAFFIC_UNKNOWN) {
            json_t *object = traffic_id_json(entry);
            set(object, "per_s", (seconds > 0.0) ? json_real((double)entry->count / seconds) : json_null());
            set(object, "length_min", json_integer((entry->count > 0u) ? entry->length_min : 0));
            set(object, "length_max", json_integer(entry->length_max));
            (void)json_array_append_new(array, object);
        }
    }
    return array;
}

static json_t *not_heard_json(const survey_result_t *result) {
    json_t *array = json_array();
    for (uint32_t message = 0u; message < (uint32_t)AGV_MSG_COUNT; message++) {
        const traffic_id_t *entry = traffic_message(result->traffic, message);
        if ((entry == NULL) || (entry->count == 0u)) {
            (void)json_array_append_new(array, json_string(signals_message_name(message)));
        }
    }
    return array;
}

bool survey_print_json(const survey_result_t *result) {
    const observation_t *observation = &result->observation;
    const traffic_totals_t totals = traffic_totals(result->traffic);
    json_t *root = json_object();
    set(root, "source", json_string(result->source.name));
    set(root, "format", (result->source.format[0] != '\0') ? json_string(result->source.format) : json_null());
    set(root, "interfaces", interfaces_json(observation));
    set(root, "first_us", integer(observation->first_us));
    set(root, "duration_ms", json_real((double)observation_us(observation) / (double)US_PER_MS));
    set(root, "frames", integer(observation->frames));
    set(root, "error_frames", integer(totals.error));
    set(root, "lost_frames", integer(observation->lost));
    set(root, "skipped_lines", integer(result->source.skipped_lines));
    set(root, "backward_stamps", integer(observation->backward_stamps));
    set(root, "engaged_ms", json_real((double)totals.engaged_us / (double)US_PER_MS));
    set(root, "engagements", integer(totals.engagements));
    set(root, "load", load_json(result));
    set(root, "id_sets", id_sets_json(result));
    set(root, "messages", traffic_messages_json(result->traffic));
    set(root, "not_heard", not_heard_json(result));
    set(root, "unknown", unknown_json(result));
    set(root, "proposal", proposal_json(&result->proposal));
    char *text = json_dumps(root, JSON_INDENT(2) | JSON_REAL_PRECISION(15));
    json_decref(root);
    if (text == NULL) {
        return report("out of memory");
    }
    (void)printf("%s\n", text);
    free(text);
    return true;
}
