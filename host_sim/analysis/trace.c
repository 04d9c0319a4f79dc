#include "analysis/trace.h"

#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>

#include "agv/names.h"
#include "agv/recorder.h"
#include "text/units.h"
#include "traffic/signals.h"

enum { LINE_SIZE = 1024, DATA_SIZE = 24 };

/** Processes and threads of the trace: the rows that it is shown in. */
enum { SUPERVISOR = 1, RECEIVED = 2, SENT = 3 };
enum { STATE_ROW = 1, OUTPUT_ROW = 2, OTHER_ROW = 99 };

/** Write an event: an object of the array. */
static void put(trace_t *trace, const char *format, ...) __attribute__((format(printf, 2, 3)));

static void put(trace_t *trace, const char *format, ...) {
    char line[LINE_SIZE];
    va_list arguments;
    va_start(arguments, format);
    const int length = vsnprintf(line, sizeof line, format, arguments);
    va_end(arguments);
    if ((length > 0) && (length < (int)sizeof line)) {
        (void)output_write(trace->output, trace->has_events ? ",\n" : "\n", trace->has_events ? 2 : 1);
        (void)output_write(trace->output, line, (size_t)length);
        trace->has_events = true;
    }
}

static void name_process(trace_t *trace, int process, const char *name) {
    put(trace, "{\"ph\":\"M\",\"name\":\"process_name\",\"pid\":%d,\"args\":{\"name\":\"%s\"}}", process, name);
}

static void name_row(trace_t *trace, int process, int row, const char *name) {
    put(trace, "{\"ph\":\"M\",\"name\":\"thread_name\",\"pid\":%d,\"tid\":%d,\"args\":{\"name\":\"%s\"}}", process, row,
        name);
    put(trace, "{\"ph\":\"M\",\"name\":\"thread_sort_index\",\"pid\":%d,\"tid\":%d,\"args\":{\"sort_index\":%d}}",
        process, row, row);
}

void trace_begin(trace_t *trace, output_t *output, const agv_config_t *config) {
    static const char head[] = "{\"displayTimeUnit\":\"ms\",\"traceEvents\":[";
    *trace = (trace_t){.output = output, .status_frame_id = config->status_frame_id};
    agv_config_ids(config, &trace->ids);
    (void)output_write(output, head, sizeof head - 1);
    name_process(trace, SUPERVISOR, "supervisor");
    name_row(trace, SUPERVISOR, STATE_ROW, "state");
    name_row(trace, SUPERVISOR, OUTPUT_ROW, "safety output");
    name_process(trace, RECEIVED, "received");
    name_process(trace, SENT, "sent by the supervisor");
    for (int process = RECEIVED; process <= SENT; process++) {
        for (uint32_t m = 0; m < SIGNALS_MESSAGES; m++) {
            name_row(trace, process, (int)m + 1, signals_message_name(m));
        }
        name_row(trace, process, OTHER_ROW, "other identifiers");
    }
}

static uint32_t message_of(const trace_t *trace, const hal_can_frame_t *frame) {
    const uint32_t message = agv_ids_find(&trace->ids, frame->id);
    const bool is_status = (trace->status_frame_id != 0) && (frame->id == trace->status_frame_id);
    return (message == AGV_MSG_NONE) && is_status ? SIGNALS_STATUS_FRAME : message;
}

void trace_frame(trace_t *trace, hal_can_side_t side, const hal_can_frame_t *frame, bool sent, uint64_t t_us) {
    char data[DATA_SIZE] = "";
    char signals[SIGNALS_TEXT_SIZE] = "";
    const uint32_t message = message_of(trace, frame);
    const bool whole = (frame->flags == 0) && (frame->length == AGV_DLC) &&
                       ((message != AGV_MSG_NONE) || (frame->id == trace->status_frame_id));
    const bool known = whole && (signals_message_name(message) != NULL);
    for (size_t i = 0; (i < frame->length) && (i < sizeof frame->data); i++) {
        (void)snprintf(&data[2 * i], 3, "%02X", frame->data[i]);
    }
    if (known) {
        (void)signals_print(signals, sizeof signals, message, frame->data);
    }
    put(trace,
        "{\"ph\":\"i\",\"s\":\"t\",\"name\":\"%03" PRIX32 "\",\"pid\":%d,\"tid\":%d,\"ts\":%" PRIu64
        ",\"args\":{\"data\":\"%s\",\"signals\":\"%s\",\"side\":\"%s\"}}",
        frame->id, sent ? SENT : RECEIVED, known ? (int)message + 1 : OTHER_ROW, t_us, data, signals,
        (side == HAL_CAN_AI) ? "ai" : "vehicle");
}

static void put_bar(trace_t *trace, int row, const char *name, uint64_t from_us, uint64_t to_us) {
    put(trace, "{\"ph\":\"X\",\"name\":\"%s\",\"pid\":%d,\"tid\":%d,\"ts\":%" PRIu64 ",\"dur\":%" PRIu64 "}", name,
        SUPERVISOR, row, from_us, to_us - from_us);
}

static void on_state(trace_t *trace, const agv_event_t *event, uint64_t t_us) {
    const char *reason = agv_fault_name((agv_fault_t)event->c);
    if (trace->state != NULL) {
        put_bar(trace, STATE_ROW, trace->state, trace->state_since_us, t_us);
    }
    trace->state = agv_state_name((agv_state_t)event->b);
    trace->state_since_us = t_us;
    if (reason != NULL) {
        put(trace, "{\"ph\":\"i\",\"s\":\"g\",\"name\":\"%s\",\"pid\":%d,\"tid\":%d,\"ts\":%" PRIu64 "}", reason,
            SUPERVISOR, STATE_ROW, t_us);
    }
}

static void on_output(trace_t *trace, bool closed, uint64_t t_us) {
    if (trace->output_closed && !closed) {
        put_bar(trace, OUTPUT_ROW, "closed", trace->closed_since_us, t_us);
    } else if (closed && !trace->output_closed) {
        trace->closed_since_us = t_us;
    } else {
        /* as before */
    }
    trace->output_closed = closed;
}

static void put_fault(trace_t *trace, uint32_t fault, bool begins, uint64_t t_us) {
    put(trace,
        "{\"ph\":\"%s\",\"cat\":\"fault\",\"name\":\"%s\",\"id\":%" PRIu32 ",\"pid\":%d,\"tid\":%d,\"ts\":%" PRIu64 "}",
        begins ? "b" : "e", agv_fault_name((agv_fault_t)fault), fault, SUPERVISOR, STATE_ROW, t_us);
}

static void on_fault(trace_t *trace, const agv_event_t *event, uint64_t t_us) {
    const bool active = event->c != 0;
    if ((event->a < AGV_FAULT_COUNT) && (active != (trace->active[event->a] != 0))) {
        trace->active[event->a] = active ? 1u : 0u;
        put_fault(trace, event->a, active, t_us);
    }
}

void trace_event(trace_t *trace, const session_event_t *event) {
    const uint64_t t_us = event->t_ms * US_PER_MS;
    if (event->is_led) {
        put(trace, "{\"ph\":\"C\",\"name\":\"LED code\",\"pid\":%d,\"ts\":%" PRIu64 ",\"args\":{\"code\":%d}}",
            SUPERVISOR, t_us, event->led_code);
        return;
    }
    switch ((agv_event_kind_t)event->recorded.kind) {
    case AGV_EVENT_STATE:
        on_state(trace, &event->recorded, t_us);
        break;
    case AGV_EVENT_FAULT:
        on_fault(trace, &event->recorded, t_us);
        break;
    case AGV_EVENT_OUTPUT:
        on_output(trace, event->recorded.a != 0, t_us);
        break;
    default:
        break;
    }
}

void trace_end(trace_t *trace, uint64_t t_us) {
    if (trace->state != NULL) {
        put_bar(trace, STATE_ROW, trace->state, trace->state_since_us, t_us);
    }
    on_output(trace, false, t_us);
    for (uint32_t fault = 0; fault < AGV_FAULT_COUNT; fault++) {
        if (trace->active[fault] != 0) {
            put_fault(trace, fault, false, t_us);
        }
    }
    (void)output_write(trace->output, "\n]}\n", 4);
}
