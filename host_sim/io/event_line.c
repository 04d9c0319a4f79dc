#include "io/event_line.h"

#include <jansson.h>
#include <string.h>

#include "agv/names.h"
#include "agv/recorder.h"
#include "agv/state.h"
#include "common/missing.h"

static const char *text_of(const json_t *object, const char *key) {
    const char *text = json_string_value(json_object_get(object, key));
    return (text != NULL) ? text : "";
}

/** The code word of a state; 0 for what is no state. */
static uint8_t state_of(const char *name) {
    for (unsigned code = 0; code <= UINT8_MAX; code++) {
        const char *state = agv_state_name((agv_state_t)code);
        if ((state != NULL) && (strcmp(state, name) == 0)) {
            return (uint8_t)code;
        }
    }
    return 0;
}

/** The bits of a list of words. */
static uint16_t bits_of(uint16_t (*bit)(const char *word), const json_t *words) {
    uint16_t bits = 0;
    for (size_t i = 0; i < json_array_size(words); i++) {
        const char *word = json_string_value(json_array_get(words, i));
        bits = (uint16_t)(bits | ((word != NULL) ? bit(word) : 0));
    }
    return bits;
}

static bool read_state(const json_t *object, agv_event_t *event) {
    *event = (agv_event_t){.kind = AGV_EVENT_STATE,
                           .a = state_of(text_of(object, "from")),
                           .b = state_of(text_of(object, "to")),
                           .c = (uint8_t)agv_fault_from_name(text_of(object, "reason"))};
    return event->b != 0;
}

static bool read_fault(const json_t *object, agv_event_t *event) {
    const bool is_trip = strcmp(text_of(object, "class"), agv_class_name(AGV_CLASS_TRIP)) == 0;
    *event = (agv_event_t){.kind = AGV_EVENT_FAULT,
                           .a = (uint8_t)agv_fault_from_name(text_of(object, "name")),
                           .b = (uint8_t)(is_trip ? AGV_CLASS_TRIP : AGV_CLASS_WARN),
                           .c = json_is_true(json_object_get(object, "active")) ? 1 : 0,
                           .missing = bits_of(part_bit, json_object_get(object, "parts"))};
    return event->a != AGV_FAULT_NONE;
}

static bool read_object(const json_t *object, session_event_t *event) {
    agv_event_t *recorded = &event->recorded;
    const char *kind = text_of(object, "event");
    if (strcmp(kind, "state") == 0) {
        return read_state(object, recorded);
    }
    if (strcmp(kind, "fault") == 0) {
        return read_fault(object, recorded);
    }
    if (strcmp(kind, "safety_output") == 0) {
        *recorded =
            (agv_event_t){.kind = AGV_EVENT_OUTPUT, .a = json_is_true(json_object_get(object, "closed")) ? 1 : 0};
    } else if (strcmp(kind, "reset") == 0) {
        *recorded = (agv_event_t){.kind = AGV_EVENT_RESET,
                                  .a = json_is_true(json_object_get(object, "accepted")) ? 1 : 0,
                                  .missing = bits_of(missing_bit, json_object_get(object, "why"))};
    } else if (strcmp(kind, "startup") == 0) {
        *recorded = (agv_event_t){.kind = AGV_EVENT_STARTUP,
                                  .missing = bits_of(missing_bit, json_object_get(object, "missing"))};
    } else if (strcmp(kind, "led") == 0) {
        event->is_led = true;
        event->led_code = (int8_t)json_integer_value(json_object_get(object, "code"));
    } else {
        return false;
    }
    return true;
}

bool event_line_read(const char *line, size_t length, session_event_t *event) {
    json_t *object = json_loadb(line, length, 0, NULL);
    *event = (session_event_t){.t_ms = 0};
    const bool is_event = (object != NULL) && read_object(object, event);
    json_decref(object);
    return is_event;
}
