/* The EPS: its mode, the steering angle, and its three messages. */

#include "vehicle/vehicle_internal.h"

#define SUPPLY_PCT 100u /* of 12 V */
#define POSITION_CENTRE 0x8000u
#define POSITION_LEFT 0x4000u
#define POSITION_RIGHT 0xC000u
#define AUTOPILOT_BIT 0x80u /* 363h byte 7 */
#define MODE_BYTE 6

void vehicle_eps_start(vehicle_t *vehicle, uint64_t now_ms) {
    vehicle_eps_t *eps = &vehicle->eps;

    eps->at_ms = now_ms;
    eps->mode = AGV_EPS_MODE_ASSIST;
    eps->wanted = AGV_EPS_MODE_ASSIST;
    eps->commanded = false;
}

void vehicle_eps_receive(vehicle_t *vehicle, uint64_t now_ms, const hal_can_frame_t *frame) {
    vehicle_eps_t *eps = &vehicle->eps;
    agv_steering_command_t command;

    if (frame->length != AGV_DLC) {
        return;
    }
    if (frame->id == vehicle->id[AGV_MSG_VEHICLE_STATUS]) {
        const bool autopilot = (frame->data[MODE_BYTE] & AUTOPILOT_BIT) != 0;
        const uint8_t wanted = autopilot ? AGV_EPS_MODE_ANGLE : AGV_EPS_MODE_ASSIST;
        if (wanted != eps->wanted) {
            vehicle_eps_move(vehicle, now_ms);
            eps->wanted = wanted;
            eps->changed_ms = now_ms;
            eps->commanded = false;
        }
    } else if ((frame->id == vehicle->id[AGV_MSG_STEERING_COMMAND]) &&
               !vehicle->messages[AGV_MSG_STEERING_COMMAND].ignored &&
               agv_unpack_steering_command(&command, frame->data)) {
        vehicle_eps_move(vehicle, now_ms);
        eps->command_ddeg = command.angle_ddeg;
        eps->commanded = true;
    }
}

/** The angle that the steering moves to; its present angle if none is commanded. */
static int32_t target_mddeg(const vehicle_t *vehicle) {
    const vehicle_eps_t *eps = &vehicle->eps;

    if (vehicle->operator.eps_stuck) {
        return eps->angle_mddeg;
    }
    if (vehicle->nodes[VEHICLE_EPS].running && (eps->mode == AGV_EPS_MODE_ANGLE)) {
        return eps->commanded ? eps->command_ddeg * 1000 : eps->angle_mddeg;
    }
    return vehicle->operator.hand_steers ? vehicle->operator.hand_ddeg * 1000 : eps->angle_mddeg;
}

void vehicle_eps_move(vehicle_t *vehicle, uint64_t now_ms) {
    vehicle_eps_t *eps = &vehicle->eps;
    const uint64_t elapsed = now_ms - eps->at_ms;

    if (elapsed != 0) {
        const uint64_t step = elapsed * vehicle->config.steering_rate_ddeg_s;
        eps->at_ms = now_ms;
        eps->angle_mddeg =
            vehicle_approach(eps->angle_mddeg, target_mddeg(vehicle), (step > INT32_MAX) ? INT32_MAX : (int32_t)step);
    }
    if ((eps->mode != eps->wanted) && (now_ms - eps->changed_ms >= vehicle->config.eps_mode_change_ms)) {
        eps->mode = eps->wanted;
    }
}

int32_t vehicle_eps_angle_ddeg(const vehicle_t *vehicle, uint64_t now_ms) {
    const bool hunts = vehicle->eps.mode == AGV_EPS_MODE_ANGLE;
    const int32_t swing_ddeg = hunts ? vehicle_swing_ddeg(&vehicle->operator.eps_hunt, now_ms) : 0;
    return vehicle_limit_angle((vehicle->eps.angle_mddeg / 1000) + swing_ddeg);
}

void vehicle_eps_steering_status(vehicle_t *vehicle, uint64_t now_ms, uint8_t data[AGV_DLC]) {
    agv_steering_status_t status;

    vehicle_eps_move(vehicle, now_ms);
    status = (agv_steering_status_t){
        .alive_counter = vehicle_count(vehicle, VEHICLE_EPS),
        .supply_pct_of_12v = SUPPLY_PCT,
        .angle_ddeg = vehicle_eps_angle_ddeg(vehicle, now_ms),
    };
    (void)agv_pack_steering_status(data, &status);
}

void vehicle_eps_eps_status(vehicle_t *vehicle, uint64_t now_ms, uint8_t data[AGV_DLC]) {
    agv_eps_status_t status = {0};

    vehicle_eps_move(vehicle, now_ms);
    status.mode = vehicle->eps.mode;
    (void)agv_pack_eps_status(data, &status);
}

void vehicle_eps_steering_position(vehicle_t *vehicle, uint64_t now_ms, uint8_t data[AGV_DLC]) {
    const agv_steering_position_t position = {POSITION_CENTRE, POSITION_LEFT, POSITION_RIGHT};

    (void)vehicle;
    (void)now_ms;
    (void)agv_pack_steering_position(data, &position);
}
