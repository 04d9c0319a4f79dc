/**
 * @file codec.h
 * Pack and unpack the payload of each of the 11 messages.
 *
 * The functions have no state and no loops. They work on the 8 payload bytes of a frame; the caller has already checked
 * the DLC. They never keep a pointer. Pointers must not be NULL, and payload and struct must not overlap.
 *
 * - `agv_pack_X(data, &in)` checks every field. If all are in range, it writes all 8 bytes (reserved bits as 0, P14) and
 *   returns true. Otherwise it returns false and leaves @p data unchanged.
 * - `agv_unpack_X(&out, data)` ignores reserved bits and writes every field of @p out. It returns false if a field holds
 *   a value that the protocol does not define. That field then contains the scaled invalid value, which must not
 *   be used; the other fields (alive counter, fault bits) are valid.
 *
 * Requirements: P2 to P14, P18 (docs/protocol.md).
 */
#ifndef AGV_CODEC_H
#define AGV_CODEC_H

#include <stdbool.h>
#include <stdint.h>

#include "agv/protocol.h"

/** Gear codes on the wire (P2; the protocol document calls the field "stall"). Any other value is invalid. */
typedef enum { AGV_GEAR_D = 1, AGV_GEAR_R = 2, AGV_GEAR_N = 4, AGV_GEAR_P = 8 } agv_gear_t;

/** EPS mode codes on the wire (P18). Any other value is invalid. */
typedef enum {
    AGV_EPS_MODE_ASSIST = 0x00,
    AGV_EPS_MODE_ANGLE = 0x01,
    AGV_EPS_MODE_SPEED = 0x02,
    AGV_EPS_MODE_TORQUE = 0x03,
    AGV_EPS_MODE_OFF = 0xFF
} agv_eps_mode_t;

/** Throttle: one count is 0.4 % (P6); 250 counts are 100 %. */
#define AGV_THROTTLE_PERMILLE_PER_COUNT 4u
#define AGV_THROTTLE_MAX_COUNTS 250u
#define AGV_THROTTLE_MAX_PERMILLE 1000u

/** Steering: raw 9000 is the centre, one count is 0.1 degree, raw 0..18000 is -900.0..+900.0 degrees (P5). */
#define AGV_ANGLE_RAW_CENTRE 9000
#define AGV_ANGLE_RAW_MAX 18000
#define AGV_ANGLE_MAX_DDEG 9000
/**
 * The side that a positive angle turns to: +1 left, -1 right. The protocol document does not state it; the integrator
 * sets it. The supervisor does not use it: it compares angles and sends back the measured one.
 */
#define AGV_ANGLE_POSITIVE_SIDE (+1)

/**
 * Vehicle speed: one count is 1 m/h = 0.001 km/h (P7). Since the document's unit is ambiguous, the value serves only to
 * detect standstill and to be compared with the wheel speeds (SUP-12, a warning by default).
 */
#define AGV_VEHICLE_SPEED_M_PER_H_PER_COUNT 1u

/** Bits of 363h byte 5, VCU level 1 alarms (the document counts them from Bit0). */
#define AGV_VCU_ALARM_REMOTE_SIGNAL_LOST 0x01u
#define AGV_VCU_ALARM_REMOTE_POWER_LOST 0x02u
#define AGV_VCU_ALARM_AI_CAN_LOST 0x08u
#define AGV_VCU_ALARM_EPS_HARDWARE 0x10u
#define AGV_VCU_ALARM_EPS_CAN_BUS 0x20u
#define AGV_VCU_ALARM_S_DRIVER 0x80u

/** Bits of 43Fh byte 5. The headlight bit is inverted (P11). */
#define AGV_SIGNAL_LEFT 0x10u
#define AGV_SIGNAL_RIGHT 0x20u
#define AGV_SIGNAL_AUTOPILOT_OFF 0x40u
#define AGV_SIGNAL_HEADLIGHT_OFF 0x80u

/** Bits of 363h byte 7. */
#define AGV_VCU_FLAG_BUTTON_1 0x01u
#define AGV_VCU_FLAG_MANUAL 0x40u
#define AGV_VCU_FLAG_AUTOPILOT 0x80u

/** EPS fault bits of 167h byte 8 (bit 1 of the document is 0x01). */
#define AGV_EPS_FAULT_UNDER_VOLTAGE 0x01u
#define AGV_EPS_FAULT_OVER_VOLTAGE 0x02u
#define AGV_EPS_FAULT_EXCESSIVE_CURRENT 0x04u
#define AGV_EPS_FAULT_OVER_CURRENT_SHUTDOWN 0x08u
#define AGV_EPS_FAULT_TEMP_ABOVE_110 0x10u
#define AGV_EPS_FAULT_TEMP_ABOVE_120 0x20u
#define AGV_EPS_FAULT_MOTOR_ENCODER 0x40u
#define AGV_EPS_FAULT_POSITION_ENCODER 0x80u

/** 43Fh: lights, autopilot off, alive counter of the AI computer. Every value is valid. */
typedef struct {
    bool turn_left_on;
    bool turn_right_on;
    bool autopilot_off; /**< true: disable autopilot; false: no request (there is no "enable", P12) */
    bool headlight_on;  /**< inverted on the wire (P11) */
    uint8_t alive_counter;
} agv_turn_signal_command_t;

/** 168h. */
typedef struct {
    uint8_t gear; /**< agv_gear_t */
} agv_gear_command_t;

/** 075h. */
typedef struct {
    uint16_t throttle_permille; /**< 0..1000; one count on the wire is 4, packing rounds down */
} agv_throttle_command_t;

/** 065h. */
typedef struct {
    int32_t angle_ddeg; /**< 0.1 degree, -9000..+9000 */
} agv_steering_command_t;

/** 363h. Every value is valid; the supervisor evaluates the mode bits (MODE_INVALID, MODE_NONE). */
typedef struct {
    uint16_t speed_m_per_h; /**< metres per hour, unsigned (P7) */
    uint8_t level1_alarms;  /**< AGV_VCU_ALARM_* bits; the two reserved bits are unpacked and packed as 0 */
    uint8_t level2_alarms;  /**< reserved in the protocol document; 0 = none */
    bool button_1;
    bool button_2;
    bool turn_left_on;
    bool turn_right_on;
    bool manual_mode;
    bool autopilot_mode;
    uint8_t alive_counter;
} agv_vehicle_status_t;

/** 0A3h. */
typedef struct {
    uint8_t gear; /**< agv_gear_t */
} agv_gear_status_t;

/** 050h. */
typedef struct {
    uint16_t throttle_permille; /**< 0..1000 in steps of 4; packing rounds down */
} agv_throttle_status_t;

/** 067h. */
typedef struct {
    uint8_t alive_counter;
    uint8_t supply_pct_of_12v; /**< 100 = 12 V (P8) */
    int32_t angle_ddeg;        /**< 0.1 degree, -9000..+9000 */
    uint16_t torque_raw;       /**< raw: the document gives no unit and no sign (P9) */
    uint16_t speed_raw;        /**< raw: the document gives no unit and no sign (P9) */
} agv_steering_status_t;

/** 167h. */
typedef struct {
    uint8_t mode;   /**< agv_eps_mode_t */
    uint8_t faults; /**< AGV_EPS_FAULT_* bits */
} agv_eps_status_t;

/** 267h, big-endian (P4). Raw values: the document gives no unit. */
typedef struct {
    uint16_t centre_raw;
    uint16_t left_raw;
    uint16_t right_raw;
} agv_steering_position_t;

/** 101h: rear wheels (P10). */
typedef struct {
    int32_t left_mm_s;
    int32_t right_mm_s;
} agv_wheel_speed_t;

/**
 * Whether the gear, throttle, steering angle or EPS mode that a message carries is valid. The result is that of
 * agv_unpack_X for this message, without unpacking it.
 * @return true for messages in which every value is valid, and for AGV_MSG_NONE and values above.
 */
bool agv_value_is_valid(uint32_t message, const uint8_t data[AGV_DLC]);

/** The used bits of each command; all others are reserved (P14). */
extern const uint8_t agv_command_bits[AGV_COMMAND_COUNT][AGV_DLC];

/** Read a raw steering angle from its two bytes (P5). @return a value above AGV_ANGLE_RAW_MAX if the angle is invalid. */
uint32_t agv_angle_read(const uint8_t *bytes);

/** Write the low 16 bits of a raw steering angle as two bytes. The range is not checked. */
void agv_angle_write(uint8_t *bytes, uint32_t angle_raw);

bool agv_pack_turn_signal_command(uint8_t data[AGV_DLC], const agv_turn_signal_command_t *in);
bool agv_unpack_turn_signal_command(agv_turn_signal_command_t *out, const uint8_t data[AGV_DLC]);
bool agv_pack_gear_command(uint8_t data[AGV_DLC], const agv_gear_command_t *in);
bool agv_unpack_gear_command(agv_gear_command_t *out, const uint8_t data[AGV_DLC]);
bool agv_pack_throttle_command(uint8_t data[AGV_DLC], const agv_throttle_command_t *in);
bool agv_unpack_throttle_command(agv_throttle_command_t *out, const uint8_t data[AGV_DLC]);
bool agv_pack_steering_command(uint8_t data[AGV_DLC], const agv_steering_command_t *in);
bool agv_unpack_steering_command(agv_steering_command_t *out, const uint8_t data[AGV_DLC]);

bool agv_pack_vehicle_status(uint8_t data[AGV_DLC], const agv_vehicle_status_t *in);
bool agv_unpack_vehicle_status(agv_vehicle_status_t *out, const uint8_t data[AGV_DLC]);
bool agv_pack_gear_status(uint8_t data[AGV_DLC], const agv_gear_status_t *in);
bool agv_unpack_gear_status(agv_gear_status_t *out, const uint8_t data[AGV_DLC]);
bool agv_pack_throttle_status(uint8_t data[AGV_DLC], const agv_throttle_status_t *in);
bool agv_unpack_throttle_status(agv_throttle_status_t *out, const uint8_t data[AGV_DLC]);
bool agv_pack_steering_status(uint8_t data[AGV_DLC], const agv_steering_status_t *in);
bool agv_unpack_steering_status(agv_steering_status_t *out, const uint8_t data[AGV_DLC]);
bool agv_pack_eps_status(uint8_t data[AGV_DLC], const agv_eps_status_t *in);
bool agv_unpack_eps_status(agv_eps_status_t *out, const uint8_t data[AGV_DLC]);
bool agv_pack_steering_position(uint8_t data[AGV_DLC], const agv_steering_position_t *in);
bool agv_unpack_steering_position(agv_steering_position_t *out, const uint8_t data[AGV_DLC]);
bool agv_pack_wheel_speed(uint8_t data[AGV_DLC], const agv_wheel_speed_t *in);
bool agv_unpack_wheel_speed(agv_wheel_speed_t *out, const uint8_t data[AGV_DLC]);

#endif
