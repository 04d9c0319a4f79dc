/* The AI computer: its four commands. */
#include "vehicle/vehicle_internal.h"

#define STANDING_MM_S 50
#define MODE_BYTE 6
#define AUTOPILOT_BIT 0x80u /* 363h byte 7 */

void vehicle_ai_start(vehicle_t *vehicle, uint64_t now_ms) {
    (void)now_ms;
    vehicle->ai = (vehicle_ai_t){.gear = 0};
}

static bool is_direction(uint8_t gear) {
    return (gear == AGV_GEAR_D) || (gear == AGV_GEAR_R);
}

void vehicle_ai_reconsider(vehicle_t *vehicle) {
    vehicle_ai_t *ai = &vehicle->ai;
    const uint8_t wish = vehicle->operator.ai_gear;

    ai->waits = !vehicle->operator.ai_stubborn && ai->moving && is_direction(wish) && (ai->gear != wish) &&
                (is_direction(ai->gear) || (ai->gear == AGV_GEAR_N));
    ai->shifts = ai->waits;
}

static void hear_mode(vehicle_t *vehicle, bool engaged) {
    const bool begins = engaged && !vehicle->ai.engaged;

    vehicle->ai.engaged = engaged;
    if (begins) {
        vehicle_ai_reconsider(vehicle);
    }
}

static void hear_gear(vehicle_t *vehicle, uint8_t gear) {
    vehicle_ai_t *ai = &vehicle->ai;
    const bool is_other = (gear != vehicle->operator.ai_gear) && (is_direction(gear) || (gear == AGV_GEAR_N));

    ai->waits = ai->waits && is_other;
    ai->shifts = ai->shifts && is_other;
    ai->gear = gear;
}

/** Also of the lowest number, which has no amount. */
static bool turns(int32_t speed_mm_s) {
    return (speed_mm_s >= STANDING_MM_S) || (speed_mm_s <= -STANDING_MM_S);
}

static void hear_wheels(vehicle_ai_t *ai, const uint8_t data[AGV_DLC]) {
    agv_wheel_speed_t speed;

    (void)agv_unpack_wheel_speed(&speed, data);
    ai->moving = turns(speed.left_mm_s) || turns(speed.right_mm_s);
    ai->waits = ai->waits && ai->moving;
}

void vehicle_ai_receive(vehicle_t *vehicle, uint64_t now_ms, const hal_can_frame_t *frame) {
    vehicle_ai_t *ai = &vehicle->ai;

    (void)now_ms;
    if (frame->length != AGV_DLC) {
        return;
    }
    if (frame->id == vehicle->id[AGV_MSG_VEHICLE_STATUS]) {
        hear_mode(vehicle, (frame->data[MODE_BYTE] & AUTOPILOT_BIT) != 0);
    } else if (frame->id == vehicle->id[AGV_MSG_GEAR_STATUS]) {
        hear_gear(vehicle, frame->data[0]);
    } else if (frame->id == vehicle->id[AGV_MSG_WHEEL_SPEED]) {
        hear_wheels(ai, frame->data);
    }
}

static bool drives(const vehicle_t *vehicle) {
    return vehicle->ai.engaged || vehicle->operator.ai_stubborn;
}

void vehicle_ai_turn_signal_command(vehicle_t *vehicle, uint64_t now_ms, uint8_t data[AGV_DLC]) {
    const agv_turn_signal_command_t command = {
        .autopilot_off = vehicle->operator.ai_autopilot_off,
        .headlight_on = true,
        .alive_counter = vehicle_count(vehicle, VEHICLE_AI),
    };

    (void)now_ms;
    (void)agv_pack_turn_signal_command(data, &command);
}

void vehicle_ai_gear_command(vehicle_t *vehicle, uint64_t now_ms, uint8_t data[AGV_DLC]) {
    agv_gear_command_t command = {drives(vehicle) ? vehicle->operator.ai_gear : AGV_GEAR_N };

    (void)now_ms;
    if (drives(vehicle) && vehicle->ai.waits) {
        command.gear = vehicle->ai.gear;
    }
    (void)agv_pack_gear_command(data, &command);
}

void vehicle_ai_throttle_command(vehicle_t *vehicle, uint64_t now_ms, uint8_t data[AGV_DLC]) {
    const bool pulls = drives(vehicle) && !vehicle->ai.shifts;
    const agv_throttle_command_t command = {pulls ? vehicle->operator.ai_throttle_permille : (uint16_t) 0 };

    (void)now_ms;
    (void)agv_pack_throttle_command(data, &command);
}

void vehicle_ai_steering_command(vehicle_t *vehicle, uint64_t now_ms, uint8_t data[AGV_DLC]) {
    const int32_t angle_ddeg =
        vehicle->operator.ai_angle_ddeg + vehicle_swing_ddeg(&vehicle->operator.ai_weave, now_ms);
    const agv_steering_command_t command = {drives(vehicle) ? vehicle_limit_angle(angle_ddeg) : 0};

    (void)agv_pack_steering_command(data, &command);
}
