#include "io/events.h"

#include <errno.h>
#include <inttypes.h>
#include <jansson.h>
#include <stdio.h>
#include <string.h>

#include "agv/names.h"
#include "agv/recorder.h"
#include "common/crash.h"

/** Write an object as a line. Takes the reference. */
static void write_line(output_t *output, json_t *object) {
    char *text = json_dumps(object, 0);
    json_decref(object);
    if (text == NULL) {
        output->error = (output->error == 0) ? ENOMEM : output->error;
        return;
    }
    size_t length = strlen(text);
    text[length] = '\n'; /* in the place of the terminating zero */
    (void)output_write(output, text, length + 1u);
    free(text);
}

static json_t *text_or_null(const char *text) {
    return (text != NULL) ? json_string(text) : json_null();
}

/** The words of all bits that are set. @param name word of a bit; NULL: there are no further bits */
static json_t *words_of(const char *(*name)(uint8_t bit), uint16_t bits) {
    json_t *words = json_array();
    for (uint8_t bit = 0u; name(bit) != NULL; bit++) {
        if ((bits & (1u << bit)) != 0u) {
            (void)json_array_append_new(words, text_or_null(name(bit)));
        }
    }
    return words;
}

static void set(json_t *object, const char *key, json_t *value) {
    /* A value that could not be made is missing from the object, which then is no object that a reader takes. */
    (void)json_object_set_new(object, key, value);
}

static json_t *start(uint64_t t_ms, const char *name) {
    json_t *object = json_object();
    set(object, "t_ms", json_integer((json_int_t)t_ms));
    set(object, "event", json_string(name));
    return object;
}

static void add_state(json_t *object, const agv_event_t *event) {
    set(object, "from", text_or_null(agv_state_name((agv_state_t)event->a)));
    set(object, "to", text_or_null(agv_state_name((agv_state_t)event->b)));
    set(object, "reason", text_or_null(agv_fault_name((agv_fault_t)event->c)));
}

static void add_fault(json_t *object, const agv_event_t *event) {
    set(object, "name", text_or_null(agv_fault_name((agv_fault_t)event->a)));
    set(object, "class", text_or_null(agv_class_name((agv_fault_class_t)event->b)));
    set(object, "active", json_boolean(event->c != 0u));
    if (event->a == (uint8_t)AGV_FAULT_SELF_TEST_FAILED) {
        set(object, "parts", words_of(agv_self_test_part_name, event->missing));
    }
}

static json_t *address(uint32_t value) {
    char digits[9];
    (void)snprintf(digits, sizeof digits, "%08" PRIx32, value);
    return json_string(digits);
}

static void add_crash(json_t *object, const agv_event_t *event) {
    const crash_addresses_t addresses = crash_addresses(event);
    set(object, "cause", text_or_null(agv_reset_cause_name(event->a)));
    set(object, "end", text_or_null(agv_end_name(event->b)));
    set(object, "pc", address(addresses.pc));
    set(object, "lr", address(addresses.lr));
}

static void write_recorded(output_t *output, uint64_t t_ms, const agv_event_t *event) {
    json_t *object = NULL;
    switch ((agv_event_kind_t)event->kind) {
    case AGV_EVENT_STATE:
        object = start(t_ms, "state");
        add_state(object, event);
        break;
    case AGV_EVENT_FAULT:
        object = start(t_ms, "fault");
        add_fault(object, event);
        break;
    case AGV_EVENT_OUTPUT:
        object = start(t_ms, "safety_output");
        set(object, "closed", json_boolean(event->a != 0u));
        break;
    case AGV_EVENT_RESET:
        object = start(t_ms, "reset");
        set(object, "accepted", json_boolean(event->a != 0u));
        set(object, "why", words_of(agv_missing_name, event->missing));
        break;
    case AGV_EVENT_STARTUP:
        object = start(t_ms, "startup");
        set(object, "missing", words_of(agv_missing_name, event->missing));
        break;
    case AGV_EVENT_CRASH:
        object = start(t_ms, "crash");
        add_crash(object, event);
        break;
    default:
        return;
    }
    write_line(output, object);
}

void events_write(void *ctx, const session_event_t *event) {
    output_t *output = ctx;
    if (event->is_led) {
        json_t *object = start(event->t_ms, "led");
        set(object, "code", json_integer(event->led_code));
        write_line(output, object);
    } else {
        write_recorded(output, event->t_ms, &event->recorded);
    }
}

void events_summarise(const session_t *session, events_summary_t *summary) {
    (void)memset(summary, 0, sizeof *summary);
    summary->t_ms = session->t_ms;
    summary->supervised_ms = session->supervised_ms;
    summary->counters = *agv_supervisor_counters(&session->supervisor);
    summary->final_state = agv_supervisor_state(&session->supervisor);
    summary->first_reason = agv_supervisor_first_reason(&session->supervisor);
}

static json_t *number(uint64_t value) {
    return json_integer((json_int_t)value);
}

void events_write_summary(output_t *output, const events_summary_t *summary) {
    const agv_counters_t *counters = &summary->counters;
    json_t *rejected = json_object();
    set(rejected, "length", number(counters->rejected[AGV_REJECTED_LENGTH]));
    set(rejected, "extended", number(counters->rejected[AGV_REJECTED_EXTENDED]));
    set(rejected, "remote", number(counters->rejected[AGV_REJECTED_REMOTE]));
    set(rejected, "fd", number(counters->rejected[AGV_REJECTED_FD]));
    set(rejected, "error", number(counters->rejected[AGV_REJECTED_ERROR]));
    json_t *object = start(summary->t_ms, "summary");
    set(object, "received", number(counters->received));
    set(object, "rejected", rejected);
    set(object, "dropped", number(counters->dropped));
    set(object, "sent", number(counters->sent));
    set(object, "shadowed", number(counters->shadowed));
    set(object, "limited", number(counters->limited));
    set(object, "warnings", number(counters->warnings));
    set(object, "supervised_ms", number(summary->supervised_ms));
    set(object, "skipped_lines", number(summary->skipped_lines));
    set(object, "backward_stamps", number(summary->backward_stamps));
    set(object, "final_state", text_or_null(agv_state_name(summary->final_state)));
    set(object, "first_reason", text_or_null(agv_fault_name(summary->first_reason)));
    write_line(output, object);
}
