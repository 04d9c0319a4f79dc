/*
 * The codec, both ways, for each of the 11 messages: bytes -> values -> bytes, and values -> bytes -> values, against a
 * second implementation of docs/protocol.md: places of the fields, byte order, reserved bits, ranges.
 *
 * Byte 1: the message; then 8 bytes of payload, or values if bit 7 of byte 1 is set.
 */
#include <stdio.h>
#include <stdlib.h>

#include "agv/codec.h"
#include "input.h"
#include "traffic.h"

/* The fields of a message as numbers, in the order of codec.h. */
enum { FIELDS_MAX = 10, MESSAGES = TRAFFIC_MESSAGES };

typedef int64_t values_t[FIELDS_MAX];

/* Bit `first` of byte `byte` (1..8) on, `bits` of them; or bytes `byte` on, low or high byte first. */
typedef struct {
    uint8_t byte;
    uint8_t first;
    uint8_t bits;
    char order; /* 'l' low byte first, 'h' high byte first */
    bool is_signed;
    bool inverted;
    int32_t factor; /* of a count */
    int32_t offset;
    int64_t lowest; /* after factor and offset; the valid range */
    int64_t highest;
} field_t;

#define FLAG(byte, bit) {byte, bit, 1, 'l', false, false, 1, 0, 0, 1}
#define NUMBER(byte, bits, order) {byte, 1, bits, order, false, false, 1, 0, 0, UINT16_MAX}
#define ANGLE(byte) {byte, 1, 16, 'l', false, false, 1, -9000, -9000, 9000}
#define PERMILLE {1, 1, 8, 'l', false, false, 4, 0, 0, 1000}
#define WHEEL(byte) {byte, 1, 32, 'l', true, false, 1, 0, INT32_MIN, INT32_MAX}

static const field_t FIELDS[MESSAGES][FIELDS_MAX] = {
    {FLAG(5, 5), FLAG(5, 6), FLAG(5, 7), {5, 8, 1, 'l', false, true, 1, 0, 0, 1}, NUMBER(8, 8, 'l')}, /* 43Fh */
    {NUMBER(1, 8, 'l')},                                                                              /* 168h */
    {PERMILLE},                                                                                       /* 075h */
    {ANGLE(1)},                                                                                       /* 065h */
    {NUMBER(1, 16, 'l'), NUMBER(5, 8, 'l'), NUMBER(6, 8, 'l'), FLAG(7, 1), FLAG(7, 2), FLAG(7, 5), FLAG(7, 6),
     FLAG(7, 7), FLAG(7, 8), NUMBER(8, 8, 'l')},                                              /* 363h */
    {NUMBER(1, 8, 'l')},                                                                      /* 0A3h */
    {PERMILLE},                                                                               /* 050h */
    {NUMBER(1, 8, 'l'), NUMBER(2, 8, 'l'), ANGLE(3), NUMBER(5, 16, 'l'), NUMBER(7, 16, 'l')}, /* 067h */
    {NUMBER(4, 8, 'l'), NUMBER(8, 8, 'l')},                                                   /* 167h */
    {NUMBER(1, 16, 'h'), NUMBER(3, 16, 'h'), NUMBER(5, 16, 'h')},                             /* 267h */
    {WHEEL(1), WHEEL(5)},                                                                     /* 101h */
};

/* Bits that are not reserved. */
static const uint8_t USED[MESSAGES][8] = {
    {0, 0, 0, 0, 0xF0, 0, 0, 0xFF},
    {0xFF},
    {0xFF},
    {0xFF, 0xFF},
    {0xFF, 0xFF, 0, 0, 0xBB, 0xFF, 0xF3, 0xFF},
    {0xFF},
    {0xFF},
    {0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF},
    {0, 0, 0, 0xFF, 0, 0, 0, 0xFF},
    {0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0, 0},
    {0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF},
};

/* ---- The codec, by number ---- */

/* One function for each message: values to bytes if `pack`, otherwise bytes to values. @return the result of the
 * codec */
#define BOTH_WAYS(name, type, to_struct, to_values)                                                                    \
    static bool name(bool pack, uint8_t data[8], values_t v) {                                                         \
        agv_##type##_t s;                                                                                              \
        if (pack) {                                                                                                    \
            memset(&s, 0, sizeof s);                                                                                   \
            to_struct;                                                                                                 \
            return agv_pack_##type(data, &s);                                                                          \
        }                                                                                                              \
        const bool valid = agv_unpack_##type(&s, data);                                                                \
        to_values;                                                                                                     \
        return valid;                                                                                                  \
    }

BOTH_WAYS(signals, turn_signal_command,
          (s.turn_left_on = v[0] != 0, s.turn_right_on = v[1] != 0, s.autopilot_off = v[2] != 0,
           s.headlight_on = v[3] != 0, s.alive_counter = (uint8_t)v[4]),
          (v[0] = s.turn_left_on, v[1] = s.turn_right_on, v[2] = s.autopilot_off, v[3] = s.headlight_on,
           v[4] = s.alive_counter))
BOTH_WAYS(gear, gear_command, s.gear = (uint8_t)v[0], v[0] = s.gear)
BOTH_WAYS(throttle, throttle_command, s.throttle_permille = (uint16_t)v[0], v[0] = s.throttle_permille)
BOTH_WAYS(steering, steering_command, s.angle_ddeg = (int32_t)v[0], v[0] = s.angle_ddeg)
BOTH_WAYS(vehicle, vehicle_status,
          (s.speed_m_per_h = (uint16_t)v[0], s.level1_alarms = (uint8_t)v[1], s.level2_alarms = (uint8_t)v[2],
           s.button_1 = v[3] != 0, s.button_2 = v[4] != 0, s.turn_left_on = v[5] != 0, s.turn_right_on = v[6] != 0,
           s.manual_mode = v[7] != 0, s.autopilot_mode = v[8] != 0, s.alive_counter = (uint8_t)v[9]),
          (v[0] = s.speed_m_per_h, v[1] = s.level1_alarms, v[2] = s.level2_alarms, v[3] = s.button_1, v[4] = s.button_2,
           v[5] = s.turn_left_on, v[6] = s.turn_right_on, v[7] = s.manual_mode, v[8] = s.autopilot_mode,
           v[9] = s.alive_counter))
BOTH_WAYS(gear_s, gear_status, s.gear = (uint8_t)v[0], v[0] = s.gear)
BOTH_WAYS(throttle_s, throttle_status, s.throttle_permille = (uint16_t)v[0], v[0] = s.throttle_permille)
BOTH_WAYS(steering_s, steering_status,
          (s.alive_counter = (uint8_t)v[0], s.supply_pct_of_12v = (uint8_t)v[1], s.angle_ddeg = (int32_t)v[2],
           s.torque_raw = (uint16_t)v[3], s.speed_raw = (uint16_t)v[4]),
          (v[0] = s.alive_counter, v[1] = s.supply_pct_of_12v, v[2] = s.angle_ddeg, v[3] = s.torque_raw,
           v[4] = s.speed_raw))
BOTH_WAYS(eps, eps_status, (s.mode = (uint8_t)v[0], s.faults = (uint8_t)v[1]), (v[0] = s.mode, v[1] = s.faults))
BOTH_WAYS(position, steering_position,
          (s.centre_raw = (uint16_t)v[0], s.left_raw = (uint16_t)v[1], s.right_raw = (uint16_t)v[2]),
          (v[0] = s.centre_raw, v[1] = s.left_raw, v[2] = s.right_raw))
BOTH_WAYS(wheels, wheel_speed, (s.left_mm_s = (int32_t)v[0], s.right_mm_s = (int32_t)v[1]),
          (v[0] = s.left_mm_s, v[1] = s.right_mm_s))

typedef bool both_ways_fn(bool pack, uint8_t data[8], values_t v);
static both_ways_fn *const CODEC[MESSAGES] = {signals,    gear,       throttle, steering, vehicle, gear_s,
                                              throttle_s, steering_s, eps,      position, wheels};

/* ---- The second implementation ---- */

static int64_t read_by_hand(const field_t *field, const uint8_t data[8]) {
    const unsigned bytes = (field->bits + 7u) / 8u;
    uint64_t raw = 0;
    for (unsigned i = 0; i < bytes; i++) {
        const unsigned place = (field->order == 'l') ? (bytes - 1u - i) : i;
        raw = (raw << 8u) | data[field->byte - 1u + place];
    }
    if (field->bits < 8u) {
        raw = (raw >> (field->first - 1u)) & 1u;
        raw ^= field->inverted ? 1u : 0u;
    }
    int64_t value = (int64_t)raw;
    if (field->is_signed && (value > INT32_MAX)) {
        value -= 0x100000000;
    }
    return (value * field->factor) + field->offset;
}

static bool valid_by_hand(unsigned message, const values_t v) {
    for (unsigned i = 0; (i < FIELDS_MAX) && (FIELDS[message][i].bits != 0u); i++) {
        if ((v[i] < FIELDS[message][i].lowest) || (v[i] > FIELDS[message][i].highest)) {
            return false;
        }
    }
    if ((message == M_GEAR) || (message == M_GEAR_STATUS)) {
        return (v[0] == 8) || (v[0] == 2) || (v[0] == 4) || (v[0] == 1);
    }
    if (message == M_EPS_STATUS) {
        return ((v[0] >= 0) && (v[0] <= 3)) || (v[0] == 0xFF);
    }
    return true;
}

static void fail(unsigned message, const char *what) {
    (void)fprintf(stderr, "codec, message %u: %s\n", message, what);
    abort();
}

/* The values after packing: rounded to the steps of the message, without reserved alarm bits. */
static void round_down(unsigned message, values_t v) {
    if ((message == M_THROTTLE) || (message == M_THROTTLE_STATUS)) {
        v[0] -= v[0] % 4;
    }
    if (message == M_VEHICLE) {
        v[1] &= 0xBB;
    }
}

static void compare(unsigned message, const values_t a, const values_t b, const char *what) {
    for (unsigned i = 0; (i < FIELDS_MAX) && (FIELDS[message][i].bits != 0u); i++) {
        if (a[i] != b[i]) {
            fail(message, what);
        }
    }
}

static void check_bytes(unsigned message, uint8_t data[8]) {
    values_t by_codec = {0};
    values_t by_hand = {0};
    uint8_t again[8];
    for (unsigned i = 0; (i < FIELDS_MAX) && (FIELDS[message][i].bits != 0u); i++) {
        by_hand[i] = read_by_hand(&FIELDS[message][i], data);
    }
    if (message == M_VEHICLE) {
        by_hand[1] &= 0xBB;
    }
    const bool valid = CODEC[message](false, data, by_codec);
    compare(message, by_codec, by_hand, "unpacked otherwise than by hand");
    if ((valid != valid_by_hand(message, by_hand)) || (valid != agv_value_is_valid(message, data))) {
        fail(message, "valid and by hand invalid, or the other way round");
    }
    memset(again, 0x5A, sizeof again);
    if (CODEC[message](true, again, by_codec) != valid) {
        fail(message, "packs what it does not unpack, or the other way round");
    }
    for (unsigned i = 0; i < 8u; i++) {
        if (again[i] != (valid ? (data[i] & USED[message][i]) : 0x5Au)) {
            fail(message, "bytes -> values -> bytes gives other bytes");
        }
    }
}

static void check_values(unsigned message, input_t *input) {
    values_t in = {0};
    values_t out = {0};
    uint8_t data[8];
    for (unsigned i = 0; (i < FIELDS_MAX) && (FIELDS[message][i].bits != 0u); i++) {
        const field_t *field = &FIELDS[message][i];
        const uint32_t low = input_word(input);
        const bool wide = (field->bits == 32u) || (field->offset != 0);
        in[i] = wide ? (int32_t)(low | ((uint32_t)input_word(input) << 16u)) : (int64_t)low;
        in[i] = ((field->bits == 8u) && (field->factor == 1)) ? (in[i] & 0xFF) : in[i];
        in[i] = (field->bits == 1u) ? (in[i] & 1) : in[i];
    }
    memset(data, 0x5A, sizeof data);
    const bool packed = CODEC[message](true, data, in);
    if (packed != valid_by_hand(message, in)) {
        fail(message, "packs what is out of range, or does not pack what is in it");
    }
    if (!packed) {
        for (unsigned i = 0; i < 8u; i++) {
            if (data[i] != 0x5Au) {
                fail(message, "touches the bytes though it refuses");
            }
        }
        return;
    }
    if (!CODEC[message](false, data, out)) {
        fail(message, "does not unpack what it packed");
    }
    round_down(message, in);
    compare(message, in, out, "values -> bytes -> values gives other values");
    check_bytes(message, data);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    input_t input = {.at = data, .left = size};
    const uint8_t which = input_byte(&input);
    const unsigned message = (which & 0x7Fu) % MESSAGES;
    uint8_t bytes[8];
    if ((which & 0x80u) != 0u) {
        check_values(message, &input);
    } else {
        input_bytes(&input, bytes, sizeof bytes);
        check_bytes(message, bytes);
    }
    return 0;
}
