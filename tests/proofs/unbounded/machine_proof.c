/* What frama-c is given: the contracts, then the shipped sources as they are. */
#include "machine.h"

// ---- Inside, step by step.

/*@ requires \valid(machine) && 0 <= state <= 255;
    assigns machine->state, machine->latched;
    ensures machine->state == state && flag_right(machine);
*/
static void enter(agv_state_machine_t *machine, agv_state_t state);

/*@ requires \valid(machine);
    assigns machine->state, machine->latched, machine->first_reason, machine->output_closed;
    ensures machine->state == 0x33 && flag_right(machine) && none(machine->first_reason) && machine->output_closed == 1;
    ensures \result == 0xE0;
*/
static uint32_t enter_standby(agv_state_machine_t *machine);

/*@ requires \valid(machine) && \valid(timers) && \separated(machine, timers) && reason < AGV_FAULT_NONE;
    assigns machine->state, machine->latched, machine->first_reason, machine->park_released;
    assigns timers->due_ms, timers->since_ms[AGV_TIMER_PARK_WAIT], timers->phase[AGV_TIMER_PARK_WAIT];
    ensures machine->state == 0x55 && flag_right(machine) && machine->first_reason == reason;
    ensures machine->park_released == 0 && \result == 0x61;
*/
static uint32_t trip(agv_state_machine_t *machine, agv_timers_t *timers, uint32_t reason);

/*@ assigns \nothing;
    ensures \result <==> !none(fault);
*/
static bool has_cause(uint8_t fault);

/*@ requires \valid_read(faults);
    assigns \nothing;
    ensures \result == 0 ==>
                (facts & 0x02) != 0 && (facts & 0x04) != 0 && (facts & 0x20) != 0 && (facts & 0x80) != 0 &&
                (facts & 0x100) != 0 && (facts & 0x400) != 0 && (facts & 0x10000) != 0 && none(faults->cause) && none(faults->ai_cause);
*/
static uint32_t missing_in_init(const agv_fault_summary_t *faults, uint32_t facts);

/*@ requires \valid(machine) && \valid(timers) && \valid_read(faults) && \valid(missing);
    requires \separated(machine, timers, faults, missing) && machine->state == 0x0F && flag_right(machine);
    assigns machine->state, machine->latched, machine->first_reason, machine->output_closed, machine->startup_reported;
    assigns timers->due_ms, timers->since_ms[AGV_TIMER_INIT_GOOD], timers->phase[AGV_TIMER_INIT_GOOD], *missing;
    ensures machine->state == 0x0F || machine->state == 0x33;
    ensures flag_right(machine);
    ensures machine->state == 0x33 ==>
                *missing == 0 && \old(reached(timers, AGV_TIMER_INIT_GOOD)) && machine->output_closed == 1 &&
                none(machine->first_reason);
    ensures machine->state == 0x0F ==>
                machine->first_reason == \old(machine->first_reason) &&
                machine->output_closed == \old(machine->output_closed);
    ensures (\result & 0x02) == 0;
*/
static uint32_t step_init(agv_state_machine_t *machine, agv_timers_t *timers, const agv_fault_summary_t *faults,
                          uint32_t facts, uint16_t *missing);

/*@ requires \valid(machine) && drives(machine->state);
    assigns machine->state;
    ensures (!engaged(facts) ==> machine->state == 0x33) && (engaged(facts) && ai_alive(facts) ==> machine->state == 0x3C) &&
                (engaged(facts) && !ai_alive(facts) ==> machine->state == \old(machine->state));
    ensures (\result & 0x02) == 0;
*/
static uint32_t follow_engagement(agv_state_machine_t *machine, uint32_t facts);

/*@ assigns \nothing;
    ensures \result <==> confirmed(facts);
*/
static bool is_confirmed(uint32_t facts);

/*@ requires \valid(machine) && is_latched(machine->state);
    assigns machine->state, machine->latched, machine->first_reason, machine->output_closed;
    ensures flag_right(machine);
    behavior accepted:
        assumes resets(facts);
        ensures machine->state == 0x33 && none(machine->first_reason) && machine->output_closed == 1 && \result == 0xE2;
    behavior kept:
        assumes !resets(facts);
        ensures confirmed(facts) ? machine->state == 0x5A : machine->state == 0x55;
        ensures machine->first_reason == \old(machine->first_reason);
        ensures machine->output_closed == \old(machine->output_closed) && \result == 0;
    complete behaviors;
    disjoint behaviors;
*/
static uint32_t step_latched(agv_state_machine_t *machine, uint32_t facts);

/*@ requires \valid(machine) && \valid_read(timers) && \valid_read(config);
    assigns machine->park_released;
    ensures \old(machine->park_released) != 0 ==> machine->park_released != 0;
*/
static void release_park(agv_state_machine_t *machine, const agv_timers_t *timers, const agv_config_t *config,
                         uint32_t facts);

/*@ requires \valid_read(machine) && \valid_read(faults);
    requires faults->unresettable <= AGV_FAULT_NONE && faults->raised <= AGV_FAULT_NONE;
    requires faults->cause <= AGV_FAULT_NONE && faults->ai_cause <= AGV_FAULT_NONE;
    assigns \nothing;
    ensures \result <= AGV_FAULT_NONE;
    ensures !is_latched(machine->state) ==> (\result != AGV_FAULT_NONE <==> must_trip(machine->state, faults, facts));
*/
static uint32_t reason_to_trip(const agv_state_machine_t *machine, const agv_fault_summary_t *faults, uint32_t facts);

/*@ requires \valid(machine) && \valid(timers) && \valid_read(faults) && \valid(missing);
    requires \separated(machine, timers, faults, missing);
    requires faults->unresettable <= AGV_FAULT_NONE && faults->raised <= AGV_FAULT_NONE;
    requires faults->cause <= AGV_FAULT_NONE && faults->ai_cause <= AGV_FAULT_NONE;
    requires flag_right(machine);
    assigns machine->state, machine->latched, machine->first_reason, machine->output_closed, machine->startup_reported,
            machine->park_released;
    assigns timers->due_ms, timers->since_ms[AGV_TIMER_INIT_GOOD], timers->phase[AGV_TIMER_INIT_GOOD], *missing;
    assigns timers->since_ms[AGV_TIMER_PARK_WAIT], timers->phase[AGV_TIMER_PARK_WAIT];
    ensures flag_right(machine);
    behavior reset:
        assumes is_latched(machine->state) && resets(facts);
        ensures machine->state == 0x33 && none(machine->first_reason) && (\result & 0x02) != 0;
    behavior latched:
        assumes is_latched(machine->state) && !resets(facts);
        ensures confirmed(facts) ? machine->state == 0x5A : machine->state == 0x55;
        ensures machine->first_reason == \old(machine->first_reason) && \result == 0;
        ensures machine->output_closed == \old(machine->output_closed);
    behavior trips:
        assumes must_trip(machine->state, faults, facts);
        ensures machine->state == 0x55 && machine->first_reason < AGV_FAULT_NONE && \result == 0x61;
        ensures machine->output_closed == \old(machine->output_closed);
    behavior init:
        assumes machine->state == 0x0F && !must_trip(machine->state, faults, facts);
        ensures machine->state == 0x0F || (machine->state == 0x33 && \old(reached(timers, AGV_TIMER_INIT_GOOD)));
        ensures machine->state == 0x0F ==> machine->output_closed == \old(machine->output_closed);
        ensures (\result & 0x02) == 0;
    behavior driven:
        assumes drives(machine->state) && !must_trip(machine->state, faults, facts);
        ensures (!engaged(facts) ==> machine->state == 0x33) && (engaged(facts) && ai_alive(facts) ==> machine->state == 0x3C) &&
                (engaged(facts) && !ai_alive(facts) ==> machine->state == \old(machine->state));
        ensures machine->first_reason == \old(machine->first_reason) && (\result & 0x02) == 0;
        ensures machine->output_closed == \old(machine->output_closed);
    complete behaviors;
    disjoint behaviors;
*/
static uint32_t step_state(agv_state_machine_t *machine, agv_timers_t *timers, const agv_fault_summary_t *faults,
                           uint32_t facts, uint16_t *missing);

/*@ requires \valid_read(machine) && \valid_read(before);
    assigns \nothing;
    ensures (\result & 0x100) != 0 <==>
                machine->latched != before->latched || machine->unresettable != before->unresettable;
    ensures (\result & 0x10) != 0 <==> machine->state != before->state;
    ensures (\result & 0x02) == 0;
*/
static uint32_t actions_of_change(const agv_state_machine_t *machine, const agv_state_machine_t *before);

#include "base/state.c"
#include "decide/state_machine.c"
