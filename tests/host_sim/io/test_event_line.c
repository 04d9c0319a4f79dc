/* Events read from lines of JSON: what events.c writes comes back, what is no event is none. */
#include "io/event_line.h"

#include <stdlib.h>
#include <string.h>

#include "agv/names.h"
#include "io/events.h"
#include "io/output.h"
#include "scratch.h"
#include "unity.h"

static session_event_t event;

void setUp(void) {
    scratch_open();
}

static bool reads(const char *line) {
    return event_line_read(line, strlen(line), &event);
}

static void comes_back(const session_event_t *written) {
    output_t *output = calloc(1, sizeof *output);
    TEST_ASSERT_TRUE(output_open(output, scratch_path("events")));
    events_write(output, written);
    TEST_ASSERT_TRUE(output_commit(output));
    free(output);
    const char *line = scratch_read("events");
    TEST_ASSERT_TRUE_MESSAGE(reads(line), line);
    TEST_ASSERT_EQUAL(written->is_led, event.is_led);
    TEST_ASSERT_EQUAL_INT8(written->led_code, event.led_code);
    TEST_ASSERT_EQUAL_MEMORY_MESSAGE(&written->recorded, &event.recorded, sizeof event.recorded, line);
}

static void recorded_comes_back(agv_event_t recorded) {
    const session_event_t written = {.recorded = recorded};
    comes_back(&written);
}

void test_what_is_written_comes_back(void) {
    recorded_comes_back((agv_event_t){.kind = AGV_EVENT_STATE, .b = AGV_STATE_INIT, .c = AGV_FAULT_NONE});
    recorded_comes_back(
        (agv_event_t){.kind = AGV_EVENT_STATE, .a = AGV_STATE_ACTIVE, .b = AGV_STATE_TRIPPED, .c = AGV_FAULT_BUS_OFF});
    for (unsigned fault = 0; fault < AGV_FAULT_COUNT; fault++) {
        recorded_comes_back((agv_event_t){.kind = AGV_EVENT_FAULT, .a = (uint8_t)fault, .b = AGV_CLASS_TRIP, .c = 1});
        recorded_comes_back((agv_event_t){.kind = AGV_EVENT_FAULT, .a = (uint8_t)fault, .b = AGV_CLASS_WARN, .c = 0});
    }
    recorded_comes_back((agv_event_t){.kind = AGV_EVENT_OUTPUT, .a = 1});
    recorded_comes_back((agv_event_t){.kind = AGV_EVENT_OUTPUT, .a = 0});
    recorded_comes_back((agv_event_t){.kind = AGV_EVENT_RESET, .a = 1});
    recorded_comes_back((agv_event_t){.kind = AGV_EVENT_RESET});
    recorded_comes_back((agv_event_t){.kind = AGV_EVENT_STARTUP, .missing = 0x7FFu});
    for (unsigned bit = 0; bit < 11; bit++) { /* each alone, and all but one */
        const uint16_t sets[] = {(uint16_t)(1u << bit), (uint16_t)(0x7FFu & ~(1u << bit))};
        for (size_t i = 0; i < 2; i++) {
            recorded_comes_back((agv_event_t){.kind = AGV_EVENT_RESET, .missing = sets[i]});
            recorded_comes_back((agv_event_t){.kind = AGV_EVENT_STARTUP, .missing = sets[i]});
            recorded_comes_back((agv_event_t){
                .kind = AGV_EVENT_FAULT, .a = AGV_FAULT_SELF_TEST_FAILED, .c = 1, .missing = sets[i] & 0x7Fu});
        }
    }
    const session_event_t led = {.is_led = true, .led_code = -1};
    comes_back(&led);
}

void test_what_is_no_event_is_none(void) {
    static const char *const lines[] = {
        "",
        "*** Booting",
        "{",
        "[]",
        "{\"event\": \"summary\"}",
        "{\"event\": \"state\", \"to\": \"NOWHERE\"}",
        "{\"event\": \"fault\", \"name\": \"NO_FAULT\", \"class\": \"trip\", \"active\": true}",
        "{\"event\": 7}"};
    for (size_t i = 0; i < sizeof lines / sizeof lines[0]; i++) {
        TEST_ASSERT_FALSE_MESSAGE(reads(lines[i]), lines[i]);
    }
}
