/* Gear box and wheels: what moves as the VCU wants it. Integers only: speed in um/s, so that 1 ms at 1 mm/s2 counts. */
#include <stdlib.h>

#include "vehicle/vehicle_internal.h"

#define STANDING_UM_S 50000
#define MPERMILLE_PER_PERMILLE 1000
#define MPERMILLE_PER_MS_PER_PCT_S 10u /* 1 % a second is 10 permille in 1000 ms */

/** What the VCU does to the vehicle over a stretch of time. */
typedef struct {
    int32_t target_um_s;
    uint32_t rate_mm_s2;
} pull_t;

/** The VCU off: the drive unit gives no power, and the gear box stays as it is. */
static bool vcu_runs(const vehicle_t *vehicle) {
    return vehicle->nodes[VEHICLE_VCU].running;
}

bool vehicle_dynamics_is_fast(const vehicle_t *vehicle) {
    return abs(vehicle->dynamics.speed_um_s) >= (int32_t)vehicle->config.walking_pace_mm_s * 1000;
}

static bool too_fast_for_park(const vehicle_t *vehicle) {
    return vehicle->config.park_guard && vehicle_dynamics_is_fast(vehicle);
}

/** The VCU wants D or R, and the wheels turn the other way. */
static bool is_against_motion(const vehicle_t *vehicle) {
    const int32_t speed_um_s = vehicle->dynamics.speed_um_s;
    return ((vehicle->vcu.gear == AGV_GEAR_D) && (speed_um_s < -STANDING_UM_S)) ||
           ((vehicle->vcu.gear == AGV_GEAR_R) && (speed_um_s > STANDING_UM_S));
}

static bool remote_is_lost(const vehicle_t *vehicle) {
    return vehicle->operator.remote_signal_lost || vehicle->operator.remote_power_lost;
}

/** On the way to P it brakes if it guards it, and on the way to the other direction. */
static bool brakes(const vehicle_t *vehicle) {
    const vehicle_vcu_t *vcu = &vehicle->vcu;
    const bool before_park = vehicle->config.park_guard && (vcu->gear == AGV_GEAR_P);
    return vcu_runs(vehicle) &&
           (before_park || is_against_motion(vehicle) || (!vcu->autopilot && remote_is_lost(vehicle)));
}

static pull_t pull_of(const vehicle_t *vehicle) {
    const vehicle_config_t *config = &vehicle->config;
    const vehicle_dynamics_t *dynamics = &vehicle->dynamics;
    int32_t target = 0;

    if (vehicle->vcu_faults.rolls) {
        return (pull_t){vehicle->vcu_faults.roll_um_s, config->acceleration_mm_s2};
    }
    if (dynamics->gear == AGV_GEAR_P) {
        return (pull_t){0, config->locked_mm_s2};
    }
    if (brakes(vehicle)) {
        return (pull_t){0, config->braking_mm_s2};
    }
    if ((dynamics->gear != AGV_GEAR_N) && vcu_runs(vehicle)) {
        target = (int32_t)vehicle_dynamics_throttle_permille(vehicle) * (int32_t)config->top_speed_mm_s;
        target = (dynamics->gear == AGV_GEAR_R) ? -target : target;
    }
    return (pull_t){target,
                    (abs(target) > abs(dynamics->speed_um_s)) ? config->acceleration_mm_s2 : config->coasting_mm_s2};
}

/** Advance the gear box to @p now_ms. */
static void shift(vehicle_t *vehicle, uint64_t now_ms) {
    vehicle_dynamics_t *dynamics = &vehicle->dynamics;
    const uint8_t wish = vehicle->vcu.gear;

    const bool guards_park = (wish == AGV_GEAR_P) && (dynamics->gear != AGV_GEAR_P) && too_fast_for_park(vehicle);
    if (guards_park || is_against_motion(vehicle)) {
        dynamics->target = dynamics->gear; /* brake first */
        return;
    }
    if (wish != dynamics->target) {
        dynamics->target = wish;
        dynamics->changed_ms = now_ms;
    }
    if ((dynamics->target != dynamics->gear) && (now_ms - dynamics->changed_ms >= vehicle->config.gear_change_ms)) {
        dynamics->gear = dynamics->target;
        if ((dynamics->gear == AGV_GEAR_P) && (abs(dynamics->speed_um_s) / 1000 > dynamics->fastest_park_mm_s)) {
            dynamics->fastest_park_mm_s = abs(dynamics->speed_um_s) / 1000;
        }
    }
}

/** The throttle that the VCU is on its way to. */
static uint16_t throttle_of(const vehicle_t *vehicle, uint64_t now_ms) {
    const vehicle_vcu_t *vcu = &vehicle->vcu;

    /* No power while a gear engages: it would be the one of the gear before. */
    if (!vcu_runs(vehicle) || brakes(vehicle) || (vcu->gear == AGV_GEAR_P) || (vehicle->dynamics.gear != vcu->gear)) {
        return 0;
    }
    if (vcu->autopilot && ((now_ms >= vcu->throttle_until_ms) || (now_ms >= vcu->ai_until_ms))) {
        return 0;
    }
    return vcu->throttle_permille;
}

uint16_t vehicle_dynamics_throttle_permille(const vehicle_t *vehicle) {
    return (uint16_t)(vehicle->dynamics.throttle_mpermille / MPERMILLE_PER_PERMILLE);
}

/** Let the throttle follow, at its rate. */
static void move_throttle(vehicle_t *vehicle, uint64_t now_ms, uint64_t elapsed_ms) {
    vehicle_dynamics_t *dynamics = &vehicle->dynamics;
    const vehicle_vcu_faults_t *faults = &vehicle->vcu_faults;
    const int32_t target = (int32_t)throttle_of(vehicle, now_ms) * MPERMILLE_PER_PERMILLE;
    const uint16_t fall_pct_s = faults->ramps ? faults->throttle_fall_pct_s : vehicle->config.throttle_fall_pct_s;
    const uint16_t pct_s = (target > dynamics->throttle_mpermille) ? vehicle->config.throttle_rise_pct_s : fall_pct_s;
    const uint64_t step = elapsed_ms * pct_s * MPERMILLE_PER_MS_PER_PCT_S;

    if ((pct_s == 0) || !vcu_runs(vehicle) || (step > INT32_MAX)) {
        dynamics->throttle_mpermille = target;
    } else {
        dynamics->throttle_mpermille = vehicle_approach(dynamics->throttle_mpermille, target, (int32_t)step);
    }
}

void vehicle_dynamics_move(vehicle_t *vehicle, uint64_t now_ms) {
    vehicle_dynamics_t *dynamics = &vehicle->dynamics;
    const uint64_t elapsed = now_ms - dynamics->at_ms;

    if (elapsed != 0) {
        const pull_t pull = pull_of(vehicle);
        const uint64_t step = elapsed * pull.rate_mm_s2;
        dynamics->at_ms = now_ms;
        dynamics->speed_um_s =
            vehicle_approach(dynamics->speed_um_s, pull.target_um_s, (step > INT32_MAX) ? INT32_MAX : (int32_t)step);
    }
    if (vcu_runs(vehicle)) {
        shift(vehicle, now_ms);
    }
    move_throttle(vehicle, now_ms, elapsed);
}
