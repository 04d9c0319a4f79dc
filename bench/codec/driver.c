/**
 * @file driver.c
 * Calls each codec function CALLS times with valid values that change from call to call; callgrind counts.
 *
 * The codec is a translation unit of its own and no link-time optimisation is used: every call is a real call, as it is
 * in the firmware. The driver checks all results, so that a codec that does nothing does not pass.
 */
#include "agv/codec.h"
#include <stdio.h>
#include <string.h>

#define CALLS 1000u

static unsigned failures;

static void check(bool good) {
    if (!good) {
        failures++;
    }
}

/* Packs, clears, unpacks and compares field by field (structs may hold padding). */
#define ROUND_TRIP(name, value, same)                                                                                  \
    do {                                                                                                               \
        agv_##name##_t in = value;                                                                                     \
        agv_##name##_t out;                                                                                            \
        uint8_t data[AGV_DLC];                                                                                         \
        memset(&out, 0xA5, sizeof out);                                                                                \
        memset(data, 0xA5, sizeof data);                                                                               \
        check(agv_pack_##name(data, &in));                                                                             \
        check(agv_unpack_##name(&out, data));                                                                          \
        check(same);                                                                                                   \
    } while (0)

static void run_commands(uint32_t n) {
    static const uint8_t GEARS[4] = {AGV_GEAR_D, AGV_GEAR_R, AGV_GEAR_N, AGV_GEAR_P};
    const bool a = (n & 1u) != 0u;
    const bool b = (n & 2u) != 0u;

    ROUND_TRIP(turn_signal_command,
               ((agv_turn_signal_command_t){.turn_left_on = a,
                                            .turn_right_on = b,
                                            .autopilot_off = !a,
                                            .headlight_on = !b,
                                            .alive_counter = (uint8_t)n}),
               in.turn_left_on == out.turn_left_on && in.turn_right_on == out.turn_right_on &&
                   in.autopilot_off == out.autopilot_off && in.headlight_on == out.headlight_on &&
                   in.alive_counter == out.alive_counter);
    ROUND_TRIP(gear_command, (agv_gear_command_t){GEARS[n & 3u]}, in.gear == out.gear);
    ROUND_TRIP(throttle_command, (agv_throttle_command_t){(uint16_t)(n % 251u * 4u)},
               in.throttle_permille == out.throttle_permille);
    ROUND_TRIP(steering_command, (agv_steering_command_t){(int32_t)(n * 18u) - 9000}, in.angle_ddeg == out.angle_ddeg);
}

static void run_statuses(uint32_t n) {
    static const uint8_t GEARS[4] = {AGV_GEAR_D, AGV_GEAR_R, AGV_GEAR_N, AGV_GEAR_P};
    static const uint8_t MODES[5] = {AGV_EPS_MODE_ASSIST, AGV_EPS_MODE_ANGLE, AGV_EPS_MODE_SPEED, AGV_EPS_MODE_TORQUE,
                                     AGV_EPS_MODE_OFF};
    const bool a = (n & 1u) != 0u;
    const bool b = (n & 2u) != 0u;

    ROUND_TRIP(vehicle_status,
               ((agv_vehicle_status_t){.speed_m_per_h = (uint16_t)(n * 65u),
                                       .level1_alarms = (uint8_t)(n & 0xBBu),
                                       .level2_alarms = (uint8_t)~n,
                                       .button_1 = a,
                                       .button_2 = b,
                                       .turn_left_on = b,
                                       .turn_right_on = a,
                                       .manual_mode = a,
                                       .autopilot_mode = !a,
                                       .alive_counter = (uint8_t)n}),
               in.speed_m_per_h == out.speed_m_per_h && in.level1_alarms == out.level1_alarms &&
                   in.level2_alarms == out.level2_alarms && in.button_1 == out.button_1 &&
                   in.button_2 == out.button_2 && in.turn_left_on == out.turn_left_on &&
                   in.turn_right_on == out.turn_right_on && in.manual_mode == out.manual_mode &&
                   in.autopilot_mode == out.autopilot_mode && in.alive_counter == out.alive_counter);
    ROUND_TRIP(gear_status, (agv_gear_status_t){GEARS[n & 3u]}, in.gear == out.gear);
    ROUND_TRIP(throttle_status, (agv_throttle_status_t){(uint16_t)(n % 251u * 4u)},
               in.throttle_permille == out.throttle_permille);
    ROUND_TRIP(steering_status,
               ((agv_steering_status_t){.alive_counter = (uint8_t)n,
                                        .supply_pct_of_12v = (uint8_t)(n * 3u),
                                        .angle_ddeg = 9000 - (int32_t)(n * 18u),
                                        .torque_raw = (uint16_t)(n * 61u),
                                        .speed_raw = (uint16_t)(n * 7u)}),
               in.alive_counter == out.alive_counter && in.supply_pct_of_12v == out.supply_pct_of_12v &&
                   in.angle_ddeg == out.angle_ddeg && in.torque_raw == out.torque_raw && in.speed_raw == out.speed_raw);
    ROUND_TRIP(eps_status, ((agv_eps_status_t){.mode = MODES[n % 5u], .faults = (uint8_t)n}),
               in.mode == out.mode && in.faults == out.faults);
    ROUND_TRIP(steering_position,
               ((agv_steering_position_t){.centre_raw = (uint16_t)(n * 11u),
                                          .left_raw = (uint16_t)(n * 13u),
                                          .right_raw = (uint16_t)(n * 17u)}),
               in.centre_raw == out.centre_raw && in.left_raw == out.left_raw && in.right_raw == out.right_raw);
    ROUND_TRIP(wheel_speed, ((agv_wheel_speed_t){.left_mm_s = (int32_t)n * -40000, .right_mm_s = (int32_t)n * 2000000}),
               in.left_mm_s == out.left_mm_s && in.right_mm_s == out.right_mm_s);
}

int main(void) {
    for (uint32_t n = 0; n < CALLS; n++) {
        run_commands(n);
        run_statuses(n);
    }
    if (failures != 0u) {
        (void)fprintf(stderr, "codec bench: %u round trips failed\n", failures);
    }
    return (failures == 0u) ? 0 : 1;
}
