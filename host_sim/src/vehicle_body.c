/* Gear box and wheels: what moves as the VCU wants it. Integers only: speed in um/s, so that 1 ms at 1 mm/s2 counts. */
#include <stdlib.h>

#include "vehicle_internal.h"

/** What the VCU has the body do over a stretch of time. */
typedef struct {
    int32_t target_um_s;
    uint32_t rate_mm_s2;
} pull_t;

/** The VCU off: the drive unit gives no power, and the gear box stays as it is. */
static bool vcu_runs(const vehicle_t *vehicle) {
    return vehicle->nodes[VEHICLE_VCU].running;
}

static bool too_fast_for_park(const vehicle_t *vehicle) {
    return vehicle->config.park_guard &&
           (abs(vehicle->body.speed_um_s) >= (int32_t)vehicle->config.walking_pace_mm_s * 1000);
}

static bool remote_is_lost(const vehicle_t *vehicle) {
    return vehicle->people.remote_signal_lost || vehicle->people.remote_power_lost;
}

/** On the way to P it brakes if it guards it. */
static bool brakes(const vehicle_t *vehicle) {
    const vehicle_vcu_t *vcu = &vehicle->vcu;
    const bool before_park = vehicle->config.park_guard && (vcu->gear == AGV_GEAR_P);
    return vcu_runs(vehicle) && (before_park || (!vcu->autopilot && remote_is_lost(vehicle)));
}

static pull_t pull_of(const vehicle_t *vehicle) {
    const vehicle_config_t *config = &vehicle->config;
    const vehicle_body_t *body = &vehicle->body;
    int32_t target = 0;

    if (body->gear == AGV_GEAR_P) {
        return (pull_t){0, config->locked_mm_s2};
    }
    if (brakes(vehicle)) {
        return (pull_t){0, config->braking_mm_s2};
    }
    if ((body->gear != AGV_GEAR_N) && vcu_runs(vehicle)) {
        target = (int32_t)body->throttle_permille * (int32_t)config->top_speed_mm_s;
        target = (body->gear == AGV_GEAR_R) ? -target : target;
    }
    return (pull_t){target,
                    (abs(target) > abs(body->speed_um_s)) ? config->acceleration_mm_s2 : config->coasting_mm_s2};
}

/** Let the gear box come to @p now_ms. */
static void shift(vehicle_t *vehicle, uint64_t now_ms) {
    vehicle_body_t *body = &vehicle->body;
    const uint8_t wish = vehicle->vcu.gear;

    if ((wish == AGV_GEAR_P) && (body->gear != AGV_GEAR_P) && too_fast_for_park(vehicle)) {
        body->target = body->gear; /* brake first */
        return;
    }
    if (wish != body->target) {
        body->target = wish;
        body->changed_ms = now_ms;
    }
    if ((body->target != body->gear) && (now_ms - body->changed_ms >= vehicle->config.gear_change_ms)) {
        body->gear = body->target;
        if ((body->gear == AGV_GEAR_P) && (abs(body->speed_um_s) / 1000 > body->fastest_park_mm_s)) {
            body->fastest_park_mm_s = abs(body->speed_um_s) / 1000;
        }
    }
}

static uint16_t throttle_of(const vehicle_t *vehicle, uint64_t now_ms) {
    const vehicle_vcu_t *vcu = &vehicle->vcu;

    if (!vcu_runs(vehicle) || brakes(vehicle) || (vcu->gear == AGV_GEAR_P) || (vehicle->body.gear == AGV_GEAR_P)) {
        return 0u;
    }
    if (vcu->autopilot && ((now_ms >= vcu->throttle_until_ms) || (now_ms >= vcu->ai_until_ms))) {
        return 0u;
    }
    return vcu->throttle_permille;
}

void vehicle_body_move(vehicle_t *vehicle, uint64_t now_ms) {
    vehicle_body_t *body = &vehicle->body;
    const uint64_t elapsed = now_ms - body->at_ms;

    if (elapsed != 0u) {
        const pull_t pull = pull_of(vehicle);
        const uint64_t step = elapsed * pull.rate_mm_s2;
        body->at_ms = now_ms;
        body->speed_um_s =
            vehicle_approach(body->speed_um_s, pull.target_um_s, (step > INT32_MAX) ? INT32_MAX : (int32_t)step);
    }
    if (vcu_runs(vehicle)) {
        shift(vehicle, now_ms);
    }
    body->throttle_permille = throttle_of(vehicle, now_ms);
}
