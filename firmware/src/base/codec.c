/**
 * @file codec.c
 * The payload of each of the 11 messages (docs/protocol.md, P2 to P14 and P18).
 *
 * It is fast and small, and does not depend on byte order or alignment:
 * - Words are built from bytes and taken apart into bytes with shifts. Compilers recognise these helpers as one load or
 *   one store where the processor allows it, and keep the bytes where it does not.
 * - A short message is built as one 64-bit value, so that its reserved bytes are cleared by the same store.
 * - Adjacent bits are built highest bit first (twice the value so far, plus the next bit).
 * - A range check is one unsigned comparison: what is below the range wraps to a large number.
 * - An unpack function stores every field before it checks them: bad values have no code path of their own.
 * bench/codec/run measures the figures and checks their limits.
 */
#include "agv/codec.h"

/* The alarm byte of 363h without its two reserved bits (P14). */
#define VCU_ALARM_MASK                                                                                                 \
    (AGV_VCU_ALARM_REMOTE_SIGNAL_LOST | AGV_VCU_ALARM_REMOTE_POWER_LOST | AGV_VCU_ALARM_AI_CAN_LOST |                  \
     AGV_VCU_ALARM_EPS_HARDWARE | AGV_VCU_ALARM_EPS_CAN_BUS | AGV_VCU_ALARM_S_DRIVER)

_Static_assert((0xFFFFu * AGV_VEHICLE_SPEED_M_PER_H_PER_COUNT) <= UINT16_MAX,
               "speed_m_per_h must hold every count in this unit: widen it first");

static inline void put_le16(uint8_t *to, uint32_t value) {
    to[0] = (uint8_t)(value & 0xFFu);
    to[1] = (uint8_t)((value >> 8) & 0xFFu);
}

static inline void put_be16(uint8_t *to, uint32_t value) {
    to[0] = (uint8_t)((value >> 8) & 0xFFu);
    to[1] = (uint8_t)(value & 0xFFu);
}

static inline void put_le32(uint8_t *to, uint32_t value) {
    to[0] = (uint8_t)(value & 0xFFu);
    to[1] = (uint8_t)((value >> 8) & 0xFFu);
    to[2] = (uint8_t)((value >> 16) & 0xFFu);
    to[3] = (uint8_t)((value >> 24) & 0xFFu);
}

static inline void put_le64(uint8_t *to, uint64_t value) {
    to[0] = (uint8_t)(value & 0xFFu);
    to[1] = (uint8_t)((value >> 8) & 0xFFu);
    to[2] = (uint8_t)((value >> 16) & 0xFFu);
    to[3] = (uint8_t)((value >> 24) & 0xFFu);
    to[4] = (uint8_t)((value >> 32) & 0xFFu);
    to[5] = (uint8_t)((value >> 40) & 0xFFu);
    to[6] = (uint8_t)((value >> 48) & 0xFFu);
    to[7] = (uint8_t)((value >> 56) & 0xFFu);
}

static inline uint16_t get_le16(const uint8_t *from) {
    return (uint16_t)((uint32_t)from[0] | ((uint32_t)from[1] << 8));
}

static inline uint16_t get_be16(const uint8_t *from) {
    return (uint16_t)(((uint32_t)from[0] << 8) | (uint32_t)from[1]);
}

static inline uint32_t get_le32(const uint8_t *from) {
    return (uint32_t)from[0] | ((uint32_t)from[1] << 8) | ((uint32_t)from[2] << 16) | ((uint32_t)from[3] << 24);
}

/** Two's complement to int32_t, without an implementation-defined conversion. Compilers generate no code for it. */
static inline int32_t to_int32(uint32_t value) {
    return (value <= (uint32_t)INT32_MAX) ? (int32_t)value : (int32_t)(value - (uint32_t)INT32_MIN) + INT32_MIN;
}

/** 1, 2, 4 or 8 (P2): in 1..8, and a single bit. */
static inline bool gear_is_valid(uint32_t gear) {
    return ((gear - 1u) < 8u) && ((gear & (gear - 1u)) == 0u);
}

/** FFh, 0, 1, 2 or 3 (P18): five consecutive values in 8-bit arithmetic. */
static inline bool eps_mode_is_valid(uint8_t mode) {
    return (uint8_t)(mode + 1u) <= (uint8_t)(AGV_EPS_MODE_TORQUE + 1);
}

/** The raw angle; above AGV_ANGLE_RAW_MAX if @p angle_ddeg is out of range (P5). */
static inline uint32_t angle_to_raw(int32_t angle_ddeg) {
    return (uint32_t)angle_ddeg + (uint32_t)AGV_ANGLE_RAW_CENTRE;
}

static inline bool pack_gear(uint8_t *data, uint32_t gear) {
    if (!gear_is_valid(gear)) {
        return false;
    }
    put_le64(data, gear);
    return true;
}

static inline bool pack_throttle(uint8_t *data, uint32_t permille) {
    if (permille > AGV_THROTTLE_MAX_PERMILLE) {
        return false;
    }
    put_le64(data, permille / AGV_THROTTLE_PERMILLE_PER_COUNT);
    return true;
}

/* 43Fh */
bool agv_pack_turn_signal_command(uint8_t data[AGV_DLC], const agv_turn_signal_command_t *in) {
    uint32_t flags = in->headlight_on ? 0u : 1u;

    flags = (flags * 2u) + in->autopilot_off;
    flags = (flags * 2u) + in->turn_right_on;
    flags = (flags * 2u) + in->turn_left_on;
    put_le64(data, ((uint64_t)flags << 36) | ((uint64_t)in->alive_counter << 56));
    return true;
}

bool agv_unpack_turn_signal_command(agv_turn_signal_command_t *out, const uint8_t data[AGV_DLC]) {
    const uint32_t flags = data[4];

    out->alive_counter = data[7];
    out->turn_left_on = (flags & AGV_SIGNAL_LEFT) != 0u;
    out->turn_right_on = (flags & AGV_SIGNAL_RIGHT) != 0u;
    out->autopilot_off = (flags & AGV_SIGNAL_AUTOPILOT_OFF) != 0u;
    out->headlight_on = (flags & AGV_SIGNAL_HEADLIGHT_OFF) == 0u;
    return true;
}

/* 168h */
bool agv_pack_gear_command(uint8_t data[AGV_DLC], const agv_gear_command_t *in) {
    return pack_gear(data, in->gear);
}

bool agv_unpack_gear_command(agv_gear_command_t *out, const uint8_t data[AGV_DLC]) {
    out->gear = data[0];
    return gear_is_valid(out->gear);
}

/* 075h */
bool agv_pack_throttle_command(uint8_t data[AGV_DLC], const agv_throttle_command_t *in) {
    return pack_throttle(data, in->throttle_permille);
}

bool agv_unpack_throttle_command(agv_throttle_command_t *out, const uint8_t data[AGV_DLC]) {
    const uint32_t counts = data[0];

    out->throttle_permille = (uint16_t)(counts * AGV_THROTTLE_PERMILLE_PER_COUNT);
    return counts <= AGV_THROTTLE_MAX_COUNTS;
}

/* 065h */
bool agv_pack_steering_command(uint8_t data[AGV_DLC], const agv_steering_command_t *in) {
    const uint32_t raw = angle_to_raw(in->angle_ddeg);

    if (raw > (uint32_t)AGV_ANGLE_RAW_MAX) {
        return false;
    }
    put_le64(data, raw);
    return true;
}

bool agv_unpack_steering_command(agv_steering_command_t *out, const uint8_t data[AGV_DLC]) {
    const int32_t raw = get_le16(data);

    out->angle_ddeg = raw - AGV_ANGLE_RAW_CENTRE;
    return raw <= AGV_ANGLE_RAW_MAX;
}

/* 363h */
bool agv_pack_vehicle_status(uint8_t data[AGV_DLC], const agv_vehicle_status_t *in) {
    uint32_t flags = in->autopilot_mode;
    uint32_t buttons = in->button_2;

    flags = (flags * 2u) + in->manual_mode;
    flags = (flags * 2u) + in->turn_right_on;
    flags = (flags * 2u) + in->turn_left_on;
    buttons = (buttons * 2u) + in->button_1;
    flags = (flags << 4) | buttons;
    put_le32(&data[0], in->speed_m_per_h / AGV_VEHICLE_SPEED_M_PER_H_PER_COUNT); /* the two reserved bytes as 0 */
    data[4] = (uint8_t)(in->level1_alarms & VCU_ALARM_MASK);
    data[5] = in->level2_alarms;
    data[6] = (uint8_t)flags;
    data[7] = in->alive_counter;
    return true;
}

bool agv_unpack_vehicle_status(agv_vehicle_status_t *out, const uint8_t data[AGV_DLC]) {
    const uint32_t flags = data[6];

    out->alive_counter = data[7];
    out->speed_m_per_h = (uint16_t)(get_le16(&data[0]) * AGV_VEHICLE_SPEED_M_PER_H_PER_COUNT);
    out->level1_alarms = (uint8_t)(data[4] & VCU_ALARM_MASK);
    out->level2_alarms = data[5];
    out->button_1 = (flags & 0x01u) != 0u;
    out->button_2 = (flags & 0x02u) != 0u;
    out->turn_left_on = (flags & 0x10u) != 0u;
    out->turn_right_on = (flags & 0x20u) != 0u;
    out->manual_mode = (flags & 0x40u) != 0u;
    out->autopilot_mode = (flags & 0x80u) != 0u;
    return true;
}

/* 0A3h */
bool agv_pack_gear_status(uint8_t data[AGV_DLC], const agv_gear_status_t *in) {
    return pack_gear(data, in->gear);
}

bool agv_unpack_gear_status(agv_gear_status_t *out, const uint8_t data[AGV_DLC]) {
    out->gear = data[0];
    return gear_is_valid(out->gear);
}

/* 050h */
bool agv_pack_throttle_status(uint8_t data[AGV_DLC], const agv_throttle_status_t *in) {
    return pack_throttle(data, in->throttle_permille);
}

bool agv_unpack_throttle_status(agv_throttle_status_t *out, const uint8_t data[AGV_DLC]) {
    const uint32_t counts = data[0];

    out->throttle_permille = (uint16_t)(counts * AGV_THROTTLE_PERMILLE_PER_COUNT);
    return counts <= AGV_THROTTLE_MAX_COUNTS;
}

/* 067h */
bool agv_pack_steering_status(uint8_t data[AGV_DLC], const agv_steering_status_t *in) {
    const uint32_t raw = angle_to_raw(in->angle_ddeg);

    if (raw > (uint32_t)AGV_ANGLE_RAW_MAX) {
        return false;
    }
    data[0] = in->alive_counter;
    data[1] = in->supply_pct_of_12v;
    put_le16(&data[2], raw);
    put_le16(&data[4], in->torque_raw);
    put_le16(&data[6], in->speed_raw);
    return true;
}

bool agv_unpack_steering_status(agv_steering_status_t *out, const uint8_t data[AGV_DLC]) {
    const int32_t raw = get_le16(&data[2]);

    out->angle_ddeg = raw - AGV_ANGLE_RAW_CENTRE;
    out->alive_counter = data[0];
    out->supply_pct_of_12v = data[1];
    out->torque_raw = get_le16(&data[4]);
    out->speed_raw = get_le16(&data[6]);
    return raw <= AGV_ANGLE_RAW_MAX;
}

/* 167h */
bool agv_pack_eps_status(uint8_t data[AGV_DLC], const agv_eps_status_t *in) {
    const uint8_t mode = in->mode;

    if (!eps_mode_is_valid(mode)) {
        return false;
    }
    put_le64(data, ((uint64_t)mode << 24) | ((uint64_t)in->faults << 56));
    return true;
}

bool agv_unpack_eps_status(agv_eps_status_t *out, const uint8_t data[AGV_DLC]) {
    const uint8_t mode = data[3];

    out->mode = mode;
    out->faults = data[7];
    return eps_mode_is_valid(mode);
}

/* 267h */
bool agv_pack_steering_position(uint8_t data[AGV_DLC], const agv_steering_position_t *in) {
    put_be16(&data[0], in->centre_raw);
    put_be16(&data[2], in->left_raw);
    put_be16(&data[4], in->right_raw);
    data[6] = 0u;
    data[7] = 0u;
    return true;
}

bool agv_unpack_steering_position(agv_steering_position_t *out, const uint8_t data[AGV_DLC]) {
    out->centre_raw = get_be16(&data[0]);
    out->left_raw = get_be16(&data[2]);
    out->right_raw = get_be16(&data[4]);
    return true;
}

/* 101h */
bool agv_pack_wheel_speed(uint8_t data[AGV_DLC], const agv_wheel_speed_t *in) {
    put_le32(&data[0], (uint32_t)in->left_mm_s);
    put_le32(&data[4], (uint32_t)in->right_mm_s);
    return true;
}

bool agv_unpack_wheel_speed(agv_wheel_speed_t *out, const uint8_t data[AGV_DLC]) {
    out->left_mm_s = to_int32(get_le32(&data[0]));
    out->right_mm_s = to_int32(get_le32(&data[4]));
    return true;
}

bool agv_value_is_valid(uint32_t message, const uint8_t data[AGV_DLC]) {
    switch (message) {
    case AGV_MSG_GEAR_COMMAND:
    case AGV_MSG_GEAR_STATUS:
        return gear_is_valid(data[0]);
    case AGV_MSG_THROTTLE_COMMAND:
    case AGV_MSG_THROTTLE_STATUS:
        return data[0] <= AGV_THROTTLE_MAX_COUNTS;
    case AGV_MSG_STEERING_COMMAND:
        return agv_angle_read(&data[0]) <= (uint32_t)AGV_ANGLE_RAW_MAX;
    case AGV_MSG_STEERING_STATUS:
        return agv_angle_read(&data[2]) <= (uint32_t)AGV_ANGLE_RAW_MAX;
    case AGV_MSG_EPS_STATUS:
        return eps_mode_is_valid(data[3]);
    default:
        return true;
    }
}

const uint8_t agv_command_bits[AGV_COMMAND_COUNT][AGV_DLC] = {
    {0u, 0u, 0u, 0u, 0xF0u, 0u, 0u, 0xFFu}, {0xFFu}, {0xFFu}, {0xFFu, 0xFFu}};

uint32_t agv_angle_read(const uint8_t *bytes) {
    return get_le16(bytes);
}

void agv_angle_write(uint8_t *bytes, uint32_t angle_raw) {
    put_le16(bytes, angle_raw);
}
