/**
 * @file supervisor_internal.h
 * What the parts of the supervisor share. One pass, in every call: observe (supervisor_frame.c, supervisor_tick.c), then
 * agv_core_decide (faults, state machine, actions), then transmit, then agv_core_conclude (latch, recorder, output).
 */
#ifndef AGV_SUPERVISOR_INTERNAL_H
#define AGV_SUPERVISOR_INTERNAL_H

#include "supervisor/core.h"

/** What a pass has decided. */
typedef struct {
    agv_actions_t actions;
    agv_fault_changes_t faults;
} agv_pass_t;

/**
 * Evaluate the faults, once, step the state machine, and carry out at once what cannot wait: open the output, discard what
 * waits to be sent, send all safe commands.
 * @param elapsed_ms since the last tick; 0 for a frame
 * @return what remains to be concluded
 */
agv_pass_t agv_core_decide(agv_core_t *core, const agv_ports_t *ports, uint32_t elapsed_ms);

/** A start in TRIPPED, or a trip: what is awaited of the vehicle begins anew. */
void agv_core_await_safe_state(agv_core_t *core);

/** Count what was sent, and what the gate refused. For a call that decides nothing it is all that remains to be done. */
void agv_core_take_tx_report(agv_core_t *core);

/** The rest, after everything was sent: latch record, counters, events, closing the output. */
void agv_core_conclude(agv_core_t *core, const agv_ports_t *ports, const agv_pass_t *pass);

/** What the transmitter is told. */
agv_tx_orders_t agv_core_orders(agv_core_t *core, const agv_ports_t *ports);

/** Whether the next step is overdue by more than the watchdog's period (TIM-4): only steps look at deadlines. */
bool agv_core_step_is_late(const agv_core_t *core);

/** Fresh 0A3h reports P. */
bool agv_core_is_in_park(const agv_core_t *core);

/** The engagement began or ended: what follows from it. */
void agv_core_follow_mode(agv_core_t *core, agv_mode_change_t change, uint32_t time_ms);

/** Evaluate whether the vehicle stands. */
void agv_core_evaluate_standstill(agv_core_t *core);

/** What the checks of motion go by. */
agv_motion_facts_t agv_core_motion_facts(const agv_core_t *core);

/** What the gateway goes by. */
agv_gateway_facts_t agv_core_gateway_facts(const agv_core_t *core);

/** Whether autopilot supervision is on: STANDBY or ACTIVE. */
bool agv_core_is_supervising(const agv_core_t *core);

/** Record a change of state or output, with the state and first reason of now. @param kind agv_event_kind_t */
void agv_core_record(const agv_core_t *core, const agv_ports_t *ports, uint32_t kind, uint32_t a, uint32_t b,
                     uint32_t c);

/** Write the latch record. */
void agv_core_store_latch(const agv_core_t *core, const agv_ports_t *ports);

/** What was found wrong before the start: bit n is the fault of rank n. */
#define AGV_FOUND_SELF_TEST_FAILED (1u << (uint32_t)AGV_FAULT_SELF_TEST_FAILED)
#define AGV_FOUND_CORRUPTED (1u << (uint32_t)AGV_FAULT_MEMORY_CORRUPTED)
#define AGV_FOUND_CONFIG_INVALID (1u << (uint32_t)AGV_FAULT_CONFIG_INVALID)

/** Start, once core->config, ids and time stand (FSM-7, FSM-9). @param found AGV_FOUND_* bits */
void agv_core_begin(agv_core_t *core, const agv_ports_t *ports, uint32_t found);

/** Start again after a corruption was found in the memory of the supervisor (INT-5). */
void agv_core_begin_corrupted(agv_core_t *core, const agv_ports_t *ports);

/** Keep second copies of what the identifiers and the wiring of this vehicle are. */
void agv_core_keep_wiring(agv_core_t *core);

/**
 * Check the configuration in the core. One that does not stand is replaced by the defaults, but on the identifiers and
 * the wiring of the second copies.
 * @param intact whether it is the one that was handed in
 * @return whether it stands
 */
bool agv_core_check_config(agv_core_t *core, bool intact);

/** Handle a frame. */
void agv_core_frame(agv_core_t *core, const agv_ports_t *ports, hal_can_side_t side, const hal_can_frame_t *frame);

/** Handle a tick. @param receive_alive the receive path has checked in since the last one */
void agv_core_tick(agv_core_t *core, const agv_ports_t *ports, bool receive_alive);

/** Advance the LED. */
void agv_core_show_led(agv_core_t *core, const agv_ports_t *ports, uint32_t elapsed_ms);

#endif
