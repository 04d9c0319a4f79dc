#include "agv/state_machine.h"

#include "agv/latch.h"

static void enter(agv_state_machine_t *machine, agv_state_t state) {
    machine->state = (uint8_t)state;
    machine->latched = (uint8_t)(agv_state_is_latched(state) ? AGV_LATCH_CLOSED : AGV_LATCH_OPEN);
    agv_timer_stop(&machine->good);
}

void agv_state_machine_start(agv_state_machine_t *machine, agv_fault_t reason, uint32_t now_ms) {
    const bool tripped = reason != AGV_FAULT_NONE;
    *machine = (agv_state_machine_t){
        .first_reason = (uint8_t)reason,
        .unresettable = AGV_FAULT_NONE,
        .button_before = true, /* until the VCU tells: what is held since before the start has no rising edge */
    };
    enter(machine, tripped ? AGV_STATE_TRIPPED : AGV_STATE_INIT);
    agv_timer_start(&machine->park_wait, now_ms);
    agv_timer_start(tripped ? &machine->unconfirmed : &machine->init, now_ms);
}

static void enter_standby(agv_state_machine_t *machine) {
    enter(machine, AGV_STATE_STANDBY);
    machine->first_reason = AGV_FAULT_NONE;
    machine->output_closed = true;
}

static void trip(agv_state_machine_t *machine, agv_fault_t reason, uint32_t now_ms) {
    enter(machine, AGV_STATE_TRIPPED);
    machine->first_reason = (uint8_t)reason;
    machine->park_released = false;
    machine->pressed_after_trip = false;
    machine->press_refused = false;
    machine->press_missing = 0u;
    agv_timer_stop(&machine->press);
    agv_timer_stop(&machine->park_sent);
    agv_timer_start(&machine->park_wait, now_ms);
    agv_timer_start(&machine->unconfirmed, now_ms);
}

static void withdraw_confirmation(agv_state_machine_t *machine, uint32_t now_ms) {
    enter(machine, AGV_STATE_TRIPPED);
    agv_timer_start(&machine->unconfirmed, now_ms);
    if (agv_timer_runs(&machine->park_sent)) {
        agv_timer_start(&machine->park_sent, now_ms);
    }
}

static void step_init(agv_state_machine_t *machine, const agv_config_t *config, const agv_situation_t *situation,
                      agv_step_t *step, uint32_t now_ms) {
    const bool cause = (situation->cause != AGV_FAULT_NONE) || situation->ai_cause;
    const uint8_t not_needed = AGV_MISSING_STANDSTILL;
    step->missing = (uint8_t)((situation->missing & ~not_needed) | (cause ? AGV_MISSING_TRIP_CAUSE : 0u));
    agv_timer_while(&machine->good, step->missing == 0u, now_ms);
    if (agv_timer_reached(&machine->good, now_ms, config->init_hold_ms)) {
        enter_standby(machine);
    } else if (!machine->startup_reported && agv_timer_exceeded(&machine->init, now_ms, config->startup_timeout_ms)) {
        machine->startup_reported = true;
        step->startup_timed_out = true;
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
    if (!situation->button) {
        machine->pressed_after_trip = false;
        machine->press_refused = false;
        machine->press_missing = 0u;
    } else if (!machine->button_before) {
        machine->pressed_after_trip = true;
    } else {
        /* held */
    }
    agv_timer_while(&machine->press, situation->button, now_ms);
}

static uint8_t missing_for_reset(const agv_state_machine_t *machine, const agv_situation_t *situation) {
    const bool cause = (situation->cause != AGV_FAULT_NONE) || (machine->unresettable != (uint8_t)AGV_FAULT_NONE);
    return (uint8_t)(situation->missing | (cause ? AGV_MISSING_TRIP_CAUSE : 0u) |
                     ((machine->state == (uint8_t)AGV_STATE_SAFE) ? 0u : AGV_MISSING_STATE) |
                     (machine->pressed_after_trip ? 0u : AGV_MISSING_BUTTON));
}

static void step_reset(agv_state_machine_t *machine, const agv_config_t *config, const agv_situation_t *situation,
                       agv_step_t *step, uint32_t now_ms) {
    follow_button(machine, situation, now_ms);
    const uint8_t missing = missing_for_reset(machine, situation);
    machine->press_missing |= situation->button ? missing : 0u;
    agv_timer_while(&machine->good, missing == 0u, now_ms);
    if (agv_timer_reached(&machine->good, now_ms, config->reset_hold_ms)) {
        enter_standby(machine);
        step->reset_accepted = true;
    } else if (!machine->press_refused && agv_timer_reached(&machine->press, now_ms, config->reset_hold_ms)) {
        machine->press_refused = true;
        step->reset_refused = true;
        step->missing = machine->press_missing;
    } else {
        /* not held for long enough */
    }
}

static void step_latched(agv_state_machine_t *machine, const agv_config_t *config, const agv_situation_t *situation,
                         agv_step_t *step, uint32_t now_ms) {
    const bool confirmed = situation->autopilot_off && situation->in_park;
    const bool safe = machine->state == (uint8_t)AGV_STATE_SAFE;
    if (confirmed && !safe) {
        enter(machine, AGV_STATE_SAFE);
    } else if (!confirmed && safe) {
        withdraw_confirmation(machine, now_ms);
    } else {
        /* stays */
    }
    step_reset(machine, config, situation, step, now_ms);
}

/* park: at_standstill holds P back until the vehicle stands, or for park_timeout_ms (FSM-1). */
static void release_park(agv_state_machine_t *machine, const agv_config_t *config, const agv_situation_t *situation,
                         uint32_t now_ms) {
    if ((config->park == (uint16_t)AGV_PARK_AT_ONCE) || ((situation->missing & AGV_MISSING_STANDSTILL) == 0u) ||
        agv_timer_reached(&machine->park_wait, now_ms, config->park_timeout_ms)) {
        machine->park_released = true;
    }
}

static void judge_output(agv_state_machine_t *machine, const agv_config_t *config, const agv_situation_t *situation,
                         uint32_t now_ms) {
    const uint16_t limit_ms = config->confirm_timeout_ms;
    const bool off_late = agv_timer_exceeded(&machine->unconfirmed, now_ms, limit_ms) && !situation->autopilot_off;
    const bool park_late = agv_timer_exceeded(&machine->park_sent, now_ms, limit_ms) && !situation->in_park;
    machine->safe_state_unconfirmed = (machine->state == (uint8_t)AGV_STATE_TRIPPED) && (off_late || park_late);
    if (machine->safe_state_unconfirmed || situation->output_unsafe ||
        (machine->unresettable != (uint8_t)AGV_FAULT_NONE)) {
        machine->output_closed = false;
    }
}

/* The reason of a trip; AGV_FAULT_NONE: none. In INIT only the unresettable ones latch. */
static agv_fault_t reason_to_trip(const agv_state_machine_t *machine, const agv_situation_t *situation) {
    if (machine->state == (uint8_t)AGV_STATE_INIT) {
        return situation->forever;
    }
    return (situation->raised != AGV_FAULT_NONE) ? situation->raised : situation->cause;
}

agv_step_t agv_state_machine_step(agv_state_machine_t *machine, const agv_config_t *config,
                                  const agv_situation_t *situation, uint32_t now_ms) {
    agv_step_t step = {.from = machine->state};
    const agv_fault_t reason = reason_to_trip(machine, situation);
    if (situation->forever != AGV_FAULT_NONE) {
        machine->unresettable = (uint8_t)situation->forever;
    }
    if (agv_state_is_latched((agv_state_t)machine->state)) {
        step_latched(machine, config, situation, &step, now_ms);
    } else if (reason != AGV_FAULT_NONE) {
        trip(machine, reason, now_ms);
        step.tripped = true;
    } else if (machine->state == (uint8_t)AGV_STATE_INIT) {
        step_init(machine, config, situation, &step, now_ms);
    } else {
        follow_engagement(machine, situation);
    }
    machine->button_before = situation->button || !situation->button_known;
    release_park(machine, config, situation, now_ms);
    judge_output(machine, config, situation, now_ms);
    return step;
}

void agv_state_machine_park_sent(agv_state_machine_t *machine, uint32_t now_ms) {
    agv_timer_while(&machine->park_sent, agv_state_is_latched((agv_state_t)machine->state), now_ms);
}

bool agv_state_machine_is_sound(const agv_state_machine_t *machine) {
    const agv_state_t state = (agv_state_t)machine->state;
    const bool open = (state == AGV_STATE_INIT) || (state == AGV_STATE_STANDBY) || (state == AGV_STATE_ACTIVE);
    const bool closed = (state == AGV_STATE_TRIPPED) || (state == AGV_STATE_SAFE);
    return (open && (machine->latched == (uint8_t)AGV_LATCH_OPEN)) ||
           (closed && (machine->latched == (uint8_t)AGV_LATCH_CLOSED));
}
