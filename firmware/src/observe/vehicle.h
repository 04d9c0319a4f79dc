/**
 * @file vehicle.h
 * The vehicle as it last reported itself: gear, throttle, steering angle, wheels, EPS mode, remote button 1. An invalid
 * value is never used.
 */
#ifndef AGV_VEHICLE_H
#define AGV_VEHICLE_H

#include <stdbool.h>
#include <stdint.h>

#include "agv/codec.h"
#include "base/timers.h"

/** Remote button 1. */
typedef enum { AGV_BUTTON_UNKNOWN, AGV_BUTTON_DOWN, AGV_BUTTON_UP } agv_button_t;

/** What the vehicle reported. */
typedef struct {
    uint16_t angle_raw;       /**< last valid measured steering angle, 0.1 degree above the leftmost one (P5) */
    uint8_t gear;             /**< agv_gear_t of the last 0A3h; 0 when that was invalid */
    uint8_t throttle;         /**< counts of the last valid 050h */
    uint8_t button;           /**< agv_button_t */
    bool angle_known;         /**< there was a valid 067h */
    bool eps_in_angle_mode;   /**< mode of the last 167h */
} agv_vehicle_t;

/** 363h: remote button 1. */
void agv_vehicle_status(agv_vehicle_t *vehicle, const uint8_t data[AGV_DLC]);

/** 0A3h. */
void agv_vehicle_gear(agv_vehicle_t *vehicle, const uint8_t data[AGV_DLC], bool valid);

/** 050h. */
void agv_vehicle_throttle(agv_vehicle_t *vehicle, const uint8_t data[AGV_DLC], bool valid);

/** 067h. */
void agv_vehicle_steering(agv_vehicle_t *vehicle, const uint8_t data[AGV_DLC], bool valid);

/** 167h. */
void agv_vehicle_eps(agv_vehicle_t *vehicle, const uint8_t data[AGV_DLC]);

/** 101h: standstill begins or ends. */
void agv_vehicle_wheels(agv_timers_t *timers, const agv_config_t *config, const uint8_t data[AGV_DLC]);

/** 101h is not fresh: the vehicle is not known to stand. */
void agv_vehicle_wheels_lost(agv_timers_t *timers);

/** Whether the vehicle stands still: both wheels slow for standstill_ms, on fresh 101h. */
bool agv_vehicle_stands(const agv_timers_t *timers);

#endif
