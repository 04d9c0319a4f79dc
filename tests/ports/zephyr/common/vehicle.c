#include "vehicle.h"

#include <string.h>

#include <zephyr/kernel.h>

#include "agv/codec.h"
#include "agv/protocol.h"

vehicle_t vehicle;

static uint8_t counter;

static void send(uint32_t message, const uint8_t data[AGV_DLC]) {
    struct can_frame frame = {.id = agv_message_id(message, AGV_ID_SET_HEADING), .dlc = AGV_DLC};
    (void)memcpy(frame.data, data, AGV_DLC);
    vehicle_sends(&frame);
}

static void send_vcu(uint8_t data[AGV_DLC]) {
    const agv_vehicle_status_t status = {.manual_mode = !vehicle.autopilot,
                                         .autopilot_mode = vehicle.autopilot,
                                         .button_1 = vehicle.button_1,
                                         .alive_counter = counter};
    const agv_throttle_status_t throttle = {0};
    const agv_wheel_speed_t wheels = {.left_mm_s = vehicle.speed_mm_s, .right_mm_s = vehicle.speed_mm_s};
    (void)agv_pack_vehicle_status(data, &status);
    send(AGV_MSG_VEHICLE_STATUS, data);
    (void)agv_pack_throttle_status(data, &throttle);
    send(AGV_MSG_THROTTLE_STATUS, data);
    (void)agv_pack_wheel_speed(data, &wheels);
    send(AGV_MSG_WHEEL_SPEED, data);
}

static void send_eps(uint8_t data[AGV_DLC]) {
    const agv_steering_status_t steering = {.alive_counter = counter, .supply_pct_of_12v = 100u};
    const agv_eps_status_t eps = {.mode = AGV_EPS_MODE_ANGLE};
    const agv_steering_position_t position = {0};
    (void)agv_pack_steering_status(data, &steering);
    send(AGV_MSG_STEERING_STATUS, data);
    (void)agv_pack_eps_status(data, &eps);
    send(AGV_MSG_EPS_STATUS, data);
    (void)agv_pack_steering_position(data, &position);
    send(AGV_MSG_STEERING_POSITION, data);
}

static void send_ai(uint8_t data[AGV_DLC], bool all) {
    const agv_turn_signal_command_t lights = {.alive_counter = counter};
    const agv_gear_command_t gear = {.gear = AGV_GEAR_D};
    const agv_throttle_command_t throttle = {.throttle_permille = 100u};
    const agv_steering_command_t steering = {0};
    (void)agv_pack_steering_command(data, &steering);
    send(AGV_MSG_STEERING_COMMAND, data);
    if (all) {
        (void)agv_pack_turn_signal_command(data, &lights);
        send(AGV_MSG_TURN_SIGNAL_COMMAND, data);
        (void)agv_pack_gear_command(data, &gear);
        send(AGV_MSG_GEAR_COMMAND, data);
        (void)agv_pack_throttle_command(data, &throttle);
        send(AGV_MSG_THROTTLE_COMMAND, data);
    }
}

static void send_due(uint32_t now_ms) {
    uint8_t data[AGV_DLC] = {0};
    if ((now_ms % 10u) == 0u) {
        counter++;
        send_vcu(data);
        send_eps(data);
    }
    if ((now_ms % 25u) == 0u) {
        const agv_gear_status_t gear = {.gear = vehicle.park ? AGV_GEAR_P : AGV_GEAR_D};
        (void)agv_pack_gear_status(data, &gear);
        send(AGV_MSG_GEAR_STATUS, data);
        if (!vehicle.ai_is_silent) {
            send_ai(data, (now_ms % 100u) == 0u);
        }
    }
}

void vehicle_run(uint32_t ms) {
    uint32_t now_ms = k_uptime_get_32();
    for (const uint32_t end_ms = now_ms + ms; now_ms != end_ms; now_ms++) {
        send_due(now_ms);
        k_sleep(K_TIMEOUT_ABS_MS(now_ms + 1u));
    }
}
