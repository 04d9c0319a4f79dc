/**
 * @file supervisor.h
 * The supervisor: two ways in (a frame arrived, a tick passed), one gate out.
 *
 * A program calls agv_supervisor_start once, then agv_supervisor_frame for every frame received, in the order of their
 * time stamps, and agv_supervisor_tick every millisecond after the frames stamped up to it. Two supervisors in one
 * process do not know of each other. Not reentrant: one thread per supervisor. All its memory is the structure that the
 * caller owns; no call allocates, recurses or loops without a bound (INT-1).
 */
#ifndef AGV_SUPERVISOR_H
#define AGV_SUPERVISOR_H

#include <stdbool.h>
#include <stdint.h>

#include "agv/config.h"
#include "agv/counters.h"
#include "agv/faults.h"
#include "agv/recorder.h"
#include "agv/state.h"
#include "hal/can.h"
#include "hal/hal.h"

/** What a supervisor is connected to; handed in at every call, never kept. */
typedef struct {
    hal_t *hal;
    agv_recorder_t *recorder;
} agv_ports_t;

/** Bytes that a supervisor needs, on every platform. */
#define AGV_SUPERVISOR_MEMORY 1016u

/**
 * One supervisor: static memory of the caller. Read it through the functions below. `seal` is a checksum over `memory`,
 * made at the end of every call and checked at the start of the next (INT-5); a flipped bit in `receive_alive`, outside
 * of it, feeds the watchdog a tick early or late.
 */
typedef struct {
    _Alignas(uint32_t) unsigned char memory[AGV_SUPERVISOR_MEMORY];
    uint32_t seal;
    bool receive_alive; /**< the receive path has checked in since the last tick (TIM-3) */
} agv_supervisor_t;

/**
 * Start (FSM-7): INIT after a power-on, else TRIPPED. Reads the reset cause and the latch through the HAL, opens the
 * safety output, sends the first safe commands.
 *
 * @param config           copied; one that does not pass agv_config_check starts in TRIPPED with CONFIG_INVALID
 * @param self_test_passed what the program's own test of RAM, flash and processor found; false: SELF_TEST_FAILED. The
 *                         supervisor tests its codec and its gate itself.
 * @param now_ms           clock, any value
 */
void agv_supervisor_start(agv_supervisor_t *supervisor, const agv_ports_t *ports, const agv_config_t *config,
                          bool self_test_passed, uint32_t now_ms);

/**
 * A frame arrived. Malformed ones (P15) are counted and refresh nothing.
 * @param side  controller it came from; frames of the AI side are ignored on the shared bus
 * @param frame with its receive time; one later than the last tick is fine, an older one does not look fresh
 */
void agv_supervisor_frame(agv_supervisor_t *supervisor, const agv_ports_t *ports, hal_can_side_t side,
                          const hal_can_frame_t *frame);

/** A millisecond passed. Also the place for what is late: a call more than watchdog_period_ms late trips (TIM-4). */
void agv_supervisor_tick(agv_supervisor_t *supervisor, const agv_ports_t *ports, uint32_t now_ms);

/**
 * The receive path has looked for frames and handed over all there were (TIM-3). Call it each time the receive queue was
 * drained, also when it was empty: without it the hardware watchdog is not fed.
 */
void agv_supervisor_receive_alive(agv_supervisor_t *supervisor);

/** The state. */
agv_state_t agv_supervisor_state(const agv_supervisor_t *supervisor);

/** The reason of the first trip since the last reset; AGV_FAULT_NONE when not tripped (FSM-5). */
agv_fault_t agv_supervisor_first_reason(const agv_supervisor_t *supervisor);

/** Faults whose cause is present now. */
agv_fault_set_t agv_supervisor_active_faults(const agv_supervisor_t *supervisor);

/** Those of them that count as trips at the moment. */
agv_fault_set_t agv_supervisor_active_trips(const agv_supervisor_t *supervisor);

/** The highest-ranking fault whose cause is present now; AGV_FAULT_NONE when there is none. */
agv_fault_t agv_supervisor_first_active(const agv_supervisor_t *supervisor);

/** Whether the cause of a fault is present now. False for AGV_FAULT_NONE. */
bool agv_supervisor_has_fault(const agv_supervisor_t *supervisor, agv_fault_t fault);

/** Age of the last frame of a message, ms; since the start when none was heard; UINT32_MAX when that is long ago. */
uint32_t agv_supervisor_age_ms(const agv_supervisor_t *supervisor, agv_message_t message);

/** Whether a message was heard and its deadline has not expired. */
bool agv_supervisor_is_fresh(const agv_supervisor_t *supervisor, agv_message_t message);

/** Time of the last tick, or of the start. */
uint32_t agv_supervisor_tick_ms(const agv_supervisor_t *supervisor);

/** Whether the safety output is closed (FSM-4). */
bool agv_supervisor_output_closed(const agv_supervisor_t *supervisor);

/** What the LED shows: 0 = healthy, 1..17 = flashes, -1 = fast even blink (LED-1). */
int8_t agv_supervisor_led_code(const agv_supervisor_t *supervisor);

/** What happened so far. */
const agv_counters_t *agv_supervisor_counters(const agv_supervisor_t *supervisor);

/** The configuration in use: what was handed in, or the defaults when that was refused. */
const agv_config_t *agv_supervisor_config(const agv_supervisor_t *supervisor);

#endif
