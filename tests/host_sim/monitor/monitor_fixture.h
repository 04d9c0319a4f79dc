/* A monitor, frames at times in milliseconds, and its log. Bytes are written out from docs/protocol.md. */
#ifndef TESTS_MONITOR_FIXTURE_H
#define TESTS_MONITOR_FIXTURE_H

#include <stdio.h>
#include <string.h>

#include "agv/config.h"
#include "monitor/monitor.h"
#include "unity.h"

enum { VEHICLE = HAL_CAN_VEHICLE, AI = HAL_CAN_AI };

static agv_config_t settings;
static monitor_t *monitor;

/* Begin; change `settings` before. */
static inline void begin(bool is_gateway, bool shadow) {
    const monitor_config_t config = {.config = &settings,
                                     .interfaces = {"can0", is_gateway ? "can1" : NULL},
                                     .is_gateway = is_gateway,
                                     .shadow = shadow};
    monitor = monitor_new(&config);
    TEST_ASSERT_NOT_NULL(monitor);
}

static inline void end(void) {
    monitor_free(monitor);
    monitor = NULL;
}

/* A frame of 8 bytes, as 16 hexadecimal digits. */
static inline void frame(int side, unsigned ms, uint32_t id, const char *digits) {
    hal_can_frame_t received = {.id = id, .length = 8};
    for (size_t i = 0; i < 8; i++) {
        unsigned byte = 0;
        TEST_ASSERT_EQUAL(1, sscanf(&digits[2 * i], "%2x", &byte));
        received.data[i] = (uint8_t)byte;
    }
    monitor_frame(monitor, (hal_can_side_t)side, &received, (uint64_t)ms * 1000);
}

static inline void wait_until(unsigned ms) {
    monitor_time(monitor, (uint64_t)ms * 1000);
}

/* How many entries of the log contain a text. */
static inline unsigned said(const char *text) {
    unsigned count = 0;
    char line[MONITOR_WHO_SIZE + MONITOR_TEXT_SIZE + 2];
    for (size_t i = 0; i < monitor_log_length(&monitor->log); i++) {
        const monitor_entry_t *entry = monitor_log_back(&monitor->log, i);
        (void)snprintf(line, sizeof line, "%s: %s", entry->who, entry->text);
        count += (strstr(line, text) != NULL) ? 1 : 0;
    }
    return count;
}

/* The time in milliseconds of the newest entry that contains a text; -1: there is none. */
static inline int said_at(const char *text) {
    for (size_t i = 0; i < monitor_log_length(&monitor->log); i++) {
        const monitor_entry_t *entry = monitor_log_back(&monitor->log, i);
        if (strstr(entry->text, text) != NULL) {
            return (int)(entry->t_us / 1000);
        }
    }
    return -1;
}

/* The row of a message. */
static inline const monitor_row_t *row_of(int side, uint32_t id) {
    for (size_t i = 0; i < monitor->row_count; i++) {
        if (((int)monitor->rows[i].side == side) && (monitor->rows[i].id == id)) {
            return &monitor->rows[i];
        }
    }
    TEST_FAIL_MESSAGE("no such row");
    return NULL;
}

#endif
