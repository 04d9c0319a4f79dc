/**
 * @file vehicle.h
 * What the vehicle last reported of itself, decoded. Nothing here judges; monitor.h does.
 */
#ifndef AGV_VEHICLE_H
#define AGV_VEHICLE_H

#include <stdbool.h>
#include <stdint.h>

#include "agv/timer.h"

/** Mode that 363h byte 7 reports. While both bits are set the mode before stands, until MODE_INVALID; then it is none. */
typedef enum { AGV_MODE_NONE, AGV_MODE_MANUAL, AGV_MODE_ENGAGED } agv_mode_t;

/** The vehicle as last reported. */
typedef struct {
    agv_timer_t both_modes; /**< runs while both mode bits are set */
    agv_timer_t slow;       /**< runs while both wheels are below the standstill speed and 101h is fresh */
    int16_t angle_ddeg;     /**< last valid measured steering angle */
    int16_t command_ddeg;   /**< last valid steering command since the engagement (gateway: as sent on) */
    uint8_t mode;           /**< agv_mode_t */
    uint8_t gear;           /**< agv_gear_t of the last 0A3h; 0 when that was invalid */
    bool throttle_on;       /**< last 050h was valid and above 0 */
    bool eps_in_angle_mode; /**< mode of the last 167h */
    bool button_pressed;    /**< remote button 1 */
    bool angle_known;
    bool command_known;
} agv_vehicle_t;

#endif
