/* Statistics of what is on a bus: gaps, deadlines, counters, values, unknown identifiers. Times in microseconds. */
#include "traffic/traffic.h"

#include <string.h>

#include "agv/config.h"
#include "unity.h"

enum { MS = 1000 };

static agv_config_t config;
static traffic_t *traffic;

void setUp(void) {
    agv_config_defaults(&config);
    traffic = traffic_new(&config);
    TEST_ASSERT_NOT_NULL(traffic);
}

void tearDown(void) {
    traffic_free(traffic);
}

static void restart(void) {
    traffic_free(traffic);
    traffic = traffic_new(&config);
}

/* A frame of 8 bytes, given as one number, data[0] first. */
static void feed_on(hal_can_side_t side, uint64_t t_us, uint32_t id, uint64_t bytes) {
    hal_can_frame_t frame = {.id = id, .length = 8};
    for (unsigned i = 0; i < 8; i++) {
        frame.data[i] = (uint8_t)(bytes >> (8 * (7 - i)));
    }
    traffic_frame(traffic, side, &frame, t_us);
}

static void feed(uint64_t t_us, uint32_t id, uint64_t bytes) {
    feed_on(HAL_CAN_VEHICLE, t_us, id, bytes);
}

void test_gaps_and_margin_of_a_status_message(void) {
    feed(0, 0x050, 0);
    feed(10 * MS, 0x050, 0);
    feed(35 * MS, 0x050, 0);
    feed(45 * MS, 0x050, 0);
    traffic_end(traffic, 50 * MS);
    const traffic_id_t *entry = traffic_message(traffic, AGV_MSG_THROTTLE_STATUS);
    TEST_ASSERT_NOT_NULL(entry);
    TEST_ASSERT_EQUAL_UINT64(4, entry->count);
    TEST_ASSERT_EQUAL_UINT64(10 * MS, entry->gaps.shortest_us);
    TEST_ASSERT_EQUAL_UINT64(25 * MS, entry->gaps.longest_us);
    TEST_ASSERT_EQUAL_UINT32(60, entry->watch->deadline_ms);
    TEST_ASSERT_EQUAL_UINT64(25 * MS, entry->watch->gaps.longest_us);
    TEST_ASSERT_EQUAL_UINT64(0, entry->watch->late);
}

void test_a_late_message_and_one_that_ends(void) {
    feed(0, 0x050, 0);
    feed(61 * MS, 0x050, 0);
    feed(0, 0x101, 0);
    feed(0, 0x0A3, 0x0800000000000000);
    traffic_end(traffic, 100 * MS);
    TEST_ASSERT_EQUAL_UINT64(1, traffic_message(traffic, AGV_MSG_THROTTLE_STATUS)->watch->late);
    TEST_ASSERT_EQUAL_UINT64(60 * MS, traffic_message(traffic, AGV_MSG_THROTTLE_STATUS)->watch->late_at_us);
    TEST_ASSERT_EQUAL_UINT64(1, traffic_message(traffic, AGV_MSG_WHEEL_SPEED)->watch->late);
    TEST_ASSERT_EQUAL_UINT64(100 * MS, traffic_message(traffic, AGV_MSG_WHEEL_SPEED)->watch->gaps.longest_us);
    TEST_ASSERT_EQUAL_UINT64(0, traffic_message(traffic, AGV_MSG_GEAR_STATUS)->watch->late); /* 125 ms */
}

void test_a_gap_over_a_start_of_the_supervisor_is_none(void) {
    feed(0, 0x050, 0);
    feed(10 * MS, 0x050, 0);
    traffic_start(traffic, 500 * MS);
    feed(505 * MS, 0x050, 0);
    feed(515 * MS, 0x050, 0);
    traffic_end(traffic, 520 * MS);
    const traffic_id_t *entry = traffic_message(traffic, AGV_MSG_THROTTLE_STATUS);
    TEST_ASSERT_EQUAL_UINT64(10 * MS, entry->gaps.longest_us);
    TEST_ASSERT_EQUAL_UINT64(10 * MS, entry->watch->gaps.longest_us);
    TEST_ASSERT_EQUAL_UINT64(0, entry->watch->late);
}

/* 363h: autopilot at 100 ms, manual from 200 ms on; an engagement ends with the third frame without autopilot. */
static void feed_modes(uint64_t until_ms) {
    for (uint64_t ms = 0; ms <= until_ms; ms += 10) {
        const uint64_t mode = ((ms >= 100) && (ms < 200)) ? 0x8000u : 0x4000u;
        feed(ms * MS, 0x363, mode | (ms / 10));
    }
}

void test_commands_are_watched_while_engaged(void) {
    feed(0, 0x065, 0x2823000000000000);
    feed_modes(400);
    traffic_end(traffic, 400 * MS);
    const traffic_id_t *entry = traffic_message(traffic, AGV_MSG_STEERING_COMMAND);
    TEST_ASSERT_EQUAL_INT(TRAFFIC_ENGAGED, entry->watch->when);
    TEST_ASSERT_EQUAL_UINT64(0, entry->watch->late); /* silent from 100 to 220 ms; the deadline is 125 ms */
    TEST_ASSERT_EQUAL_UINT64(1, traffic_totals(traffic).engagements);
    TEST_ASSERT_EQUAL_UINT64(120 * MS, traffic_totals(traffic).engaged_us);
    config.steering_command_timeout_ms = 75;
    restart();
    feed(0, 0x065, 0x2823000000000000);
    feed_modes(400);
    traffic_end(traffic, 400 * MS);
    entry = traffic_message(traffic, AGV_MSG_STEERING_COMMAND);
    TEST_ASSERT_EQUAL_UINT64(1, entry->watch->late);
    TEST_ASSERT_EQUAL_UINT64(120 * MS, entry->watch->gaps.longest_us);
}

/* Autopilot from 1000 ms on; manual from 2000 to 2110 ms: the third 363h ends the engagement at 2020 ms, 100 ms before the next. */
void test_an_engagement_that_continues_another_is_the_same(void) {
    for (uint64_t ms = 1000; ms <= 3000; ms += 10) {
        feed(ms * MS, 0x363, (((ms >= 2000) && (ms < 2120)) ? 0x4000u : 0x8000u) | ((ms / 10) % 256));
        if ((ms <= 2000) || (ms >= 2180)) {
            feed(ms * MS, 0x065, 0x2823000000000000);
        }
    }
    traffic_end(traffic, 3000 * MS);
    const traffic_watch_t *watch = traffic_message(traffic, AGV_MSG_STEERING_COMMAND)->watch;
    TEST_ASSERT_EQUAL_UINT64(1, traffic_totals(traffic).engagements);
    TEST_ASSERT_EQUAL_UINT64(1900 * MS, traffic_totals(traffic).engaged_us);
    TEST_ASSERT_EQUAL_UINT64(180 * MS, watch->gaps.longest_us);
    TEST_ASSERT_EQUAL_UINT64(1, watch->late);
    TEST_ASSERT_EQUAL_UINT64(2125 * MS, watch->late_at_us);
}

/* The deadline of 363h is 50 ms. For 100 ms more the engagement could be continued. */
void test_an_engagement_ends_with_the_vcu(void) {
    for (uint64_t ms = 0; ms <= 100; ms += 10) {
        feed(ms * MS, 0x363, 0x8000 | (ms / 10));
    }
    feed(100 * MS, 0x168, 0x0800000000000000);
    feed(4990 * MS, 0x050, 0);
    feed(5000 * MS, 0x363, 0x8000 | 10); /* with the old counter */
    feed(5010 * MS, 0x168, 0x0800000000000000);
    traffic_end(traffic, 5020 * MS);
    TEST_ASSERT_EQUAL_UINT64(1, traffic_totals(traffic).engagements);
    TEST_ASSERT_EQUAL_UINT64(250 * MS, traffic_totals(traffic).engaged_us);
    TEST_ASSERT_EQUAL_UINT64(0, traffic_message(traffic, AGV_MSG_GEAR_COMMAND)->watch->late);
}

void test_an_invalid_command_restarts_no_deadline(void) {
    feed(0, 0x363, 0x8000);
    feed(10 * MS, 0x168, 0x0800000000000000);
    feed(20 * MS, 0x168, 0x0300000000000000);
    feed(30 * MS, 0x168, 0x0800000000000000);
    traffic_end(traffic, 30 * MS);
    const traffic_id_t *entry = traffic_message(traffic, AGV_MSG_GEAR_COMMAND);
    TEST_ASSERT_EQUAL_UINT64(10 * MS, entry->gaps.longest_us);
    TEST_ASSERT_EQUAL_UINT64(20 * MS, entry->watch->gaps.longest_us);
    TEST_ASSERT_EQUAL_UINT64(1, entry->ranges[0].invalid);
}

void test_a_heartbeat_is_a_changed_counter(void) {
    feed(0, 0x067, 0x0100000000000000);
    feed(10 * MS, 0x067, 0x0200000000000000);
    feed(20 * MS, 0x067, 0x0200000000000000);
    feed(70 * MS, 0x067, 0x0200000000000000);
    feed(80 * MS, 0x067, 0x0300000000000000);
    traffic_end(traffic, 80 * MS);
    const traffic_id_t *entry = traffic_message(traffic, AGV_MSG_STEERING_STATUS);
    TEST_ASSERT_EQUAL_UINT64(50 * MS, entry->gaps.longest_us);
    TEST_ASSERT_EQUAL_UINT64(70 * MS, entry->watch->gaps.longest_us);
    TEST_ASSERT_EQUAL_UINT64(1, entry->watch->late);
    TEST_ASSERT_EQUAL_UINT64(60 * MS, entry->counter->longest_us);
    TEST_ASSERT_EQUAL_UINT64(2, entry->counter->repeats);
}

static counter_kind_t kind_of_steps(uint8_t step, unsigned frames) {
    counter_use_t use = {0};
    for (unsigned i = 0; i < frames; i++) {
        counter_use_add(&use, (uint8_t)(i * step), i * 10 * MS);
    }
    return counter_use_kind(&use);
}

void test_how_counters_count(void) {
    TEST_ASSERT_EQUAL_INT(COUNTER_INCREMENTS, kind_of_steps(1, 600));
    TEST_ASSERT_EQUAL_INT(COUNTER_INCREMENTS, kind_of_steps(3, 600));
    TEST_ASSERT_EQUAL_INT(COUNTER_ANY, kind_of_steps(4, 600));
    TEST_ASSERT_EQUAL_INT(COUNTER_ANY, kind_of_steps(255, 600));
    TEST_ASSERT_EQUAL_INT(COUNTER_STUCK, kind_of_steps(0, 600));
    TEST_ASSERT_EQUAL_INT(COUNTER_UNSEEN, kind_of_steps(1, 19));
    TEST_ASSERT_EQUAL_STRING("increments", counter_use_word(COUNTER_INCREMENTS));
    TEST_ASSERT_EQUAL_STRING("stuck", counter_use_word(COUNTER_STUCK));
}

void test_ranges_words_and_alarms(void) {
    feed(0, 0x0A3, 0x0800000000000000);
    feed(25 * MS, 0x0A3, 0x0100000000000000);
    feed(50 * MS, 0x0A3, 0x0700000000000000);
    feed(0, 0x167, 0x0000000100000000);
    feed(10 * MS, 0x167, 0x0000000100000040);
    traffic_end(traffic, 50 * MS);
    const traffic_range_t *gear = &traffic_message(traffic, AGV_MSG_GEAR_STATUS)->ranges[0];
    TEST_ASSERT_EQUAL_HEX32((1u << 8) | (1u << 1) | (1u << 7), gear->words[0]);
    TEST_ASSERT_EQUAL_UINT64(2, gear->valid);
    TEST_ASSERT_EQUAL_UINT64(1, gear->invalid);
    const traffic_id_t *eps = traffic_message(traffic, AGV_MSG_EPS_STATUS);
    for (size_t i = 0; i < signals_count(AGV_MSG_EPS_STATUS); i++) {
        if (signals_info(AGV_MSG_EPS_STATUS, i)->kind == SIGNAL_ALARM) {
            const bool is_encoder = strcmp(signals_info(AGV_MSG_EPS_STATUS, i)->name, "EPS_MOTOR_ENCODER") == 0;
            TEST_ASSERT_EQUAL_UINT64(is_encoder ? 1 : 0, eps->ranges[i].set);
        }
    }
}

void test_malformed_frames_are_counted_and_restart_nothing(void) {
    hal_can_frame_t frame = {.id = 0x101, .length = 7};
    feed(0, 0x101, 0);
    traffic_frame(traffic, HAL_CAN_VEHICLE, &frame, 10 * MS);
    frame = (hal_can_frame_t){.id = 0x101, .length = 8, .flags = HAL_CAN_FD};
    traffic_frame(traffic, HAL_CAN_VEHICLE, &frame, 20 * MS);
    frame = (hal_can_frame_t){.id = 0x101, .flags = HAL_CAN_REMOTE};
    traffic_frame(traffic, HAL_CAN_VEHICLE, &frame, 30 * MS);
    frame = (hal_can_frame_t){.id = 4, .flags = HAL_CAN_ERROR, .length = 8};
    traffic_frame(traffic, HAL_CAN_VEHICLE, &frame, 35 * MS);
    feed(40 * MS, 0x101, 0);
    traffic_end(traffic, 40 * MS);
    const traffic_id_t *entry = traffic_message(traffic, AGV_MSG_WHEEL_SPEED);
    TEST_ASSERT_EQUAL_UINT64(2, entry->count);
    TEST_ASSERT_EQUAL_UINT64(3, entry->malformed);
    TEST_ASSERT_EQUAL_UINT64(40 * MS, entry->gaps.longest_us);
    TEST_ASSERT_EQUAL_UINT64(1, traffic_totals(traffic).error);
}

void test_identifiers_in_their_order(void) {
    hal_can_frame_t frame = {.id = 0x123, .flags = HAL_CAN_EXTENDED, .length = 3};
    traffic_frame(traffic, HAL_CAN_VEHICLE, &frame, 0);
    feed(0, 0x7FF, 0);
    feed(0, 0x000, 0);
    feed(0, 0x7F0, 0x33FF010100000000);
    traffic_end(traffic, 0);
    TEST_ASSERT_EQUAL_HEX32(0x000, traffic_at(traffic, 0)->id);
    TEST_ASSERT_EQUAL_HEX32(TRAFFIC_UNKNOWN, traffic_at(traffic, 0)->message);
    TEST_ASSERT_EQUAL_HEX32(SIGNALS_STATUS_FRAME, traffic_at(traffic, 1)->message);
    TEST_ASSERT_EQUAL_HEX32(0x7FF, traffic_at(traffic, 2)->id);
    TEST_ASSERT_EQUAL_HEX32(0x123, traffic_at(traffic, 3)->id);
    TEST_ASSERT_TRUE(traffic_at(traffic, 3)->is_extended);
    TEST_ASSERT_NULL(traffic_at(traffic, 4));
    TEST_ASSERT_TRUE(traffic_heard(traffic, 0x7FF));
    TEST_ASSERT_FALSE(traffic_heard(traffic, 0x123));
}

void test_first_and_last_time_of_an_identifier(void) {
    uint64_t first_us = 0;
    uint64_t last_us = 0;
    feed_on(HAL_CAN_AI, 5 * MS, 0x067, 0);
    feed(7 * MS, 0x067, 0);
    feed_on(HAL_CAN_AI, 9 * MS, 0x067, 0);
    TEST_ASSERT_TRUE(traffic_times(traffic, 0x067, &first_us, &last_us));
    TEST_ASSERT_EQUAL_UINT64(5 * MS, first_us);
    TEST_ASSERT_EQUAL_UINT64(9 * MS, last_us);
    TEST_ASSERT_FALSE(traffic_times(traffic, 0x068, &first_us, &last_us));
    TEST_ASSERT_FALSE(traffic_times(traffic, 0x10000, &first_us, &last_us));
}

void test_a_gateway_hears_commands_on_the_ai_side(void) {
    config.topology = AGV_TOPOLOGY_GATEWAY;
    restart();
    feed(0, 0x168, 0x0800000000000000);
    TEST_ASSERT_NULL(traffic_message(traffic, AGV_MSG_GEAR_COMMAND));
    feed_on(HAL_CAN_AI, 0, 0x168, 0x0800000000000000);
    TEST_ASSERT_NOT_NULL(traffic_message(traffic, AGV_MSG_GEAR_COMMAND)->watch);
    traffic_end(traffic, 0);
    TEST_ASSERT_NULL(traffic_at(traffic, 0)->watch); /* of the vehicle side */
}

/* A flood of every identifier: memory stays bounded, and nothing is lost but the statistics of some. */
void test_every_identifier(void) {
    for (uint32_t id = 0; id <= 0x7FF; id++) {
        feed(0, id, 0);
        feed_on(HAL_CAN_AI, 0, id, 0);
    }
    for (uint32_t id = 0; id < 5000; id++) {
        const hal_can_frame_t frame = {.id = id * 0x1001u, .flags = HAL_CAN_EXTENDED, .length = 0};
        traffic_frame(traffic, HAL_CAN_VEHICLE, &frame, 0);
    }
    traffic_end(traffic, 0);
    TEST_ASSERT_EQUAL_UINT64(4096 + 5000, traffic_totals(traffic).data);
    TEST_ASSERT_EQUAL_UINT64(5000 - 512, traffic_totals(traffic).uncounted);
}

void test_messages_as_json(void) {
    feed(0, 0x0A3, 0x0800000000000000);
    feed(25 * MS, 0x0A3, 0x0800000000000000);
    feed(25 * MS, 0x123, 0);
    traffic_end(traffic, 25 * MS);
    json_t *array = traffic_messages_json(traffic);
    TEST_ASSERT_EQUAL_UINT(1, json_array_size(array));
    const json_t *message = json_array_get(array, 0);
    TEST_ASSERT_EQUAL_STRING("0A3", json_string_value(json_object_get(message, "id")));
    TEST_ASSERT_EQUAL_STRING("gear_status", json_string_value(json_object_get(message, "name")));
    TEST_ASSERT_EQUAL_INT(2, json_integer_value(json_object_get(message, "count")));
    TEST_ASSERT_EQUAL_INT(125, json_integer_value(json_object_get(message, "deadline_ms")));
    TEST_ASSERT_EQUAL_INT(100, (int)json_real_value(json_object_get(message, "margin_ms")));
    TEST_ASSERT_EQUAL_INT(25, (int)json_real_value(json_object_get(json_object_get(message, "gap_ms"), "max")));
    json_decref(array);
}
