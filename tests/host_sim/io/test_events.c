/* Events as JSON Lines: every kind, every key, and what observers of a session are told. */
#include "io/events.h"

#include <stdlib.h>
#include <string.h>

#include "agv/config.h"
#include "hal_sim/sim_hal.h"
#include "scratch.h"
#include "unity.h"

static output_t *output;
static session_t *session;
static hal_t hal;

void setUp(void) {
    scratch_open();
    output = calloc(1, sizeof *output);
    session = calloc(1, sizeof *session);
    TEST_ASSERT_TRUE(output_open(output, scratch_path("events")));
    session_init(session, &hal);
}

void tearDown(void) {
    output_discard(output);
    free(output);
    free(session);
}

static const char *lines(void) {
    TEST_ASSERT_TRUE(output_commit(output));
    return scratch_read("events");
}

static void write_event(agv_event_t recorded) {
    const session_event_t event = {.t_ms = 12345678901, .recorded = recorded};
    events_write(output, &event);
}

void test_states(void) {
    write_event((agv_event_t){.kind = AGV_EVENT_STATE, .a = 0, .b = AGV_STATE_INIT, .c = AGV_FAULT_NONE});
    write_event((agv_event_t){
        .kind = AGV_EVENT_STATE, .a = AGV_STATE_ACTIVE, .b = AGV_STATE_TRIPPED, .c = AGV_FAULT_AI_HEARTBEAT_STUCK});
    TEST_ASSERT_EQUAL_STRING(
        "{\"t_ms\": 12345678901, \"event\": \"state\", \"from\": null, \"to\": \"INIT\", \"reason\": null}\n"
        "{\"t_ms\": 12345678901, \"event\": \"state\", \"from\": \"ACTIVE\", \"to\": \"TRIPPED\", "
        "\"reason\": \"AI_HEARTBEAT_STUCK\"}\n",
        lines());
}

void test_faults(void) {
    write_event((agv_event_t){.kind = AGV_EVENT_FAULT, .a = AGV_FAULT_BUS_OFF, .b = AGV_CLASS_TRIP, .c = 1});
    write_event((agv_event_t){.kind = AGV_EVENT_FAULT, .a = AGV_FAULT_ERROR_PASSIVE, .b = AGV_CLASS_WARN, .c = 0});
    TEST_ASSERT_EQUAL_STRING(
        "{\"t_ms\": 12345678901, \"event\": \"fault\", \"name\": \"BUS_OFF\", \"class\": \"trip\", "
        "\"active\": true}\n"
        "{\"t_ms\": 12345678901, \"event\": \"fault\", \"name\": \"ERROR_PASSIVE\", "
        "\"class\": \"warn\", \"active\": false}\n",
        lines());
}

/* Shows: HW-4, SELF_TEST_FAILED */
void test_a_failed_self_test_names_the_parts(void) {
    write_event((agv_event_t){.kind = AGV_EVENT_FAULT,
                              .a = AGV_FAULT_SELF_TEST_FAILED,
                              .b = AGV_CLASS_TRIP,
                              .c = 1,
                              .missing = HAL_SELF_TEST_FLASH | HAL_SELF_TEST_CORE});
    TEST_ASSERT_EQUAL_STRING("{\"t_ms\": 12345678901, \"event\": \"fault\", \"name\": \"SELF_TEST_FAILED\", \"class\": "
                             "\"trip\", \"active\": true, \"parts\": [\"flash\", \"core\"]}\n",
                             lines());
}

void test_output_and_led(void) {
    write_event((agv_event_t){.kind = AGV_EVENT_OUTPUT, .a = 1});
    const session_event_t led = {.t_ms = 5, .is_led = true, .led_code = -1};
    events_write(output, &led);
    TEST_ASSERT_EQUAL_STRING("{\"t_ms\": 12345678901, \"event\": \"safety_output\", \"closed\": true}\n"
                             "{\"t_ms\": 5, \"event\": \"led\", \"code\": -1}\n",
                             lines());
}

void test_reset_and_startup_name_what_was_missing(void) {
    write_event((agv_event_t){.kind = AGV_EVENT_RESET, .a = 1});
    write_event((agv_event_t){.kind = AGV_EVENT_RESET, .a = 0, .missing = 0xFF});
    write_event((agv_event_t){.kind = AGV_EVENT_STARTUP, .missing = AGV_MISSING_MANUAL | AGV_MISSING_OUTPUT});
    TEST_ASSERT_EQUAL_STRING(
        "{\"t_ms\": 12345678901, \"event\": \"reset\", \"accepted\": true, \"why\": []}\n"
        "{\"t_ms\": 12345678901, \"event\": \"reset\", \"accepted\": false, \"why\": [\"state\", \"vcu_heartbeat\", "
        "\"eps_heartbeat\", \"trip_cause\", \"standstill\", \"manual\", \"button\", \"messages\"]}\n"
        "{\"t_ms\": 12345678901, \"event\": \"startup\", \"missing\": [\"manual\", \"output_feedback\"]}\n",
        lines());
}

/* Shows: INT-3 */
void test_how_the_run_before_ended(void) {
    write_event((agv_event_t){
        .kind = AGV_EVENT_CRASH, .a = 3, .b = 4, .frames = {{0x34, 0x12, 0x00, 0x08, 0x79, 0x56, 0x00, 0x08}}});
    write_event((agv_event_t){.kind = AGV_EVENT_CRASH, .a = 1});
    TEST_ASSERT_EQUAL_STRING("{\"t_ms\": 12345678901, \"event\": \"crash\", \"cause\": \"lock-up\", \"end\": "
                             "\"stack overflow\", \"pc\": \"08001234\", \"lr\": \"08005679\"}\n"
                             "{\"t_ms\": 12345678901, \"event\": \"crash\", \"cause\": \"watchdog\", \"end\": "
                             "null, \"pc\": \"00000000\", \"lr\": \"00000000\"}\n",
                             lines());
}

void test_what_is_no_event_or_no_name(void) {
    write_event((agv_event_t){.kind = 99});
    write_event((agv_event_t){.kind = AGV_EVENT_STATE, .a = 1, .b = 2, .c = 255});
    TEST_ASSERT_EQUAL_STRING(
        "{\"t_ms\": 12345678901, \"event\": \"state\", \"from\": null, \"to\": null, \"reason\": null}\n", lines());
}

void test_the_summary(void) {
    const events_summary_t summary = {.t_ms = 1,
                                      .counters = {.received = 2,
                                                   .rejected = {[AGV_REJECTED_LENGTH] = 3,
                                                                [AGV_REJECTED_EXTENDED] = 4,
                                                                [AGV_REJECTED_REMOTE] = 5,
                                                                [AGV_REJECTED_FD] = 6,
                                                                [AGV_REJECTED_ERROR] = 7},
                                                   .dropped = 8,
                                                   .sent = 9,
                                                   .shadowed = 10,
                                                   .limited = 14,
                                                   .warnings = 11},
                                      .supervised_ms = 15,
                                      .skipped_lines = 12,
                                      .backward_stamps = 13,
                                      .final_state = AGV_STATE_SAFE,
                                      .first_reason = AGV_FAULT_BUS_OFF};
    events_write_summary(output, &summary);
    TEST_ASSERT_EQUAL_STRING("{\"t_ms\": 1, \"event\": \"summary\", \"received\": 2, \"rejected\": {\"length\": 3, "
                             "\"extended\": 4, \"remote\": 5, \"fd\": 6, \"error\": 7}, \"dropped\": 8, \"sent\": 9, "
                             "\"shadowed\": 10, \"limited\": 14, \"warnings\": 11, \"supervised_ms\": 15, "
                             "\"skipped_lines\": 12, \"backward_stamps\": 13, "
                             "\"final_state\": \"SAFE\", \"first_reason\": \"BUS_OFF\"}\n",
                             lines());
}

static void start(uint64_t t_ms, uint32_t clock_ms) {
    agv_config_t config;
    const sim_hal_config_t hal_config = {.clock_start_ms = clock_ms};
    agv_config_defaults(&config);
    sim_hal_init_direct(&hal, &hal_config, 1, NULL, NULL);
    session_start(session, &config, t_ms, clock_ms);
}

void test_a_session_begins_with_state_output_and_led(void) {
    TEST_ASSERT_TRUE(session_observe(session, events_write, output));
    start(0, UINT32_MAX);
    session_tick(session, 1, 0);
    TEST_ASSERT_EQUAL_STRING("{\"t_ms\": 0, \"event\": \"state\", \"from\": null, \"to\": \"INIT\", \"reason\": null}\n"
                             "{\"t_ms\": 0, \"event\": \"safety_output\", \"closed\": false}\n"
                             "{\"t_ms\": 0, \"event\": \"led\", \"code\": 0}\n",
                             lines());
}

void test_a_session_that_is_started_again_tells_of_the_new_run_only(void) {
    start(0, 0);
    TEST_ASSERT_TRUE(session_observe(session, events_write, output));
    start(70, 70);
    TEST_ASSERT_EQUAL_STRING(
        "{\"t_ms\": 70, \"event\": \"state\", \"from\": null, \"to\": \"INIT\", \"reason\": null}\n"
        "{\"t_ms\": 70, \"event\": \"safety_output\", \"closed\": false}\n"
        "{\"t_ms\": 70, \"event\": \"led\", \"code\": 0}\n",
        lines());
}

void test_the_summary_is_of_all_starts(void) {
    const hal_can_frame_t frame = {.id = 0x123, .length = 1};
    events_summary_t summary;
    start(0, 0);
    session_frame(session, HAL_CAN_VEHICLE, &frame, 10);
    session_stop(session, 20);
    start(70, 70);
    session_frame(session, HAL_CAN_VEHICLE, &frame, 80);
    session_frame(session, HAL_CAN_VEHICLE, &frame, 90);
    events_summarise(session, &summary);
    TEST_ASSERT_EQUAL_UINT32(3, summary.counters.received);
}

void test_time_goes_on_over_the_wrap_of_the_clock(void) {
    TEST_ASSERT_TRUE(session_observe(session, events_write, output));
    start(0, UINT32_MAX - 9999);
    for (uint32_t t_ms = 1; t_ms <= 10100; t_ms++) {
        sim_hal_set_now_ms(&hal, UINT32_MAX - 9999 + t_ms);
        session_tick(session, t_ms, UINT32_MAX - 9999 + t_ms);
    }
    const char *text = lines();
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(text, "{\"t_ms\": 10001, \"event\": \"startup\", "), text);
}

void test_observers_are_bounded(void) {
    for (unsigned i = 0; i < SESSION_OBSERVERS_MAX; i++) {
        TEST_ASSERT_TRUE(session_observe(session, events_write, output));
    }
    TEST_ASSERT_FALSE(session_observe(session, events_write, output));
}

void test_a_write_that_fails_is_remembered(void) {
    output_discard(output);
    TEST_ASSERT_TRUE(output_open(output, "/dev/full"));
    for (unsigned i = 0; i < 2000; i++) {
        write_event((agv_event_t){.kind = AGV_EVENT_OUTPUT});
    }
    TEST_ASSERT_FALSE(output_commit(output));
    TEST_ASSERT_EQUAL_STRING("host_sim: /dev/full: No space left on device\n", scratch_said());
}
