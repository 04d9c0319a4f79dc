/**
 * @file sim_internal.h
 * Declarations that the source files of the simulated bus share.
 *
 * The bus keeps sets of nodes as bit masks, so that a quiet bus costs one comparison a call:
 * - listening: on the bus, not bus-off; receives and acknowledges
 * - ready: a listening node with a frame that may start
 * - alone: unplugged and not error passive, with a frame to send
 * - recovering: recovering from bus-off
 * - suspended: error passive, and perhaps still in its suspend time
 * - corrupting, misreading: nodes with injected errors
 * - of the current frame: senders; sending and hearing (senders and receivers that have not left the bus since it began);
 *   dropped (stopped sending after a bit error); misread (could not read the frame)
 *
 * due_us is the time of the next event. Every function that changes another member calls sim_bus_schedule() at its end.
 */
#ifndef SIM_INTERNAL_H
#define SIM_INTERNAL_H

#include "hal_sim/sim_bus.h"

#define SIM_TEC_FAILED 8u
#define SIM_TEC_MAX 255u
#define SIM_REC_MAX 255u
#define SIM_PASSIVE_ABOVE 127u

/**
 * A frame without acknowledge ends after the acknowledge slot: the slot's delimiter and the 7 end bits are not sent.
 */
#define SIM_BITS_AFTER_ACKNOWLEDGE 8u

/** The bit of a node in a set. */
static inline uint32_t sim_bit(unsigned node) {
    return UINT32_C(1) << node;
}

/** The lowest node of a set that is not empty. */
static inline unsigned sim_lowest(uint32_t set) {
#if defined(__GNUC__)
    return (unsigned)__builtin_ctz(set);
#else
    unsigned node = 0;
    while ((set & sim_bit(node)) == 0) {
        node++;
    }
    return node;
#endif
}

static inline bool sim_is_passive(const sim_bus_node_state_t *node) {
    return node->tec > SIM_PASSIVE_ABOVE || node->rec > SIM_PASSIVE_ABOVE;
}

/** The mailbox that takes part in the arbitration. The node has a frame. */
static inline unsigned sim_bus_choose(const sim_bus_node_state_t *node) {
    unsigned chosen = 0;
    if (node->config.tx_order == SIM_BUS_TX_BY_ID) {
        for (unsigned i = 1; i < node->tx_count; i++) {
            if (node->tx_key[i] < node->tx_key[chosen]) {
                chosen = i;
            }
        }
    }
    return chosen;
}

/*
 * The layers of the source files, lowest first. Each file calls only earlier ones:
 * sim_frame.c, sim_node.c, sim_spoil.c, sim_schedule.c, sim_fault.c, sim_wire.c, then sim_bus.c and sim_inject.c.
 */

/** @name sim_frame.c @{ */
/** Order of arbitration: the lower number wins. Only equal numbers collide. */
uint32_t sim_frame_key(const hal_can_frame_t *frame);

/** Whether the frame is a classic one, the only kind that this bus carries. */
bool sim_frame_is_classic(const hal_can_frame_t *frame);

/** Number of bits from the start bit to the DLC, without stuff bits and DLC. */
uint32_t sim_frame_header_bits(const hal_can_frame_t *frame);

/** A bit of the body, which is DLC and data. @param index 0 = first bit of the DLC */
bool sim_frame_bit(const hal_can_frame_t *frame, uint32_t index);

/** Number of bits of the body. */
uint32_t sim_frame_body_bits(const hal_can_frame_t *frame);
/** @} */

/** @name sim_node.c @{ */
/** Empty a mailbox. The later ones move up, so that the mailboxes stay in the order of the requests. */
void sim_bus_remove(sim_bus_node_state_t *node, unsigned slot);

/** Pass a frame to a node that receives it: queue and callback. */
void sim_bus_arrive(sim_bus_node_state_t *node, const hal_can_frame_t *frame, uint64_t time_us);

/** Add to the receive error counter (REC). */
void sim_bus_misread(sim_bus_node_state_t *node, unsigned amount);
/** @} */

/** @name sim_spoil.c @{ */
/** Apply the injected errors to the frame that begins. @return true: the frame is destroyed. */
bool sim_bus_spoil(sim_bus_t *bus);
/** @} */

/** @name sim_schedule.c @{ */
/** Compute due_us. */
void sim_bus_schedule(sim_bus_t *bus);

/** Duration of one of the sequences of recessive bits that the recovery counts. */
static inline uint64_t sim_bus_sequence_us(const sim_bus_t *bus) {
    return (uint64_t)SIM_BUS_RECOVERY_BITS * bus->bit_us;
}

/** End of a node's recovery; SIM_BUS_NEVER while its count is paused. */
uint64_t sim_bus_recovered_us(const sim_bus_t *bus, const sim_bus_node_state_t *node);
/** @} */

/** @name sim_fault.c @{ */
/** Update the sets of nodes for a node whose state changed. If it has left the bus, its current frame is aborted. */
void sim_bus_refresh(sim_bus_t *bus, unsigned number);

/** Count a failed frame of a node: TEC + 8, which may cause bus-off. */
void sim_bus_penalise(sim_bus_t *bus, unsigned number);

void sim_bus_enter_bus_off(sim_bus_t *bus, unsigned number);

/** Called when a frame begins: counts the recessive bits of the idle bus until now, then pauses the recovery. */
void sim_bus_pause_recovery(sim_bus_t *bus);

/** Called at the end of a frame or error frame: counts its 11 recessive bits, and continues the recovery. */
void sim_bus_resume_recovery(sim_bus_t *bus);

/** Process the events that are due now for nodes that are alone or recovering. */
void sim_bus_run_aside(sim_bus_t *bus);
/** @} */

#endif
