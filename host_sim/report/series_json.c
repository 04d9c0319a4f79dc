#include <stdio.h>

#include "agv/codec.h"
#include "agv/names.h"
#include "agv/recorder.h"
#include "common/json_build.h"
#include "common/missing.h"
#include "report/series.h"
#include "report/series_internal.h"
#include "report/series_lines.h"

enum { TEXT_SIZE = 256 };

static const char *const lane_names[SERIES_LANES] = {
    [SERIES_LANE_STATE] = "state",
    [SERIES_LANE_MODE] = "mode",
    [SERIES_LANE_GEAR] = "gear",
    [SERIES_LANE_GEAR_COMMAND] = "gear_command",
    [SERIES_LANE_GEAR_SENT] = "gear_sent",
    [SERIES_LANE_OUTPUT] = "output",
    [SERIES_LANE_LED] = "led",
};

static json_t *messages_json(const series_t *series) {
    static const char *const senders[] = {
        [MESSAGE_FROM_AI] = "AI computer", [MESSAGE_FROM_VCU] = "VCU", [MESSAGE_FROM_EPS] = "EPS"};
    json_t *messages = json_array();
    for (uint32_t i = 0; i < AGV_MSG_COUNT; i++) {
        const agv_message_t message = (agv_message_t)i;
        const bool is_command = i < AGV_COMMAND_COUNT;
        char id[8];
        (void)snprintf(id, sizeof id, "%03X", (unsigned)series->reader.ids.of[i]);
        json_t *object = json_object();
        json_put(object, "name", json_text(agv_message_name(message)));
        json_put(object, "id", json_string(id));
        json_put(object, "sender", json_string(senders[message_sender(i)]));
        json_put(object, "cycle", json_uint(agv_message_cycle_ms(i)));
        json_put(object, "deadline", json_uint(agv_config_get(&series->reader.config, message_deadline_setting(i))));
        json_put(object, "heartbeat", json_boolean(message_counter_at(i) != MESSAGE_NO_COUNTER));
        json_put(object, "command", json_boolean(is_command));
        json_put(object, "heard", json_boolean(series->ages.heard[i]));
        json_add(messages, object);
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
        return json_text(agv_state_name((agv_state_t)change->b));
    case SERIES_LANE_MODE:
        return (change->c == 0) ? json_string(modes[change->a]) : json_null();
    case SERIES_LANE_OUTPUT:
        return json_string((change->a != 0) ? "closed" : "open");
    case SERIES_LANE_LED:
        return json_integer((int8_t)change->a);
    default:
        return (change->c == 0) ? gear_json(change->a) : json_null();
    }
}

static json_t *lane_json(const series_changes_t *changes, size_t lane) {
    json_t *object = json_object();
    json_t *t = json_array();
    json_t *v = json_array();
    uint64_t last = 0;
    for (size_t i = 0; i < changes->count; i++) {
        series_append_time(t, &last, changes->changes[i].t_us);
        json_add(v, value_json(lane, &changes->changes[i]));
    }
    json_put(object, "t", t);
    json_put(object, "v", v);
    return object;
}

static json_t *lanes_json(const series_t *series) {
    json_t *object = json_object();
    for (size_t lane = 0; lane < SERIES_LANE_FAULT; lane++) {
        json_put(object, lane_names[lane], lane_json(&series->lanes[lane], lane));
    }
    return object;
}

static json_t *faults_json(const series_changes_t *faults) {
    json_t *array = json_array();
    for (size_t i = 0; i < faults->count; i++) {
        const series_change_t *change = &faults->changes[i];
        json_t *entry = json_array();
        json_add(entry, series_units(change->t_us));
        json_add(entry, json_text(agv_fault_name((agv_fault_t)change->a)));
        json_add(entry, json_text(agv_class_name((agv_fault_class_t)change->b)));
        json_add(entry, json_integer((change->c != 0) ? 1 : 0));
        json_add(array, entry);
    }
    return array;
}

static json_t *notes_json(const series_changes_t *notes) {
    json_t *array = json_array();
    for (size_t i = 0; i < notes->count; i++) {
        const series_change_t *change = &notes->changes[i];
        char missing[MISSING_TEXT_SIZE];
        char text[TEXT_SIZE];
        const char *what = (change->kind != AGV_EVENT_RESET) ? "still in INIT"
                           : (change->a != 0)                ? "reset accepted"
                                                             : "reset refused";
        if (change->kind == AGV_EVENT_CRASH) {
            what = "the previous run was ended by the port";
        }
        (void)snprintf(text, sizeof text, "%s%s%s", what, (change->missing != 0) ? ", missing: " : "",
                       missing_text(change->missing, missing));
        json_t *entry = json_array();
        json_add(entry, series_units(change->t_us));
        json_add(entry, json_string(text));
        json_add(array, entry);
    }
    return array;
}

json_t *series_json(const series_t *series) {
    json_t *object = json_object();
    uint64_t left_out = 0;
    for (size_t lane = 0; lane < SERIES_LANES; lane++) {
        left_out += series->lanes[lane].left_out;
    }
    json_put(object, "end", series_units(series->end_us));
    json_put(object, "unit_us", json_uint(SERIES_UNIT_US));
    json_put(object, "messages", messages_json(series));
    json_put(object, "lanes", lanes_json(series));
    json_put(object, "faults", faults_json(&series->lanes[SERIES_LANE_FAULT]));
    json_put(object, "notes", notes_json(&series->lanes[SERIES_LANE_NOTE]));
    json_put(object, "left_out", json_uint(left_out));
    json_put(object, "overview", series_overview_json(series));
    json_put(object, "details", series_details_json(series));
    return object;
}
