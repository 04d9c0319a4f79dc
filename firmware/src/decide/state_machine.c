#include "decide/state_machine.h"

#include "keep/latch.h"

static void enter(agv_state_machine_t *machine, agv_timers_t *timers, agv_state_t state) {
    machine->state = (uint8_t)state;
    machine->latched = (uint8_t)(agv_state_is_latched(state) ? AGV_LATCH_CLOSED : AGV_LATCH_OPEN);
    agv_timer_stop(timers, AGV_TIMER_RESET_GOOD);
}

void agv_state_machine_start(agv_state_machine_t *machine, agv_timers_t *timers, const agv_config_t *config,
                             uint32_t reason) {
    const bool tripped = reason != (uint32_t)AGV_FAULT_NONE;
    machine->first_reason = (uint8_t)reason;
    machine->unresettable = AGV_FAULT_NONE;
    machine->button_before = true; /* what is held since before the start has no rising edge */
    machine->park_released = config->park == (uint16_t)AGV_PARK_AT_ONCE;
    enter(machine, timers, tripped ? AGV_STATE_TRIPPED : AGV_STATE_INIT);
    agv_timer_start(timers, AGV_TIMER_PARK_WAIT);
    agv_timer_start(timers, AGV_TIMER_STARTUP); /* of these two the one of the state counts */
    agv_timer_start(timers, AGV_TIMER_UNCONFIRMED);
}

void agv_state_machine_forbid_reset(agv_state_machine_t *machine, uint32_t fault) {
    if (fault != (uint32_t)AGV_FAULT_NONE) {
        machine->unresettable = (uint8_t)fault;
    }
}

static uint32_t enter_standby(agv_state_machine_t *machine, agv_timers_t *timers) {
    enter(machine, timers, AGV_STATE_STANDBY);
    machine->first_reason = AGV_FAULT_NONE;
    machine->output_closed = true;
    return AGV_ACTION_DISCARD | AGV_ACTION_PURGE | AGV_ACTION_UNLATCH;
}

/* No press counts that began before now. */
static void forget_press(agv_state_machine_t *machine) {
    machine->pressed_after_trip = false;
    machine->press_refused = false;
    machine->press_missing = 0u;
}

static uint32_t trip(agv_state_machine_t *machine, agv_timers_t *timers, uint32_t reason) {
    enter(machine, timers, AGV_STATE_TRIPPED);
    machine->first_reason = (uint8_t)reason;
    machine->park_released = false;
    forget_press(machine);
    agv_timer_stop(timers, AGV_TIMER_PRESS);
    agv_timer_stop(timers, AGV_TIMER_PARK_SENT);
    agv_timer_start(timers, AGV_TIMER_PARK_WAIT);
    agv_timer_start(timers, AGV_TIMER_UNCONFIRMED);
    return AGV_ACTION_TRIP | AGV_ACTION_DISCARD | AGV_ACTION_PURGE;
}

static void withdraw_confirmation(agv_state_machine_t *machine, agv_timers_t *timers) {
    enter(machine, timers, AGV_STATE_TRIPPED);
    agv_timer_start(timers, AGV_TIMER_UNCONFIRMED);
    if (agv_timer_runs(timers, AGV_TIMER_PARK_SENT)) {
        agv_timer_start(timers, AGV_TIMER_PARK_SENT);
    }
}

static uint32_t step_init(agv_state_machine_t *machine, agv_timers_t *timers, const agv_fault_summary_t *faults,
                          uint32_t facts) {
    const bool cause = (faults->cause != (uint8_t)AGV_FAULT_NONE) || (faults->ai_cause != (uint8_t)AGV_FAULT_NONE);
    const uint32_t needed = AGV_FACT_VCU_ALIVE | AGV_FACT_EPS_ALIVE | AGV_FACT_MANUAL | AGV_FACT_MESSAGES;
    const uint32_t missing = (needed & ~facts) | (cause ? AGV_MISSING_TRIP_CAUSE : 0u);
    if (agv_timer_while(timers, AGV_TIMER_INIT_GOOD, missing == 0u)) {
        return enter_standby(machine, timers);
    }
    if (!machine->startup_reported && agv_timer_reached(timers, AGV_TIMER_STARTUP)) {
        machine->startup_reported = true;
        return AGV_ACTION_STARTUP_LATE | missing;
    }
    return 0u;
}

static uint32_t follow_engagement(agv_state_machine_t *machine, uint32_t facts) {
    const bool was_active = machine->state == (uint8_t)AGV_STATE_ACTIVE;
    if ((facts & AGV_FACT_ENGAGED) == 0u) {
        machine->state = (uint8_t)AGV_STATE_STANDBY;
    } else if ((facts & AGV_FACT_AI_ALIVE) != 0u) {
        machine->state = (uint8_t)AGV_STATE_ACTIVE;
    } else {
        /* engaged without the AI alive: AI_HEARTBEAT_* trips in its time */
    }
    /* From ACTIVE: motion commands that wait for a stalled side. */
    return (was_active && (machine->state != (uint8_t)AGV_STATE_ACTIVE)) ? AGV_ACTION_DISCARD : 0u;
}

static uint32_t missing_for_reset(const agv_state_machine_t *machine, const agv_fault_summary_t *faults,
                                  uint32_t facts) {
    const uint32_t needed =
        AGV_FACT_VCU_ALIVE | AGV_FACT_EPS_ALIVE | AGV_FACT_STANDSTILL | AGV_FACT_MANUAL | AGV_FACT_MESSAGES;
    uint32_t missing = needed & ~facts;
    if ((faults->cause != (uint8_t)AGV_FAULT_NONE) || (machine->unresettable != (uint8_t)AGV_FAULT_NONE)) {
        missing |= AGV_MISSING_TRIP_CAUSE;
    }
    if (machine->state != (uint8_t)AGV_STATE_SAFE) {
        missing |= AGV_MISSING_STATE;
    }
    if (!machine->pressed_after_trip) {
        missing |= AGV_MISSING_BUTTON;
    }
    return missing;
}

static uint32_t step_reset(agv_state_machine_t *machine, agv_timers_t *timers, const agv_fault_summary_t *faults,
                           uint32_t facts) {
    const bool button = (facts & AGV_FACT_BUTTON_DOWN) != 0u;
    if (!button) {
        forget_press(machine);
    } else if (!machine->button_before) {
        machine->pressed_after_trip = true;
    } else {
        /* held */
    }
    const bool held = agv_timer_while(timers, AGV_TIMER_PRESS, button);
    const uint32_t missing = missing_for_reset(machine, faults, facts);
    if (button) {
        machine->press_missing |= (uint8_t)missing;
    }
    if (agv_timer_while(timers, AGV_TIMER_RESET_GOOD, missing == 0u)) {
        return enter_standby(machine, timers) | AGV_ACTION_RESET_ACCEPTED;
    }
    if (held && !machine->press_refused) {
        machine->press_refused = true;
        return AGV_ACTION_RESET_REFUSED | machine->press_missing;
    }
    return 0u;
}

static uint32_t step_latched(agv_state_machine_t *machine, agv_timers_t *timers, const agv_fault_summary_t *faults,
                             uint32_t facts) {
    const uint32_t confirmation = AGV_FACT_AUTOPILOT_OFF | AGV_FACT_IN_PARK;
    const bool confirmed = (facts & confirmation) == confirmation;
    const bool safe = machine->state == (uint8_t)AGV_STATE_SAFE;
    if (confirmed && !safe) {
        enter(machine, timers, AGV_STATE_SAFE);
    } else if (!confirmed && safe) {
        withdraw_confirmation(machine, timers);
    } else {
        /* stays */
    }
    return step_reset(machine, timers, faults, facts);
}

/* park: at_standstill holds P back until the vehicle stands, or for park_timeout_ms (FSM-1). */
static void release_park(agv_state_machine_t *machine, const agv_timers_t *timers, const agv_config_t *config,
                         uint32_t facts) {
    if ((config->park == (uint16_t)AGV_PARK_AT_ONCE) || ((facts & AGV_FACT_STANDSTILL) != 0u) ||
        agv_timer_reached(timers, AGV_TIMER_PARK_WAIT)) {
        machine->park_released = true;
    }
}

bool agv_state_machine_is_unconfirmed(const agv_state_machine_t *machine, const agv_timers_t *timers, uint32_t facts) {
    const bool off_missing = (facts & AGV_FACT_AUTOPILOT_OFF) == 0u;
    const bool park_missing = (facts & AGV_FACT_IN_PARK) == 0u;
    const bool off_late = off_missing && agv_timer_reached(timers, AGV_TIMER_UNCONFIRMED);
    const bool park_late = (off_missing || park_missing) && agv_timer_reached(timers, AGV_TIMER_PARK_SENT);
    return (machine->state == (uint8_t)AGV_STATE_TRIPPED) && (off_late || park_late);
}

bool agv_state_machine_is_startup_late(const agv_state_machine_t *machine, const agv_timers_t *timers) {
    return (machine->state == (uint8_t)AGV_STATE_INIT) && agv_timer_reached(timers, AGV_TIMER_STARTUP);
}

static void open_output(agv_state_machine_t *machine, const agv_timers_t *timers, uint32_t facts) {
    if (agv_state_machine_is_unconfirmed(machine, timers, facts) || ((facts & AGV_FACT_OUTPUT_UNSAFE) != 0u) ||
        (machine->unresettable != (uint8_t)AGV_FAULT_NONE)) {
        machine->output_closed = false;
    }
}

/* The reason of a trip; AGV_FAULT_NONE: none. In INIT only the unresettable ones latch. */
static uint32_t reason_to_trip(const agv_state_machine_t *machine, const agv_fault_summary_t *faults) {
    if (machine->state == (uint8_t)AGV_STATE_INIT) {
        return faults->unresettable;
    }
    return (faults->raised != (uint8_t)AGV_FAULT_NONE) ? faults->raised : faults->cause;
}

static uint32_t step_state(agv_state_machine_t *machine, agv_timers_t *timers, const agv_fault_summary_t *faults,
                           uint32_t facts) {
    const uint32_t reason = reason_to_trip(machine, faults);
    if (agv_state_is_latched((agv_state_t)machine->state)) {
        return step_latched(machine, timers, faults, facts);
    }
    if (reason != (uint32_t)AGV_FAULT_NONE) {
        return trip(machine, timers, reason);
    }
    return (machine->state == (uint8_t)AGV_STATE_INIT) ? step_init(machine, timers, faults, facts)
                                                       : follow_engagement(machine, facts);
}

/* What follows from the machine being another one than before. */
static uint32_t changes(const agv_state_machine_t *machine, const agv_state_machine_t *before) {
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
    actions.what = step_state(machine, timers, faults, facts);
    machine->button_before = (facts & AGV_FACT_BUTTON_UP) == 0u;
    release_park(machine, timers, config, facts);
    open_output(machine, timers, facts);
    actions.what |= changes(machine, &before);
    return actions;
}

void agv_state_machine_park_sent(const agv_state_machine_t *machine, agv_timers_t *timers) {
    (void)agv_timer_while(timers, AGV_TIMER_PARK_SENT, agv_state_is_latched((agv_state_t)machine->state));
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
    for (uint32_t i = 0u; i < (sizeof(pairs) / sizeof(pairs[0])); i++) {
        if ((machine->state == pairs[i].state) && (machine->latched == pairs[i].latched)) {
            sound = true;
        }
    }
    return sound;
}
