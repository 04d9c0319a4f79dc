/**
 * @file hold.h
 * The held steering angle (FSM-10). It is stored with its complement; if the two do not match, no angle is held (INT-5).
 */
#ifndef AGV_HOLD_H
#define AGV_HOLD_H

#include <stdbool.h>
#include <stdint.h>

#include "observe/vehicle.h"

/** The held angle. No angle is held while `check` is not the complement, as when all is zero. */
typedef struct {
    uint16_t raw;       /**< 0..18000 (P5) */
    uint16_t check;     /**< complement of raw */
    uint16_t unsent_ms; /**< time for which no 065h has left the controller, at most AGV_HOLD_UNSENT_MAX_MS */
    bool handed_over;   /**< the controller accepted a 065h, and may still have it */
    bool taken;         /**< it was taken since the last tick */
} agv_hold_t;

/** After this time without 065h, ms, the wheels may have turned: the angle is out of date (FSM-10). */
enum { AGV_HOLD_UNSENT_MAX_MS = 2000 };

/** Hold, at a trip, the angle of the last valid 067h if it is not older than hold_age_ms. */
void agv_hold_trip(agv_hold_t *hold, const agv_vehicle_t *vehicle, const agv_timers_t *timers);

/** Drop the held angle: at a reset, when manual is reported, when the EPS takes no angles, and when it is out of date. */
void agv_hold_drop(agv_hold_t *hold);

/**
 * Hold the angle of a valid 067h if none is held, or if the held one is out of date. Call in TRIPPED and SAFE while manual
 * is not reported.
 */
void agv_hold_take(agv_hold_t *hold, const agv_vehicle_t *vehicle);

/**
 * Measure for how long no 065h has left the controller. After AGV_HOLD_UNSENT_MAX_MS the angle is dropped; one that is taken
 * later is kept only while it is not older than hold_age_ms, until a 065h has left. Call in TRIPPED and SAFE, in every pass.
 * @param elapsed_ms since the last tick; 0 for a frame
 */
void agv_hold_follow(agv_hold_t *hold, const agv_timers_t *timers, uint32_t elapsed_ms);

/**
 * Replace an angle that was taken from frames that were handled late: the wheels may have turned since. If a tick comes more than
 * hold_age_ms after the last one, and the angle was taken between the two, the newest angle is held instead. If that is older
 * than hold_age_ms, none is held. Call in TRIPPED and SAFE, in every pass.
 * @param elapsed_ms since the last tick; 0 for a frame
 */
void agv_hold_renew(agv_hold_t *hold, const agv_vehicle_t *vehicle, const agv_timers_t *timers, uint32_t hold_age_ms,
                    uint32_t elapsed_ms);

/** The controller accepted a 065h. */
void agv_hold_handed_over(agv_hold_t *hold);

/** All frames that the controller accepted have left it. */
void agv_hold_left(agv_hold_t *hold);

/** The frames that the controller accepted are discarded. */
void agv_hold_withdrawn(agv_hold_t *hold);

/**
 * Whether a 065h that may no longer be sent waits in a stalled transmitter, from which it would leave later.
 * @param sendable 065h may be sent now
 */
bool agv_hold_is_stuck(const agv_hold_t *hold, bool stalled, bool sendable);

/** Whether an angle is held. */
bool agv_hold_is_held(const agv_hold_t *hold);

#endif
