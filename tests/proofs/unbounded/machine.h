/*
 * The state machine (FSM-3 to FSM-5, FSM-7, FSM-9, FSM-11) as a contract in ACSL: every state code, also corrupted ones,
 * and every combination of facts, faults, timers and configuration. Written from docs/requirements.md. States, facts and
 * actions are raw numbers here: 0Fh INIT, 33h STANDBY, 3Ch ACTIVE, 55h TRIPPED, 5Ah SAFE. A compiler sees declarations only.
 */
#ifndef PROOF_UNBOUNDED_MACHINE_H
#define PROOF_UNBOUNDED_MACHINE_H

#include "decide/state_machine.h"
#include "timers.h"

/*@
  // ---- What is not INIT, STANDBY or ACTIVE is latched.
  predicate is_latched(integer state) = state != 0x0F && state != 0x33 && state != 0x3C;
  predicate drives(integer state) = state == 0x33 || state == 0x3C;
  predicate none(integer fault) = fault == AGV_FAULT_NONE;

  // ---- Facts.
  predicate resets(integer facts) = (facts & 0x80000) != 0;
  predicate engaged(integer facts) = (facts & 0x1000) != 0;
  predicate ai_alive(integer facts) = (facts & 0x2000) != 0;
  predicate confirmed(integer facts) = (facts & 0x4000) != 0 && (facts & 0x8000) != 0;
  predicate output_unsafe(integer facts) = (facts & 0x40000) != 0;

  // ---- The latch record's flag goes with the state: 96h latched, 69h not.
  predicate flag_right{L}(agv_state_machine_t *m) = is_latched(m->state) ? m->latched == 0x96 : m->latched == 0x69;

  // ---- FSM-11: a trip-class cause trips while the vehicle may be driven. One from the AI computer that was there before
  // (it outlived a reset) trips when the autopilot is engaged. In INIT only unresettable faults latch.
  predicate must_trip{L}(integer state, agv_fault_summary_t *f, integer facts) =
      state == 0x0F ? !none(f->unresettable) :
      drives(state) && (!none(f->raised) || !none(f->cause) || (engaged(facts) && !none(f->ai_cause)));

  // ---- FSM-3: the conditions of a reset, each with its bit in what is missing.
  predicate reset_allowed{L}(agv_state_machine_t *m, agv_fault_summary_t *f, integer facts) =
      m->state == 0x5A && confirmed(facts) && none(f->cause) && none(m->unresettable) &&
      (facts & 0x02) != 0 && (facts & 0x04) != 0 && (facts & 0x10) != 0 && (facts & 0x20) != 0 &&
      (facts & 0x80) != 0 && (facts & 0x100) != 0 && (facts & 0x400) != 0;

  predicate step_ready{L}(agv_state_machine_t *m, agv_timers_t *t, agv_config_t *c, agv_fault_summary_t *f) =
      \valid(m) && \valid(t) && \valid_read(c) && \valid_read(f) && \separated(m, t, c, f);
*/

/*@ assigns \nothing;
    ensures \result <==> state != 0x33 && state != 0x3C;
*/
bool agv_state_commands_safe(agv_state_t state);

/*@ assigns \nothing;
    ensures \result <==> is_latched(state);
*/
bool agv_state_is_latched(agv_state_t state);

/*@ // FSM-7: a start with a reason begins in TRIPPED with that reason, any other one in INIT, always with P wanted.
    requires \valid(machine) && \valid(timers) && \valid_read(config) && \separated(machine, timers, config);
    requires reason <= AGV_FAULT_NONE;
    assigns machine->state, machine->latched, machine->first_reason, machine->unresettable, machine->park_released;
    assigns timers->due_ms, timers->since_ms[0 .. AGV_TIMER_COUNT - 1], timers->phase[0 .. AGV_TIMER_COUNT - 1];
    ensures machine->state == (reason != AGV_FAULT_NONE ? 0x55 : 0x0F) && flag_right(machine);
    ensures machine->first_reason == reason && none(machine->unresettable);
*/
void agv_state_machine_start(agv_state_machine_t *machine, agv_timers_t *timers, const agv_config_t *config,
                             uint32_t reason);

/*@ requires \valid(machine) && fault <= AGV_FAULT_NONE;
    assigns machine->unresettable;
    ensures machine->unresettable == (fault != AGV_FAULT_NONE ? fault : \old(machine->unresettable));
*/
void agv_state_machine_forbid_reset(agv_state_machine_t *machine, uint32_t fault);

/*@ // FSM-3: what is missing for a reset, bit by bit; nothing if and only if a reset is allowed.
    requires \valid_read(machine) && \valid_read(faults);
    assigns \nothing;
    ensures \result == 0 <==> reset_allowed(machine, faults, facts);
    ensures (\result & 0x01) == 0 <==> machine->state == 0x5A && confirmed(facts);
    ensures (\result & 0x02) == 0 <==> (facts & 0x02) != 0;
    ensures (\result & 0x04) == 0 <==> (facts & 0x04) != 0;
    ensures (\result & 0x08) == 0 <==> none(faults->cause) && none(machine->unresettable);
    ensures (\result & 0x10) == 0 <==> (facts & 0x10) != 0;
    ensures (\result & 0x20) == 0 <==> (facts & 0x20) != 0;
    ensures (\result & 0x80) == 0 <==> (facts & 0x80) != 0;
    ensures (\result & 0x100) == 0 <==> (facts & 0x100) != 0;
    ensures (\result & 0x400) == 0 <==> (facts & 0x400) != 0;
*/
uint32_t agv_state_machine_lacks_for_reset(const agv_state_machine_t *machine, const agv_fault_summary_t *faults,
                                           uint32_t facts);

/*@ requires \valid_read(machine) && \valid_read(timers);
    assigns \nothing;
    ensures \result <==> machine->state == 0x0F && reached(timers, AGV_TIMER_STARTUP);
*/
bool agv_state_machine_is_startup_late(const agv_state_machine_t *machine, const agv_timers_t *timers);

/*@ // One step, for every state and all inputs. The behaviors are all transitions that there are.
    requires step_ready(machine, timers, config, faults) && flag_right(machine);
    requires faults->unresettable <= AGV_FAULT_NONE && faults->raised <= AGV_FAULT_NONE;
    requires faults->cause <= AGV_FAULT_NONE && faults->ai_cause <= AGV_FAULT_NONE;
    assigns *machine;
    assigns timers->due_ms, timers->since_ms[AGV_TIMER_INIT_GOOD], timers->phase[AGV_TIMER_INIT_GOOD];
    assigns timers->since_ms[AGV_TIMER_PARK_WAIT], timers->phase[AGV_TIMER_PARK_WAIT];
    ensures flag_right(machine); // the stored latch follows the state
    ensures machine->latched != \old(machine->latched) || machine->unresettable != \old(machine->unresettable) ==>
                (\result.what & 0x100) != 0; // and is stored whenever it changes (FSM-7)
    ensures \old(machine->output_closed) == 0 && machine->output_closed != 0 ==> // FSM-4
                machine->state == 0x33 && \old(machine->state) != 0x33;
    ensures output_unsafe(facts) || !none(machine->unresettable) ==> machine->output_closed == 0; // FSM-4, FSM-9
    ensures !none(\old(machine->unresettable)) ==> !none(machine->unresettable); // FSM-9
    behavior door: // the only way out of TRIPPED, SAFE and every corrupted state
        assumes is_latched(machine->state) && resets(facts);
        ensures machine->state == 0x33 && (\result.what & 0x02) != 0;
    behavior latched:
        assumes is_latched(machine->state) && !resets(facts);
        ensures confirmed(facts) ? machine->state == 0x5A : machine->state == 0x55;
        ensures machine->first_reason == \old(machine->first_reason); // FSM-5
        ensures (\result.what & 0x02) == 0;
    behavior trips: // FSM-11
        assumes must_trip(machine->state, faults, facts);
        ensures machine->state == 0x55 && machine->first_reason < AGV_FAULT_NONE;
    behavior init:
        assumes machine->state == 0x0F && !must_trip(machine->state, faults, facts);
        ensures machine->state == 0x0F || (machine->state == 0x33 && \old(reached(timers, AGV_TIMER_INIT_GOOD)));
    behavior driven: // FSM-11: ACTIVE only without any trip-class cause
        assumes drives(machine->state) && !must_trip(machine->state, faults, facts);
        ensures machine->state == 0x33 || machine->state == 0x3C;
        ensures machine->state == 0x3C ==>
                    engaged(facts) && none(faults->raised) && none(faults->cause) && none(faults->ai_cause);
    complete behaviors;
    disjoint behaviors;
*/
agv_actions_t agv_state_machine_step(agv_state_machine_t *machine, agv_timers_t *timers, const agv_config_t *config,
                                     const agv_fault_summary_t *faults, uint32_t facts);

/*@ // INT-5: a state code and a flag that do not belong together are found.
    requires \valid_read(machine);
    assigns \nothing;
    ensures \result <==>
                flag_right(machine) && (machine->state == 0x0F || machine->state == 0x33 || machine->state == 0x3C ||
                                        machine->state == 0x55 || machine->state == 0x5A);
*/
bool agv_state_machine_is_sound(const agv_state_machine_t *machine);

#endif
