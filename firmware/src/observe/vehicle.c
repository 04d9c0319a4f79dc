#include "observe/vehicle.h"

void agv_vehicle_status(agv_vehicle_t *vehicle, const uint8_t data[AGV_DLC]) {
    vehicle->vcu_speed = (uint16_t)((uint32_t)data[0] | ((uint32_t)data[1] << 8u));
    if (vehicle->vcu_speed != 0u) {
        vehicle->vcu_speed_seen = true;
    }
}

void agv_vehicle_gear(agv_vehicle_t *vehicle, const uint8_t data[AGV_DLC], bool valid) {
    vehicle->gear = valid ? data[0] : 0u;
}

void agv_vehicle_throttle(agv_vehicle_t *vehicle, const uint8_t data[AGV_DLC], bool valid) {
    vehicle->throttle_known = valid;
    if (valid) {
        vehicle->throttle = data[0];
    }
}

void agv_vehicle_steering(agv_vehicle_t *vehicle, agv_timers_t *timers, const hal_can_frame_t *frame, bool valid) {
    if (valid) {
        vehicle->angle_raw = (uint16_t)agv_angle_read(&frame->data[2]);
        vehicle->angle_known = true;
        agv_timer_start_at(timers, AGV_TIMER_ANGLE, frame->time_ms);
    }
}

void agv_vehicle_eps(agv_vehicle_t *vehicle, const uint8_t data[AGV_DLC]) {
    vehicle->eps_in_angle_mode = data[3] == (uint8_t)AGV_EPS_MODE_ANGLE;
}

void agv_vehicle_wheels(agv_vehicle_t *vehicle, const uint8_t data[AGV_DLC]) {
    (void)agv_unpack_wheel_speed(&vehicle->wheels, data);
}

static bool is_below(int32_t speed_mm_s, int32_t limit_mm_s) {
    return (speed_mm_s < limit_mm_s) && (speed_mm_s > -limit_mm_s);
}

static bool wheels_are_below(const agv_vehicle_t *vehicle, uint32_t limit_mm_s) {
    return is_below(vehicle->wheels.left_mm_s, (int32_t)limit_mm_s) &&
           is_below(vehicle->wheels.right_mm_s, (int32_t)limit_mm_s);
}

static bool wheels_are_slow(const agv_vehicle_t *vehicle, const agv_config_t *config) {
    return vehicle->wheels_fresh && wheels_are_below(vehicle, config->standstill_speed_mm_s);
}

void agv_vehicle_evaluate(agv_vehicle_t *vehicle, agv_timers_t *timers, const agv_config_t *config, bool wheels_fresh,
                          bool vcu_alive) {
    vehicle->wheels_fresh = wheels_fresh;
    vehicle->vcu_alive = vcu_alive;
    (void)agv_timer_while(timers, AGV_TIMER_STANDSTILL, agv_vehicle_is_slow(vehicle, config));
    /* also between two ticks, when one is late */
    const bool slow = wheels_are_slow(vehicle, config) && !vehicle->wheels_doubted;
    const bool stand = agv_timer_while(timers, AGV_TIMER_WHEELS_SLOW, slow);
    (void)agv_timer_while(timers, AGV_TIMER_WHEELS_STOOD, stand);
}

void agv_vehicle_doubt_wheels(agv_vehicle_t *vehicle, agv_timers_t *timers, const agv_config_t *config,
                              bool implausible) {
    vehicle->wheels_doubted = implausible && (config->standstill_vcu_counts != AGV_STANDSTILL_VCU_ANY);
    if (vehicle->wheels_doubted) {
        agv_timer_stop(timers, AGV_TIMER_WHEELS_SLOW);
    }
}

bool agv_vehicle_is_slow(const agv_vehicle_t *vehicle, const agv_config_t *config) {
    const bool vcu_is_slow = (config->standstill_vcu_counts == AGV_STANDSTILL_VCU_ANY) ||
                             (vehicle->vcu_speed <= config->standstill_vcu_counts);
    return vehicle->vcu_alive && vcu_is_slow && wheels_are_slow(vehicle, config);
}

bool agv_vehicle_is_at_standstill(const agv_timers_t *timers) {
    return agv_timer_reached(timers, AGV_TIMER_STANDSTILL);
}

bool agv_vehicle_wheels_stand(const agv_timers_t *timers) {
    return agv_timer_reached(timers, AGV_TIMER_WHEELS_SLOW);
}

bool agv_vehicle_wheel_turns(const agv_vehicle_t *vehicle, uint32_t speed_mm_s) {
    return !wheels_are_below(vehicle, speed_mm_s);
}

bool agv_vehicle_may_move(const agv_vehicle_t *vehicle, uint32_t speed_mm_s) {
    return vehicle->wheels_doubted || agv_vehicle_wheel_turns(vehicle, speed_mm_s);
}

bool agv_vehicle_throttle_is_idle(const agv_vehicle_t *vehicle, const agv_config_t *config) {
    return vehicle->throttle <= config->throttle_idle_counts;
}
