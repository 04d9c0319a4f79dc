/**
 * @file transmitter.h
 * What is sent: the supervisor's own safe commands on their slots, the frames that the gateway passes on, the status
 * frame. Everything goes through the gate (gate.h). What the HAL does not take waits here: one frame an identifier, the
 * newest; own frames are built anew when they leave, so that nothing stale leaves.
 */
#ifndef AGV_TRANSMITTER_H
#define AGV_TRANSMITTER_H

#include <stdbool.h>
#include <stdint.h>

#include "agv/protocol.h"
#include "agv/state.h"
#include "base/timers.h"
#include "decide/hold.h"
#include "hal/can.h"
#include "transmit/scheduler.h"

/** Sets of messages: bit n is message n. The commands, and the status messages that go to the AI side. */
#define AGV_SET_COMMANDS 0x000Fu
#define AGV_SET_STATUS 0x07F0u

/** Status frame (TOP-3), byte 2: no first reason. */
#define AGV_STATUS_FRAME_NO_REASON 0xFFu

/** What the transmitter has done since it was last asked. */
typedef struct {
    uint16_t sent;
    uint16_t shadowed;
    uint16_t refused;       /**< by the gate: TX_GATE_REFUSED */
    uint16_t dropped;       /**< waited and were replaced or discarded */
    uint32_t skipped_slots; /**< TIM-1 */
    uint8_t passed;         /**< commands of the AI computer that were passed on, bit n = command n */
    bool park_sent;         /**< an own 168h left */
} agv_tx_report_t;

/** The transmitter. */
typedef struct {
    agv_scheduler_t scheduler;
    uint32_t status_due_ms;                /**< when the next status frame is due */
    uint32_t status_ms;                    /**< when the last one was handed to the HAL */
    uint32_t kept;                         /**< frames to be passed that wait, bit n = message n */
    uint32_t passed_ms[AGV_COMMAND_COUNT]; /**< when a command was last passed on */
    agv_tx_report_t report;
    uint8_t kept_data[AGV_MSG_COUNT][AGV_DLC];
    uint8_t wanted_before;  /**< own commands that were sent at the last tick */
    uint8_t passed_lately;  /**< commands that were passed on less than half their cycle ago */
    bool status_again;      /**< the last status frame may have been discarded with what waited */
    bool throttle_0_waits;  /**< the engagement ended, and the HAL has not taken the 075h of that */
    uint8_t alive_counter;  /**< of the own 43Fh */
    uint8_t status_counter; /**< alive counter of the status frame */
} agv_transmitter_t;

/** What the supervisor tells the transmitter at each call. */
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
    uint32_t config_checksum;
} agv_tx_orders_t;

/** Nothing waits, from zeroed memory; the slots begin with the first burst, the status frame now. */
void agv_transmitter_start(agv_transmitter_t *transmitter, uint32_t now_ms);

/** Forget what waits to be sent on a side: it is never sent. */
void agv_transmitter_discard(agv_transmitter_t *transmitter, agv_timers_t *timers, hal_can_side_t side);

/** Send all commands that the state asks for at once and begin their slots anew (FSM-2). */
void agv_transmitter_burst(agv_transmitter_t *transmitter, const agv_tx_orders_t *orders);

/**
 * A foreign command was heard where the own one is sent: answer it, now or when override_gap_ms is over (TOP-1).
 * @param data its payload; NULL when it is malformed and so differs in any case
 */
void agv_transmitter_answer(agv_transmitter_t *transmitter, const agv_tx_orders_t *orders, uint32_t command,
                            const uint8_t *data);

/**
 * Pass a frame on to the other side (TOP-2). A command goes at most once in half its cycle: what comes sooner waits until
 * that is over, and the newest counts.
 */
void agv_transmitter_pass(agv_transmitter_t *transmitter, const agv_tx_orders_t *orders, uint32_t message,
                          const uint8_t data[AGV_DLC]);

/** Drop a command that waits to be passed on. */
void agv_transmitter_drop(agv_transmitter_t *transmitter, agv_timers_t *timers, uint32_t command);

/** An engagement ended (TOP-2): one 075h with throttle 0, so that no old command is the newest at the next one. */
void agv_transmitter_end_engagement(agv_transmitter_t *transmitter, const agv_tx_orders_t *orders);

/** The payload of a command that was passed on last. */
const uint8_t *agv_transmitter_passed(const agv_transmitter_t *transmitter, uint32_t command);

/** The status frame, when it is due (TOP-3); a part of agv_transmitter_tick. */
void agv_transmitter_status(agv_transmitter_t *transmitter, const agv_tx_orders_t *orders);

/** Everything that is due: what waits, overrides, slots, the status frame. */
void agv_transmitter_tick(agv_transmitter_t *transmitter, const agv_tx_orders_t *orders);

/** Whether the HAL has not taken a frame for the vehicle for longer than tx_stalled_ms (SUP-7). */
bool agv_transmitter_is_stalled(const agv_timers_t *timers);

/** Whether there is something to report. */
bool agv_transmitter_has_report(const agv_transmitter_t *transmitter);

/** What was done since the last call of this function. */
agv_tx_report_t agv_transmitter_take_report(agv_transmitter_t *transmitter);

#endif
