/* A run over time: lanes, lines, gaps, what is kept around a trip, and that the memory stays bounded. */
#include "report/series.h"

#include <stdlib.h>
#include <string.h>

#include "agv/recorder.h"
#include "agv/state.h"
#include "unity.h"

enum { MS = 1000, S = 1000000 };

static agv_config_t config;
static series_t *series;
static json_t *result;

void setUp(void) {
    agv_config_defaults(&config);
    series = series_new(&config);
    result = NULL;
}

void tearDown(void) {
    json_decref(result);
    series_free(series);
}

static void receive(uint32_t id, uint64_t t_us, const uint8_t bytes[8]) {
    hal_can_frame_t frame = {.id = id, .length = 8};
    memcpy(frame.data, bytes, sizeof frame.data);
    series_frame(series, HAL_CAN_VEHICLE, &frame, t_us);
}

static void wheels(uint64_t t_us, uint8_t mm_s) {
    const uint8_t bytes[8] = {mm_s, 0, 0, 0, mm_s, 0, 0, 0};
    receive(0x101, t_us, bytes);
}

static void steering(uint64_t t_us, uint8_t counter) {
    const uint8_t bytes[8] = {counter, 100, 0x28, 0x23, 0, 0, 0, 0}; /* 9000: the centre */
    receive(0x067, t_us, bytes);
}

static void gear(uint64_t t_us, uint8_t code) {
    const uint8_t bytes[8] = {code};
    receive(0x0A3, t_us, bytes);
}

static void state(uint64_t t_ms, agv_state_t from, agv_state_t to, agv_fault_t reason) {
    const session_event_t event = {
        .t_ms = t_ms,
        .recorded = {.kind = AGV_EVENT_STATE, .a = (uint8_t)from, .b = (uint8_t)to, .c = (uint8_t)reason}};
    series_event(series, &event);
}

static void output(uint64_t t_ms, uint8_t closed) {
    const session_event_t event = {.t_ms = t_ms, .recorded = {.kind = AGV_EVENT_OUTPUT, .a = closed}};
    series_event(series, &event);
}

static void end(uint64_t t_us) {
    series_end(series, t_us);
    result = series_json(series);
}

/** What lies under the keys: "overview/signals/wheel_left/lo" */
static const json_t *at(const char *path) {
    char text[128];
    const json_t *value = result;
    strcpy(text, path);
    for (char *key = strtok(text, "/"); key != NULL; key = strtok(NULL, "/")) {
        value =
            json_is_array(value) ? json_array_get(value, (size_t)strtoul(key, NULL, 10)) : json_object_get(value, key);
    }
    return value;
}

static void is(const char *path, const char *expected) {
    char *text = json_dumps(at(path), JSON_COMPACT | JSON_ENCODE_ANY);
    TEST_ASSERT_NOT_NULL_MESSAGE(text, path);
    TEST_ASSERT_EQUAL_STRING_MESSAGE(expected, text, path);
    free(text);
}

void test_a_value_is_kept_where_it_changes(void) {
    wheels(10 * MS, 0);
    wheels(20 * MS, 0);
    wheels(30 * MS, 50);
    wheels(40 * MS, 50);
    wheels(50 * MS, 20);
    end(60 * MS);
    is("overview/step", "10");
    is("overview/signals/wheel_left/t", "[100,200,200]"); /* 10 ms, then 20 ms later, then 20 ms later */
    is("overview/signals/wheel_left/lo", "[0,50,20]");
    TEST_ASSERT_NULL(at("overview/signals/wheel_left/hi")); /* one value in every step */
    TEST_ASSERT_NULL(at("overview/signals/throttle_status"));
}

void test_a_signal_that_stays_away_is_lost_after_300_ms(void) {
    wheels(10 * MS, 7);
    wheels(1010 * MS, 7);
    end(1020 * MS);
    is("overview/signals/wheel_left/t", "[100,3000,7000]");
    is("overview/signals/wheel_left/lo", "[7,null,7]");
}

void test_a_lane_has_its_changes_and_when_it_was_lost(void) {
    gear(0, 8);
    gear(25 * MS, 8);
    gear(50 * MS, 1);
    gear(75 * MS, 0);
    end(500 * MS);
    is("lanes/gear/t", "[0,500,250,3000]");
    is("lanes/gear/v", "[\"P\",\"D\",\"00h\",null]");
}

void test_commands_of_the_supervisor_are_a_lane_of_their_own(void) {
    const uint8_t drive[8] = {1};
    const hal_can_frame_t park = {.id = 0x168, .length = 8, .data = {8}};
    receive(0x168, 0, drive);
    series_sent(series, HAL_CAN_VEHICLE, &park, 5 * MS);
    end(10 * MS);
    is("lanes/gear_command/v", "[\"D\"]");
    is("lanes/gear_sent/v", "[\"P\"]");
    is("messages/1/heard", "true");
    is("messages/1/name", "\"gear_command\"");
    is("messages/1/id", "\"168\"");
    is("messages/1/deadline", "350");
}

void test_a_gateway_takes_commands_from_the_ai_side_alone(void) {
    const uint8_t drive[8] = {1};
    hal_can_frame_t frame = {.id = 0x168, .length = 8, .data = {2}};
    config.topology = AGV_TOPOLOGY_GATEWAY;
    series_free(series);
    series = series_new(&config);
    receive(0x168, 0, drive);
    series_frame(series, HAL_CAN_AI, &frame, 1 * MS);
    end(10 * MS);
    is("lanes/gear_command/v", "[\"R\"]");
}

void test_frames_that_the_supervisor_rejects_count_for_nothing(void) {
    hal_can_frame_t frame = {.id = 0x101, .length = 7};
    series_frame(series, HAL_CAN_VEHICLE, &frame, 0);
    frame.length = 8;
    frame.flags = HAL_CAN_EXTENDED;
    series_frame(series, HAL_CAN_VEHICLE, &frame, 1 * MS);
    end(10 * MS);
    is("overview/signals", "{}");
    is("messages/10/heard", "false");
}

void test_the_longest_gap_of_each_step(void) {
    wheels(0, 1);
    wheels(10 * MS, 1);
    wheels(35 * MS, 1);
    end(40 * MS);
    is("overview/gaps/10/t", "[110,250,40]"); /* the ends of the steps of 1 ms; the last gap is open at the end */
    is("overview/gaps/10/gap", "[100,250,50]");
}

static void trip_at(uint64_t t_ms) {
    state(t_ms, AGV_STATE_ACTIVE, AGV_STATE_TRIPPED, AGV_FAULT_EPS_HEARTBEAT_STUCK);
}

void test_around_a_trip_a_frame_with_the_old_counter_is_marked(void) {
    steering(0, 1);
    steering(10 * MS, 2);
    steering(20 * MS, 2);
    steering(30 * MS, 2);
    trip_at(30);
    end(32 * MS);
    is("details/0/trip", "300");
    is("details/0/gaps/7/t", "[0,100,100,100,20]");
    is("details/0/gaps/7/gap", "[0,100,-100,-200,-220]");
    is("overview/gaps/7/gap", "[100,220]"); /* the open gap: the frames with the old counter ended none */
}

void test_8_s_before_and_6_s_after_a_trip_are_kept(void) {
    for (uint64_t t_ms = 0; t_ms <= 30000; t_ms += 10) {
        if (t_ms == 15000) {
            trip_at(t_ms);
        }
        wheels(t_ms * MS, (uint8_t)(t_ms / 1000));
    }
    end(30 * (uint64_t)S);
    size_t count = 0;
    const series_frame_t *frames = series_frames(series, 15 * S, &count);
    TEST_ASSERT_NOT_NULL(frames);
    TEST_ASSERT_EQUAL_UINT64(7 * S, frames[0].t_us);
    TEST_ASSERT_EQUAL_UINT64(21 * S, frames[count - 1].t_us);
    TEST_ASSERT_EQUAL(1401, count);
    TEST_ASSERT_NOT_NULL(series_frames(series, 16 * S, &count)); /* what follows the trip lies in it */
    TEST_ASSERT_NULL(series_frames(series, 14 * S, &count));
    TEST_ASSERT_EQUAL(0, count);
}

void test_trips_close_to_each_other_have_their_own_surroundings(void) {
    for (uint64_t t_ms = 0; t_ms <= 4000; t_ms += 10) {
        if ((t_ms == 1000) || (t_ms == 3000)) {
            trip_at(t_ms);
        }
        wheels(t_ms * MS, 1);
    }
    end(4 * S);
    size_t count = 0;
    TEST_ASSERT_NOT_NULL(series_frames(series, 1 * S, &count));
    TEST_ASSERT_EQUAL(401, count);
    TEST_ASSERT_NOT_NULL(series_frames(series, 3 * S, &count));
    TEST_ASSERT_EQUAL(401, count);
    TEST_ASSERT_EQUAL(2, json_array_size(at("details")));
}

void test_only_the_first_trips_keep_their_surroundings(void) {
    for (uint64_t trip = 1; trip <= SERIES_DETAILS_MAX + 3; trip++) {
        wheels(trip * 20 * S, 1);
        trip_at(trip * 20000);
    }
    end(1000 * (uint64_t)S);
    size_t count = 0;
    TEST_ASSERT_EQUAL(SERIES_DETAILS_MAX, json_array_size(at("details")));
    TEST_ASSERT_NULL(series_frames(series, 20 * (SERIES_DETAILS_MAX + 1) * (uint64_t)S, &count));
    TEST_ASSERT_EQUAL(SERIES_DETAILS_MAX + 3, json_array_size(at("lanes/state/t")));
}

void test_an_hour_has_no_more_steps_than_a_minute(void) {
    for (uint64_t t_ms = 0; t_ms <= 3600000; t_ms += 10) {
        wheels(t_ms * MS, (t_ms == 1800000) ? 99 : (uint8_t)(t_ms / 10 % 2));
    }
    end(3600 * (uint64_t)S);
    is("overview/step", "10240"); /* 1.024 s: 1 ms doubled ten times, 3516 steps */
    const json_t *lo = at("overview/signals/wheel_left/lo");
    const json_t *hi = at("overview/signals/wheel_left/hi");
    TEST_ASSERT_EQUAL(json_array_size(lo), json_array_size(hi));
    json_int_t highest = 0;
    for (size_t i = 0; i < json_array_size(hi); i++) {
        const json_int_t value = json_integer_value(json_array_get(hi, i));
        highest = (value > highest) ? value : highest;
    }
    TEST_ASSERT_EQUAL(99, highest); /* one frame of 360,000 is still seen */
    TEST_ASSERT_LESS_OR_EQUAL(SERIES_OVERVIEW_STEPS, json_array_size(at("overview/gaps/10/t")));
}

void test_changes_without_room_are_counted(void) {
    for (uint64_t i = 0; i < SERIES_CHANGES_MAX + 5; i++) {
        gear(i * 25 * MS, (i % 2 == 0) ? 1 : 4);
    }
    end((SERIES_CHANGES_MAX + 5) * 25 * (uint64_t)MS);
    is("left_out", "5");
    TEST_ASSERT_EQUAL(SERIES_CHANGES_MAX, json_array_size(at("lanes/gear/t")));
}

void test_a_fault_that_changes_too_often_leaves_room_for_others(void) {
    session_event_t event = {.is_left_out = true,
                             .recorded = {.kind = AGV_EVENT_FAULT, .a = AGV_FAULT_EPS_TEMP_ABOVE_110}};
    for (uint64_t i = 0; i < SERIES_CHANGES_MAX; i++) {
        event.t_ms = i * 10;
        event.recorded.c = (i % 2 == 0) ? 1 : 0;
        series_event(series, &event);
    }
    event.is_left_out = false;
    event.recorded.a = AGV_FAULT_BUS_OFF;
    series_event(series, &event);
    end(20 * (uint64_t)S);
    is("left_out", "512");
    TEST_ASSERT_EQUAL((SERIES_CHANGES_MAX / 2) + 1, json_array_size(at("faults")));
}

void test_when_the_output_opened_for_a_trip(void) {
    output(0, 0);
    output(500, 1);
    trip_at(1000);
    output(1500, 0);
    state(9000, AGV_STATE_SAFE, AGV_STATE_STANDBY, AGV_FAULT_NONE);
    output(9000, 1);
    trip_at(10000);
    state(12000, AGV_STATE_SAFE, AGV_STATE_STANDBY, AGV_FAULT_NONE);
    trip_at(20000);
    output(20000, 0);
    end(30 * (uint64_t)S);
    TEST_ASSERT_EQUAL_UINT64(1500 * MS, series_output_opened_us(series, 1000 * MS));
    TEST_ASSERT_EQUAL_UINT64(UINT64_MAX, series_output_opened_us(series, 10000 * (uint64_t)MS)); /* it stayed closed */
    TEST_ASSERT_EQUAL_UINT64(20000 * (uint64_t)MS, series_output_opened_us(series, 20000 * (uint64_t)MS));
}

void test_an_output_that_was_open_before_the_trip(void) {
    output(0, 0);
    state(0, AGV_STATE_INIT, AGV_STATE_TRIPPED, AGV_FAULT_OUTPUT_FEEDBACK);
    end(1 * (uint64_t)S);
    TEST_ASSERT_EQUAL_UINT64(0, series_output_opened_us(series, 0));
    TEST_ASSERT_EQUAL_UINT64(0, series_output_opened_us(series, 500 * MS));
}

void test_the_end_is_never_before_the_last_frame(void) {
    wheels(50 * MS, 1);
    end(40 * MS);
    TEST_ASSERT_EQUAL_UINT64(50 * MS, series_end_us(series));
    is("end", "500");
}

void test_a_run_without_anything(void) {
    end(0);
    is("end", "0");
    is("details", "[]");
    is("lanes/state/t", "[]");
}
