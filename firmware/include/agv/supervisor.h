/**
 * @file supervisor.h
 * The supervisor. It has two inputs, a received frame and a tick, and sends every frame through one gate.
 *
 * A program calls agv_supervisor_start once. Then it calls agv_supervisor_frame for every received frame, in the order of
 * the time stamps, and agv_supervisor_tick every millisecond, after the frames with time stamps up to that tick. Whenever
 * the receive queue is empty it calls agv_supervisor_receive_alive; without it the hardware watchdog is not fed (TIM-3).
 * One process may run several supervisors; they share nothing. The functions are not reentrant: use one thread for each
 * supervisor. The caller owns all memory; no call allocates, recurses or has an unbounded loop (INT-1).
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
#include "agv/version.h"
#include "hal/can.h"
#include "hal/hal.h"

/** The HAL, the flight recorder and the version of a supervisor. Passed to every call; the supervisor never keeps the pointers. */
typedef struct {
    hal_t *hal;
    agv_recorder_t *recorder;
    const agv_version_t *version; /**< NULL: none is reported (status_version) */
} agv_ports_t;

/** Memory of a supervisor in bytes, the same on every platform. The core uses slightly less; the unused bytes are 0. */
#define AGV_SUPERVISOR_MEMORY 1016u

/**
 * One supervisor, in memory of the caller. Read it through the functions below. `seal` is a checksum over `memory`,
 * calculated at the end of every call and checked at the start of the next one (INT-5). It does not cover
 * `receive_alive`: a flipped bit there feeds the watchdog one tick early or late.
 */
typedef struct {
    _Alignas(uint32_t) unsigned char memory[AGV_SUPERVISOR_MEMORY];
    uint32_t seal;
    bool receive_alive; /**< agv_supervisor_receive_alive was called since the last tick (TIM-3) */
} agv_supervisor_t;

/**
 * Start the supervisor (FSM-7): in TRIPPED after a reset other than power-on, or when after_power_on or a fault that is
 * found now requires it; else in INIT. Reads the reset cause and the latch through the HAL, opens the safety output, tests
 * codec and gate, asks the HAL for the result of its self-test (HW-4), and sends the first safe commands.
 *
 * @param config copied. If agv_config_check refuses it, the supervisor starts in TRIPPED with CONFIG_INVALID.
 * @param now_ms current time, any value
 */
void agv_supervisor_start(agv_supervisor_t *supervisor, const agv_ports_t *ports, const agv_config_t *config,
                          uint32_t now_ms);

/**
 * Handle a received frame. Malformed frames (P15) are counted and refresh no deadline.
 * @param side  controller that received it; on a shared bus, frames of the AI side are ignored
 * @param frame with its receive time, which may be later than the last tick. An old frame refreshes
 *              the deadline of its message only from its receive time on.
 */
void agv_supervisor_frame(agv_supervisor_t *supervisor, const agv_ports_t *ports, hal_can_side_t side,
                          const hal_can_frame_t *frame);

/** Handle a tick; call it every millisecond. A call that is more than watchdog_period_ms late trips (TIM-4). */
void agv_supervisor_tick(agv_supervisor_t *supervisor, const agv_ports_t *ports, uint32_t now_ms);

/**
 * Report that all received frames were passed to agv_supervisor_frame (TIM-3). Call it each time the receive queue has
 * been drained, also if it was empty: without these calls the hardware watchdog is not fed.
 */
void agv_supervisor_receive_alive(agv_supervisor_t *supervisor);

/** The current state. */
agv_state_t agv_supervisor_state(const agv_supervisor_t *supervisor);

/** The reason of the first trip since the last reset (FSM-5); AGV_FAULT_NONE when not tripped. */
agv_fault_t agv_supervisor_first_reason(const agv_supervisor_t *supervisor);

/** The active faults. docs/faults.md says when a fault of each kind ends. */
agv_fault_set_t agv_supervisor_active_faults(const agv_supervisor_t *supervisor);

/** The active faults that count as trips at present. */
agv_fault_set_t agv_supervisor_active_trips(const agv_supervisor_t *supervisor);

/** The highest-ranking active fault; AGV_FAULT_NONE if there is none. */
agv_fault_t agv_supervisor_first_active(const agv_supervisor_t *supervisor);

/** Whether a fault is active. False for AGV_FAULT_NONE. */
bool agv_supervisor_has_fault(const agv_supervisor_t *supervisor, agv_fault_t fault);

/**
 * Age of the last frame of a message in ms, at the last tick; if none was received, the time since the start. UINT32_MAX when
 * the age is more than some 6000 ms (messages are aged in turn, one each tick), and for AGV_MSG_NONE and values above.
 */
uint32_t agv_supervisor_age_ms(const agv_supervisor_t *supervisor, agv_message_t message);

/**
 * Whether a message was received and its deadline has not expired (SUP-2, SUP-3). For 363h, 067h and 43Fh the deadline counts
 * from the last *changed* alive counter, so a message with a small age may be stale. False for AGV_MSG_NONE and values above.
 */
bool agv_supervisor_is_fresh(const agv_supervisor_t *supervisor, agv_message_t message);

/**
 * Time of the last tick in ms; the time of the start when there was no tick yet. When a frame before the tick had a later time
 * stamp than the tick, it is the frame's time.
 */
uint32_t agv_supervisor_tick_ms(const agv_supervisor_t *supervisor);

/** Whether the safety output is commanded closed (FSM-4). The contact itself may differ (OUTPUT_FEEDBACK, HW-1). */
bool agv_supervisor_output_closed(const agv_supervisor_t *supervisor);

/**
 * Whether the vehicle is at standstill: the wheels and the VCU's speed have been low for standstill_ms, 101h is fresh, and
 * the VCU is alive.
 */
bool agv_supervisor_is_at_standstill(const agv_supervisor_t *supervisor);

/** What the LED shows (LED-1): 0 = healthy, 1..17 = number of flashes, -1 = fast blinking. */
int8_t agv_supervisor_led_code(const agv_supervisor_t *supervisor);

/** The counters. The pointer is valid as long as the supervisor. */
const agv_counters_t *agv_supervisor_counters(const agv_supervisor_t *supervisor);

/**
 * The configuration in use: the one passed to agv_supervisor_start. If that was refused or is corrupted: the defaults, with
 * the topology, ID set, identifiers, park and status_frame_id of this vehicle where these are valid (FSM-9). The pointer is valid
 * as long as the supervisor.
 */
const agv_config_t *agv_supervisor_config(const agv_supervisor_t *supervisor);

#endif
