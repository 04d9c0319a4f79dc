/* Common start of the tests of the gateway: one fixture with that topology, and the commands of the AI computer. Included by
 * the test itself. */
#ifndef ONE_GATEWAY_H
#define ONE_GATEWAY_H

#include <string.h>

#include "expect.h"
#include "fixture.h"
#include "unity.h"
#include "walk.h"

static fixture_t f;

void setUp(void) {
    fixture_init(&f);
    f.config.topology = AGV_TOPOLOGY_GATEWAY;
}

static inline void from_ai(uint32_t id, const uint8_t data[8]) {
    hal_can_frame_t frame = {.id = id, .length = 8};
    memcpy(frame.data, data, 8);
    fixture_forget_sent(&f);
    fixture_raw(&f, HAL_CAN_AI, frame);
}

/* Exactly this frame was sent in this call, to that side. */
static inline void expect_passed(hal_can_side_t side, uint32_t id, const uint8_t expected[8]) {
    TEST_ASSERT_EQUAL_UINT32(1, f.sent_count);
    TEST_ASSERT_EQUAL_UINT32(f.call, f.sent[0].call);
    TEST_ASSERT_EQUAL_INT(side, f.sent[0].side);
    TEST_ASSERT_EQUAL_HEX32(id, f.sent[0].id);
    TEST_ASSERT_EQUAL_UINT8(8, f.sent[0].length);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(expected, f.sent[0].data, 8);
}

/* A command of the AI computer is forwarded in the same call, with these bytes. */
static inline void expect_pass(uint32_t id, const uint8_t command[8], const uint8_t expected[8]) {
    from_ai(id, command);
    expect_passed(HAL_CAN_VEHICLE, id, expected);
}

/* The log has one frame with this identifier, and it has these bytes. */
static inline void expect_sent_once(uint32_t id, const uint8_t expected[8]) {
    TEST_ASSERT_EQUAL_UINT32(1, fixture_count_sent(&f, id));
    TEST_ASSERT_EQUAL_HEX8_ARRAY(expected, fixture_nth_sent(&f, id, 0)->data, 8);
}

static inline uint32_t dropped(void) {
    return agv_supervisor_counters(&f.supervisor)->dropped;
}

static inline void expect_dropped(uint32_t id, const uint8_t data[8]) {
    const uint32_t before = dropped();
    from_ai(id, data);
    expect_silence(&f);
    TEST_ASSERT_EQUAL_UINT32(before + 1, dropped());
}

/* Commands with every reserved bit set, and as they must be sent. */
static const uint8_t SIGNALS[8] = {0xFF, 0xFF, 0xFF, 0xFF, 0xAF, 0xFF, 0xFF, 0x5A};
static const uint8_t SIGNALS_PACKED[8] = {0, 0, 0, 0, 0xA0, 0, 0, 0x5A};
static const uint8_t DRIVE[8] = {1, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF};
static const uint8_t DRIVE_PACKED[8] = {1};
static const uint8_t THROTTLE[8] = {77, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF};
static const uint8_t THROTTLE_PACKED[8] = {77};
static const uint8_t ANGLE[8] = {0x34, 0x22, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF};
static const uint8_t ANGLE_PACKED[8] = {0x34, 0x22};
static const uint8_t ZERO[8] = {0};

static const uint8_t NO_GEAR[8] = {3};
static const uint8_t TOO_MUCH_THROTTLE[8] = {251};
static const uint8_t TOO_MUCH_ANGLE[8] = {0x51, 0x46}; /* 18001 */

/* Silent for longer than half of each cycle: the next frame of each command passes at once. */
static inline void pause_ai(void) {
    fixture_mute_ai(&f, true);
    fixture_run(&f, 60);
}

/* The third 363h without bit 8 ends the engagement. */
static inline void disengage(void) {
    walk_disengage(&f);
    expect_state(&f, AGV_STATE_STANDBY);
}

#endif
