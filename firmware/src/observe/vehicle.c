#include "observe/vehicle.h"

void agv_vehicle_status(agv_vehicle_t *vehicle, const uint8_t data[AGV_DLC]) {
    const bool down = (data[6] & AGV_VCU_FLAG_BUTTON_1) != 0u;
    vehicle->button = (uint8_t)(down ? AGV_BUTTON_DOWN : AGV_BUTTON_UP);
}

void agv_vehicle_gear(agv_vehicle_t *vehicle, const uint8_t data[AGV_DLC], bool valid) {
    vehicle->gear = valid ? data[0] : 0u;
}

void agv_vehicle_throttle(agv_vehicle_t *vehicle, const uint8_t data[AGV_DLC], bool valid) {
    if (valid) {
        vehicle->throttle = data[0];
    }
}

void agv_vehicle_steering(agv_vehicle_t *vehicle, const uint8_t data[AGV_DLC], bool valid) {
    if (valid) {
        vehicle->angle_raw = (uint16_t)agv_angle_read(&data[2]);
        vehicle->angle_known = true;
    }
}

void agv_vehicle_eps(agv_vehicle_t *vehicle, const uint8_t data[AGV_DLC]) {
    vehicle->eps_in_angle_mode = data[3] == (uint8_t)AGV_EPS_MODE_ANGLE;
}

static bool is_slow(int32_t speed_mm_s, int32_t limit_mm_s) {
    return (speed_mm_s < limit_mm_s) && (speed_mm_s > -limit_mm_s);
}

void agv_vehicle_wheels(agv_timers_t *timers, const agv_config_t *config, const uint8_t data[AGV_DLC]) {
    const int32_t limit_mm_s = (int32_t)config->standstill_speed_mm_s;
    agv_wheel_speed_t wheels;
    (void)agv_unpack_wheel_speed(&wheels, data);
    (void)agv_timer_while(timers, AGV_TIMER_STANDSTILL,
                          is_slow(wheels.left_mm_s, limit_mm_s) && is_slow(wheels.right_mm_s, limit_mm_s));
}

void agv_vehicle_wheels_lost(agv_timers_t *timers) {
    agv_timer_stop(timers, AGV_TIMER_STANDSTILL);
}

bool agv_vehicle_stands(const agv_timers_t *timers) {
    return agv_timer_reached(timers, AGV_TIMER_STANDSTILL);
}
