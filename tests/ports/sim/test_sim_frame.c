/* Length of a frame on the simulated bus, compared with numbers calculated by hand and with frames that are really
 * stuffed. */
#include "hal_sim/sim_bus.h"

#include "unity.h"

static uint32_t bits(uint8_t flags, uint8_t length) {
    const hal_can_frame_t frame = {.flags = flags, .length = length};
    return sim_bus_frame_bits(&frame);
}

/*
 * By hand, 11-bit identifier. n = 8: start 1 + identifier 11 + RTR 1 + IDE 1 + r0 1 + DLC 4 + data 64 + CRC 15 = 98 bits
 * that can be stuffed: the first five may be equal, then every fourth starts a new run: 97 / 4 = 24 stuff bits; CRC
 * delimiter 1 + acknowledge 2 + end 7 = 10 more: 98 + 24 + 10 = 132.
 */
void test_longest_standard_frames_as_worked_out_by_hand(void) {
    TEST_ASSERT_EQUAL_UINT32(34 + 8 + 10, bits(0, 0));     /* 33 / 4 =  8 */
    TEST_ASSERT_EQUAL_UINT32(42 + 10 + 10, bits(0, 1));    /* 41 / 4 = 10 */
    TEST_ASSERT_EQUAL_UINT32(50 + 12 + 10, bits(0, 2));    /* 49 / 4 = 12 */
    TEST_ASSERT_EQUAL_UINT32(58 + 14 + 10, bits(0, 3));    /* 57 / 4 = 14 */
    TEST_ASSERT_EQUAL_UINT32(66 + 16 + 10, bits(0, 4));    /* 65 / 4 = 16 */
    TEST_ASSERT_EQUAL_UINT32(74 + 18 + 10, bits(0, 5));    /* 73 / 4 = 18 */
    TEST_ASSERT_EQUAL_UINT32(82 + 20 + 10, bits(0, 6));    /* 81 / 4 = 20 */
    TEST_ASSERT_EQUAL_UINT32(90 + 22 + 10, bits(0, 7));    /* 89 / 4 = 22 */
    TEST_ASSERT_EQUAL_UINT32(132, bits(0, 8));             /* 97 / 4 = 24 */
    TEST_ASSERT_EQUAL_UINT32(52, bits(HAL_CAN_REMOTE, 8)); /* requests 8 bytes, carries none */
}

/* 29 bits: 20 more that can be stuffed (SRR 1 + identifier 18 + r1 1): 54 + 8n. */
void test_longest_extended_frames_as_worked_out_by_hand(void) {
    TEST_ASSERT_EQUAL_UINT32(54 + 13 + 10, bits(HAL_CAN_EXTENDED, 0));  /*  53 / 4 = 13 */
    TEST_ASSERT_EQUAL_UINT32(62 + 15 + 10, bits(HAL_CAN_EXTENDED, 1));  /*  61 / 4 = 15 */
    TEST_ASSERT_EQUAL_UINT32(86 + 21 + 10, bits(HAL_CAN_EXTENDED, 4));  /*  85 / 4 = 21 */
    TEST_ASSERT_EQUAL_UINT32(118 + 29 + 10, bits(HAL_CAN_EXTENDED, 8)); /* 117 / 4 = 29 */
    TEST_ASSERT_EQUAL_UINT32(77, bits(HAL_CAN_EXTENDED | HAL_CAN_REMOTE, 3));
}

/* The bits of a real frame, with stuff bits. */
typedef struct {
    uint32_t sent;
    uint32_t run;
    uint32_t crc;
    unsigned last;
} stuffer_t;

static void put_bit(stuffer_t *stuffer, unsigned bit) {
    stuffer->sent++;
    stuffer->run = bit == stuffer->last ? stuffer->run + 1 : 1;
    stuffer->last = bit;
    if (stuffer->run == 5) {
        stuffer->sent++;
        stuffer->run = 1;
        stuffer->last = 1 - bit;
    }
}

static void put_field(stuffer_t *stuffer, uint32_t value, unsigned width) {
    for (unsigned i = width; i-- > 0;) {
        const unsigned bit = value >> i & 1;
        const unsigned top = stuffer->crc >> 14 & 1;
        stuffer->crc = (stuffer->crc << 1 & 0x7FFFu) ^ (bit != top ? 0x4599u : 0);
        put_bit(stuffer, bit);
    }
}

static uint32_t actual_bits(const hal_can_frame_t *frame) {
    stuffer_t stuffer = {.last = 2};
    put_field(&stuffer, 0, 1);
    if ((frame->flags & HAL_CAN_EXTENDED) != 0) {
        put_field(&stuffer, frame->id >> 18, 11);
        put_field(&stuffer, 3, 2);
        put_field(&stuffer, frame->id & 0x3FFFFu, 18);
    } else {
        put_field(&stuffer, frame->id, 11);
    }
    put_field(&stuffer, 0, 3); /* RTR, IDE, r0 or RTR, r1, r0 */
    put_field(&stuffer, frame->length, 4);
    for (unsigned i = 0; i < frame->length; i++) {
        put_field(&stuffer, frame->data[i], 8);
    }
    for (uint32_t crc = stuffer.crc, i = 15; i-- > 0;) {
        put_bit(&stuffer, crc >> i & 1);
    }
    return stuffer.sent + 10;
}

static uint32_t next_random(uint32_t *state) {
    *state = *state * 1664525 + 1013904223;
    return *state >> 8;
}

static hal_can_frame_t random_frame(uint32_t *state) {
    static const uint8_t STUFFY[4] = {0x00, 0xFF, 0x87, 0xC3}; /* bytes with long runs of equal bits */
    hal_can_frame_t frame = {.length = (uint8_t)(next_random(state) % 9)};
    frame.flags = next_random(state) % 2 != 0 ? (uint8_t)HAL_CAN_EXTENDED : 0;
    frame.id = next_random(state) & (frame.flags != 0 ? 0x1FFFFFu : 0x7Fu);
    const bool stuffy = next_random(state) % 2 != 0;
    for (unsigned i = 0; i < frame.length; i++) {
        const uint32_t random = next_random(state);
        frame.data[i] = stuffy ? STUFFY[random % 4] : (uint8_t)random;
    }
    return frame;
}

/* No frame that was really stuffed is longer than the formula says, and some come within 3 bits of it. */
void test_no_real_frame_is_longer(void) {
    uint32_t state = 1;
    uint32_t closest = UINT32_MAX;
    for (unsigned i = 0; i < 200000; i++) {
        const hal_can_frame_t frame = random_frame(&state);
        const uint32_t longest = sim_bus_frame_bits(&frame);
        const uint32_t actual = actual_bits(&frame);
        TEST_ASSERT_TRUE(actual <= longest);
        closest = longest - actual < closest ? longest - actual : closest;
    }
    TEST_ASSERT_TRUE(closest <= 3);
}
