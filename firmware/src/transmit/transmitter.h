/**
 * @file transmitter.h
 * Sends the supervisor's own safe commands in their slots, the frames that the gateway forwards, and the status frame, all
 * through the gate (gate.h). A frame that the HAL does not accept waits here, at most one per identifier, the newest. Own
 * frames are built when they are sent, so that none is stale.
 */
#ifndef AGV_TRANSMITTER_H
#define AGV_TRANSMITTER_H

#include <stdbool.h>
#include <stdint.h>

#include "agv/protocol.h"
#include "agv/state.h"
#include "agv/version.h"
#include "base/timers.h"
#include "decide/hold.h"
#include "hal/can.h"
#include "transmit/scheduler.h"

/** Sets of messages, bit n is message n: the commands, and the status messages that are forwarded to the AI side. */
#define AGV_SET_COMMANDS (((uint32_t)1u << AGV_COMMAND_COUNT) - 1u)
#define AGV_SET_STATUS ((((uint32_t)1u << (uint32_t)AGV_MSG_COUNT) - 1u) & ~AGV_SET_COMMANDS)

/** Status frame (TOP-3), byte 2: no first reason. */
#define AGV_STATUS_FRAME_NO_REASON 0xFFu

/** Page of a status frame: bits 5..8 of byte 3. It tells what bytes 5..8 are. */
#define AGV_STATUS_PAGE_STATE 0u    /**< checksum of the configuration */
#define AGV_STATUS_PAGE_VERSION 1u  /**< version: major, minor, patch */
#define AGV_STATUS_PAGE_REVISION 2u /**< revision of the sources */

/** What the transmitter has done since the last report. The counts have the meaning of agv_counters_t. */
typedef struct {
    uint16_t sent;
    uint16_t shadowed;
    uint16_t refused;       /**< refused by the gate (TX_GATE_REFUSED) */
    uint16_t dropped;       /**< frames that waited and were replaced or discarded */
    uint32_t skipped_slots; /**< TIM-1 */
    uint8_t passed;         /**< forwarded commands of the AI computer, bit n = command n */
    bool park_sent;         /**< an own 168h was sent */
    bool hold_sent;         /**< an own 065h was sent */
} agv_tx_report_t;

/** The transmitter. */
typedef struct {
    agv_scheduler_t scheduler;
    uint32_t status_due_ms;                /**< when the next status frame is due */
    uint32_t status_ms;                    /**< when the last one was handed to the HAL */
    uint32_t tick_ms;                      /**< the last tick */
    uint32_t kept;                         /**< frames that wait to be forwarded, bit n = message n */
    uint32_t passed_ms[AGV_COMMAND_COUNT]; /**< when a command was last forwarded */
    agv_tx_report_t report;
    uint8_t kept_data[AGV_MSG_COUNT][AGV_DLC];
    uint8_t wanted_before;  /**< own commands that were sent periodically at the last tick */
    uint8_t foreign_lately; /**< commands of other senders that differ, since the last tick; upper half: before it */
    uint8_t alone[AGV_COMMAND_COUNT]; /**< high: they lately came alone, not in bursts */
    uint8_t passed_lately;            /**< commands that were forwarded less than half their cycle ago */
    bool status_again;                /**< the last status frame may have been discarded with the waiting frames */
    bool throttle_0_waits;            /**< the 075h at the end of an engagement waits for the HAL */
    uint8_t alive_counter;            /**< of the own 43Fh */
    uint8_t status_counter;           /**< alive counter of the status frame */
} agv_transmitter_t;

/** Inputs of the transmitter, from the supervisor at each call. */
typedef struct {
    hal_t *hal;
    const agv_config_t *config;
    const agv_ids_t *ids;
    agv_timers_t *timers;
    agv_hold_t hold;      /**< steering angle of the own 065h */
    uint8_t state;        /**< agv_state_t */
    uint8_t first_reason; /**< agv_fault_t */
    bool output_closed;
    bool park_released; /**< own 168h may be sent (FSM-1) */
    bool holdable;      /**< own 065h may be sent (FSM-10) */
    bool passive;       /**< ERROR_PASSIVE: overrides wait until a burst is over */
    uint32_t config_checksum;
    const agv_version_t *version; /**< NULL: none */
} agv_tx_orders_t;

/** Start, from zeroed memory. The slots begin with the first burst; the first status frame is due now. */
void agv_transmitter_start(agv_transmitter_t *transmitter, uint32_t now_ms);

/** Discard the frames that wait to be sent on a side. */
void agv_transmitter_discard(agv_transmitter_t *transmitter, agv_timers_t *timers, hal_can_side_t side);

/**
 * Discard the frames that wait to be sent to the vehicle, in TRIPPED and SAFE.
 * @param status_again send the status frame again at once; false: in its next slot, because it may be what cannot leave
 */
void agv_transmitter_withdraw(agv_transmitter_t *transmitter, agv_timers_t *timers, bool status_again);

/** Send all commands of the state at once, and restart their slots (FSM-2). */
void agv_transmitter_burst(agv_transmitter_t *transmitter, const agv_tx_orders_t *orders);

/**
 * Override another sender's command, now or when override_gap_ms is over, if the own one is sent in this state and
 * differs (TOP-1). While the controller is error-passive, the override is sent right behind a frame of a sender that pauses
 * for 2 ms or more between its frames. Otherwise it waits for the end of a ms in which no such frame came: between frames that
 * follow each other without a gap it would collide each time, up to bus-off.
 * @param data its payload; NULL if it is malformed, which always counts as different
 */
void agv_transmitter_answer(agv_transmitter_t *transmitter, const agv_tx_orders_t *orders, uint32_t command,
                            const uint8_t *data);

/**
 * Forward a frame to the other side (TOP-2). A command is forwarded at most once in half its cycle: one that comes sooner
 * waits, and a newer one replaces it.
 */
void agv_transmitter_pass(agv_transmitter_t *transmitter, const agv_tx_orders_t *orders, uint32_t message,
                          const uint8_t data[AGV_DLC]);

/** Drop a command that waits to be forwarded: its bit is set in `kept`. */
void agv_transmitter_drop(agv_transmitter_t *transmitter, agv_timers_t *timers, uint32_t command);

/**
 * The end of an engagement (TOP-2). What waits in the controller is purged: a command of motion may not leave after it. One
 * 075h with throttle 0 is sent: otherwise the vehicle's latest throttle command at the next engagement would be an old one.
 */
void agv_transmitter_end_engagement(agv_transmitter_t *transmitter, const agv_tx_orders_t *orders);

/** The payload of the last forwarded command of this kind. */
const uint8_t *agv_transmitter_passed(const agv_transmitter_t *transmitter, uint32_t command);

/** Send the status frame if it is due (TOP-3); a part of agv_transmitter_tick. */
void agv_transmitter_status(agv_transmitter_t *transmitter, const agv_tx_orders_t *orders);

/** Send everything that is due: waiting frames, overrides, slots, the status frame. */
void agv_transmitter_tick(agv_transmitter_t *transmitter, const agv_tx_orders_t *orders);

/** Whether a frame for the vehicle waits for the HAL. */
bool agv_transmitter_waits(const agv_timers_t *timers);

/** Whether a frame for the vehicle has been waiting for the HAL for longer than tx_stalled_ms (SUP-7). */
bool agv_transmitter_is_stalled(const agv_timers_t *timers);

/** Whether there is something to report. */
bool agv_transmitter_has_report(const agv_transmitter_t *transmitter);

/** Return what was done since the last call of this function, and start a new report. */
agv_tx_report_t agv_transmitter_take_report(agv_transmitter_t *transmitter);

#endif
