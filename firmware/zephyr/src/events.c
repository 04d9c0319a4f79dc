#include "events.h"

#include <zephyr/logging/log.h>
#include <zephyr/sys/util.h>

#include "agv/names.h"
#include "agv_board.h"
#include "agv_revision.h"
#include "app_version.h"
#include "event_text.h"

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

const char *events_lacks(void) {
    return AGV_BOARD_LACKS;
}

#if defined(CONFIG_AGV_EVENTS)

LOG_MODULE_REGISTER(agv, LOG_LEVEL_INF);

/* The logger copies the line. */
static void print_event(const agv_event_t *event) {
    static char line[EVENT_TEXT_SIZE];
    const bool is_raised = (event->kind == (uint8_t)AGV_EVENT_FAULT) && (event->c != 0u);
    event_text(event, line, sizeof line);
    if (is_raised || (event->kind == (uint8_t)AGV_EVENT_CRASH)) {
        LOG_WRN("%s", line);
    } else {
        LOG_INF("%s", line);
    }
}

/* The first event of this run: all before the newest that carry its number. */
static uint32_t first_of_run(const agv_recorder_t *recorder) {
    uint32_t first = agv_recorder_next_sequence(recorder);
    agv_event_t newest;
    agv_event_t event;
    if (agv_recorder_get(recorder, first - 1u, &newest)) {
        for (uint32_t i = 0u; (i < (uint32_t)AGV_RECORDER_EVENTS) && agv_recorder_get(recorder, first - 1u, &event) &&
                              (event.run == newest.run);
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
    for (uint32_t fault = 0u; fault < (uint32_t)AGV_FAULT_COUNT; fault++) {
        const bool is_trip = agv_config_is_trip(config, fault);
        if (is_trip != agv_config_is_trip(&defaults, fault)) {
            LOG_WRN("not the default: class of %s: %s", agv_fault_name((agv_fault_t)fault),
                    is_trip ? "trip" : "warn, WEAKER");
        }
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
