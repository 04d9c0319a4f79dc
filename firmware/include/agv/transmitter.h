/**
 * @file transmitter.h
 * What is sent: the supervisor's own safe commands on their slots, the frames that the gateway passes on, the status
 * frame. Everything goes through the gate (gate.h). What the HAL does not take waits here: one frame an identifier, the
 * newest; own frames are built anew when they leave, so nothing stale can.
 */
#ifndef AGV_TRANSMITTER_H
#define AGV_TRANSMITTER_H

#include <stdbool.h>
#include <stdint.h>

#include "agv/counters.h"
#include "agv/gate.h"
#include "agv/protocol.h"
#include "agv/scheduler.h"
#include "agv/timer.h"
#include "hal/hal.h"

/** Sets of commands: bit n is the command n of agv_message_t. */
#define AGV_COMMANDS_ALL 0x0Fu

/** Whom to send through; made for each call. */
typedef struct {
    hal_t *hal;
    agv_gate_t gate;
    agv_counters_t *counters;
    uint32_t now_ms;
    uint16_t override_gap_ms;
    uint8_t wanted;        /**< own commands that are sent now (0 in STANDBY and ACTIVE) */
    bool frozen_heartbeat; /**< the counter in the own 43Fh stands still (FSM-8) */
    bool vehicle_side_off; /**< bus-off: nothing is handed to the HAL */
    bool refused;          /**< out: the gate refused a frame */
    bool park_sent;        /**< out: 168h P was sent */
} agv_outlet_t;

/** The transmitter. */
typedef struct {
    agv_scheduler_t scheduler;
    uint32_t status_due_ms;
    agv_timer_t waits[AGV_COMMAND_COUNT]; /**< vehicle side: since when the HAL does not take this command */
    uint16_t kept;                        /**< passed frames that the HAL did not take, bit n = message n */
    uint8_t kept_data[AGV_MSG_COUNT][AGV_DLC];
    uint8_t wanted_before;
    uint8_t alive_counter;  /**< of the own 43Fh */
    uint8_t status_counter; /**< alive counter of the status frame */
} agv_transmitter_t;

/** Nothing waits; the slots begin now. */
void agv_transmitter_start(agv_transmitter_t *transmitter, uint32_t now_ms);

/** Forget what waits to be sent to the vehicle: it is never sent. */
void agv_transmitter_discard(agv_transmitter_t *transmitter, agv_counters_t *counters);

/** Forget what waits to be sent to the AI side. */
void agv_transmitter_discard_ai(agv_transmitter_t *transmitter, agv_counters_t *counters);

/** Send all wanted commands at once and begin their slots anew (FSM-2). */
void agv_transmitter_burst(agv_transmitter_t *transmitter, agv_outlet_t *outlet);

/** A foreign command was heard: answer it, now or when override_gap_ms is over (TOP-1). */
void agv_transmitter_override(agv_transmitter_t *transmitter, agv_outlet_t *outlet, agv_message_t command);

/** Whether a received payload commands what the own command does; the alive counter does not count. */
bool agv_transmitter_same_command(agv_message_t command, const agv_outlet_t *outlet, const uint8_t data[AGV_DLC]);

/** Pass a frame on to the other side (TOP-2). */
void agv_transmitter_pass(agv_transmitter_t *transmitter, agv_outlet_t *outlet, agv_message_t message,
                          const uint8_t data[AGV_DLC]);

/** Everything that is due: what waits, overrides, slots. */
void agv_transmitter_tick(agv_transmitter_t *transmitter, agv_outlet_t *outlet);

/** Whether the HAL has not taken a frame for the vehicle for longer than @p limit_ms (SUP-7). */
bool agv_transmitter_stalled(agv_transmitter_t *transmitter, uint32_t now_ms, uint16_t limit_ms);

/** Send the status frame if it is due (TOP-3): @p data is its payload but for byte 4, the alive counter. */
void agv_transmitter_status(agv_transmitter_t *transmitter, agv_outlet_t *outlet, const uint8_t data[AGV_DLC],
                            uint16_t period_ms);

#endif
