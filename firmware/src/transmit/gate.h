/**
 * @file gate.h
 * The gate (INT-4): the last code before the HAL, through which every frame is sent. It checks the raw bytes of each frame
 * against the state, independently of its callers, and so enforces FSM-6. Allowed are only:
 *
 * - INIT, TRIPPED, SAFE and invalid states, vehicle side: 43Fh with autopilot off, both turn signals and headlight on;
 *   168h with P; 075h with 0; 065h with the held angle (not in INIT). Reserved bits are 0.
 * - STANDBY, ACTIVE, vehicle side: on a shared bus nothing. In a gateway 43Fh with any lights, 075h with 0; in ACTIVE, or
 *   if all commands are forwarded in manual, a valid gear, throttle up to the ceiling (0 in manual), and an angle in range.
 *   Reserved bits are 0.
 * - AI side: the seven status messages, in a gateway only.
 * - Vehicle side: the supervisor's own status frame, if it is configured.
 */
#ifndef AGV_GATE_H
#define AGV_GATE_H

#include <stdbool.h>
#include <stdint.h>

#include "agv/config.h"
#include "hal/can.h"
#include "hal/hal.h"

/** Inputs of the gate. */
typedef struct {
    const agv_config_t *config; /**< topology, ceiling, shadow, status frame */
    const agv_ids_t *ids;
    uint16_t hold_raw;   /**< held steering angle, raw 0..18000 */
    uint16_t hold_check; /**< complement of hold_raw; any other value: no angle is held */
    uint8_t state;       /**< agv_state_t */
} agv_gate_t;

/** Result of sending a frame. */
typedef enum {
    AGV_GATE_BUSY,     /**< the HAL did not accept it */
    AGV_GATE_SENT,     /**< the HAL accepted it */
    AGV_GATE_SHADOWED, /**< allowed, but not sent because of the shadow mode */
    AGV_GATE_REFUSED   /**< not allowed in this state */
} agv_gate_result_t;

/** Whether a frame may be sent. Pure. */
bool agv_gate_allows(const agv_gate_t *gate, hal_can_side_t side, const hal_can_frame_t *frame);

/** Send a frame if it is allowed. This is the only caller of hal_can_send in the core. */
agv_gate_result_t agv_gate_send(const agv_gate_t *gate, hal_t *hal, hal_can_side_t side, const hal_can_frame_t *frame);

#endif
