/**
 * @file sim_bus.h
 * A classic CAN bus in one process, in virtual time: several nodes, arbitration, frame times, fault confinement.
 *
 * Time is a 64-bit count of microseconds that starts at 0 and advances only in sim_bus_run_until(). One bit lasts 8, 4, 2
 * or 1 us (125, 250, 500 kbit/s, 1 Mbit/s), so all times are exact. The same calls always give the same run.
 *
 * All frames sent at a time t take part in the arbitration at t, in any order of the calls, because a frame starts only
 * when time advances beyond t. A frame is received (and sent successfully) with the last bit of its end-of-frame field;
 * the next frame may start three bits later.
 *
 * Frame times assume the worst-case number of stuff bits (sim_bus_frame_bits()). Errors follow ISO 11898-1: a sender
 * adds 8 to its transmit error counter (TEC) for a failed frame and subtracts 1 for a successful one; receivers add 1 to
 * their receive error counter (REC) or subtract 1. Above 127 a node is error passive; with a TEC above 255 it is bus-off.
 * Failed frames are retransmitted until they succeed, are purged, or their node goes bus-off.
 *
 * There is no allocation and no global state: the program owns the sim_bus_t. Copy it by assignment to take a snapshot;
 * read it through these functions only. For an invalid node number the functions do nothing, and return false or zeros.
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
#define SIM_BUS_TAPS_MAX 4u      /**< listeners that are not nodes */

#define SIM_BUS_INTERFRAME_BITS 3u      /**< recessive bits between two frames */
#define SIM_BUS_SUSPEND_BITS 8u         /**< further bits that an error-passive sender waits */
#define SIM_BUS_ERROR_BITS 20u          /**< error frame: 6 flag, at most 6 echoed flag, 8 delimiter bits */
#define SIM_BUS_RECOVERY_SEQUENCES 128u /**< sequences of SIM_BUS_RECOVERY_BITS recessive bits that end bus-off */
#define SIM_BUS_RECOVERY_BITS 11u
#define SIM_BUS_NEVER UINT64_MAX   /**< sim_bus_due_us(): no event is due */
#define SIM_BUS_FOREVER UINT32_MAX /**< number of frames: until it is set again */

/** Number of a node: 0 and up, in the order of attaching. */
typedef uint8_t sim_bus_node_t;
#define SIM_BUS_NO_NODE 0xFFu

/** Which of a node's waiting frames takes part in the arbitration. Of two frames with the same ID the older one. */
typedef enum {
    SIM_BUS_TX_BY_ID, /**< the one that would win on the bus (mailboxes, as most controllers have them) */
    SIM_BUS_TX_FIFO   /**< the oldest (a driver with one queue, such as Linux) */
} sim_bus_tx_order_t;

/**
 * Called when a node receives a frame, at that bus time. It may call all functions except sim_bus_run_until().
 * @param frame flags, id, length and data as sent; time_ms = bus time in milliseconds, rounded down (wraps)
 */
typedef void sim_bus_receive_fn(void *ctx, const hal_can_frame_t *frame);

/** Properties of a node. All zero: 8 mailboxes by ID, no receive queue, no callback. */
typedef struct {
    sim_bus_receive_fn *on_receive; /**< called for every received frame, after it was queued; may be NULL */
    void *ctx;                      /**< passed to on_receive */
    uint8_t tx_slots;               /**< 1..SIM_BUS_TX_SLOTS_MAX; 0 = 8 */
    uint8_t rx_slots;               /**< 0 (no queue, only on_receive) .. SIM_BUS_RX_SLOTS_MAX */
    sim_bus_tx_order_t tx_order;
    bool keep_on_bus_off; /**< frames that wait at bus-off are sent after the recovery, unless they are purged */
} sim_bus_node_config_t;

/** A frame or an error frame on the bus. */
typedef struct {
    const hal_can_frame_t *frame; /**< time_ms = end_us in milliseconds, rounded down (wraps); valid during the call */
    uint64_t start_us;            /**< first bit */
    uint64_t end_us;              /**< last bit of end-of-frame or of the error delimiter */
    uint32_t senders;             /**< bit n: node n sent it; several nodes if their frames were identical */
    sim_bus_node_t sender;        /**< the lowest of them */
    bool error;                   /**< the frame was destroyed by an error frame, or was not acknowledged */
} sim_bus_event_t;

/** Called for every frame and every error frame, before the receivers get it. It must not change the bus. */
typedef void sim_bus_tap_fn(void *ctx, const sim_bus_event_t *event);

/** Counters since sim_bus_init(). */
typedef struct {
    uint64_t frames;  /**< successful frames */
    uint64_t errors;  /**< error frames */
    uint64_t busy_us; /**< time taken by both, including interframe bits */
    uint64_t purged;  /**< frames that were taken back, and never sent */
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

/** Add a listener. @return false: there are SIM_BUS_TAPS_MAX already. */
bool sim_bus_add_tap(sim_bus_t *bus, sim_bus_tap_fn *fn, void *ctx);
/** @} */

/** @name Time @{ */

/** Bus time in microseconds; in a callback the time of the event. */
static inline uint64_t sim_bus_now_us(const sim_bus_t *bus) {
    return bus->now_us;
}

/** Time of the next event of the bus; SIM_BUS_NEVER if none is due. */
static inline uint64_t sim_bus_due_us(const sim_bus_t *bus) {
    return bus->due_us;
}

/**
 * Advance the time to @p until_us, and process all events up to and including it, in the order of time. Does nothing for a
 * time in the past. Must not be called from a callback.
 */
static inline void sim_bus_run_until(sim_bus_t *bus, uint64_t until_us) {
    if (until_us >= bus->due_us) {
        sim_bus_process(bus, until_us);
    } else if (until_us > bus->now_us) {
        bus->now_us = until_us;
    }
}

/**
 * Advance several buses whose nodes send to each other from their callbacks (a gateway). Events are processed in the order
 * of time, those at the same time in the order of the array, and all buses have the same time.
 */
void sim_bus_run_all_until(sim_bus_t *const buses[], size_t count, uint64_t until_us);
/** @} */

/** @name Driver of a node @{ */

/**
 * Put a frame in a mailbox; it takes part in the next arbitration.
 * @param frame classic data or remote frame, 11 or 29 bits; time_ms is ignored, data beyond length is not sent
 * @return false: no free mailbox (or sim_bus_set_full()), bus-off, no power, or not a classic frame (HAL_CAN_FD,
 *         HAL_CAN_ERROR, a length above 8, an ID that is too large).
 */
bool sim_bus_send(sim_bus_t *bus, sim_bus_node_t node, const hal_can_frame_t *frame);

/** Discard the waiting frames. One that is being transmitted may still succeed, but is not retransmitted if it fails. */
void sim_bus_purge(sim_bus_t *bus, sim_bus_node_t node);

/**
 * Start the recovery from bus-off; does nothing otherwise. It ends after 128 times 11 recessive bits (on an idle bus 1408
 * bits; the end of each frame of others counts as 11), with both error counters at 0.
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

/** @name Fault injection @{ */

/**
 * Switch a node off or on. Off: it does not send, receive or acknowledge; its current frame is aborted, and its queues are
 * emptied. On: as just attached (counters at 0, error active); its injected faults remain.
 */
void sim_bus_set_power(sim_bus_t *bus, sim_bus_node_t node, bool on);

/** Unplug a node or plug it in. An unplugged node is alone: it receives nothing, and its frames are not acknowledged. */
void sim_bus_set_plugged(sim_bus_t *bus, sim_bus_node_t node, bool plugged);

/** Stall a node: its frames wait and are not sent. It still receives and acknowledges. */
void sim_bus_set_stalled(sim_bus_t *bus, sim_bus_node_t node, bool stalled);

/** While set, sim_bus_send() of this node returns false, as if all mailboxes were in use. */
void sim_bus_set_full(sim_bus_t *bus, sim_bus_node_t node, bool full);

/** Destroy the next @p count frames of all nodes by an error frame after their last bit; 0 = stop. */
void sim_bus_corrupt_all(sim_bus_t *bus, uint32_t count);

/** Destroy the next @p count frames of this node, for all receivers; 0 = stop. */
void sim_bus_corrupt_sent(sim_bus_t *bus, sim_bus_node_t node, uint32_t count);

/**
 * Only this node cannot read the next @p count frames of others; 0 = stop. While it is error active, its error frames
 * destroy them for all receivers (its REC increases by 9 each time); while it is error passive, only it loses the frame.
 */
void sim_bus_corrupt_received(sim_bus_t *bus, sim_bus_node_t node, uint32_t count);

/** Set both error counters of a node with power; a TEC above 255 is bus-off at once. Does not end bus-off. */
void sim_bus_set_error_counters(sim_bus_t *bus, sim_bus_node_t node, uint16_t tec, uint16_t rec);

/** Set a node to bus-off at once (as a TEC above 255 does). */
void sim_bus_force_bus_off(sim_bus_t *bus, sim_bus_node_t node);

/** Count an overrun, as if the controller had lost a frame. */
void sim_bus_inject_overrun(sim_bus_t *bus, sim_bus_node_t node);

/**
 * Let one node receive a frame now that is not on the bus. The frame may be of a kind that the bus does not carry
 * (HAL_CAN_FD, HAL_CAN_ERROR). Only a node that has power and is not bus-off receives it.
 */
void sim_bus_deliver(sim_bus_t *bus, sim_bus_node_t node, const hal_can_frame_t *frame);
/** @} */

/** @name Status @{ */

/** Error counters: TEC 0..255 (above: bus-off), REC 0..255. Either pointer may be NULL. */
void sim_bus_error_counters(const sim_bus_t *bus, sim_bus_node_t node, uint16_t *tec, uint16_t *rec);

/** Number of frames in the node's mailboxes, including the one that is being transmitted. */
size_t sim_bus_waiting(const sim_bus_t *bus, sim_bus_node_t node);

/** Counters of the bus. */
void sim_bus_stats(const sim_bus_t *bus, sim_bus_stats_t *stats);

/**
 * Longest length of a frame in bits, from the start bit to the last bit of end-of-frame, with as many stuff bits as any
 * content can need; SIM_BUS_INTERFRAME_BITS come on top. 11-bit ID with n bytes: 44 + 8n + floor((34 + 8n - 1) / 4),
 * 29-bit ID: 64 + 8n + floor((54 + 8n - 1) / 4). A remote frame carries no data: n = 0.
 */
uint32_t sim_bus_frame_bits(const hal_can_frame_t *frame);
/** @} */

#endif
