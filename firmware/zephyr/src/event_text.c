#include "event_text.h"

#include <stdarg.h>
#include <string.h>

#include <zephyr/sys/byteorder.h>
#include <zephyr/sys/printk.h>
#include <zephyr/sys/util.h>

#include "agv/names.h"
#include "hal_zephyr/zephyr_hal.h"

/* A line that grows. What does not fit is left out. */
typedef struct {
    char *text;
    size_t size;
    size_t used;
} line_t;

static void add(line_t *line, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    const int length = vsnprintk(&line->text[line->used], line->size - line->used, format, arguments);
    va_end(arguments);
    line->used = MIN(line->used + (size_t)MAX(length, 0), line->size - 1u);
}

static line_t begin(char *text, size_t size) {
    text[0] = '\0';
    return (line_t){.text = text, .size = size, .used = 0u};
}

static const char *name_or_dash(const char *name) {
    return (name != NULL) ? name : "-";
}

static void add_missing(line_t *line, uint16_t missing) {
    for (uint8_t bit = 0u; agv_missing_name(bit) != NULL; bit++) {
        if ((missing & (1u << bit)) != 0u) {
            add(line, " %s", agv_missing_name(bit));
        }
    }
}

static void add_parts(line_t *line, uint32_t failed) {
    for (uint8_t part = 0u; agv_self_test_part_name(part) != NULL; part++) {
        if ((failed & BIT(part)) != 0u) {
            add(line, " %s", agv_self_test_part_name(part));
        }
    }
}

void event_text_parts(uint32_t failed, char *words, size_t size) {
    line_t line = begin(words, size);
    add_parts(&line, failed);
}

static void add_state(line_t *line, const agv_event_t *event) {
    add(line, "=> %s", name_or_dash(agv_state_name((agv_state_t)event->b)));
    if (event->c < (uint8_t)AGV_FAULT_COUNT) {
        add(line, ": %s", agv_fault_name((agv_fault_t)event->c));
    }
}

static void add_fault(line_t *line, const agv_event_t *event) {
    add(line, "%s", name_or_dash(agv_fault_name((agv_fault_t)event->a)));
    if (event->c == 0u) {
        add(line, " ended");
    } else {
        add(line, " raised (%s)", agv_class_name((agv_fault_class_t)event->b));
        if (event->a == (uint8_t)AGV_FAULT_SELF_TEST_FAILED) {
            add(line, ":");
            add_parts(line, event->missing);
        }
    }
}

static void add_reset(line_t *line, const agv_event_t *event) {
    add(line, "reset %s", (event->a != 0u) ? "accepted" : "refused:");
    add_missing(line, event->missing);
}

static void add_crash(line_t *line, const agv_event_t *event) {
    const char *const end = agv_end_name(event->b);
    add(line, "the run before ended: reset by %s", name_or_dash(agv_reset_cause_name(event->a)));
    if (end != NULL) {
        add(line, ", %s, PC %08x, LR %08x", end, sys_get_le32(&event->frames[0][0]),
            sys_get_le32(&event->frames[0][4]));
    }
}

void event_text(const agv_event_t *event, char *text, size_t size) {
    line_t line = begin(text, size);
    add(&line, "%u ms: ", event->time_ms);
    switch (event->kind) {
    case AGV_EVENT_STATE:
        add_state(&line, event);
        break;
    case AGV_EVENT_FAULT:
        add_fault(&line, event);
        break;
    case AGV_EVENT_OUTPUT:
        add(&line, "safety output %s", (event->a != 0u) ? "closed" : "open");
        break;
    case AGV_EVENT_RESET:
        add_reset(&line, event);
        break;
    case AGV_EVENT_STARTUP:
        add(&line, "startup waits for");
        add_missing(&line, event->missing);
        break;
    case AGV_EVENT_CRASH:
        add_crash(&line, event);
        break;
    default:
        add(&line, "event of unknown kind %u", event->kind);
        break;
    }
}
