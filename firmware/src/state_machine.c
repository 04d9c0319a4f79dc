#include "agv/state_machine.h"

#include "agv/latch.h"
#include "agv/recorder.h"

void agv_state_machine_start(agv_state_machine_t *machine, agv_fault_t reason, uint32_t now_ms) {
    const bool tripped = reason != AGV_FAULT_NONE;
    *machine = (agv_state_machine_t){
        .state = (uint8_t)(tripped ? AGV_STATE_TRIPPED : AGV_STATE_INIT),
        .latched = (uint8_t)(tripped ? AGV_LATCH_CLOSED : AGV_LATCH_OPEN),
        .first_reason = (uint8_t)reason,
        .unresettable = AGV_FAULT_NONE,
        .button_before = true, /* a button held since before the start has no rising edge */
    };
    agv_timer_start(&machine->park_wait, now_ms);
    agv_timer_start(tripped ? &machine->unconfirmed : &machine->init, now_ms);
}

static void enter(agv_state_machine_t *machine, agv_state_t state) {
    machine->state = (uint8_t)state;
    machine->latched = (uint8_t)(agv_state_is_latched(state) ? AGV_LATCH_CLOSED : AGV_LATCH_OPEN);
    agv_timer_stop(&machine->reset_good);
}

static void enter_standby(agv_state_machine_t *machine) {
    enter(machine, AGV_STATE_STANDBY);
    machine->first_reason = AGV_FAULT_NONE;
    machine->output_closed = true;
    machine->park_released = false;
    agv_timer_stop(&machine->init);
    agv_timer_stop(&machine->park_sent);
    agv_timer_stop(&machine->park_wait);
}

static void trip(agv_state_machine_t *machine, agv_fault_t reason, uint32_t now_ms) {
    enter(machine, AGV_STATE_TRIPPED);
    machine->first_reason = (uint8_t)reason;
    machine->park_released = false;
    machine->pressed_after_trip = false;
    machine->press_refused = false;
    machine->press_missing = 0u;
    agv_timer_stop(&machine->init);
    agv_timer_stop(&machine->press);
    agv_timer_stop(&machine->park_sent);
    agv_timer_start(&machine->park_wait, now_ms);
    agv_timer_start(&machine->unconfirmed, now_ms);
}

static void withdraw_confirmation(agv_state_machine_t *machine, uint32_t now_ms) {
    enter(machine, AGV_STATE_TRIPPED);
    agv_timer_start(&machine->unconfirmed, now_ms);
    if (machine->park_sent.phase != (uint8_t)AGV_TIMER_STOPPED) {
        agv_timer_start(&machine->park_sent, now_ms);
    }
}

static uint8_t missing_when(bool condition, uint8_t what) {
    return condition ? what : 0u;
}

static uint8_t missing_of_vehicle(const agv_situation_t *situation, agv_fault_set_t trips) {
    return (uint8_t)(missing_when(!situation->vcu_alive, AGV_MISSING_VCU_HEARTBEAT) |
                     missing_when(!situation->eps_alive, AGV_MISSING_EPS_HEARTBEAT) |
                     missing_when(trips != 0u, AGV_MISSING_TRIP_CAUSE) |
                     missing_when(!situation->manual, AGV_MISSING_MANUAL) |
                     missing_when(!situation->messages_fresh, AGV_MISSING_MESSAGES));
}

static bool is_confirmed(const agv_situation_t *situation) {
    return situation->autopilot_off && situation->in_park;
}

static void step_init(agv_state_machine_t *machine, const agv_config_t *config, const agv_situation_t *situation,
                      agv_step_t *step, uint32_t now_ms) {
    const uint8_t missing = missing_of_vehicle(situation, situation->active_trips);
    agv_timer_while(&machine->init_good, missing == 0u, now_ms);
    if (agv_timer_reached(&machine->init_good, now_ms, config->init_hold_ms)) {
        enter_standby(machine);
    } else if (agv_timer_exceeded(&machine->init, now_ms, config->startup_timeout_ms) && !machine->startup_reported) {
        machine->startup_reported = true;
        step->startup_timed_out = true;
        step->missing = missing;
    } else {
        /* wait */
    }
}

static void follow_engagement(agv_state_machine_t *machine, const agv_situation_t *situation) {
    if (!situation->engaged) {
        machine->state = (uint8_t)AGV_STATE_STANDBY;
    } else if (situation->ai_alive) {
        machine->state = (uint8_t)AGV_STATE_ACTIVE;
    } else {
        /* engaged without the AI alive: AI_HEARTBEAT_* trips in its time */
    }
}

/* Presses of the reset button: since when, and whether they began after the trip. */
static void follow_button(agv_state_machine_t *machine, const agv_situation_t *situation, uint32_t now_ms) {
    if (situation->button && !machine->button_before) {
        machine->pressed_after_trip = true;
    }
    if (!situation->button) {
        machine->pressed_after_trip = false;
        machine->press_refused = false;
        machine->press_missing = 0u;
    }
    agv_timer_while(&machine->press, situation->button, now_ms);
}

static void step_reset(agv_state_machine_t *machine, const agv_config_t *config, const agv_situation_t *situation,
                       agv_step_t *step, uint32_t now_ms) {
    const bool in_safe = machine->state == (uint8_t)AGV_STATE_SAFE;
    const agv_fault_set_t causes = situation->active_trips & ~agv_faults_from_ai;
    const bool unresettable = machine->unresettable != (uint8_t)AGV_FAULT_NONE;
    follow_button(machine, situation, now_ms);
    const uint8_t missing =
        (uint8_t)(missing_of_vehicle(situation, causes) | missing_when(!in_safe, AGV_MISSING_STATE) |
                  missing_when(unresettable, AGV_MISSING_TRIP_CAUSE) |
                  missing_when(!situation->standstill, AGV_MISSING_STANDSTILL) |
                  missing_when(!machine->pressed_after_trip, AGV_MISSING_BUTTON));
    agv_timer_while(&machine->reset_good, missing == 0u, now_ms);
    if (situation->button) {
        machine->press_missing |= missing;
    }
    if (agv_timer_reached(&machine->reset_good, now_ms, config->reset_hold_ms)) {
        enter_standby(machine);
        step->reset_accepted = true;
    } else if (agv_timer_reached(&machine->press, now_ms, config->reset_hold_ms) && !machine->press_refused) {
        machine->press_refused = true;
        step->reset_refused = true;
        step->missing = machine->press_missing;
    } else {
        /* not held for long enough */
    }
}

static void step_latched(agv_state_machine_t *machine, const agv_config_t *config, const agv_situation_t *situation,
                         agv_step_t *step, uint32_t now_ms) {
    if ((machine->state == (uint8_t)AGV_STATE_TRIPPED) && is_confirmed(situation)) {
        enter(machine, AGV_STATE_SAFE);
        agv_timer_stop(&machine->unconfirmed);
    } else if ((machine->state == (uint8_t)AGV_STATE_SAFE) && !is_confirmed(situation)) {
        withdraw_confirmation(machine, now_ms);
    } else {
        /* stays */
    }
    step_reset(machine, config, situation, step, now_ms);
}

/* park: at_standstill holds P back until the vehicle stands, or for park_timeout_ms (FSM-1). */
static void release_park(agv_state_machine_t *machine, const agv_config_t *config, const agv_situation_t *situation,
                         uint32_t now_ms) {
    if ((config->park == (uint16_t)AGV_PARK_AT_ONCE) || situation->standstill ||
        agv_timer_reached(&machine->park_wait, now_ms, config->park_timeout_ms)) {
        machine->park_released = true;
    }
}

static void judge_output(agv_state_machine_t *machine, const agv_config_t *config, const agv_situation_t *situation,
                         uint32_t now_ms) {
    const bool too_long = agv_timer_exceeded(&machine->unconfirmed, now_ms, config->confirm_timeout_ms);
    const bool park_too_long = agv_timer_exceeded(&machine->park_sent, now_ms, config->confirm_timeout_ms);
    machine->safe_state_unconfirmed =
        (machine->state == (uint8_t)AGV_STATE_TRIPPED) &&
        ((too_long && !situation->autopilot_off) || (park_too_long && !situation->in_park));
    if (machine->safe_state_unconfirmed || situation->output_unsafe ||
        (machine->unresettable != (uint8_t)AGV_FAULT_NONE)) {
        machine->output_closed = false;
    }
}

static bool trips_now(const agv_state_machine_t *machine, const agv_situation_t *situation) {
    const bool init = machine->state == (uint8_t)AGV_STATE_INIT;
    const agv_fault_set_t counting = situation->raised_trips | (situation->active_trips & ~agv_faults_from_ai);
    return (counting & (init ? agv_faults_unresettable : ~(agv_fault_set_t)0u)) != 0u;
}

static agv_fault_t reason_of(const agv_situation_t *situation) {
    const agv_fault_set_t raised = situation->raised_trips;
    return agv_fault_highest((raised != 0u) ? raised : situation->active_trips);
}

agv_step_t agv_state_machine_step(agv_state_machine_t *machine, const agv_config_t *config,
                                  const agv_situation_t *situation, uint32_t now_ms) {
    agv_step_t step = {.from = machine->state};
    const agv_fault_set_t forever = situation->raised_trips & agv_faults_unresettable;
    if (forever != 0u) {
        machine->unresettable = (uint8_t)agv_fault_highest(forever);
    }
    if (agv_state_is_latched((agv_state_t)machine->state)) {
        step_latched(machine, config, situation, &step, now_ms);
    } else if (trips_now(machine, situation)) {
        trip(machine, reason_of(situation), now_ms);
        step.tripped = true;
    } else if (machine->state == (uint8_t)AGV_STATE_INIT) {
        step_init(machine, config, situation, &step, now_ms);
    } else {
        follow_engagement(machine, situation);
    }
    machine->button_before = situation->button;
    if (agv_state_commands_safe((agv_state_t)machine->state)) {
        release_park(machine, config, situation, now_ms);
    }
    judge_output(machine, config, situation, now_ms);
    return step;
}

void agv_state_machine_park_sent(agv_state_machine_t *machine, uint32_t now_ms) {
    if (agv_state_is_latched((agv_state_t)machine->state)) {
        agv_timer_while(&machine->park_sent, true, now_ms);
    }
}

agv_fault_set_t agv_state_machine_faults(const agv_state_machine_t *machine) {
    const bool waiting = machine->startup_reported && (machine->state == (uint8_t)AGV_STATE_INIT);
    return agv_fault_when(machine->safe_state_unconfirmed, AGV_FAULT_SAFE_STATE_UNCONFIRMED) |
           agv_fault_when(waiting, AGV_FAULT_STARTUP_TIMEOUT);
}

bool agv_state_machine_is_sound(const agv_state_machine_t *machine) {
    switch (machine->state) {
    case AGV_STATE_INIT:
    case AGV_STATE_STANDBY:
    case AGV_STATE_ACTIVE:
        return machine->latched == (uint8_t)AGV_LATCH_OPEN;
    case AGV_STATE_TRIPPED:
    case AGV_STATE_SAFE:
        return machine->latched == (uint8_t)AGV_LATCH_CLOSED;
    default:
        return false;
    }
}
