/* A vehicle on no bus: what it sends is kept in a log, and hears nothing but what a test says. */
#ifndef TESTS_VEHICLE_FIXTURE_H
#define TESTS_VEHICLE_FIXTURE_H

#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include "unity.h"
#include "vehicle/vehicle.h"

#define LOG_MAX 20000u

typedef struct {
    uint64_t t_ms;
    vehicle_node_t from;
    hal_can_side_t side;
    hal_can_frame_t frame;
} sent_t;

static sent_t sent[LOG_MAX];
static size_t sent_count;
static uint64_t now_ms;
static vehicle_config_t config;
static vehicle_t vehicle;
/* Whether the nodes hear each other, as on a bus without delay. */
static bool connected;

static void keep(void *ctx, vehicle_node_t from, hal_can_side_t side, const hal_can_frame_t *frame) {
    (void)ctx;
    TEST_ASSERT_LESS_THAN_size_t(LOG_MAX, sent_count);
    sent[sent_count] = (sent_t){now_ms, from, side, *frame};
    sent_count++;
}

static void begin(void) {
    sent_count = 0;
    now_ms = 0;
    vehicle_init(&vehicle, &config, keep, NULL);
}

static void deliver(size_t first) {
    for (size_t i = first; i < sent_count; i++) {
        for (int n = 0; n < VEHICLE_NODES; n++) {
            if (n != (int)sent[i].from) {
                vehicle_receive(&vehicle, (vehicle_node_t)n, now_ms, &sent[i].frame);
            }
        }
    }
}

/* Time passes up to, and without, a moment. */
static void run_until(uint64_t t_ms) {
    while (now_ms < t_ms) {
        const size_t first = sent_count;
        vehicle_tick(&vehicle, now_ms);
        if (connected) {
            deliver(first);
        }
        now_ms++;
    }
}

static bool act(vehicle_action_t action) {
    return vehicle_do(&vehicle, now_ms, &action);
}

/* Byte @p index of a message has the bits of @p mask as in @p value: in @p count frames, each @p every-th one (0: each). */
static inline void patch(agv_message_t message, unsigned index, uint8_t mask, uint8_t value, uint16_t count,
                         uint16_t every) {
    vehicle_action_t action = {.what = VEHICLE_DO_PATCH, .message = message, .count = count, .every = every};
    memset(action.keep, 0xFF, sizeof action.keep);
    action.keep[index] = (uint8_t)~mask;
    action.value[index] = value;
    TEST_ASSERT_TRUE(act(action));
}

static vehicle_view_t look(void) {
    vehicle_view_t view;
    vehicle_view(&vehicle, now_ms, &view);
    return view;
}

/* A command comes from the bus. */
static void command(agv_message_t message, uint8_t byte0, uint8_t byte1) {
    const hal_can_frame_t frame = {.id = config.ids.of[message], .length = AGV_DLC, .data = {byte0, byte1}};
    vehicle_receive(&vehicle, VEHICLE_VCU, now_ms, &frame);
    vehicle_receive(&vehicle, VEHICLE_EPS, now_ms, &frame);
}

/* Frames of a message sent since `first`. */
static size_t count_of(agv_message_t message, size_t first) {
    size_t count = 0;
    for (size_t i = first; i < sent_count; i++) {
        count += (sent[i].frame.id == config.ids.of[message]) ? 1 : 0;
    }
    return count;
}

/* The newest frame of a message. */
static const sent_t *last_of(agv_message_t message) {
    for (size_t i = sent_count; i > 0; i--) {
        if (sent[i - 1].frame.id == config.ids.of[message]) {
            return &sent[i - 1];
        }
    }
    TEST_FAIL_MESSAGE("no such frame was sent");
    return NULL;
}

/* What the newest 067h says. */
static inline int32_t measured_ddeg(void) {
    const uint8_t *data = last_of(AGV_MSG_STEERING_STATUS)->frame.data;
    return data[2] + (data[3] * 256) - 9000;
}

/* What is expected at a moment. */
static inline void expect_gear_at(uint64_t t_ms, uint8_t gear) {
    run_until(t_ms);
    TEST_ASSERT_EQUAL_HEX8(gear, look().gear);
}

static inline void expect_speed_at(uint64_t t_ms, int32_t speed_mm_s) {
    run_until(t_ms);
    TEST_ASSERT_EQUAL_INT32(speed_mm_s, look().speed_mm_s);
}

static inline void expect_throttle_at(uint64_t t_ms, uint16_t permille) {
    run_until(t_ms);
    TEST_ASSERT_EQUAL_UINT16(permille, look().throttle_permille);
}

/* A byte of the newest frame of a message. */
static inline void expect_byte_at(uint64_t t_ms, agv_message_t message, unsigned index, uint8_t value) {
    run_until(t_ms);
    TEST_ASSERT_EQUAL_HEX8(value, last_of(message)->frame.data[index]);
}

/* Frames of a message sent since `first`. */
static inline void expect_count_at(uint64_t t_ms, agv_message_t message, size_t first, size_t count) {
    run_until(t_ms);
    TEST_ASSERT_EQUAL_size_t(count, count_of(message, first));
}

#endif
