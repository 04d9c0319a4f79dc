/**
 * @file vehicle.h
 * The vehicle as it last reported itself: gear, throttle, steering angle, wheels, VCU's speed, EPS mode; and whether it
 * stands (the words of docs/requirements.md). An invalid value is never used.
 */
#ifndef AGV_VEHICLE_H
#define AGV_VEHICLE_H

#include <stdbool.h>
#include <stdint.h>

#include "agv/codec.h"
#include "agv/config.h"
#include "base/timers.h"
#include "hal/can.h"

/** What the vehicle reported. */
typedef struct {
    agv_wheel_speed_t wheels;
    uint16_t vcu_speed;     /**< 363h, metres per hour (P7) */
    uint16_t angle_raw;     /**< last valid measured steering angle, 0.1 degree above the leftmost one (P5) */
    uint8_t gear;           /**< agv_gear_t of the last 0A3h; 0 when that was invalid */
    uint8_t throttle;       /**< counts of the last valid 050h */
    bool throttle_known;    /**< there was a valid 050h */
    bool angle_known;       /**< there was a valid 067h */
    bool eps_in_angle_mode; /**< mode of the last 167h */
    bool vcu_speed_seen;    /**< 363h reported a speed above 0 in this run */
    bool wheels_fresh;      /**< 101h is fresh, as of the last evaluation */
    bool vcu_alive;         /**< the VCU is alive, as of the last evaluation */
} agv_vehicle_t;

/** 363h: the VCU's speed. */
void agv_vehicle_status(agv_vehicle_t *vehicle, const uint8_t data[AGV_DLC]);

/** 0A3h. */
void agv_vehicle_gear(agv_vehicle_t *vehicle, const uint8_t data[AGV_DLC], bool valid);

/** 050h. */
void agv_vehicle_throttle(agv_vehicle_t *vehicle, const uint8_t data[AGV_DLC], bool valid);

/** 067h, received at @p time_ms. */
void agv_vehicle_steering(agv_vehicle_t *vehicle, agv_timers_t *timers, const hal_can_frame_t *frame, bool valid);

/** 167h. */
void agv_vehicle_eps(agv_vehicle_t *vehicle, const uint8_t data[AGV_DLC]);

/** 101h. */
void agv_vehicle_wheels(agv_vehicle_t *vehicle, const uint8_t data[AGV_DLC]);

/** Evaluate whether the vehicle stands. Call at every tick and after each 101h and 363h. */
void agv_vehicle_evaluate(agv_vehicle_t *vehicle, agv_timers_t *timers, const agv_config_t *config, bool wheels_fresh,
                          bool vcu_alive);

/** Both wheels are slow now, 101h is fresh, the VCU is alive and reports a slow speed too (INIT). */
bool agv_vehicle_is_slow(const agv_vehicle_t *vehicle, const agv_config_t *config);

/** Standstill: that for standstill_ms. */
bool agv_vehicle_is_at_standstill(const agv_timers_t *timers);

/** The wheels stand: both wheels are slow for standstill_ms, on fresh 101h. */
bool agv_vehicle_wheels_stand(const agv_timers_t *timers);

/** One wheel turns at this speed or faster in amount, on fresh 101h. */
bool agv_vehicle_wheel_turns(const agv_vehicle_t *vehicle, uint32_t speed_mm_s);

/** Throttle status at idle; false when there was no valid 050h. */
bool agv_vehicle_throttle_is_idle(const agv_vehicle_t *vehicle, const agv_config_t *config);

#endif
