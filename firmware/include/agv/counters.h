/**
 * @file counters.h
 * What a supervisor counts. Counters never go down but for their wrap.
 */
#ifndef AGV_COUNTERS_H
#define AGV_COUNTERS_H

#include <stdint.h>

/** Why a frame was rejected (P15). A frame with several of these properties counts under the last of them. */
typedef enum {
    AGV_REJECTED_LENGTH,   /**< identifier of the protocol, DLC not 8 */
    AGV_REJECTED_FD,       /**< CAN FD */
    AGV_REJECTED_REMOTE,   /**< remote request */
    AGV_REJECTED_EXTENDED, /**< 29-bit identifier */
    AGV_REJECTED_ERROR,    /**< error frame */
    AGV_REJECTED_KINDS
} agv_rejected_t;

/** The counters of one supervisor. */
typedef struct {
    uint32_t received; /**< frames handed in, of any kind, both sides */
    uint32_t rejected[AGV_REJECTED_KINDS];
    uint32_t dropped;  /**< commands out of range, frames not passed on by the gateway, frames that could not be sent */
    uint32_t sent;     /**< frames that the HAL took */
    uint32_t shadowed; /**< frames that would have been sent, but for the shadow mode (TOP-4) */
    uint32_t gate_refused;  /**< frames that the gate refused (INT-4) */
    uint32_t skipped_slots; /**< periodic slots missed after an overrun (TIM-1) */
    uint32_t limited;       /**< commands that the envelope of the gateway changed (TOP-2) */
    uint32_t warnings;      /**< faults raised as warnings */
} agv_counters_t;

#endif
