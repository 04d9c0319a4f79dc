/* The VCU: modes, commands, alarms, and its four messages. */
#include <stdlib.h>
#include <string.h>

#include "vehicle/vehicle_internal.h"

#define COMMAND_HOLD_MS 300u  /* for which gear P and autopilot off stand after their last frame */
#define THROTTLE_HOLD_MS 500u /* after which a 075h that stays away is throttle 0 */
#define M_PER_H_NUMERATOR 36  /* 1 um/s is 0.0036 m/h */
#define M_PER_H_DENOMINATOR 10000
#define SIGNALS_LENGTH 5u /* of a 43Fh that is cut short and still carries the lights and autopilot off */

void vehicle_vcu_start(vehicle_t *vehicle, uint64_t now_ms) {
    vehicle_vcu_t *vcu = &vehicle->vcu;

    memset(vcu, 0, sizeof *vcu);
    vcu->gear = (vehicle->dynamics.speed_um_s == 0) ? AGV_GEAR_P : AGV_GEAR_N;
    vcu->ai_until_ms = now_ms + vehicle->config.ai_lost_ms;
    vcu->eps_until_ms = now_ms + vehicle->config.eps_lost_ms;
}

void vehicle_vcu_stop(vehicle_t *vehicle, uint64_t now_ms) {
    vehicle->vcu.autopilot = false;
    vehicle_dynamics_move(vehicle, now_ms);
}

/** The remote controller's commands take effect again. */
void vehicle_vcu_remote(vehicle_t *vehicle, uint64_t now_ms) {
    vehicle_vcu_t *vcu = &vehicle->vcu;
    const vehicle_operator_t *operator= & vehicle->operator;

    if (vcu->autopilot ||
        (now_ms < vcu->park_until_ms) || operator->remote_signal_lost || operator->remote_power_lost) {
        return;
    }
    vehicle_dynamics_move(vehicle, now_ms);
    vcu->gear = operator->remote_gear;
    vcu->throttle_permille = operator->remote_throttle_permille;
    vehicle_dynamics_move(vehicle, now_ms);
}

void vehicle_vcu_engage(vehicle_t *vehicle, uint64_t now_ms) {
    vehicle_vcu_t *vcu = &vehicle->vcu;

    if (vcu->autopilot || (now_ms < vcu->off_until_ms)) {
        return;
    }
    vehicle_dynamics_move(vehicle, now_ms);
    vcu->autopilot = true;
    vcu->throttle_permille = 0;
    vcu->throttle_until_ms = 0;
}

void vehicle_vcu_disengage(vehicle_t *vehicle, uint64_t now_ms) {
    vehicle_vcu_t *vcu = &vehicle->vcu;

    if (vcu->autopilot) {
        vehicle_dynamics_move(vehicle, now_ms);
        vcu->autopilot = false;
        vcu->throttle_permille = 0;
        vehicle_dynamics_move(vehicle, now_ms);
    }
}

static void obey_gear(vehicle_t *vehicle, uint64_t now_ms, const uint8_t data[AGV_DLC]) {
    vehicle_vcu_t *vcu = &vehicle->vcu;
    agv_gear_command_t command;

    if (!agv_unpack_gear_command(&command, data)) {
        return;
    }
    vehicle_dynamics_move(vehicle, now_ms);
    if ((command.gear == AGV_GEAR_P) && vehicle->vcu_faults.refuses_park && vehicle_dynamics_is_fast(vehicle)) {
        return;
    }
    if (command.gear == AGV_GEAR_P) {
        vcu->park_until_ms = now_ms + COMMAND_HOLD_MS;
        vcu->throttle_permille = 0;
        vcu->gear = AGV_GEAR_P;
    } else if (vcu->autopilot) {
        vcu->park_until_ms = 0;
        vcu->gear = command.gear;
    }
    vehicle_dynamics_move(vehicle, now_ms);
}

static void obey_throttle(vehicle_t *vehicle, uint64_t now_ms, const uint8_t data[AGV_DLC]) {
    vehicle_vcu_t *vcu = &vehicle->vcu;
    const bool ignored = vehicle->messages[AGV_MSG_THROTTLE_COMMAND].ignored;
    agv_throttle_command_t command;

    if (vcu->autopilot && agv_unpack_throttle_command(&command, data)) {
        vehicle_dynamics_move(vehicle, now_ms);
        vcu->throttle_permille = ignored ? vcu->throttle_permille : command.throttle_permille;
        vcu->throttle_until_ms = now_ms + THROTTLE_HOLD_MS;
        vehicle_dynamics_move(vehicle, now_ms);
    }
}

static void hear_ai(vehicle_t *vehicle, uint64_t now_ms, uint8_t counter) {
    vehicle_vcu_t *vcu = &vehicle->vcu;

    if (!vcu->ai_heard || (counter != vcu->ai_counter)) {
        vcu->ai_heard = true;
        vcu->ai_counter = counter;
        vcu->ai_until_ms = now_ms + vehicle->config.ai_lost_ms;
    }
}

static void obey_turn_signals(vehicle_t *vehicle, uint64_t now_ms, const hal_can_frame_t *frame) {
    vehicle_vcu_t *vcu = &vehicle->vcu;
    agv_turn_signal_command_t command;

    (void)agv_unpack_turn_signal_command(&command, frame->data);
    if (frame->length >= AGV_DLC) {
        hear_ai(vehicle, now_ms, command.alive_counter);
    }
    if ((frame->length < SIGNALS_LENGTH) || vehicle->messages[AGV_MSG_TURN_SIGNAL_COMMAND].ignored) {
        return;
    }
    vcu->turn_left_on = command.turn_left_on;
    vcu->turn_right_on = command.turn_right_on;
    if (command.autopilot_off) {
        vcu->off_until_ms = now_ms + COMMAND_HOLD_MS;
        vehicle_vcu_disengage(vehicle, now_ms);
    }
}

static void hear_eps(vehicle_t *vehicle, uint64_t now_ms, const uint8_t data[AGV_DLC]) {
    vehicle_vcu_t *vcu = &vehicle->vcu;

    if (!vcu->eps_heard || (data[0] != vcu->eps_counter)) {
        vcu->eps_heard = true;
        vcu->eps_counter = data[0];
        vcu->eps_until_ms = now_ms + vehicle->config.eps_lost_ms;
    }
}

void vehicle_vcu_receive(vehicle_t *vehicle, uint64_t now_ms, const hal_can_frame_t *frame) {
    const uint16_t *id = vehicle->id;
    const bool whole = (frame->length == AGV_DLC) && (frame->flags == 0);
    const bool is_sloppy = vehicle->config.obeys_short_frames || vehicle->vcu_faults.is_sloppy;
    const bool usable = whole || (is_sloppy && (frame->length > 0));

    if (frame->id == id[AGV_MSG_STEERING_STATUS]) {
        if (whole) {
            hear_eps(vehicle, now_ms, frame->data);
        }
    } else if (frame->id == id[AGV_MSG_EPS_STATUS]) {
        if (whole) {
            vehicle->vcu.eps_fault = (frame->data[7] & (uint8_t)~AGV_EPS_FAULT_TEMP_ABOVE_110) != 0;
        }
    } else if (!usable) {
        return;
    } else if (frame->id == id[AGV_MSG_GEAR_COMMAND]) {
        if (!vehicle->messages[AGV_MSG_GEAR_COMMAND].ignored) {
            obey_gear(vehicle, now_ms, frame->data);
        }
    } else if (frame->id == id[AGV_MSG_THROTTLE_COMMAND]) {
        obey_throttle(vehicle, now_ms, frame->data);
    } else if (frame->id == id[AGV_MSG_TURN_SIGNAL_COMMAND]) {
        obey_turn_signals(vehicle, now_ms, frame);
    }
}

uint8_t vehicle_vcu_alarms(const vehicle_t *vehicle, uint64_t now_ms) {
    const vehicle_vcu_t *vcu = &vehicle->vcu;
    const vehicle_operator_t *operator= & vehicle->operator;
    uint32_t alarms = 0;

    alarms |= operator->remote_signal_lost ? AGV_VCU_ALARM_REMOTE_SIGNAL_LOST : 0;
    alarms |= operator->remote_power_lost ? AGV_VCU_ALARM_REMOTE_POWER_LOST : 0;
    alarms |= (now_ms >= vcu->ai_until_ms) ? AGV_VCU_ALARM_AI_CAN_LOST : 0;
    alarms |= (now_ms >= vcu->eps_until_ms) ? AGV_VCU_ALARM_EPS_CAN_BUS : 0;
    alarms |= vcu->eps_fault ? AGV_VCU_ALARM_EPS_HARDWARE : 0;
    return (uint8_t)alarms;
}

/** The speed of the wheels in metres per hour (P7), as far as 16 bits go. */
static uint16_t reported_speed_m_per_h(const vehicle_t *vehicle) {
    const int64_t m_per_h = (int64_t)abs(vehicle->dynamics.speed_um_s) * M_PER_H_NUMERATOR / M_PER_H_DENOMINATOR;
    const int64_t reported = m_per_h * vehicle->config.reported_speed_pct / 100;
    return (reported > UINT16_MAX) ? UINT16_MAX : (uint16_t)reported;
}

void vehicle_vcu_vehicle_status(vehicle_t *vehicle, uint64_t now_ms, uint8_t data[AGV_DLC]) {
    const vehicle_vcu_t *vcu = &vehicle->vcu;
    const vehicle_operator_t *operator= & vehicle->operator;
    const bool remote = !operator->remote_signal_lost && !operator->remote_power_lost;
    agv_vehicle_status_t status;

    vehicle_dynamics_move(vehicle, now_ms);
    status = (agv_vehicle_status_t){
        .speed_m_per_h = reported_speed_m_per_h(vehicle),
        .level1_alarms = vehicle_vcu_alarms(vehicle, now_ms),
        .button_1 = remote && operator->button_1,
        .button_2 = remote && operator->button_2,
        .turn_left_on = vcu->turn_left_on,
        .turn_right_on = vcu->turn_right_on,
        .manual_mode = !vcu->autopilot,
        .autopilot_mode = vcu->autopilot,
        .alive_counter = vehicle_count(vehicle, VEHICLE_VCU),
    };
    (void)agv_pack_vehicle_status(data, &status);
}

void vehicle_vcu_gear_status(vehicle_t *vehicle, uint64_t now_ms, uint8_t data[AGV_DLC]) {
    agv_gear_status_t status;

    vehicle_dynamics_move(vehicle, now_ms);
    status.gear = vehicle->dynamics.gear;
    (void)agv_pack_gear_status(data, &status);
}

void vehicle_vcu_throttle_status(vehicle_t *vehicle, uint64_t now_ms, uint8_t data[AGV_DLC]) {
    agv_throttle_status_t status;

    vehicle_dynamics_move(vehicle, now_ms);
    status.throttle_permille = vehicle_dynamics_throttle_permille(vehicle);
    (void)agv_pack_throttle_status(data, &status);
}

void vehicle_vcu_wheel_speed(vehicle_t *vehicle, uint64_t now_ms, uint8_t data[AGV_DLC]) {
    agv_wheel_speed_t speed;

    vehicle_dynamics_move(vehicle, now_ms);
    speed.left_mm_s = vehicle->dynamics.speed_um_s / 1000;
    speed.right_mm_s = speed.left_mm_s;
    (void)agv_pack_wheel_speed(data, &speed);
}
