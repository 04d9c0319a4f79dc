/* Common start of the tests of the transmitter: one transmitter, in TRIPPED on a shared bus, and the frames that the HAL
 * accepted. Included by the test itself. */
#ifndef ONE_TRANSMITTER_H
#define ONE_TRANSMITTER_H

#include "transmit/transmitter.h"

#include <string.h>

#include "mock_can.h"
#include "unity.h"

/* The context of a port; the core never accesses its members. */
struct hal {
    int unused;
};
static hal_t hal;

static agv_transmitter_t transmitter;
static agv_timers_t timers;
static agv_config_t config;
static agv_ids_t ids;
static agv_tx_orders_t orders;

/* The frames that the HAL accepted. */
typedef struct {
    hal_can_side_t side;
    hal_can_frame_t frame;
} sent_t;
static sent_t sent[64];
static unsigned sent_count;
static bool hal_takes;

static inline bool send_stub(hal_t *port, hal_can_side_t side, const hal_can_frame_t *frame, int calls) {
    (void)calls;
    TEST_ASSERT_EQUAL_PTR(&hal, port);
    if (hal_takes) {
        TEST_ASSERT_TRUE(sent_count < sizeof sent / sizeof sent[0]);
        sent[sent_count++] = (sent_t){side, *frame};
    }
    return hal_takes;
}

/* TRIPPED, with an angle of +12.3 degrees held: 9123 = 23A3h. */
void setUp(void) {
    hal_can_send_Stub(send_stub);
    hal_takes = true;
    sent_count = 0;
    agv_config_defaults(&config);
    config.status_frame_id = 0; /* tested separately */
    agv_config_ids(&config, &ids);
    agv_timers_set_time(&timers, 1000);
    agv_timers_start(&timers);
    transmitter = (agv_transmitter_t){0};
    agv_transmitter_start(&transmitter, 1000);
    orders = (agv_tx_orders_t){.hal = &hal,
                               .config = &config,
                               .ids = &ids,
                               .timers = &timers,
                               .hold = {.raw = 9123, .check = 0xDC5C},
                               .state = AGV_STATE_TRIPPED,
                               .first_reason = AGV_FAULT_BUS_OFF,
                               .park_released = true,
                               .holdable = true,
                               .config_checksum = 0x12345678};
}

static inline void tick(uint32_t ms) {
    for (uint32_t i = 0; i < ms; i++) {
        agv_timers_advance(&timers, &config, timers.now_ms + 1, 0);
        agv_transmitter_tick(&transmitter, &orders);
    }
}

static inline void burst(void) {
    agv_transmitter_burst(&transmitter, &orders);
}

static inline void expect_sent(unsigned n, hal_can_side_t side, uint32_t id, const uint8_t data[8]) {
    TEST_ASSERT_TRUE(n < sent_count);
    TEST_ASSERT_EQUAL(side, sent[n].side);
    TEST_ASSERT_EQUAL_HEX32(id, sent[n].frame.id);
    TEST_ASSERT_EQUAL_UINT8(8, sent[n].frame.length);
    TEST_ASSERT_EQUAL_UINT8(0, sent[n].frame.flags);
    TEST_ASSERT_EQUAL_UINT32(timers.now_ms, sent[n].frame.time_ms);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(data, sent[n].frame.data, 8);
}

/* Whenever it was sent. */
static inline void expect_sent_data(unsigned n, uint32_t id, const uint8_t data[8]) {
    TEST_ASSERT_TRUE(n < sent_count);
    TEST_ASSERT_EQUAL_HEX32(id, sent[n].frame.id);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(data, sent[n].frame.data, 8);
}

static inline agv_tx_report_t report(void) {
    return agv_transmitter_take_report(&transmitter);
}

static inline void pass(unsigned message, const uint8_t data[8]) {
    agv_transmitter_pass(&transmitter, &orders, message, data);
}

static inline void answer(unsigned command, const uint8_t *data) {
    agv_transmitter_answer(&transmitter, &orders, command, data);
}

static inline void drop(unsigned command) {
    agv_transmitter_drop(&transmitter, &timers, command);
}

static inline void discard(hal_can_side_t side) {
    agv_transmitter_discard(&transmitter, &timers, side);
}

static inline void be_gateway(void) {
    config.topology = AGV_TOPOLOGY_GATEWAY;
    orders.state = AGV_STATE_ACTIVE;
}

/* After this many ticks, this many frames were sent since the start of the test; the transmitter is stalled or not. */
#define EXPECT_COUNT_AFTER(ms, count)                                                                                  \
    do {                                                                                                               \
        tick(ms);                                                                                                      \
        TEST_ASSERT_EQUAL_UINT(count, sent_count);                                                                     \
    } while (0)
#define EXPECT_STALLED_AFTER(ms, stalled)                                                                              \
    do {                                                                                                               \
        tick(ms);                                                                                                      \
        TEST_ASSERT_EQUAL(stalled, agv_transmitter_is_stalled(&timers));                                               \
    } while (0)

static const uint8_t SIGNALS[8] = {0, 0, 0, 0, 0x70};
static const uint8_t PARK[8] = {8};
static const uint8_t ZEROS[8] = {0};
static const uint8_t HELD[8] = {0xA3, 0x23};
static const uint8_t DRIVE[8] = {1};
static const uint8_t REVERSE[8] = {2};
static const uint8_t NEUTRAL[8] = {4};

#endif
