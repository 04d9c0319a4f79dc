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

#include "agv/protocol.h"
#include "agv/scheduler.h"
#include "hal/can.h"

struct agv_core;

/** Sets of messages: bit n is message n. The commands, and the status messages that go to the AI side. */
#define AGV_SET_COMMANDS 0x000Fu
#define AGV_SET_STATUS 0x07F0u

/** The transmitter. */
typedef struct {
    agv_scheduler_t scheduler;
    uint32_t status_due_ms;
    uint32_t kept; /**< passed frames that the HAL did not take, bit n = message n */
    uint8_t kept_data[AGV_MSG_COUNT][AGV_DLC];
    uint8_t wanted_before;  /**< own commands that were sent at the last tick */
    uint8_t alive_counter;  /**< of the own 43Fh */
    uint8_t status_counter; /**< alive counter of the status frame */
} agv_transmitter_t;

/** Nothing waits, from zeroed memory; the slots begin with the first burst. */
void agv_transmitter_start(struct agv_core *core);

/** Forget what waits to be sent on a side: it is never sent. */
void agv_transmitter_discard(struct agv_core *core, hal_can_side_t side);

/** Send all commands that the state asks for at once and begin their slots anew (FSM-2). */
void agv_transmitter_burst(struct agv_core *core);

/**
 * A foreign command was heard where the own one is sent: answer it, now or when override_gap_ms is over (TOP-1).
 * @param data its payload; NULL when it is malformed and so differs in any case
 */
void agv_transmitter_answer(struct agv_core *core, uint32_t command, const uint8_t *data);

/** Pass a frame on to the other side (TOP-2), a command as agv_gateway_limit leaves it. */
void agv_transmitter_pass(struct agv_core *core, uint32_t message, const uint8_t data[AGV_DLC]);

/** Everything that is due: what waits, overrides, slots, the status frame. */
void agv_transmitter_tick(struct agv_core *core);

/** Whether the HAL has not taken a frame for the vehicle for longer than tx_stalled_ms (SUP-7). */
bool agv_transmitter_stalled(struct agv_core *core);

#endif
