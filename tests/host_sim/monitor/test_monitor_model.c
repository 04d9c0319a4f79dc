/* What the monitor knows of the messages. */
#include "monitor_fixture.h"

#define MANUAL "0000000000004000"
#define AUTOPILOT "0000000000008001"

void setUp(void) {
    agv_config_defaults(&settings);
    begin(false, false);
}

void tearDown(void) {
    end();
}

void test_a_shared_bus_has_eleven_rows_and_a_gateway_four_more(void) {
    TEST_ASSERT_EQUAL(11, monitor->row_count);
    TEST_ASSERT_EQUAL_HEX(0x43F, monitor->rows[0].id);
    TEST_ASSERT_EQUAL(350000, monitor->rows[0].deadline_us);
    end();
    begin(true, false);
    TEST_ASSERT_EQUAL(15, monitor->row_count);
    TEST_ASSERT_EQUAL(AI, monitor->rows[0].side);
    TEST_ASSERT_EQUAL(VEHICLE, monitor->rows[4].side);
}

void test_gaps_and_their_reset(void) {
    const monitor_row_t *row = row_of(VEHICLE, 0x168);
    TEST_ASSERT_EQUAL(MONITOR_NO_GAP, row->gap_min_us);
    frame(VEHICLE, 100, 0x168, "0800000000000000");
    TEST_ASSERT_EQUAL(MONITOR_NO_GAP, row->gap_min_us);
    frame(VEHICLE, 190, 0x168, "0800000000000000");
    frame(VEHICLE, 310, 0x168, "0800000000000000");
    TEST_ASSERT_EQUAL(90000, row->gap_min_us);
    TEST_ASSERT_EQUAL(120000, row->gap_max_us);
    TEST_ASSERT_EQUAL(3, row->count);
    monitor_reset(monitor);
    TEST_ASSERT_EQUAL(MONITOR_NO_GAP, row->gap_min_us);
    frame(VEHICLE, 410, 0x168, "0800000000000000");
    TEST_ASSERT_EQUAL(100000, row->gap_min_us);
    TEST_ASSERT_EQUAL(100000, row->gap_max_us);
}

/* 363h every 10 ms, with a mode, up to a time. */
static void report_mode(unsigned from_ms, unsigned to_ms, const char *mode) {
    char data[17];
    for (unsigned ms = from_ms; ms <= to_ms; ms += 10) {
        (void)snprintf(data, sizeof data, "000000000000%s%02X", mode, (ms / 10) % 256);
        frame(VEHICLE, ms, 0x363, data);
    }
}

void test_late_at_the_deadline_and_back(void) {
    frame(VEHICLE, 100, 0x0A3, "0800000000000000");
    wait_until(225);
    TEST_ASSERT_FALSE(row_of(VEHICLE, 0x0A3)->is_late);
    wait_until(230);
    TEST_ASSERT_TRUE(row_of(VEHICLE, 0x0A3)->is_late);
    TEST_ASSERT_EQUAL(1, said("vcu: 0A3h gear_status late: no frame for 125 ms"));
    TEST_ASSERT_EQUAL(225, said_at("0A3h gear_status late"));
    frame(VEHICLE, 1100, 0x0A3, "0800000000000000");
    TEST_ASSERT_FALSE(row_of(VEHICLE, 0x0A3)->is_late);
    TEST_ASSERT_EQUAL(1, said("vcu: 0A3h gear_status back after 1000 ms"));
}

/* Shows: SUP-3 */
void test_in_manual_no_command_is_late(void) {
    const uint32_t commands[] = {0x168, 0x075, 0x065};
    report_mode(0, 90, "40");
    frame(VEHICLE, 100, 0x168, "0800000000000000");
    frame(VEHICLE, 100, 0x075, "0000000000000000");
    frame(VEHICLE, 100, 0x065, "2823000000000000");
    report_mode(100, 2000, "40");
    for (size_t i = 0; i < 3; i++) {
        TEST_ASSERT_TRUE(row_of(VEHICLE, commands[i])->is_silent);
        TEST_ASSERT_FALSE(monitor_is_late(row_of(VEHICLE, commands[i])));
    }
    TEST_ASSERT_EQUAL(0, said("late"));
    TEST_ASSERT_EQUAL(1, said("ai: 168h gear_command silent: no frame for 350 ms"));
    TEST_ASSERT_EQUAL(450, said_at("168h gear_command silent"));
    frame(VEHICLE, 2010, 0x168, "0800000000000000");
    TEST_ASSERT_FALSE(row_of(VEHICLE, 0x168)->is_silent);
    TEST_ASSERT_FALSE(monitor_is_late(row_of(VEHICLE, 0x168)));
    TEST_ASSERT_EQUAL(1, said("168h gear_command back after 1910 ms"));
}

/* Shows: SUP-3 */
void test_an_engagement_restarts_the_deadline_of_a_command(void) {
    frame(VEHICLE, 100, 0x168, "0800000000000000");
    report_mode(110, 1000, "40");
    report_mode(1010, 1360, "80");
    TEST_ASSERT_EQUAL(0, said("late"));
    report_mode(1370, 1380, "80");
    TEST_ASSERT_TRUE(row_of(VEHICLE, 0x168)->is_late);
    TEST_ASSERT_EQUAL(1, said("168h gear_command late: no frame for 1260 ms"));
    TEST_ASSERT_EQUAL(1360, said_at("168h gear_command late"));
    report_mode(1390, 3000, "40"); /* after the third one it is engaged no more */
    TEST_ASSERT_FALSE(monitor_is_late(row_of(VEHICLE, 0x168)));
    TEST_ASSERT_EQUAL(1, said("late"));
}

/* Shows: SUP-3 */
void test_a_continued_engagement_restarts_no_deadline(void) {
    report_mode(0, 1000, "80");
    frame(VEHICLE, 1008, 0x065, "2823000000000000");
    report_mode(1010, 1120, "40"); /* ended at 1030 */
    report_mode(1130, 1140, "80");
    TEST_ASSERT_EQUAL(1133, said_at("065h steering_command late: no frame for 125 ms"));
}

/* Shows: SUP-9 */
void test_both_modes_neither_begin_nor_end_an_engagement(void) {
    report_mode(0, 50, "C0");
    TEST_ASSERT_FALSE(monitor->engagement.is_engaged);
    report_mode(60, 60, "80");
    report_mode(70, 80, "40");
    report_mode(90, 120, "C0");
    report_mode(130, 140, "40");
    TEST_ASSERT_TRUE(monitor->engagement.is_engaged);
    report_mode(150, 150, "40");
    TEST_ASSERT_FALSE(monitor->engagement.is_engaged);
}

/* Shows: SUP-8 */
void test_in_manual_the_loss_of_43fh_is_a_warning_unless_the_setting_says_trip(void) {
    frame(VEHICLE, 100, 0x43F, "0000000000000001");
    report_mode(100, 1000, "40");
    TEST_ASSERT_EQUAL(0, said("late"));
    TEST_ASSERT_EQUAL(1, said("ai: 43Fh turn_signal_command silent: no frame for 350 ms"));
    TEST_ASSERT_EQUAL(MONITOR_WARN, monitor_log_back(&monitor->log, 0)->level);
    report_mode(1010, 1020, "80"); /* no engagement makes a heartbeat younger */
    TEST_ASSERT_EQUAL(1010, said_at("43Fh turn_signal_command late: no frame for 910 ms"));
    end();
    settings.ai_lost_in_manual = AGV_AI_LOST_TRIP;
    begin(false, false);
    frame(VEHICLE, 100, 0x43F, "0000000000000001");
    report_mode(100, 1000, "40");
    TEST_ASSERT_EQUAL(450, said_at("43Fh turn_signal_command late: no frame for 350 ms"));
}

void test_a_vcu_that_is_lost_ends_the_engagement(void) {
    report_mode(0, 100, "80");
    frame(VEHICLE, 100, 0x168, "0800000000000000");
    wait_until(2000);
    TEST_ASSERT_EQUAL(1, said("late"));
    TEST_ASSERT_EQUAL(1, said("363h vehicle_status late"));
    TEST_ASSERT_TRUE(row_of(VEHICLE, 0x168)->is_silent);
}

void test_the_longest_gap_is_no_lateness_in_manual(void) {
    frame(VEHICLE, 100, 0x168, "0800000000000000");
    report_mode(110, 1000, "40");
    frame(VEHICLE, 1005, 0x168, "0800000000000000");
    TEST_ASSERT_FALSE(row_of(VEHICLE, 0x168)->has_been_late);
    report_mode(1010, 1020, "80"); /* nor is it one when the engagement begins */
    TEST_ASSERT_FALSE(monitor_is_late(row_of(VEHICLE, 0x168)));
}

void test_a_short_lateness_is_shown_for_half_a_second_at_least(void) {
    frame(VEHICLE, 100, 0x363, MANUAL);
    frame(VEHICLE, 170, 0x363, MANUAL);
    TEST_ASSERT_EQUAL(1, said("363h vehicle_status late"));
    TEST_ASSERT_EQUAL(1, said("363h vehicle_status back after 70 ms"));
    for (unsigned ms = 180; ms <= 600; ms += 10) {
        frame(VEHICLE, ms, 0x363, MANUAL);
    }
    TEST_ASSERT_TRUE(monitor_is_late(row_of(VEHICLE, 0x363)));
    TEST_ASSERT_EQUAL(70000, monitor_age_us(monitor, row_of(VEHICLE, 0x363)));
    for (unsigned ms = 610; ms <= 1010; ms += 10) {
        frame(VEHICLE, ms, 0x363, MANUAL);
    }
    TEST_ASSERT_FALSE(monitor_is_late(row_of(VEHICLE, 0x363)));
    TEST_ASSERT_EQUAL(10000, monitor_age_us(monitor, row_of(VEHICLE, 0x363)));
}

void test_what_was_never_heard_is_not_late(void) {
    wait_until(60000);
    TEST_ASSERT_EQUAL(0, said("late"));
    TEST_ASSERT_EQUAL(0, monitor_age_us(monitor, row_of(VEHICLE, 0x363)));
}

void test_a_counter_that_stands_still(void) {
    char data[17];
    for (unsigned ms = 0; ms <= 100; ms += 10) {
        (void)snprintf(data, sizeof data, "00000000000040%02X", (ms < 40) ? ms / 10 : 4);
        frame(VEHICLE, ms, 0x363, data);
    }
    TEST_ASSERT_TRUE(row_of(VEHICLE, 0x363)->is_stuck); /* unchanged since 40 ms, the deadline is 50 ms */
    TEST_ASSERT_EQUAL(1, said("vcu: 363h vehicle_status stuck: counter unchanged for 50 ms"));
    frame(VEHICLE, 110, 0x363, "0000000000004005");
    TEST_ASSERT_FALSE(row_of(VEHICLE, 0x363)->is_stuck);
    TEST_ASSERT_EQUAL(1, said("363h vehicle_status counter changes again after 70 ms"));
}

void test_words_that_change_are_listed_numbers_are_not(void) {
    frame(VEHICLE, 10, 0x363, MANUAL);
    frame(VEHICLE, 20, 0x363, AUTOPILOT);
    frame(VEHICLE, 30, 0x0A3, "0800000000000000");
    frame(VEHICLE, 40, 0x0A3, "0100000000000000");
    frame(VEHICLE, 50, 0x050, "0000000000000000");
    frame(VEHICLE, 60, 0x050, "4B00000000000000");
    TEST_ASSERT_EQUAL(1, said("vcu: 363h mode: manual -> autopilot"));
    TEST_ASSERT_EQUAL(1, said("vcu: 0A3h gear: P -> D"));
    TEST_ASSERT_EQUAL(2, monitor_log_length(&monitor->log));
}

void test_two_senders_that_disagree_do_not_fill_the_log(void) {
    for (unsigned ms = 0; ms < 1000; ms += 20) {
        frame(VEHICLE, ms, 0x168, "0100000000000000");
        frame(VEHICLE, ms + 10, 0x168, "0800000000000000");
    }
    TEST_ASSERT_LESS_THAN(5, said("168h gear: "));
    TEST_ASSERT_EQUAL(1, said("168h changes more than 4 times a second: not listed"));
}

void test_alarms_in_words_with_their_codes(void) {
    monitor_alarm_t alarms[4];
    TEST_ASSERT_EQUAL(0, monitor_alarms(monitor, alarms, 4));
    frame(VEHICLE, 10, 0x363, "0000000081004000"); /* S_DRIVER, REMOTE_SIGNAL_LOST */
    frame(VEHICLE, 11, 0x167, "0000000100000002"); /* over-voltage */
    TEST_ASSERT_EQUAL(3, monitor_alarms(monitor, alarms, 4));
    TEST_ASSERT_EQUAL(AGV_FAULT_EPS_OVER_VOLTAGE, alarms[0].fault);
    TEST_ASSERT_EQUAL(13, alarms[0].led_code);
    TEST_ASSERT_EQUAL(AGV_FAULT_S_DRIVER_ALARM, alarms[1].fault);
    TEST_ASSERT_EQUAL(8, alarms[1].led_code);
    TEST_ASSERT_EQUAL(AGV_FAULT_REMOTE_SIGNAL_LOST, alarms[2].fault);
    TEST_ASSERT_EQUAL(17, alarms[2].led_code);
    TEST_ASSERT_EQUAL(2, monitor_alarms(monitor, alarms, 2));
    TEST_ASSERT_EQUAL(1, said("eps: alarm EPS_OVER_VOLTAGE, LED code 13"));
    frame(VEHICLE, 20, 0x167, "0000000100000000");
    TEST_ASSERT_EQUAL(2, monitor_alarms(monitor, alarms, 4));
    TEST_ASSERT_EQUAL(1, said("eps: alarm EPS_OVER_VOLTAGE has ended"));
}

void test_other_identifiers(void) {
    frame(VEHICLE, 10, 0x123, MANUAL);
    frame(VEHICLE, 20, 0x123, MANUAL);
    frame(VEHICLE, 30, 0x203, MANUAL);
    TEST_ASSERT_EQUAL(2, monitor->other_count);
    TEST_ASSERT_EQUAL(2, monitor->others[0].count);
    TEST_ASSERT_EQUAL(1, said("can0: 123h received, no message of the protocol"));
    TEST_ASSERT_EQUAL(1, said("can0: 203h received, an identifier of the other ID set"));
    for (uint32_t id = 0x500u; id < 0x540u; id++) {
        frame(VEHICLE, 40, id, MANUAL);
    }
    TEST_ASSERT_EQUAL(MONITOR_OTHERS_MAX, monitor->other_count);
    TEST_ASSERT_EQUAL(64 - (32 - 2), monitor->others_uncounted);
}

void test_frames_of_another_form_count_as_no_message(void) {
    const hal_can_frame_t forms[] = {
        {.id = 0x168u, .length = 7},
        {.id = 0x168u, .length = 8, .flags = HAL_CAN_REMOTE},
        {.id = 0x168u, .length = 8, .flags = HAL_CAN_FD},
    };
    for (size_t i = 0; i < 3; i++) {
        monitor_frame(monitor, HAL_CAN_VEHICLE, &forms[i], 1000 * (i + 1));
    }
    TEST_ASSERT_EQUAL(0, row_of(VEHICLE, 0x168)->count);
    TEST_ASSERT_EQUAL(3, monitor->rejected);
    TEST_ASSERT_EQUAL(1, said("168h in another form"));
    const hal_can_frame_t extended = {.id = 0x168u, .length = 8, .flags = HAL_CAN_EXTENDED};
    monitor_frame(monitor, HAL_CAN_VEHICLE, &extended, 5000);
    TEST_ASSERT_EQUAL(1, said("00000168h received, no message of the protocol"));
}

void test_the_sides_of_a_gateway_are_apart(void) {
    end();
    begin(true, false);
    frame(AI, 10, 0x168, "0100000000000000");
    frame(VEHICLE, 11, 0x168, "0800000000000000");
    TEST_ASSERT_EQUAL(1, row_of(AI, 0x168)->data[0]);
    TEST_ASSERT_EQUAL(8, row_of(VEHICLE, 0x168)->data[0]);
    TEST_ASSERT_EQUAL_STRING("ai", monitor_sender(monitor, row_of(AI, 0x168)));
    TEST_ASSERT_EQUAL_STRING("supervisor", monitor_sender(monitor, row_of(VEHICLE, 0x168)));
}

void test_what_a_gateway_repeats_on_the_ai_side_is_nothing_unknown(void) {
    end();
    begin(true, false);
    frame(AI, 10, 0x363, MANUAL);
    frame(AI, 11, 0x7F0, "0FFF000000000000");
    TEST_ASSERT_EQUAL(0, monitor->other_count);
    TEST_ASSERT_EQUAL(0, row_of(VEHICLE, 0x363)->count);
    TEST_ASSERT_EQUAL(MONITOR_NO_SOURCE, monitor->supervisor.source);
}

void test_rate_over_the_last_second(void) {
    for (unsigned ms = 0; ms <= 2400; ms += 10) {
        frame(VEHICLE, ms, 0x363, MANUAL);
    }
    const monitor_row_t *row = row_of(VEHICLE, 0x363);
    TEST_ASSERT_UINT_WITHIN(2, 100, monitor_rate(monitor, row->count, row->counts));
    wait_until(4000);
    TEST_ASSERT_EQUAL(0, monitor_rate(monitor, row->count, row->counts));
}

void test_links_and_losses(void) {
    monitor_link(monitor, HAL_CAN_VEHICLE, false, 1000);
    TEST_ASSERT_EQUAL(0, monitor_log_length(&monitor->log));
    monitor_link(monitor, HAL_CAN_VEHICLE, true, 2000);
    monitor_link(monitor, HAL_CAN_VEHICLE, true, 3000);
    monitor_link(monitor, HAL_CAN_VEHICLE, false, 4000);
    TEST_ASSERT_EQUAL(1, said("can0: the interface is down"));
    TEST_ASSERT_EQUAL(1, said("can0: the interface is up again"));
    for (unsigned i = 0; i < 10; i++) {
        monitor_lost(monitor, HAL_CAN_VEHICLE, 5, 10000 + i);
    }
    TEST_ASSERT_EQUAL(50, monitor->lost);
    TEST_ASSERT_EQUAL(1, said("can0: frames lost"));
}

void test_the_log_keeps_the_newest(void) {
    char text[20];
    for (unsigned i = 0; i < MONITOR_LOG_ENTRIES + 10; i++) {
        (void)snprintf(text, sizeof text, "entry %u", i);
        monitor_note(monitor, MONITOR_QUIET, "test", text);
    }
    TEST_ASSERT_EQUAL(MONITOR_LOG_ENTRIES, monitor_log_length(&monitor->log));
    TEST_ASSERT_EQUAL_STRING("entry 1009", monitor_log_back(&monitor->log, 0)->text);
    TEST_ASSERT_EQUAL_STRING("entry 10", monitor_log_back(&monitor->log, 999)->text);
    TEST_ASSERT_NULL(monitor_log_back(&monitor->log, 1000));
}
