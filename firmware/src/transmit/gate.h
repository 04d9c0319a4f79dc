/**
 * @file gate.h
 * The gate (INT-4): every frame leaves through here, the last code before the HAL. It knows the state and the raw frame,
 * trusts nobody who asks, and says FSM-6 in terms of identifiers and bytes:
 *
 * - INIT, TRIPPED, SAFE (and whatever is no state), vehicle side: 43Fh with autopilot off, both turn signals and
 *   headlight on; 168h P; 075h 0; 065h with the held angle (not in INIT). Reserved bits 0, nothing else.
 * - STANDBY, ACTIVE, vehicle side: shared bus nothing; gateway 43Fh with any lights, 075h with 0, and in ACTIVE (or when
 *   all commands pass in manual) valid gear, throttle up to the ceiling (not in manual), angle in range. Reserved bits 0.
 * - AI side: the seven status messages, gateway only.
 * - The supervisor's own status frame, vehicle side, when it is configured.
 */
#ifndef AGV_GATE_H
#define AGV_GATE_H

#include <stdbool.h>
#include <stdint.h>

#include "agv/config.h"
#include "hal/can.h"
#include "hal/hal.h"

/** What the gate goes by. */
typedef struct {
    const agv_config_t *config; /**< topology, ceiling, shadow, status frame */
    const agv_ids_t *ids;
    uint16_t hold_raw;   /**< held steering angle, raw 0..18000 */
    uint16_t hold_check; /**< its complement; anything else: no angle is held */
    uint8_t state;       /**< agv_state_t */
} agv_gate_t;

/** What became of a frame. */
typedef enum {
    AGV_GATE_BUSY,     /**< the HAL did not take it */
    AGV_GATE_SENT,     /**< the HAL took it */
    AGV_GATE_SHADOWED, /**< it may leave, but nothing leaves in shadow mode */
    AGV_GATE_REFUSED   /**< it may not leave in this state */
} agv_gate_result_t;

/** Whether a frame may leave. Pure. */
bool agv_gate_allows(const agv_gate_t *gate, hal_can_side_t side, const hal_can_frame_t *frame);

/** Send a frame if it may leave. The one caller of hal_can_send in the core. */
agv_gate_result_t agv_gate_send(const agv_gate_t *gate, hal_t *hal, hal_can_side_t side, const hal_can_frame_t *frame);

#endif
