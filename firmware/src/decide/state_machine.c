#include "decide/state_machine.h"

#include "keep/latch.h"

static void enter(agv_state_machine_t *machine, agv_state_t state) {
    machine->state = (uint8_t)state;
    machine->latched = (uint8_t)(agv_state_is_latched(state) ? AGV_LATCH_CLOSED : AGV_LATCH_OPEN);
}

void agv_state_machine_start(agv_state_machine_t *machine, agv_timers_t *timers, const agv_config_t *config,
                             uint32_t reason) {
    const bool tripped = reason != (uint32_t)AGV_FAULT_NONE;
    machine->first_reason = (uint8_t)reason;
    machine->unresettable = AGV_FAULT_NONE;
    machine->park_released = config->park == (uint16_t)AGV_PARK_AT_ONCE;
    enter(machine, tripped ? AGV_STATE_TRIPPED : AGV_STATE_INIT);
    agv_timer_start(timers, AGV_TIMER_PARK_WAIT);
    agv_timer_start(timers, AGV_TIMER_STARTUP);
}

void agv_state_machine_forbid_reset(agv_state_machine_t *machine, uint32_t fault) {
    if (fault != (uint32_t)AGV_FAULT_NONE) {
        machine->unresettable = (uint8_t)fault;
    }
}

static uint32_t enter_standby(agv_state_machine_t *machine) {
    enter(machine, AGV_STATE_STANDBY);
    machine->first_reason = AGV_FAULT_NONE;
    machine->output_closed = true;
    return AGV_ACTION_DISCARD | AGV_ACTION_PURGE | AGV_ACTION_UNLATCH;
}

static uint32_t trip(agv_state_machine_t *machine, agv_timers_t *timers, uint32_t reason) {
    enter(machine, AGV_STATE_TRIPPED);
    machine->first_reason = (uint8_t)reason;
    machine->park_released = false;
    agv_timer_start(timers, AGV_TIMER_PARK_WAIT);
    return AGV_ACTION_TRIP | AGV_ACTION_DISCARD | AGV_ACTION_PURGE;
}

static bool has_cause(uint8_t fault) {
    return fault != (uint8_t)AGV_FAULT_NONE;
}

static uint32_t missing_in_init(const agv_fault_summary_t *faults, uint32_t facts) {
    const uint32_t needed = AGV_FACT_VCU_ALIVE | AGV_FACT_EPS_ALIVE | AGV_FACT_MANUAL | AGV_FACT_MESSAGES |
                            AGV_FACT_IDLE | AGV_FACT_OUTPUT_OPEN;
    uint32_t missing = needed & ~facts;
    missing |= ((facts & AGV_FACT_SLOW) == 0u) ? AGV_MISSING_STANDSTILL : 0u;
    missing |= ((facts & AGV_FACT_ENGAGED) != 0u) ? AGV_FACT_MANUAL : 0u;
    missing |= (has_cause(faults->cause) || has_cause(faults->ai_cause)) ? AGV_MISSING_TRIP_CAUSE : 0u;
    return missing;
}

static uint32_t step_init(agv_state_machine_t *machine, agv_timers_t *timers, const agv_fault_summary_t *faults,
                          uint32_t facts, uint16_t *missing) {
    *missing = (uint16_t)missing_in_init(faults, facts);
    if (agv_timer_while(timers, AGV_TIMER_INIT_GOOD, *missing == 0u)) {
        return enter_standby(machine);
    }
    if (!machine->startup_reported && agv_timer_reached(timers, AGV_TIMER_STARTUP)) {
        machine->startup_reported = true;
        return AGV_ACTION_STARTUP_LATE;
    }
    return 0u;
}

static uint32_t follow_engagement(agv_state_machine_t *machine, uint32_t facts) {
    const bool was_active = machine->state == (uint8_t)AGV_STATE_ACTIVE;
    if ((facts & AGV_FACT_ENGAGED) == 0u) {
        machine->state = (uint8_t)AGV_STATE_STANDBY;
        return was_active ? AGV_ACTION_END_ENGAGEMENT : 0u;
    }
    if ((facts & AGV_FACT_AI_ALIVE) != 0u) {
        machine->state = (uint8_t)AGV_STATE_ACTIVE;
    }
    return 0u; /* engaged while the AI is not alive: AI_HEARTBEAT_* will trip */
}

static bool is_confirmed(uint32_t facts) {
    const uint32_t confirmation = AGV_FACT_AUTOPILOT_OFF | AGV_FACT_IN_PARK;
    return (facts & confirmation) == confirmation;
}

uint32_t agv_state_machine_lacks_for_reset(const agv_state_machine_t *machine, const agv_fault_summary_t *faults,
                                           uint32_t facts) {
    const uint32_t needed = AGV_FACT_VCU_ALIVE | AGV_FACT_EPS_ALIVE | AGV_FACT_STANDSTILL | AGV_FACT_MANUAL |
                            AGV_FACT_MESSAGES | AGV_FACT_IDLE | AGV_FACT_OUTPUT_OPEN;
    uint32_t missing = needed & ~facts;
    if (has_cause(faults->cause) || has_cause(machine->unresettable)) {
        missing |= AGV_MISSING_TRIP_CAUSE;
    }
    if ((machine->state != (uint8_t)AGV_STATE_SAFE) || !is_confirmed(facts)) {
        missing |= AGV_MISSING_STATE;
    }
    return missing;
}

static uint32_t step_latched(agv_state_machine_t *machine, uint32_t facts) {
    if ((facts & AGV_FACT_RESET) != 0u) {
        return enter_standby(machine) | AGV_ACTION_RESET_ACCEPTED;
    }
    enter(machine, is_confirmed(facts) ? AGV_STATE_SAFE : AGV_STATE_TRIPPED);
    return 0u;
}

/* park: at_standstill holds P back until the wheels stand, or for park_timeout_ms (FSM-1). */
static void release_park(agv_state_machine_t *machine, const agv_timers_t *timers, const agv_config_t *config,
                         uint32_t facts) {
    if ((config->park == (uint16_t)AGV_PARK_AT_ONCE) || ((facts & AGV_FACT_WHEELS_STAND) != 0u) ||
        agv_timer_reached(timers, AGV_TIMER_PARK_WAIT)) {
        machine->park_released = true;
    }
}

bool agv_state_machine_is_startup_late(const agv_state_machine_t *machine, const agv_timers_t *timers) {
    return (machine->state == (uint8_t)AGV_STATE_INIT) && agv_timer_reached(timers, AGV_TIMER_STARTUP);
}

/*
 * The reason of a trip, or AGV_FAULT_NONE. In INIT only unresettable faults latch. A cause from the AI computer that
 * outlived a reset trips when the autopilot is engaged (FSM-11).
 */
static uint32_t reason_to_trip(const agv_state_machine_t *machine, const agv_fault_summary_t *faults, uint32_t facts) {
    if (machine->state == (uint8_t)AGV_STATE_INIT) {
        return faults->unresettable;
    }
    if (has_cause(faults->raised)) {
        return faults->raised;
    }
    if (has_cause(faults->cause)) {
        return faults->cause;
    }
    return ((facts & AGV_FACT_ENGAGED) != 0u) ? faults->ai_cause : (uint32_t)AGV_FAULT_NONE;
}

static uint32_t step_state(agv_state_machine_t *machine, agv_timers_t *timers, const agv_fault_summary_t *faults,
                           uint32_t facts, uint16_t *missing) {
    const uint32_t reason = reason_to_trip(machine, faults, facts);
    if (agv_state_is_latched((agv_state_t)machine->state)) {
        return step_latched(machine, facts);
    }
    if (reason != (uint32_t)AGV_FAULT_NONE) {
        return trip(machine, timers, reason);
    }
    return (machine->state == (uint8_t)AGV_STATE_INIT) ? step_init(machine, timers, faults, facts, missing)
                                                       : follow_engagement(machine, facts);
}

/* The actions that follow from a change of the state machine. */
static uint32_t actions_of_change(const agv_state_machine_t *machine, const agv_state_machine_t *before) {
    uint32_t what = (machine->state != before->state) ? AGV_ACTION_STATE : 0u;
    if ((machine->latched != before->latched) || (machine->unresettable != before->unresettable)) {
        what |= AGV_ACTION_STORE_LATCH;
    }
    if (machine->output_closed != before->output_closed) {
        what |= machine->output_closed ? AGV_ACTION_CLOSE_OUTPUT : AGV_ACTION_OPEN_OUTPUT;
    }
    return what;
}

agv_actions_t agv_state_machine_step(agv_state_machine_t *machine, agv_timers_t *timers, const agv_config_t *config,
                                     const agv_fault_summary_t *faults, uint32_t facts) {
    const agv_state_machine_t before = *machine;
    agv_actions_t actions = {.from = before.state, .first_reason = before.first_reason};
    agv_state_machine_forbid_reset(machine, faults->unresettable);
    actions.what = step_state(machine, timers, faults, facts, &actions.missing);
    release_park(machine, timers, config, facts);
    if (((facts & AGV_FACT_OUTPUT_UNSAFE) != 0u) || has_cause(machine->unresettable)) {
        machine->output_closed = false;
    }
    actions.what |= actions_of_change(machine, &before);
    return actions;
}

bool agv_state_machine_is_sound(const agv_state_machine_t *machine) {
    static const struct {
        uint8_t state;
        uint8_t latched;
    } pairs[] = {{AGV_STATE_INIT, AGV_LATCH_OPEN},
                 {AGV_STATE_STANDBY, AGV_LATCH_OPEN},
                 {AGV_STATE_ACTIVE, AGV_LATCH_OPEN},
                 {AGV_STATE_TRIPPED, AGV_LATCH_CLOSED},
                 {AGV_STATE_SAFE, AGV_LATCH_CLOSED}};
    bool sound = false;
    /* for tests/proofs/unbounded/run */
    /*@ loop invariant 0 <= i <= 5;
        loop invariant sound == 0 || sound == 1;
        loop invariant sound != 0 <==> \exists integer k; 0 <= k < i &&
            machine->state == pairs[k].state && machine->latched == pairs[k].latched;
        loop assigns i, sound;
        loop variant 5 - i; */
    for (uint32_t i = 0u; i < (sizeof(pairs) / sizeof(pairs[0])); i++) {
        if ((machine->state == pairs[i].state) && (machine->latched == pairs[i].latched)) {
            sound = true;
        }
    }
    return sound;
}
