/**
 * @file vehicle.h
 * The last reported state of the vehicle: gear, throttle, steering angle, wheel speeds, VCU's speed, EPS mode; and whether
 * it stands (defined in docs/requirements.md). An invalid value is never used.
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
    uint16_t angle_raw;     /**< last valid measured steering angle, raw, 9000 is the centre (P5) */
    uint8_t gear;           /**< agv_gear_t of the last 0A3h; 0 when that was invalid */
    uint8_t throttle;       /**< counts of the last valid 050h */
    bool throttle_known;    /**< the last 050h was valid */
    bool angle_known;       /**< a valid 067h was received */
    bool eps_in_angle_mode; /**< mode of the last 167h */
    bool vcu_speed_seen;    /**< 363h reported a speed above 0 in this run */
    bool wheels_fresh;      /**< 101h is fresh, as of the last evaluation */
    bool wheels_doubted;    /**< the VCU's speed contradicts 101h (SUP-12) */
    bool vcu_alive;         /**< the VCU is alive, as of the last evaluation */
} agv_vehicle_t;

/** Take the VCU's speed from a 363h. */
void agv_vehicle_status(agv_vehicle_t *vehicle, const uint8_t data[AGV_DLC]);

/** Take the gear from a 0A3h. */
void agv_vehicle_gear(agv_vehicle_t *vehicle, const uint8_t data[AGV_DLC], bool valid);

/** Take the throttle from a 050h. */
void agv_vehicle_throttle(agv_vehicle_t *vehicle, const uint8_t data[AGV_DLC], bool valid);

/** Take the steering angle and its receive time from a 067h. */
void agv_vehicle_steering(agv_vehicle_t *vehicle, agv_timers_t *timers, const hal_can_frame_t *frame, bool valid);

/** Take the EPS mode from a 167h. */
void agv_vehicle_eps(agv_vehicle_t *vehicle, const uint8_t data[AGV_DLC]);

/** Take the wheel speeds from a 101h. */
void agv_vehicle_wheels(agv_vehicle_t *vehicle, const uint8_t data[AGV_DLC]);

/** Evaluate whether the vehicle stands. Call at every tick and after each 101h and 363h. */
void agv_vehicle_evaluate(agv_vehicle_t *vehicle, agv_timers_t *timers, const agv_config_t *config, bool wheels_fresh,
                          bool vcu_alive);

/**
 * Take whether the two speeds contradict each other (SUP-12). While they do, the wheels neither stand nor are slow: a 101h
 * that reads 0 for good must not hide a vehicle that moves. It has no effect where the VCU's speed is not looked at
 * (standstill_vcu_counts is AGV_STANDSTILL_VCU_ANY). Call at every tick after agv_vehicle_evaluate().
 */
void agv_vehicle_doubt_wheels(agv_vehicle_t *vehicle, agv_timers_t *timers, const agv_config_t *config,
                              bool implausible);

/** Whether both wheels are slow now with fresh 101h, and a live VCU also reports a slow speed (INIT). */
bool agv_vehicle_is_slow(const agv_vehicle_t *vehicle, const agv_config_t *config);

/** Whether the vehicle is at standstill: agv_vehicle_is_slow has held for standstill_ms. */
bool agv_vehicle_is_at_standstill(const agv_timers_t *timers);

/** Whether the wheels stand: both have been slow for standstill_ms, with fresh 101h that the VCU does not contradict. */
bool agv_vehicle_wheels_stand(const agv_timers_t *timers);

/** Whether in the last 101h, fresh or not, a wheel turns at @p speed_mm_s or faster, in either direction. */
bool agv_vehicle_wheel_turns(const agv_vehicle_t *vehicle, uint32_t speed_mm_s);

/** Whether in the last 101h, fresh or not, a wheel turns at @p speed_mm_s or faster, or the VCU contradicts it. */
bool agv_vehicle_may_move(const agv_vehicle_t *vehicle, uint32_t speed_mm_s);

/** Whether the last valid 050h is at idle; true if none was received. */
bool agv_vehicle_throttle_is_idle(const agv_vehicle_t *vehicle, const agv_config_t *config);

#endif
