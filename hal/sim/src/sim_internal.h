/**
 * @file sim_internal.h
 * What the source files of the simulated bus share.
 *
 * The bus keeps sets of nodes as bit masks, so that a quiet bus costs one comparison a call:
 * listening  on the wire, not bus-off: hears and acknowledges          ready      of those, has a frame that may start
 * alone      unplugged and not passive, with a frame to send           recovering on the way back from bus-off
 * suspended  error passive and perhaps still in its suspend time       corrupting, misreading: errors are ordered
 * and about the frame on the wire: senders (whose it is), sending and hearing (of senders and receivers, those that
 * have not left since it began), dropped (lost a collision without a word), misread (could not read it).
 *
 * due_us is the one number that says when something happens next; whoever changes anything else calls
 * sim_bus_schedule() at the end.
 */
#ifndef SIM_INTERNAL_H
#define SIM_INTERNAL_H

#include "hal_sim/sim_bus.h"

#define SIM_TEC_FAILED 8u
#define SIM_TEC_MAX 255u
#define SIM_REC_MAX 255u
#define SIM_PASSIVE_ABOVE 127u

/** A frame that nobody acknowledges breaks off after the acknowledge slot: its delimiter and 7 end bits are not sent. */
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
 * The files from below to above; each calls only those before it:
 * sim_frame.c, sim_node.c, sim_spoil.c, sim_schedule.c, sim_fault.c, sim_wire.c; sim_bus.c and sim_inject.c beside it.
 */

/** @name sim_frame.c @{ */
/** Order of arbitration: the lower number wins. Only equal numbers collide. */
uint32_t sim_frame_key(const hal_can_frame_t *frame);

/** Whether this bus can carry it. */
bool sim_frame_is_classic(const hal_can_frame_t *frame);

/** Number of bits from the start bit to the DLC, without stuff bits and DLC. */
uint32_t sim_frame_header_bits(const hal_can_frame_t *frame);

/** Bit @p index (0 = first of the DLC) of what follows the header. */
bool sim_frame_bit(const hal_can_frame_t *frame, uint32_t index);

/** Number of these bits: DLC and data. */
uint32_t sim_frame_body_bits(const hal_can_frame_t *frame);
/** @} */

/** @name sim_node.c @{ */
/** Empty a mailbox; those behind it move up, so that they stay in the order of their requests. */
void sim_bus_remove(sim_bus_node_state_t *node, unsigned slot);

/** A frame arrives at a node that can hear it. */
void sim_bus_arrive(sim_bus_node_state_t *node, const hal_can_frame_t *frame, uint64_t time_us);

/** REC + amount. */
void sim_bus_misread(sim_bus_node_state_t *node, unsigned amount);
/** @} */

/** @name sim_spoil.c @{ */
/** Errors that were ordered and hit the frame that begins. @return true: it is destroyed. */
bool sim_bus_spoil(sim_bus_t *bus);
/** @} */

/** @name sim_schedule.c @{ */
/** Work out due_us anew. */
void sim_bus_schedule(sim_bus_t *bus);

/** How long one sequence of recessive bits takes that counts for the recovery. */
static inline uint64_t sim_bus_sequence_us(const sim_bus_t *bus) {
    return (uint64_t)SIM_BUS_RECOVERY_BITS * bus->bit_us;
}

/** When a node that is recovering is back; SIM_BUS_NEVER while the count stands still. */
uint64_t sim_bus_recovered_us(const sim_bus_t *bus, const sim_bus_node_state_t *node);
/** @} */

/** @name sim_fault.c @{ */
/** Bring the sets in line with what the node is now; one that has left the wire breaks off what it was sending. */
void sim_bus_refresh(sim_bus_t *bus, unsigned number);

/** A frame of this node failed: TEC + 8, and what follows from it. */
void sim_bus_penalise(sim_bus_t *bus, unsigned number);

void sim_bus_enter_bus_off(sim_bus_t *bus, unsigned number);

/** A frame begins: the recessive bits of the idle wire until now count for the recovery, then the count stands still. */
void sim_bus_pause_recovery(sim_bus_t *bus);

/** The end of a frame or error frame: 11 recessive bits for all that are recovering on this wire. */
void sim_bus_resume_recovery(sim_bus_t *bus);

/** Do what is due now for the nodes that are alone or recovering. */
void sim_bus_run_aside(sim_bus_t *bus);
/** @} */

#endif
