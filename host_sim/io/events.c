#include "io/events.h"

#include <inttypes.h>
#include <jansson.h>
#include <stdio.h>
#include <string.h>

#include "agv/names.h"
#include "agv/recorder.h"
#include "common/crash.h"
#include "common/json_build.h"
#include "io/output_json.h"

/** The words of all bits that are set. @param name word of a bit; NULL: there are no further bits */
static json_t *words_of(const char *(*name)(uint8_t bit), uint16_t bits) {
    json_t *words = json_array();
    for (uint8_t bit = 0; name(bit) != NULL; bit++) {
        if ((bits & (1u << bit)) != 0) {
            json_add(words, json_text(name(bit)));
        }
    }
    return words;
}

static json_t *start(uint64_t t_ms, const char *name) {
    json_t *object = json_object();
    json_put(object, "t_ms", json_integer((json_int_t)t_ms));
    json_put(object, "event", json_string(name));
    return object;
}

static void add_state(json_t *object, const agv_event_t *event) {
    json_put(object, "from", json_text(agv_state_name((agv_state_t)event->a)));
    json_put(object, "to", json_text(agv_state_name((agv_state_t)event->b)));
    json_put(object, "reason", json_text(agv_fault_name((agv_fault_t)event->c)));
}

static void add_fault(json_t *object, const agv_event_t *event) {
    json_put(object, "name", json_text(agv_fault_name((agv_fault_t)event->a)));
    json_put(object, "class", json_text(agv_class_name((agv_fault_class_t)event->b)));
    json_put(object, "active", json_boolean(event->c != 0));
    if (event->a == AGV_FAULT_SELF_TEST_FAILED) {
        json_put(object, "parts", words_of(agv_self_test_part_name, event->missing));
    }
}

static json_t *address(uint32_t value) {
    char digits[9];
    (void)snprintf(digits, sizeof digits, "%08" PRIx32, value);
    return json_string(digits);
}

static void add_crash(json_t *object, const agv_event_t *event) {
    const crash_addresses_t addresses = crash_addresses(event);
    json_put(object, "cause", json_text(agv_reset_cause_name(event->a)));
    json_put(object, "end", json_text(agv_end_name(event->b)));
    json_put(object, "pc", address(addresses.pc));
    json_put(object, "lr", address(addresses.lr));
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
        json_put(object, "closed", json_boolean(event->a != 0));
        break;
    case AGV_EVENT_RESET:
        object = start(t_ms, "reset");
        json_put(object, "accepted", json_boolean(event->a != 0));
        json_put(object, "why", words_of(agv_missing_name, event->missing));
        break;
    case AGV_EVENT_STARTUP:
        object = start(t_ms, "startup");
        json_put(object, "missing", words_of(agv_missing_name, event->missing));
        break;
    case AGV_EVENT_CRASH:
        object = start(t_ms, "crash");
        add_crash(object, event);
        break;
    default:
        return;
    }
    output_json(output, object, 0);
}

void events_write(void *ctx, const session_event_t *event) {
    output_t *output = ctx;
    if (event->is_led) {
        json_t *object = start(event->t_ms, "led");
        json_put(object, "code", json_integer(event->led_code));
        output_json(output, object, 0);
    } else {
        write_recorded(output, event->t_ms, &event->recorded);
    }
}

void events_summarise(const session_t *session, events_summary_t *summary) {
    (void)memset(summary, 0, sizeof *summary);
    summary->t_ms = session->t_ms;
    summary->supervised_ms = session->supervised_ms;
    summary->counters = session_counters(session);
    summary->final_state = agv_supervisor_state(&session->supervisor);
    summary->first_reason = agv_supervisor_first_reason(&session->supervisor);
}

void events_write_summary(output_t *output, const events_summary_t *summary) {
    const agv_counters_t *counters = &summary->counters;
    json_t *rejected = json_object();
    json_put(rejected, "length", json_uint(counters->rejected[AGV_REJECTED_LENGTH]));
    json_put(rejected, "extended", json_uint(counters->rejected[AGV_REJECTED_EXTENDED]));
    json_put(rejected, "remote", json_uint(counters->rejected[AGV_REJECTED_REMOTE]));
    json_put(rejected, "fd", json_uint(counters->rejected[AGV_REJECTED_FD]));
    json_put(rejected, "error", json_uint(counters->rejected[AGV_REJECTED_ERROR]));
    json_t *object = start(summary->t_ms, "summary");
    json_put(object, "received", json_uint(counters->received));
    json_put(object, "rejected", rejected);
    json_put(object, "dropped", json_uint(counters->dropped));
    json_put(object, "sent", json_uint(counters->sent));
    json_put(object, "shadowed", json_uint(counters->shadowed));
    json_put(object, "limited", json_uint(counters->limited));
    json_put(object, "warnings", json_uint(counters->warnings));
    json_put(object, "supervised_ms", json_uint(summary->supervised_ms));
    json_put(object, "skipped_lines", json_uint(summary->skipped_lines));
    json_put(object, "backward_stamps", json_uint(summary->backward_stamps));
    json_put(object, "final_state", json_text(agv_state_name(summary->final_state)));
    json_put(object, "first_reason", json_text(agv_fault_name(summary->first_reason)));
    output_json(output, object, 0);
}
