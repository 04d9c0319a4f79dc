/* The AI computer: its four commands. */
#include "vehicle_internal.h"

#define MODE_BYTE 6
#define MANUAL_BIT 0x40u /* 363h byte 7 */
#define AUTOPILOT_BIT 0x80u

void vehicle_ai_start(vehicle_t *vehicle, uint64_t now_ms) {
    (void)now_ms;
    vehicle->ai.engaged = false;
}

void vehicle_ai_receive(vehicle_t *vehicle, uint64_t now_ms, const hal_can_frame_t *frame) {
    (void)now_ms;
    if ((frame->id == vehicle->id[AGV_MSG_VEHICLE_STATUS]) && (frame->length == AGV_DLC)) {
        vehicle->ai.engaged = (frame->data[MODE_BYTE] & AUTOPILOT_BIT) != 0u;
    }
}

static bool drives(const vehicle_t *vehicle) {
    return vehicle->ai.engaged || vehicle->people.ai_stubborn;
}

void vehicle_ai_turn_signal_command(vehicle_t *vehicle, uint64_t now_ms, uint8_t data[AGV_DLC]) {
    const agv_turn_signal_command_t command = {
        .autopilot_off = vehicle->people.ai_autopilot_off,
        .headlight_on = true,
        .alive_counter = vehicle_count(vehicle, VEHICLE_AI),
    };

    (void)now_ms;
    (void)agv_pack_turn_signal_command(data, &command);
}

void vehicle_ai_gear_command(vehicle_t *vehicle, uint64_t now_ms, uint8_t data[AGV_DLC]) {
    const agv_gear_command_t command = {drives(vehicle) ? vehicle->people.ai_gear : AGV_GEAR_N};

    (void)now_ms;
    (void)agv_pack_gear_command(data, &command);
}

void vehicle_ai_throttle_command(vehicle_t *vehicle, uint64_t now_ms, uint8_t data[AGV_DLC]) {
    const agv_throttle_command_t command = {drives(vehicle) ? vehicle->people.ai_throttle_permille : (uint16_t)0};

    (void)now_ms;
    (void)agv_pack_throttle_command(data, &command);
}

void vehicle_ai_steering_command(vehicle_t *vehicle, uint64_t now_ms, uint8_t data[AGV_DLC]) {
    const agv_steering_command_t command = {drives(vehicle) ? vehicle->people.ai_angle_ddeg : 0};

    (void)now_ms;
    (void)agv_pack_steering_command(data, &command);
}
