/*
 * What a page shows without a run. An object:
 *
 * version   "2.1.0"
 * faults    by rank: name, phrase (completes "The vehicle stands because ..."), class, led (its code), fixed, unresettable
 * settings  name, preset, lowest, highest, unit, words ("a|b", null for a number), meaning, weakens, gateway_only
 * messages  name, sender, command (whether the AI computer commands by it)
 * actions   of steps: actor ("node": VCU, EPS, AI computer), word, needs, takes (names of parameters)
 * fields    that `set` can hold: actor, name
 */
#include <stdlib.h>

#include "agv/config.h"
#include "agv/faults.h"
#include "agv/names.h"
#include "common/json_build.h"
#include "report/sentence.h"
#include "scenario/scenario_actions.h"
#include "vehicle/vehicle.h"
#include "web_sim.h"

static json_t *faults(void) {
    json_t *list = json_array();
    for (uint32_t i = 0u; i < (uint32_t)AGV_FAULT_COUNT; i++) {
        json_t *object = json_object();
        json_put(object, "name", json_text(agv_fault_name((agv_fault_t)i)));
        json_put(object, "phrase", json_text(sentence_phrase((agv_fault_t)i)));
        json_put(object, "class", json_text(agv_class_name(agv_fault_default_class(i))));
        json_put(object, "led", json_integer(agv_fault_led_code(i)));
        json_put(object, "fixed", json_boolean((agv_fault_flags(i) & AGV_FAULT_FLAG_FIXED) != 0u));
        json_put(object, "unresettable", json_boolean((agv_fault_flags(i) & AGV_FAULT_FLAG_UNRESETTABLE) != 0u));
        json_add(list, object);
    }
    return list;
}

static json_t *settings(void) {
    json_t *list = json_array();
    for (uint16_t i = 0u; i < (uint16_t)AGV_SETTING_COUNT; i++) {
        const agv_setting_info_t *info = agv_setting_info(i);
        json_t *object = json_object();
        json_put(object, "name", json_text(info->name));
        json_put(object, "preset", json_integer(info->preset));
        json_put(object, "lowest", json_integer(info->lowest));
        json_put(object, "highest", json_integer(info->highest));
        json_put(object, "unit", json_text(info->unit));
        json_put(object, "words", json_text(info->words));
        json_put(object, "meaning", json_text(info->meaning));
        json_put(object, "weakens", json_text(info->weakens));
        json_put(object, "gateway_only", json_boolean(info->gateway_only));
        json_add(list, object);
    }
    return list;
}

static json_t *messages(void) {
    static const char *const senders[VEHICLE_NODES] = {"vcu", "eps", "ai"};
    json_t *list = json_array();
    for (int m = 0; m < (int)AGV_MSG_COUNT; m++) {
        json_t *object = json_object();
        json_put(object, "name", json_text(agv_message_name((agv_message_t)m)));
        json_put(object, "sender", json_text(senders[vehicle_sender_of((agv_message_t)m)]));
        json_put(object, "command", json_boolean(m < (int)AGV_COMMAND_COUNT));
        json_add(list, object);
    }
    return list;
}

static json_t *parameters(uint32_t bits) {
    json_t *list = json_array();
    for (unsigned i = 0u; i < SCENARIO_PARAMETERS; i++) {
        if ((bits & (1u << i)) != 0u) {
            json_add(list, json_text(SCENARIO_PARAMETER_ROWS[i].name));
        }
    }
    return list;
}

static const char *actor_name(scenario_actor_t actor) {
    return (actor == ACTOR_NONE) ? "node" : SCENARIO_ACTORS[actor].word;
}

static json_t *actions(void) {
    json_t *list = json_array();
    size_t number = 0u;
    for (const scenario_action_row_t *row = scenario_action(number); row != NULL; row = scenario_action(number)) {
        json_t *object = json_object();
        json_put(object, "actor", json_text(actor_name(row->actor)));
        json_put(object, "word", json_text(row->word));
        json_put(object, "needs", parameters(row->needs));
        json_put(object, "takes", parameters(row->takes));
        json_add(list, object);
        number++;
    }
    return list;
}

static json_t *fields(void) {
    json_t *list = json_array();
    size_t number = 0u;
    for (const scenario_field_row_t *row = scenario_field(number); row != NULL; row = scenario_field(number)) {
        json_t *object = json_object();
        json_put(object, "actor", json_text(actor_name(row->actor)));
        json_put(object, "name", json_text(row->name));
        json_add(list, object);
        number++;
    }
    return list;
}

const char *web_lists(void) {
    static char *text;
    json_t *object = json_object();
    json_put(object, "version", json_text(HOST_SIM_VERSION));
    json_put(object, "faults", faults());
    json_put(object, "settings", settings());
    json_put(object, "messages", messages());
    json_put(object, "actions", actions());
    json_put(object, "fields", fields());
    free(text);
    text = json_dumps(object, JSON_COMPACT);
    json_decref(object);
    return text;
}
