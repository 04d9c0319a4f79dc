/**
 * @file counters.h
 * The counters of a supervisor. They only increase, and wrap.
 */
#ifndef AGV_COUNTERS_H
#define AGV_COUNTERS_H

#include <stdint.h>

/** Why a frame was rejected (P15). A frame with several of these properties is counted under the last of them. */
typedef enum {
    AGV_REJECTED_LENGTH,   /**< the identifier of a message, but its DLC is not 8 */
    AGV_REJECTED_FD,       /**< CAN FD */
    AGV_REJECTED_REMOTE,   /**< remote request */
    AGV_REJECTED_EXTENDED, /**< 29-bit identifier */
    AGV_REJECTED_ERROR,    /**< error frame */
    AGV_REJECTED_KINDS
} agv_rejected_t;

/** The counters of one supervisor, since its start (INT-2). They go on after MEMORY_CORRUPTED, and wrap. */
typedef struct {
    uint32_t received;                     /**< frames received, of any kind, on both sides */
    uint32_t rejected[AGV_REJECTED_KINDS]; /**< frames that were not evaluated, by reason */
    uint32_t
        dropped; /**< invalid commands, frames of the wrong side or (gateway) with an unknown identifier, and frames that were
                            not sent or forwarded */
    uint32_t sent;          /**< frames that the HAL accepted */
    uint32_t shadowed;      /**< frames not sent because of the shadow mode (TOP-4) */
    uint32_t gate_refused;  /**< frames that the gate refused (INT-4) */
    uint32_t skipped_slots; /**< transmit slots missed after an overrun (TIM-1) */
    uint32_t limited;       /**< commands that the gateway limited (TOP-2) */
    uint32_t warnings;      /**< faults raised as warnings */
} agv_counters_t;

#endif
