/**
 * @file supervisor_internal.h
 * Functions that the parts of the supervisor share. Every call makes one pass: observe (supervisor_frame.c,
 * supervisor_tick.c), agv_core_decide (faults, state machine, actions), transmit, agv_core_conclude (latch, recorder,
 * output).
 */
#ifndef AGV_SUPERVISOR_INTERNAL_H
#define AGV_SUPERVISOR_INTERNAL_H

#include "supervisor/core.h"

/** Decisions of a pass. */
typedef struct {
    agv_actions_t actions;
    agv_fault_changes_t faults;
} agv_pass_t;

/**
 * Evaluate the faults, step the state machine, and carry out the urgent actions at once: open the output, discard waiting
 * frames, send all safe commands.
 * @param elapsed_ms since the last tick; 0 for a frame
 * @return the decisions, for agv_core_conclude
 */
agv_pass_t agv_core_decide(agv_core_t *core, const agv_ports_t *ports, uint32_t elapsed_ms);

/**
 * Restart the checks of the safe state (confirmation, stopping), at a trip or a start in TRIPPED.
 * @param at_tick in a tick or at the start, not in the handling of a frame
 */
void agv_core_await_safe_state(agv_core_t *core, bool at_tick);

/** Count sent and refused frames. This alone ends a call that decides nothing. */
void agv_core_take_tx_report(agv_core_t *core);

/** Conclude a pass, after everything was sent: latch record, counters, events, closing the output. */
void agv_core_conclude(agv_core_t *core, const agv_ports_t *ports, const agv_pass_t *pass);

/** The inputs of the transmitter. */
agv_tx_orders_t agv_core_orders(agv_core_t *core, const agv_ports_t *ports);

/** Whether the next step is late by more than the watchdog's period (TIM-4). Only steps evaluate deadlines. */
bool agv_core_step_is_late(const agv_core_t *core);

/** Whether a fresh 0A3h reports P. */
bool agv_core_is_in_park(const agv_core_t *core);

/** Update the modules that depend on the engagement after a change of it. */
void agv_core_follow_mode(agv_core_t *core, agv_mode_change_t change, uint32_t time_ms);

/** Evaluate whether the vehicle stands. */
void agv_core_evaluate_standstill(agv_core_t *core);

/** The inputs of the motion checks. */
agv_motion_facts_t agv_core_motion_facts(const agv_core_t *core);

/** The inputs of the gateway. */
agv_gateway_facts_t agv_core_gateway_facts(const agv_core_t *core);

/** Whether the state is STANDBY or ACTIVE. */
bool agv_core_is_supervising(const agv_core_t *core);

/** Record an event with the current state and first reason. @param kind agv_event_kind_t */
void agv_core_record(const agv_core_t *core, const agv_ports_t *ports, uint32_t kind, uint32_t a, uint32_t b,
                     uint32_t c);

/** Write the latch record. */
void agv_core_store_latch(const agv_core_t *core, const agv_ports_t *ports);

/** Faults found before the start: bit n is the fault of rank n. */
#define AGV_FOUND_CORRUPTED (1u << (uint32_t)AGV_FAULT_MEMORY_CORRUPTED)
#define AGV_FOUND_CONFIG_INVALID (1u << (uint32_t)AGV_FAULT_CONFIG_INVALID)

/** Start, after core->config, ids and time are set (FSM-7, FSM-9). @param found AGV_FOUND_* bits */
void agv_core_begin(agv_core_t *core, const agv_ports_t *ports, uint32_t found);

/** Start again after a corruption of the supervisor's memory was found (INT-5). */
void agv_core_begin_corrupted(agv_core_t *core, const agv_ports_t *ports);

/** Make second copies of topology, ID set, identifiers, status_frame_id and park. */
void agv_core_keep_wiring(agv_core_t *core);

/**
 * Check the configuration in the core. If it is refused, it is replaced by the defaults, with the values of the
 * second copies.
 * @param intact whether it is still the configuration that was passed to agv_supervisor_start
 * @return whether it was accepted
 */
bool agv_core_check_config(agv_core_t *core, bool intact);

/** Handle a frame. */
void agv_core_frame(agv_core_t *core, const agv_ports_t *ports, hal_can_side_t side, const hal_can_frame_t *frame);

/** Handle a tick. @param receive_alive the receive path has checked in since the last tick */
void agv_core_tick(agv_core_t *core, const agv_ports_t *ports, bool receive_alive);

/** Advance the LED. */
void agv_core_show_led(agv_core_t *core, const agv_ports_t *ports, uint32_t elapsed_ms);

#endif
