/**
 * @file vehicle_internal.h
 * What the parts of the vehicle share. For vehicle*.c only.
 */
#ifndef VEHICLE_INTERNAL_H
#define VEHICLE_INTERNAL_H

#include "vehicle/vehicle.h"

/** Compose the payload that a healthy node sends now; raises its alive counter where the message carries one. */
typedef void vehicle_compose_fn(vehicle_t *vehicle, uint64_t now_ms, uint8_t data[AGV_DLC]);

/** A message of the vehicle. */
typedef struct {
    vehicle_node_t node;
    uint16_t phase_ms; /**< the preset of vehicle_config_t: spread, so that few fall together */
    vehicle_compose_fn *compose;
} vehicle_row_t;

extern const vehicle_row_t VEHICLE_ROWS[AGV_MSG_COUNT];

/** Bring a value closer to its target by at most @p step. */
static inline int32_t vehicle_approach(int32_t value, int32_t target, int32_t step) {
    if (value < target) {
        return (target - value <= step) ? target : value + step;
    }
    return (value - target <= step) ? target : value - step;
}

/** Where a swing is now: a triangle that begins at 0 and goes up first. */
int32_t vehicle_swing_ddeg(const vehicle_swing_t *swing, uint64_t now_ms);

/** An angle within what the messages can carry. */
int32_t vehicle_limit_angle(int32_t angle_ddeg);

/** The alive counter of the next frame. */
uint8_t vehicle_count(vehicle_t *vehicle, vehicle_node_t node);

/** @name vehicle_vcu.c @{ */
void vehicle_vcu_start(vehicle_t *vehicle, uint64_t now_ms);
void vehicle_vcu_stop(vehicle_t *vehicle, uint64_t now_ms);
void vehicle_vcu_receive(vehicle_t *vehicle, uint64_t now_ms, const hal_can_frame_t *frame);
void vehicle_vcu_engage(vehicle_t *vehicle, uint64_t now_ms);
void vehicle_vcu_disengage(vehicle_t *vehicle, uint64_t now_ms);
void vehicle_vcu_remote(vehicle_t *vehicle, uint64_t now_ms);
uint8_t vehicle_vcu_alarms(const vehicle_t *vehicle, uint64_t now_ms);
vehicle_compose_fn vehicle_vcu_vehicle_status;
vehicle_compose_fn vehicle_vcu_gear_status;
vehicle_compose_fn vehicle_vcu_throttle_status;
vehicle_compose_fn vehicle_vcu_wheel_speed;
/** @} */

/** @name vehicle_dynamics.c @{ */
/** Advance gear box and wheels to @p now_ms. */
void vehicle_dynamics_move(vehicle_t *vehicle, uint64_t now_ms);
/** What 050h reports. */
uint16_t vehicle_dynamics_throttle_permille(const vehicle_t *vehicle);
/** Walking pace or faster: no speed at which to take P. */
bool vehicle_dynamics_is_fast(const vehicle_t *vehicle);
/** @} */

/** @name vehicle_eps.c @{ */
void vehicle_eps_start(vehicle_t *vehicle, uint64_t now_ms);
void vehicle_eps_receive(vehicle_t *vehicle, uint64_t now_ms, const hal_can_frame_t *frame);
/** Advance the steering to @p now_ms. */
void vehicle_eps_move(vehicle_t *vehicle, uint64_t now_ms);
/** The angle as it is measured. */
int32_t vehicle_eps_angle_ddeg(const vehicle_t *vehicle, uint64_t now_ms);
vehicle_compose_fn vehicle_eps_steering_status;
vehicle_compose_fn vehicle_eps_eps_status;
vehicle_compose_fn vehicle_eps_steering_position;
/** @} */

/** @name vehicle_ai.c @{ */
void vehicle_ai_start(vehicle_t *vehicle, uint64_t now_ms);
/** After new orders or an engagement: decide whether it must stop first. */
void vehicle_ai_reconsider(vehicle_t *vehicle);
void vehicle_ai_receive(vehicle_t *vehicle, uint64_t now_ms, const hal_can_frame_t *frame);
vehicle_compose_fn vehicle_ai_turn_signal_command;
vehicle_compose_fn vehicle_ai_gear_command;
vehicle_compose_fn vehicle_ai_throttle_command;
vehicle_compose_fn vehicle_ai_steering_command;
/** @} */

/** @name vehicle_send.c: how nodes send, and misbehave @{ */
/** Send the frame of a message that is due, as its node and the message misbehave. */
void vehicle_send_message(vehicle_t *vehicle, agv_message_t message, uint64_t now_ms);
/** Begin a stretch of `count` frames (VEHICLE_FOREVER), once or again and again. */
vehicle_stretch_t vehicle_stretch(uint16_t count, uint16_t every);
/** Bits of its payload keep a value from now on, those that were patched before too (VEHICLE_DO_PATCH, _HOLD). */
void vehicle_patch(vehicle_message_t *message, const vehicle_action_t *action);
/** End of that for all bits. */
void vehicle_unpatch(vehicle_message_t *message);
/** Send what rogue nodes have due. @return when the next one is due. */
uint64_t vehicle_send_rogues(vehicle_t *vehicle, uint64_t now_ms);
bool vehicle_add_rogue(vehicle_t *vehicle, uint64_t now_ms, const vehicle_action_t *action);
void vehicle_recover(vehicle_t *vehicle, vehicle_node_t node);
/** @} */

/** @name vehicle.c @{ */
/** Something was changed from outside: the next tick looks at everything. */
void vehicle_look_again(vehicle_t *vehicle, uint64_t now_ms);
void vehicle_power(vehicle_t *vehicle, vehicle_node_t node, bool on, uint64_t now_ms);
/** @} */

#endif
