#include "agv/state_machine.h"

#include "agv/core.h"
#include "agv/latch.h"

static void enter(agv_core_t *core, agv_state_t state) {
    core->machine.state = (uint8_t)state;
    core->machine.latched = (uint8_t)(agv_state_is_latched(state) ? AGV_LATCH_CLOSED : AGV_LATCH_OPEN);
    agv_watch_stop(core, AGV_WATCH_RESET_GOOD);
}

void agv_state_machine_start(agv_core_t *core, uint32_t reason) {
    const bool tripped = reason != (uint32_t)AGV_FAULT_NONE;
    core->machine.first_reason = (uint8_t)reason;
    core->machine.unresettable = AGV_FAULT_NONE;
    core->machine.button_before =
        true; /* until the VCU tells: what is held since before the start has no rising edge */
    enter(core, tripped ? AGV_STATE_TRIPPED : AGV_STATE_INIT);
    agv_watch_start(core, AGV_WATCH_PARK_WAIT);
    agv_watch_start(core, AGV_WATCH_INIT); /* of these two the one of the state counts */
    agv_watch_start(core, AGV_WATCH_UNCONFIRMED);
}

static void enter_standby(agv_core_t *core) {
    enter(core, AGV_STATE_STANDBY);
    core->machine.first_reason = AGV_FAULT_NONE;
    core->machine.output_closed = true;
}

/* No press counts that began before now. */
static void forget_press(agv_state_machine_t *machine) {
    machine->pressed_after_trip = false;
    machine->press_refused = false;
    machine->press_missing = 0u;
}

static void trip(agv_core_t *core, uint32_t reason) {
    enter(core, AGV_STATE_TRIPPED);
    core->machine.first_reason = (uint8_t)reason;
    core->machine.park_released = false;
    forget_press(&core->machine);
    agv_watch_stop(core, AGV_WATCH_PRESS);
    agv_watch_stop(core, AGV_WATCH_PARK_SENT);
    agv_watch_start(core, AGV_WATCH_PARK_WAIT);
    agv_watch_start(core, AGV_WATCH_UNCONFIRMED);
}

static void withdraw_confirmation(agv_core_t *core) {
    enter(core, AGV_STATE_TRIPPED);
    agv_watch_start(core, AGV_WATCH_UNCONFIRMED);
    if (agv_watch_runs(core, AGV_WATCH_PARK_SENT)) {
        agv_watch_start(core, AGV_WATCH_PARK_SENT);
    }
}

static uint32_t step_init(agv_core_t *core, uint32_t facts) {
    const bool cause = (core->summary.cause != (uint8_t)AGV_FAULT_NONE) || core->summary.ai_cause;
    const uint32_t needed = AGV_FACT_VCU_ALIVE | AGV_FACT_EPS_ALIVE | AGV_FACT_MANUAL | AGV_FACT_MESSAGES;
    const uint32_t missing = (needed & ~facts) | (cause ? AGV_MISSING_TRIP_CAUSE : 0u);
    if (agv_watch_while(core, AGV_WATCH_INIT_GOOD, missing == 0u)) {
        enter_standby(core);
    } else if (!core->machine.startup_reported && agv_watch_reached(core, AGV_WATCH_INIT)) {
        core->machine.startup_reported = true;
        return AGV_STEP_STARTUP_TIMED_OUT | missing;
    } else {
        /* wait */
    }
    return 0u;
}

static void follow_engagement(agv_core_t *core, uint32_t facts) {
    if ((facts & AGV_FACT_ENGAGED) == 0u) {
        core->machine.state = (uint8_t)AGV_STATE_STANDBY;
    } else if ((facts & AGV_FACT_AI_ALIVE) != 0u) {
        core->machine.state = (uint8_t)AGV_STATE_ACTIVE;
    } else {
        /* engaged without the AI alive: AI_HEARTBEAT_* trips in its time */
    }
}

static uint32_t missing_for_reset(const agv_core_t *core, uint32_t facts) {
    const agv_state_machine_t *const machine = &core->machine;
    const uint32_t needed =
        AGV_FACT_VCU_ALIVE | AGV_FACT_EPS_ALIVE | AGV_FACT_STANDSTILL | AGV_FACT_MANUAL | AGV_FACT_MESSAGES;
    uint32_t missing = needed & ~facts;
    if ((core->summary.cause != (uint8_t)AGV_FAULT_NONE) || (machine->unresettable != (uint8_t)AGV_FAULT_NONE)) {
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

static uint32_t step_reset(agv_core_t *core, uint32_t facts) {
    agv_state_machine_t *const machine = &core->machine;
    const bool button = (facts & AGV_FACT_BUTTON_DOWN) != 0u;
    if (!button) {
        forget_press(machine);
    } else if (!machine->button_before) {
        machine->pressed_after_trip = true;
    } else {
        /* held */
    }
    const bool held = agv_watch_while(core, AGV_WATCH_PRESS, button);
    const uint32_t missing = missing_for_reset(core, facts);
    if (button) {
        machine->press_missing |= (uint8_t)missing;
    }
    if (agv_watch_while(core, AGV_WATCH_RESET_GOOD, missing == 0u)) {
        enter_standby(core);
        return AGV_STEP_RESET_ACCEPTED;
    }
    if (held && !machine->press_refused) {
        machine->press_refused = true;
        return AGV_STEP_RESET_REFUSED | machine->press_missing;
    }
    return 0u;
}

static uint32_t step_latched(agv_core_t *core, uint32_t facts) {
    const uint32_t confirmation = AGV_FACT_AUTOPILOT_OFF | AGV_FACT_IN_PARK;
    const bool confirmed = (facts & confirmation) == confirmation;
    const bool safe = core->machine.state == (uint8_t)AGV_STATE_SAFE;
    if (confirmed && !safe) {
        enter(core, AGV_STATE_SAFE);
    } else if (!confirmed && safe) {
        withdraw_confirmation(core);
    } else {
        /* stays */
    }
    return step_reset(core, facts);
}

/* park: at_standstill holds P back until the vehicle stands, or for park_timeout_ms (FSM-1). */
static void release_park(agv_core_t *core, uint32_t facts) {
    if ((core->config.park == (uint16_t)AGV_PARK_AT_ONCE) || ((facts & AGV_FACT_STANDSTILL) != 0u) ||
        agv_watch_reached(core, AGV_WATCH_PARK_WAIT)) {
        core->machine.park_released = true;
    }
}

static void judge_output(agv_core_t *core, uint32_t facts) {
    agv_state_machine_t *const machine = &core->machine;
    const bool off_late = agv_watch_reached(core, AGV_WATCH_UNCONFIRMED) && ((facts & AGV_FACT_AUTOPILOT_OFF) == 0u);
    const bool park_late = agv_watch_reached(core, AGV_WATCH_PARK_SENT); /* in P: SAFE, or autopilot off is late too */
    machine->safe_state_unconfirmed = (machine->state == (uint8_t)AGV_STATE_TRIPPED) && (off_late || park_late);
    if (machine->safe_state_unconfirmed || ((facts & AGV_FACT_OUTPUT_UNSAFE) != 0u) ||
        (machine->unresettable != (uint8_t)AGV_FAULT_NONE)) {
        machine->output_closed = false;
    }
}

/* The reason of a trip; AGV_FAULT_NONE: none. In INIT only the unresettable ones latch. */
static uint32_t reason_to_trip(const agv_core_t *core) {
    const agv_summary_t *const summary = &core->summary;
    if (core->machine.state == (uint8_t)AGV_STATE_INIT) {
        return summary->forever;
    }
    return (summary->raised != (uint8_t)AGV_FAULT_NONE) ? summary->raised : summary->cause;
}

uint32_t agv_state_machine_step(agv_core_t *core, uint32_t facts) {
    const uint32_t reason = reason_to_trip(core);
    uint32_t did = 0u;
    if (core->summary.forever != (uint8_t)AGV_FAULT_NONE) {
        core->machine.unresettable = core->summary.forever;
    }
    if (agv_core_is_latched(core)) {
        did = step_latched(core, facts);
    } else if (reason != (uint32_t)AGV_FAULT_NONE) {
        trip(core, reason);
        did = AGV_STEP_TRIPPED;
    } else if (core->machine.state == (uint8_t)AGV_STATE_INIT) {
        did = step_init(core, facts);
    } else {
        follow_engagement(core, facts);
    }
    core->machine.button_before = (facts & AGV_FACT_BUTTON_UP) == 0u;
    release_park(core, facts);
    judge_output(core, facts);
    return did;
}

void agv_state_machine_park_sent(agv_core_t *core) {
    (void)agv_watch_while(core, AGV_WATCH_PARK_SENT, agv_core_is_latched(core));
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
