#include "events.h"

#include <string.h>

#include <zephyr/logging/log.h>
#include <zephyr/sys/printk.h>
#include <zephyr/sys/util.h>

#include "agv_board.h"
#include "agv_revision.h"
#include "app_version.h"

#if defined(CONFIG_AGV_SHADOW_ON)
#define HOW " shadow"
#else
#define HOW ""
#endif
#if defined(CONFIG_AGV_CAN_LISTEN_ONLY)
#define BUS " listen-only"
#else
#define BUS ""
#endif

const char *events_version(void) {
    return APP_VERSION_STRING "+" AGV_REVISION HOW BUS;
}

#if defined(CONFIG_AGV_EVENTS)

#include "agv/names.h"

LOG_MODULE_REGISTER(agv, LOG_LEVEL_INF);

enum { WORDS_SIZE = 100 };

static const char *text(const char *name) {
    return (name != NULL) ? name : "-";
}

/* For the line that follows. */
static const char *words_of(uint16_t missing) {
    static char words[WORDS_SIZE];
    size_t used = 0u;
    words[0] = '\0';
    for (uint8_t bit = 0u; agv_missing_name(bit) != NULL; bit++) {
        if (((missing & (1u << bit)) != 0u) && (used < sizeof words)) {
            used += (size_t)snprintk(&words[used], sizeof words - used, " %s", agv_missing_name(bit));
        }
    }
    return words;
}

static void tell_fault(const agv_event_t *event) {
    const char *const name = text(agv_fault_name((agv_fault_t)event->a));
    if (event->c == 0u) {
        LOG_INF("%u ms: %s ended", event->time_ms, name);
    } else {
        LOG_WRN("%u ms: %s raised (%s)", event->time_ms, name, agv_class_name((agv_fault_class_t)event->b));
    }
}

static void print_event(const agv_event_t *event) {
    switch (event->kind) {
    case AGV_EVENT_STATE:
        LOG_INF("%u ms: => %s%s%s", event->time_ms, text(agv_state_name((agv_state_t)event->b)),
                (event->c < (uint8_t)AGV_FAULT_COUNT) ? ": " : "",
                (event->c < (uint8_t)AGV_FAULT_COUNT) ? agv_fault_name((agv_fault_t)event->c) : "");
        break;
    case AGV_EVENT_FAULT:
        tell_fault(event);
        break;
    case AGV_EVENT_OUTPUT:
        LOG_INF("%u ms: safety output %s", event->time_ms, (event->a != 0u) ? "closed" : "open");
        break;
    case AGV_EVENT_RESET:
        LOG_INF("%u ms: reset %s%s", event->time_ms,
                (event->a != 0u) ? "accepted" : "refused:", words_of(event->missing));
        break;
    default:
        LOG_INF("%u ms: startup waits for%s", event->time_ms, words_of(event->missing));
        break;
    }
}

/* The first event of this run: all before the newest that carry its number. */
static uint32_t first_of_run(const agv_recorder_t *recorder) {
    uint32_t first = agv_recorder_next_sequence(recorder);
    agv_event_t newest;
    agv_event_t event;
    if (agv_recorder_get(recorder, first - 1u, &newest)) {
        for (uint32_t i = 0u;
             (i < AGV_RECORDER_EVENTS) && agv_recorder_get(recorder, first - 1u, &event) && (event.run == newest.run);
             i++) {
            first--;
        }
    }
    return first;
}

static void tell_deviations(const agv_config_t *config) {
    agv_config_t defaults;
    agv_config_defaults(&defaults);
    for (uint16_t i = 0u; i < (uint16_t)AGV_SETTING_COUNT; i++) {
        if (agv_config_get(config, i) != agv_config_get(&defaults, i)) {
            LOG_WRN("not the default: %s %u%s", agv_setting_info(i)->name, agv_config_get(config, i),
                    agv_config_weakens(config, i) ? ", WEAKER" : "");
        }
    }
    if (memcmp(&config->trips, &defaults.trips, sizeof config->trips) != 0) {
        LOG_WRN("not the default: what faults do");
    }
}

#define PRINT_FACT(name, text) LOG_INF("board: %s: %s", name, text);

uint32_t events_begin(const agv_config_t *config, const agv_recorder_t *recorder) {
    LOG_INF("AGV supervisor %s, configuration %08x", events_version(), agv_config_checksum(config));
    AGV_BOARD_FACTS(PRINT_FACT)
    tell_deviations(config);
    return first_of_run(recorder);
}

void events_print(const agv_recorder_t *recorder, uint32_t *printed) {
    const uint32_t next = agv_recorder_next_sequence(recorder);
    agv_event_t event;
    if ((next - *printed) > AGV_RECORDER_EVENTS) {
        *printed = next - AGV_RECORDER_EVENTS;
    }
    for (; *printed != next; (*printed)++) {
        if (agv_recorder_get(recorder, *printed, &event)) {
            print_event(&event);
        }
    }
}

void events_print_led(uint32_t now_ms, int8_t code, int8_t *printed) {
    if (code != *printed) {
        *printed = code;
        LOG_INF("%u ms: LED code %d", now_ms, code);
    }
}

#else

uint32_t events_begin(const agv_config_t *config, const agv_recorder_t *recorder) {
    ARG_UNUSED(config);
    return agv_recorder_next_sequence(recorder);
}

void events_print(const agv_recorder_t *recorder, uint32_t *printed) {
    *printed = agv_recorder_next_sequence(recorder);
}

void events_print_led(uint32_t now_ms, int8_t code, int8_t *printed) {
    ARG_UNUSED(now_ms);
    *printed = code;
}

#endif
