/* The state of the supervisor: by its status frame, or by one that only listens. */
#include "monitor_fixture.h"

void setUp(void) {
    agv_config_defaults(&settings);
    begin(false, false);
}

void tearDown(void) {
    end();
}

/* 7F0h: state, reason, output, counter; page 0 with the checksum of the default configuration, unless another is given. */
static void status(unsigned ms, unsigned state, unsigned reason, unsigned output, uint32_t checksum) {
    char data[17];
    (void)snprintf(data, sizeof data, "%02X%02X%02X00%02X%02X%02X%02X", state, reason, output, checksum & 0xFFu,
                   (checksum >> 8) & 0xFFu, (checksum >> 16) & 0xFFu, checksum >> 24);
    frame(VEHICLE, ms, 0x7F0, data);
}

static void default_status(unsigned ms, unsigned state, unsigned reason, unsigned output) {
    status(ms, state, reason, output, agv_config_checksum(&settings));
}

/* Healthy nodes in manual mode, gear P, at standstill. */
static void healthy(unsigned from_ms, unsigned to_ms, bool with_ai) {
    char data[17];
    for (unsigned ms = from_ms; ms < to_ms; ms += 10) {
        const unsigned counter = (ms / 10) & 0xFFu;
        (void)snprintf(data, sizeof data, "00000000000040%02X", counter);
        frame(VEHICLE, ms, 0x363, data);
        (void)snprintf(data, sizeof data, "%02X64282300000000", counter);
        frame(VEHICLE, ms, 0x067, data);
        frame(VEHICLE, ms, 0x0A3, "0800000000000000");
        frame(VEHICLE, ms, 0x050, "0000000000000000");
        frame(VEHICLE, ms, 0x167, "0000000100000000");
        frame(VEHICLE, ms, 0x267, "0000000000000000");
        frame(VEHICLE, ms, 0x101, "0000000000000000");
        (void)snprintf(data, sizeof data, "00000000000000%02X", counter);
        if (with_ai && (ms % 100 == 0)) {
            frame(VEHICLE, ms, 0x43F, data);
            frame(VEHICLE, ms, 0x168, "0800000000000000");
            frame(VEHICLE, ms, 0x075, "0000000000000000");
            frame(VEHICLE, ms, 0x065, "2823000000000000");
        }
    }
}

void test_the_state_of_the_status_frame(void) {
    default_status(100, 0x0F, 255, 0);
    TEST_ASSERT_EQUAL(MONITOR_STATUS_FRAME, monitor->supervisor.source);
    TEST_ASSERT_EQUAL(AGV_STATE_INIT, monitor->supervisor.state);
    default_status(200, 0x33, 255, 1);
    TEST_ASSERT_TRUE(monitor->supervisor.output_closed);
    default_status(300, 0x55, AGV_FAULT_EPS_OVER_VOLTAGE, 1);
    TEST_ASSERT_EQUAL(AGV_FAULT_EPS_OVER_VOLTAGE, monitor->supervisor.first_reason);
    TEST_ASSERT_EQUAL(1, said("supervisor: its status frame 7F0h is received"));
    TEST_ASSERT_EQUAL(1, said("supervisor: INIT -> STANDBY"));
    TEST_ASSERT_EQUAL(1, said("supervisor: STANDBY -> TRIPPED: EPS_OVER_VOLTAGE"));
    TEST_ASSERT_EQUAL(0, said("configuration"));
    TEST_ASSERT_NULL(monitor->shadow);
}

void test_the_pages_of_the_version_change_no_output_and_no_checksum(void) {
    default_status(100, 0x33, 255, 1);
    frame(VEHICLE, 101, 0x7F0, "33FF110000010000");
    frame(VEHICLE, 102, 0x7F0, "33FF2100DEADBEEF");
    TEST_ASSERT_TRUE(monitor->supervisor.output_closed);
    TEST_ASSERT_EQUAL_HEX32(agv_config_checksum(&settings), monitor->supervisor.checksum);
    TEST_ASSERT_EQUAL(0, said("configuration"));
}

void test_another_configuration_is_noticed(void) {
    status(100, 0x33, 255, 1, 0x12345678u);
    status(200, 0x33, 255, 1, 0x12345678u);
    TEST_ASSERT_EQUAL(1, said("its configuration is 12345678"));
}

void test_without_a_status_frame_for_a_second_a_supervisor_listens(void) {
    healthy(0, 990, true);
    TEST_ASSERT_EQUAL(MONITOR_NO_SOURCE, monitor->supervisor.source);
    healthy(990, 1500, true);
    TEST_ASSERT_EQUAL(MONITOR_SHADOW, monitor->supervisor.source);
    TEST_ASSERT_EQUAL(AGV_STATE_STANDBY, monitor->supervisor.state);
    TEST_ASSERT_EQUAL(1, said("shadow: STANDBY"));
    healthy(1500, 2000, false);
    TEST_ASSERT_EQUAL(1, said("shadow: fault AI_HEARTBEAT_LOST (warn)"));
}

void test_the_faults_that_the_listening_supervisor_had_before_it_is_shown(void) {
    wait_until(999);
    TEST_ASSERT_EQUAL(0, said("fault"));
    wait_until(1001);
    TEST_ASSERT_EQUAL(1, said("shadow: INIT"));
    TEST_ASSERT_EQUAL(1, said("shadow: fault VCU_HEARTBEAT_LOST (trip)"));
    TEST_ASSERT_EQUAL(1, said("shadow: fault EPS_HEARTBEAT_LOST (trip)"));
    TEST_ASSERT_TRUE(said_at("fault VCU_HEARTBEAT_LOST") >= 1000);
    wait_until(3000);
    TEST_ASSERT_EQUAL(1, said("fault VCU_HEARTBEAT_LOST"));
}

void test_a_status_frame_that_stops_coming(void) {
    default_status(100, 0x33, 255, 1);
    wait_until(1099);
    TEST_ASSERT_EQUAL(MONITOR_STATUS_FRAME, monitor->supervisor.source);
    wait_until(1101);
    TEST_ASSERT_EQUAL(MONITOR_SHADOW, monitor->supervisor.source);
    TEST_ASSERT_EQUAL(1, said("supervisor: no status frame any more"));
    TEST_ASSERT_EQUAL(AGV_STATE_INIT, monitor->supervisor.state);
    default_status(2000, 0x33, 255, 1);
    TEST_ASSERT_EQUAL(MONITOR_STATUS_FRAME, monitor->supervisor.source);
    TEST_ASSERT_EQUAL(AGV_STATE_STANDBY, monitor->supervisor.state);
}

void test_the_shadow_that_was_asked_for_stays(void) {
    end();
    begin(false, true);
    TEST_ASSERT_EQUAL(1, said("shadow: INIT"));
    default_status(100, 0x33, 255, 1);
    TEST_ASSERT_EQUAL(MONITOR_SHADOW, monitor->supervisor.source);
    TEST_ASSERT_EQUAL(AGV_STATE_INIT, monitor->supervisor.state);
    TEST_ASSERT_EQUAL(0, said("STATUS_ID_IN_USE"));
}

void test_a_hole_in_a_log_is_no_silence_of_the_bus(void) {
    healthy(0, 1500, true);
    healthy(3600000, 3601000, true);
    TEST_ASSERT_EQUAL(1, said("shadow: the time jumped: it starts again"));
    TEST_ASSERT_EQUAL(0, said("TRIPPED"));
    TEST_ASSERT_EQUAL(AGV_STATE_STANDBY, monitor->supervisor.state);
}

void test_faults_of_the_supervisor_are_alarms_once_each(void) {
    monitor_alarm_t alarms[8];
    healthy(0, 1500, true);
    frame(VEHICLE, 1500, 0x363,
          "0000000001004001"); /* the VCU reports REMOTE_SIGNAL_LOST, and so does the supervisor */
    frame(VEHICLE, 1510, 0x363, "0000000001004002");
    frame(VEHICLE, 1520, 0x363, "0000000001004003");
    wait_until(1530);
    TEST_ASSERT_EQUAL(1, said("REMOTE_SIGNAL_LOST (trip)"));
    TEST_ASSERT_EQUAL(1, monitor_alarms(monitor, alarms, 8));
    TEST_ASSERT_EQUAL(AGV_FAULT_REMOTE_SIGNAL_LOST, alarms[0].fault);
    TEST_ASSERT_TRUE(alarms[0].is_trip);
}

void test_the_program_says_what_its_supervisor_does(void) {
    end();
    const monitor_config_t config = {.config = &settings, .interfaces = {"can0", NULL}, .owned = true};
    monitor = monitor_new(&config);
    const session_event_t event = {
        .recorded = {.kind = AGV_EVENT_STATE, .a = AGV_STATE_STANDBY, .b = AGV_STATE_ACTIVE, .c = AGV_FAULT_NONE}};
    const monitor_supervisor_t told = {.state = AGV_STATE_ACTIVE, .first_reason = AGV_FAULT_NONE, .has_led = true};
    monitor_event(monitor, &event, 1000);
    monitor_told(monitor, &told);
    wait_until(5000);
    TEST_ASSERT_EQUAL(MONITOR_OWNER, monitor->supervisor.source);
    TEST_ASSERT_EQUAL(AGV_STATE_ACTIVE, monitor->supervisor.state);
    TEST_ASSERT_EQUAL(1, said("supervisor: STANDBY -> ACTIVE"));
    TEST_ASSERT_EQUAL(1, monitor_log_length(&monitor->log));
}

void test_a_fault_that_changes_too_often_is_said_once(void) {
    end();
    const monitor_config_t config = {.config = &settings, .interfaces = {"can0", NULL}, .owned = true};
    monitor = monitor_new(&config);
    session_event_t event = {.recorded = {.kind = AGV_EVENT_FAULT, .a = AGV_FAULT_EPS_TEMP_ABOVE_110, .c = 1}};
    monitor_event(monitor, &event, 1000);
    for (uint64_t i = 0; i < 10; i++) {
        event.is_left_out = true;
        monitor_event(monitor, &event, 2000 + i);
    }
    event.is_left_out = false;
    event.recorded.c = 0;
    monitor_event(monitor, &event, 3000);
    TEST_ASSERT_EQUAL(1, said("fault EPS_TEMP_ABOVE_110 changes more than 4 times a second: not listed"));
    TEST_ASSERT_EQUAL(1, said("fault EPS_TEMP_ABOVE_110 (warn) has ended"));
    TEST_ASSERT_EQUAL(3, monitor_log_length(&monitor->log));
}
