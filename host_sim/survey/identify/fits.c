#include "survey/identify/fits.h"

#include <stddef.h>
#include <stdlib.h>

#include "agv/codec.h"
#include "traffic/signals.h"

enum { WHEEL_MAX_MM_S = 30000, WHEEL_APART_MM_S = 3000, MODE_AT = 6 };

/** The bits of each message that are not reserved; filled in once. */
static struct {
    bool made;
    uint8_t of[AGV_MSG_COUNT][AGV_DLC];
} masks;

static bool has_reserved_bits(uint32_t message, const uint8_t data[AGV_DLC]) {
    for (uint32_t i = 0; !masks.made && (i < AGV_MSG_COUNT); i++) {
        signals_mask(i, masks.of[i]);
    }
    masks.made = true;
    uint32_t reserved = 0;
    for (size_t i = 0; i < AGV_DLC; i++) {
        reserved |= (uint32_t)(data[i] & (uint8_t)~masks.of[message][i]);
    }
    return reserved != 0;
}

/** Two rear wheels turn about as fast, and no faster than a vehicle of this kind drives. */
static bool are_wheels(const uint8_t data[AGV_DLC]) {
    agv_wheel_speed_t wheels;
    (void)agv_unpack_wheel_speed(&wheels, data);
    return (wheels.left_mm_s > -WHEEL_MAX_MM_S) && (wheels.left_mm_s < WHEEL_MAX_MM_S) &&
           (wheels.right_mm_s > -WHEEL_MAX_MM_S) && (wheels.right_mm_s < WHEEL_MAX_MM_S) &&
           (abs(wheels.left_mm_s - wheels.right_mm_s) < WHEEL_APART_MM_S);
}

/** The centre lies between left and right, or nothing was measured yet. */
static bool are_positions(const uint8_t data[AGV_DLC]) {
    agv_steering_position_t position;
    (void)agv_unpack_steering_position(&position, data);
    const bool is_empty = (position.left_raw == 0) && (position.centre_raw == 0) && (position.right_raw == 0);
    return is_empty || ((position.left_raw < position.centre_raw) && (position.centre_raw < position.right_raw)) ||
           ((position.left_raw > position.centre_raw) && (position.centre_raw > position.right_raw));
}

bool fits_protocol(uint32_t message, const uint8_t data[AGV_DLC]) {
    const bool has_mode = (data[MODE_AT] & (AGV_VCU_FLAG_MANUAL | AGV_VCU_FLAG_AUTOPILOT)) != 0;
    return !has_reserved_bits(message, data) && agv_value_is_valid(message, data) &&
           (has_mode || (message != AGV_MSG_VEHICLE_STATUS));
}

static bool is_plausible(uint32_t message, const uint8_t data[AGV_DLC]) {
    if (!fits_protocol(message, data)) {
        return false;
    }
    switch (message) {
    case AGV_MSG_WHEEL_SPEED:
        return are_wheels(data);
    case AGV_MSG_STEERING_POSITION:
        return are_positions(data);
    default:
        return true;
    }
}

uint32_t fits_frame(uint32_t fits, const uint8_t data[AGV_DLC]) {
    uint32_t left = fits;
    for (uint32_t message = 0; message < AGV_MSG_COUNT; message++) {
        const uint32_t bit = agv_message_bit(message);
        if (((left & bit) != 0) && !is_plausible(message, data)) {
            left &= ~bit;
        }
    }
    return left;
}
