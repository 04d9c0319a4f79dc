/**
 * @file sim_bus.h
 * A classic CAN bus in one process, in virtual time: several nodes, arbitration, frame times, fault confinement.
 *
 * Time is a 64-bit count of microseconds that starts at 0 and moves only in sim_bus_run_until(). One bit lasts 8, 4, 2
 * or 1 us (125, 250, 500 kbit/s, 1 Mbit/s), so every moment is exact. The same calls give the same run, always.
 *
 * What happens at one moment: whatever was sent at the moment t takes part in the arbitration at t, in whatever order
 * the calls came, because a frame starts only when time moves on beyond t. A frame has arrived (and was sent
 * successfully) with the last bit of its end-of-frame field; three bits later the next one may start.
 *
 * Frame times assume the worst-case number of stuff bits (sim_bus_frame_bits()). Errors follow ISO 11898-1: a sender
 * whose frame fails adds 8 to its transmit error counter (TEC), a success takes 1 off; receivers add 1 to their receive
 * error counter (REC) or take 1 off; above 127 a node is error passive, and with a TEC above 255 it is bus-off.
 * Failed frames are sent again until they succeed, are purged, or their node goes bus-off.
 *
 * No allocation, no globals: the program owns the sim_bus_t. It may be copied by assignment to take a snapshot, and is
 * to be read through these functions only. A node number that was not given out: nothing happens, false, zeros.
 */
#ifndef HAL_SIM_SIM_BUS_H
#define HAL_SIM_SIM_BUS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "hal/can.h"

#define SIM_BUS_NODES_MAX 16u    /**< nodes on one bus */
#define SIM_BUS_TX_SLOTS_MAX 16u /**< mailboxes of one node */
#define SIM_BUS_RX_SLOTS_MAX 64u /**< receive queue of one node */
#define SIM_BUS_TAPS_MAX 4u      /**< listeners that are no nodes */

#define SIM_BUS_INTERFRAME_BITS 3u      /**< recessive bits between two frames */
#define SIM_BUS_SUSPEND_BITS 8u         /**< that an error-passive sender waits on top of it */
#define SIM_BUS_ERROR_BITS 20u          /**< error frame: 6 flag, at most 6 echoed flag, 8 delimiter bits */
#define SIM_BUS_RECOVERY_SEQUENCES 128u /**< of SIM_BUS_RECOVERY_BITS recessive bits each end bus-off */
#define SIM_BUS_RECOVERY_BITS 11u
#define SIM_BUS_NEVER UINT64_MAX   /**< sim_bus_due_us(): nothing is going on */
#define SIM_BUS_FOREVER UINT32_MAX /**< as a count of frames: until it is set anew */

/** Number of a node: 0 and up, in the order of attaching. */
typedef uint8_t sim_bus_node_t;
#define SIM_BUS_NO_NODE 0xFFu

/** Which of a node's waiting frames takes part in the arbitration. Equal IDs: always the older one. */
typedef enum {
    SIM_BUS_TX_BY_ID, /**< the one that would win on the bus (mailboxes, as most controllers have them) */
    SIM_BUS_TX_FIFO   /**< the oldest (a driver with one queue, such as Linux) */
} sim_bus_tx_order_t;

/**
 * A frame has arrived at a node. bus time is the moment of arrival. May call everything here but sim_bus_run_until().
 * @param frame flags, id, length and data as sent; time_ms = bus time in milliseconds, rounded down (wraps)
 */
typedef void sim_bus_receive_fn(void *ctx, const hal_can_frame_t *frame);

/** How a node is built. All zero: 8 mailboxes by ID, no receive queue, no callback. */
typedef struct {
    sim_bus_receive_fn *on_receive; /**< called for every frame that arrives, after it was queued; may be NULL */
    void *ctx;                      /**< handed to on_receive */
    uint8_t tx_slots;               /**< 1..SIM_BUS_TX_SLOTS_MAX; 0 = 8 */
    uint8_t rx_slots;               /**< 0 (no queue: on_receive is all) .. SIM_BUS_RX_SLOTS_MAX */
    sim_bus_tx_order_t tx_order;
    bool keep_on_bus_off; /**< waiting frames outlive bus-off and leave after the recovery, unless purged before */
} sim_bus_node_config_t;

/** What was on the wire. */
typedef struct {
    const hal_can_frame_t *frame; /**< time_ms = end_us in milliseconds, rounded down (wraps); valid during the call */
    uint64_t start_us;            /**< first bit */
    uint64_t end_us;              /**< last bit of end-of-frame or of the error delimiter */
    uint32_t senders;      /**< one bit a node: those whose frame this is; several when identical frames merged */
    sim_bus_node_t sender; /**< the lowest of them */
    bool error;            /**< the frame was destroyed by an error frame (or nobody acknowledged it) */
} sim_bus_event_t;

/** Called for every frame and every error frame, before the receivers get it. Must not change the bus. */
typedef void sim_bus_tap_fn(void *ctx, const sim_bus_event_t *event);

/** Counters since sim_bus_init(). */
typedef struct {
    uint64_t frames;  /**< that arrived */
    uint64_t errors;  /**< error frames */
    uint64_t busy_us; /**< time that the wire was taken by both, interframe bits included */
} sim_bus_stats_t;

/** @name Private: layout only, so that a program can own a bus. @{ */
typedef struct {
    hal_can_frame_t frame;
    uint64_t time_us;
} sim_bus_slot_t;

typedef struct {
    sim_bus_node_config_t config;
    uint16_t tec;
    uint16_t rec;
    uint8_t tx_count;
    uint8_t tx_current;
    uint8_t rx_head;
    uint8_t rx_count;
    bool current_aborted;
    bool powered;
    bool plugged;
    bool stalled;
    bool full;
    bool bus_off;
    uint16_t bus_off_count;
    uint16_t overrun_count;
    uint32_t recovery_left;
    uint32_t corrupt_sent;
    uint32_t corrupt_received;
    uint64_t suspend_until_us;
    uint64_t recovery_from_us;
    uint64_t alone_us;
    uint32_t tx_key[SIM_BUS_TX_SLOTS_MAX];
    sim_bus_slot_t tx[SIM_BUS_TX_SLOTS_MAX];
    sim_bus_slot_t rx[SIM_BUS_RX_SLOTS_MAX];
} sim_bus_node_state_t;

typedef struct {
    sim_bus_tap_fn *fn;
    void *ctx;
} sim_bus_tap_t;

typedef enum { SIM_BUS_ARRIVES, SIM_BUS_DESTROYED, SIM_BUS_NOT_ACKNOWLEDGED } sim_bus_outcome_t;

typedef struct {
    uint64_t now_us;
    uint64_t due_us;
    uint64_t free_us;
    uint64_t start_us;
    uint64_t end_us;
    uint32_t bit_us;
    uint32_t ready;
    uint32_t listening;
    uint32_t suspended;
    uint32_t alone;
    uint32_t recovering;
    uint32_t senders;
    uint32_t sending;
    uint32_t hearing;
    uint32_t dropped;
    uint32_t misread;
    uint32_t corrupting;
    uint32_t misreading;
    uint32_t corrupt_all;
    bool busy;
    uint8_t node_count;
    uint8_t tap_count;
    sim_bus_outcome_t outcome;
    hal_can_frame_t frame;
    sim_bus_stats_t stats;
    sim_bus_tap_t taps[SIM_BUS_TAPS_MAX];
    sim_bus_node_state_t nodes[SIM_BUS_NODES_MAX];
} sim_bus_t;

void sim_bus_process(sim_bus_t *bus, uint64_t until_us);
/** @} */

/** @name Building @{ */

/**
 * Make an empty bus at time 0.
 * @param bitrate 125000, 250000, 500000 or 1000000 bit/s
 * @return false: another bit rate; the bus must not be used.
 */
bool sim_bus_init(sim_bus_t *bus, uint32_t bitrate);

/**
 * Attach a node: powered, plugged in, error active.
 * @param config is copied; NULL = all zero
 * @return its number, or SIM_BUS_NO_NODE: the bus is full or the configuration out of range.
 */
sim_bus_node_t sim_bus_attach(sim_bus_t *bus, const sim_bus_node_config_t *config);

/** Listen to the wire. @return false: there are SIM_BUS_TAPS_MAX already. */
bool sim_bus_add_tap(sim_bus_t *bus, sim_bus_tap_fn *fn, void *ctx);
/** @} */

/** @name Time @{ */

/** Bus time in microseconds; inside a callback the moment of the event. */
static inline uint64_t sim_bus_now_us(const sim_bus_t *bus) {
    return bus->now_us;
}

/** The earliest moment to which time must run for something to happen; SIM_BUS_NEVER while nothing is going on. */
static inline uint64_t sim_bus_due_us(const sim_bus_t *bus) {
    return bus->due_us;
}

/**
 * Let time pass up to @p until_us; everything that ends up to this moment, itself included, has happened then, in the
 * order of time. A moment that is over already: nothing happens. Not to be called from a callback.
 */
static inline void sim_bus_run_until(sim_bus_t *bus, uint64_t until_us) {
    if (until_us >= bus->due_us) {
        sim_bus_process(bus, until_us);
    } else if (until_us > bus->now_us) {
        bus->now_us = until_us;
    }
}

/**
 * The same for several buses whose nodes send to each other from their callbacks (a gateway): what happens on all of
 * them happens in the order of time, at one moment in the order of the array, and all clocks read the same.
 */
void sim_bus_run_all_until(sim_bus_t *const buses[], size_t count, uint64_t until_us);
/** @} */

/** @name What a node's driver does @{ */

/**
 * Put a frame in a mailbox; it takes part in the next arbitration.
 * @param frame classic data or remote frame, 11 or 29 bits; time_ms is ignored, data beyond length is not sent
 * @return false: no mailbox free (or sim_bus_set_full()), bus-off, no power, or no classic frame (HAL_CAN_FD,
 *         HAL_CAN_ERROR, a length above 8, an ID that is too large).
 */
bool sim_bus_send(sim_bus_t *bus, sim_bus_node_t node, const hal_can_frame_t *frame);

/** Discard the waiting frames. One that is on the wire still may succeed, but is not sent again when it fails. */
void sim_bus_purge(sim_bus_t *bus, sim_bus_node_t node);

/**
 * Start the recovery from bus-off; nothing otherwise. It ends after 128 times 11 recessive bits (idle bus: 1408 bits;
 * the end of each frame of others counts as 11), with both error counters at 0.
 */
void sim_bus_recover(sim_bus_t *bus, sim_bus_node_t node);

/** What hal_can_status() reports. tx_pending_ms: full milliseconds since the oldest frame was taken, at least 1. */
void sim_bus_status(const sim_bus_t *bus, sim_bus_node_t node, hal_can_status_t *status);

/**
 * Take the oldest frame from the receive queue.
 * @param frame time_ms = bus time of arrival in milliseconds, rounded down (wraps)
 * @param time_us moment of arrival; may be NULL
 * @return false: empty.
 */
bool sim_bus_receive(sim_bus_t *bus, sim_bus_node_t node, hal_can_frame_t *frame, uint64_t *time_us);
/** @} */

/** @name What can go wrong, on demand @{ */

/**
 * Switch a node off or on. Off: it neither sends, receives nor acknowledges, what it is sending breaks off, queues are
 * emptied. On: as freshly attached (counters at 0, error active); its faults below stay as they are.
 */
void sim_bus_set_power(sim_bus_t *bus, sim_bus_node_t node, bool on);

/** Unplug or plug a node. Unplugged it is alone on a wire of its own: it hears nothing, and nobody acknowledges. */
void sim_bus_set_plugged(sim_bus_t *bus, sim_bus_node_t node, bool plugged);

/** A stalled node never gets to send: its frames wait. It receives and acknowledges as before. */
void sim_bus_set_stalled(sim_bus_t *bus, sim_bus_node_t node, bool stalled);

/** While set, sim_bus_send() of this node returns false as with all mailboxes taken. */
void sim_bus_set_full(sim_bus_t *bus, sim_bus_node_t node, bool full);

/** The next @p count frames of anybody are destroyed by an error frame after their last bit; 0 = no more. */
void sim_bus_corrupt_all(sim_bus_t *bus, uint32_t count);

/** The next @p count frames that this node sends are destroyed, for everybody; 0 = no more. */
void sim_bus_corrupt_sent(sim_bus_t *bus, sim_bus_node_t node, uint32_t count);

/**
 * This node, and it alone, cannot read the next @p count frames of others; 0 = no more. Its error frame destroys them
 * for everybody while it is error active (its REC rises by 9 each time), and costs itself the frame when passive.
 */
void sim_bus_corrupt_received(sim_bus_t *bus, sim_bus_node_t node, uint32_t count);

/** Set both error counters of a node with power; a TEC above 255 is bus-off at once. Does not end bus-off. */
void sim_bus_set_error_counters(sim_bus_t *bus, sim_bus_node_t node, uint16_t tec, uint16_t rec);

/** Bus-off at once (as a TEC above 255). */
void sim_bus_force_bus_off(sim_bus_t *bus, sim_bus_node_t node);

/** Count an overrun, as if a frame had been lost in the controller. */
void sim_bus_inject_overrun(sim_bus_t *bus, sim_bus_node_t node);

/**
 * Hand any frame to one node as received now, past the wire: also those that this bus does not carry (HAL_CAN_FD,
 * HAL_CAN_ERROR). Only a node that is powered and not bus-off gets it.
 */
void sim_bus_deliver(sim_bus_t *bus, sim_bus_node_t node, const hal_can_frame_t *frame);
/** @} */

/** @name Looking @{ */

/** Error counters: TEC 0..255 (above: bus-off), REC 0..255. Either pointer may be NULL. */
void sim_bus_error_counters(const sim_bus_t *bus, sim_bus_node_t node, uint16_t *tec, uint16_t *rec);

/** Frames waiting in the node's mailboxes, the one on the wire included. */
size_t sim_bus_waiting(const sim_bus_t *bus, sim_bus_node_t node);

/** Counters of the wire. */
void sim_bus_stats(const sim_bus_t *bus, sim_bus_stats_t *stats);

/**
 * Longest length of a frame in bits, from the start bit to the last bit of end-of-frame, with as many stuff bits as any
 * content can need; SIM_BUS_INTERFRAME_BITS come on top. 11-bit ID with n bytes: 44 + 8n + floor((34 + 8n - 1) / 4),
 * 29-bit ID: 64 + 8n + floor((54 + 8n - 1) / 4). A remote frame carries no data: n = 0.
 */
uint32_t sim_bus_frame_bits(const hal_can_frame_t *frame);
/** @} */

#endif
