#include "agv/codec.h"
#include "agv/latch.h"
#include "hal/safety_output.h"
#include "supervisor_internal.h"

void agv_core_record(const agv_core_t *core, uint32_t what, uint32_t a, uint32_t b, uint32_t c) {
    const agv_entry_t entry = {.kind = (uint8_t)what,
                               .a = (uint8_t)a,
                               .b = (uint8_t)b,
                               .c = (uint8_t)c,
                               .missing = (uint8_t)(what >> 8u),
                               .state = core->machine.state,
                               .first_reason = core->machine.first_reason};
    agv_recorder_add(core->recorder, &entry, core->now_ms);
}

void agv_core_store_latch(const agv_core_t *core) {
    agv_latch_write(core->hal, core->machine.latched, core->machine.first_reason, core->machine.unresettable);
}

/* The new marks of a fault, as it stands now. */
static uint32_t judge_marks(const agv_core_t *core, uint32_t fault, uint32_t marks) {
    uint32_t now = marks & (AGV_MARK_ACTIVE | AGV_MARK_LATCHED);
    if ((now & AGV_MARK_ACTIVE) != 0u) {
        now |= AGV_MARK_REPORTED;
        if (agv_monitor_is_trip(core, fault)) {
            now |= AGV_MARK_TRIPPING;
            now |= ((marks & AGV_MARK_TRIPPING) == 0u) ? AGV_MARK_RAISED : 0u;
            now |= agv_core_is_latched(core) ? AGV_MARK_LATCHED : 0u;
        }
    }
    return now;
}

/* Raised, raised again with another class, or ended. */
static void record_change(agv_core_t *core, uint32_t fault, uint32_t before, uint32_t now) {
    const uint32_t active = now & AGV_MARK_ACTIVE;
    const bool trip = (((active != 0u) ? now : before) & AGV_MARK_TRIPPING) != 0u;
    if ((active != 0u) && !trip) {
        core->counters.warnings++;
    }
    agv_core_record(core, AGV_EVENT_FAULT, fault, trip ? AGV_CLASS_TRIP : AGV_CLASS_WARN, active);
}

/* From the highest rank down. */
static void report_all(agv_core_t *core) {
    for (uint32_t fault = 0u; fault < (uint32_t)AGV_FAULT_COUNT; fault++) {
        const uint32_t before = core->faults.marks[fault];
        const uint32_t now = judge_marks(core, fault, before);
        core->faults.marks[fault] = (uint8_t)now;
        if (((before ^ now) & (AGV_MARK_REPORTED | AGV_MARK_TRIPPING)) != 0u) {
            record_change(core, fault, before, now);
        }
    }
}

static void sum_up(agv_summary_t *summary, uint32_t fault, uint32_t marks) {
    const uint32_t flags = agv_fault_flags(fault);
    if ((marks & AGV_MARK_TRIPPING) != 0u) {
        if ((flags & AGV_FAULT_FLAG_FROM_AI) != 0u) {
            summary->ai_cause = true;
        } else {
            summary->cause = (uint8_t)fault;
        }
        if ((flags & AGV_FAULT_FLAG_UNRESETTABLE) != 0u) {
            summary->forever = (uint8_t)fault;
        }
    }
    if ((marks & AGV_MARK_RAISED) != 0u) {
        summary->raised = (uint8_t)fault;
    }
    if (((marks & AGV_MARK_ACTIVE) != 0u) && ((flags & AGV_FAULT_FLAG_OF_EPS) != 0u)) {
        summary->eps_fault = true;
    }
    if ((marks & (AGV_MARK_TRIPPING | AGV_MARK_LATCHED)) != 0u) {
        summary->trip = (uint8_t)fault;
    } else if ((marks & AGV_MARK_ACTIVE) != 0u) {
        summary->warning = (uint8_t)fault;
    } else {
        /* nothing of it */
    }
}

/* From the lowest rank up: of each kind the highest stays. */
static void sum_up_all(agv_core_t *core) {
    core->summary = (agv_summary_t){.raised = AGV_FAULT_NONE,
                                    .cause = AGV_FAULT_NONE,
                                    .forever = AGV_FAULT_NONE,
                                    .trip = AGV_FAULT_NONE,
                                    .warning = AGV_FAULT_NONE};
    for (uint32_t above = AGV_FAULT_COUNT; above != 0u; above--) {
        sum_up(&core->summary, above - 1u, core->faults.marks[above - 1u]);
    }
}

void agv_core_report_faults(agv_core_t *core) {
    agv_summary_t *const summary = &core->summary;
    if (!core->summary.changed) {
        summary->raised = AGV_FAULT_NONE;
        return;
    }
    report_all(core);
    sum_up_all(core);
    core->led_code =
        (int8_t)agv_led_code((summary->trip != (uint8_t)AGV_FAULT_NONE) ? summary->trip : summary->warning);
}

_Static_assert((AGV_MODE_MANUAL == AGV_FACT_MANUAL) && (AGV_MODE_ENGAGED == AGV_FACT_ENGAGED), "the mode is two facts");

static bool output_is_unsafe(agv_core_t *core) {
    return agv_watch_reached(core, AGV_WATCH_UNFED) || agv_faults_is_active(core, AGV_FAULT_BUS_OFF) ||
           agv_faults_is_active(core, AGV_FAULT_TX_STALLED);
}

bool agv_core_step_is_late(const agv_core_t *core) {
    return (core->now_ms - core->last_tick_ms) > ((uint32_t)core->config.watchdog_period_ms + 1u);
}

static uint32_t facts_of(agv_core_t *core) {
    uint32_t facts = agv_monitor_standstill(core) ? AGV_FACT_STANDSTILL : 0u;
    facts |= output_is_unsafe(core) ? AGV_FACT_OUTPUT_UNSAFE : 0u;
    facts |= agv_monitor_messages_fresh(core) ? AGV_FACT_MESSAGES : 0u;
    facts |= agv_monitor_autopilot_off(core) ? AGV_FACT_AUTOPILOT_OFF : 0u;
    facts |= agv_monitor_in_park(core) ? AGV_FACT_IN_PARK : 0u;
    if (agv_core_alive(core, AGV_NODE_VCU) && !agv_core_step_is_late(core)) { /* else nobody looked at deadlines */
        facts |= AGV_FACT_VCU_ALIVE;
    }
    facts |= agv_core_alive(core, AGV_NODE_EPS) ? AGV_FACT_EPS_ALIVE : 0u;
    facts |= agv_core_alive(core, AGV_NODE_AI) ? AGV_FACT_AI_ALIVE : 0u;
    facts |= core->vehicle.mode;
    facts |= core->vehicle.button * AGV_FACT_BUTTON_DOWN; /* or UP, or neither */
    return facts;
}

/* The angle of the moment of the trip; without one, the first valid angle after it (FSM-10). */
static void follow_hold(agv_core_t *core, bool tripped) {
    const agv_vehicle_t *const vehicle = &core->vehicle;
    const bool latched = agv_core_is_latched(core);
    if (tripped || !latched) {
        core->hold = (agv_hold_t){0};
    }
    if (latched && vehicle->angle_known && !agv_core_holds_angle(core)) {
        core->hold.raw = vehicle->angle_raw;
        core->hold.check = (uint16_t)~core->hold.raw;
    }
}

/* INIT or SAFE to STANDBY: what was latched is over. */
static void forget_latched(agv_core_t *core, bool reset) {
    for (uint32_t i = 0u; i < (uint32_t)AGV_FAULT_COUNT; i++) {
        core->faults.marks[i] &= (uint8_t)~AGV_MARK_LATCHED;
    }
    if (reset) {
        agv_monitor_forget_ai(core);
    }
}

static void carry_out_transition(agv_core_t *core, agv_state_t from, uint32_t did) {
    const bool tripped = (did & AGV_STEP_TRIPPED) != 0u;
    const bool left_safe_commands = (core->machine.state == (uint8_t)AGV_STATE_STANDBY) && (from != AGV_STATE_ACTIVE);
    if (tripped || left_safe_commands || (from == AGV_STATE_ACTIVE)) {
        /* nothing of before may still be sent; from ACTIVE: motion commands that wait for a stalled side */
        agv_transmitter_discard(core, HAL_CAN_VEHICLE);
    }
    if (tripped || left_safe_commands) {
        hal_can_purge(core->hal, HAL_CAN_VEHICLE);
    }
    if (tripped) {
        agv_transmitter_burst(core);
    }
    if (left_safe_commands) {
        forget_latched(core, (did & AGV_STEP_RESET_ACCEPTED) != 0u);
    }
    core->gateway.sent = false;   /* the slew limit begins anew with every engagement */
    core->summary.changed = true; /* what is latched, and for how long, goes by the state */
    agv_core_record(core, AGV_EVENT_STATE, from, core->machine.state,
                    tripped ? core->machine.first_reason : (uint32_t)AGV_FAULT_NONE);
}

/* A press of the reset button was answered, or INIT has lasted too long. */
static void record_answer(const agv_core_t *core, uint32_t did) {
    const bool startup = (did & AGV_STEP_STARTUP_TIMED_OUT) != 0u;
    const uint32_t kind = startup ? AGV_EVENT_STARTUP : AGV_EVENT_RESET;
    agv_core_record(core, kind | (did << 8u), ((did & AGV_STEP_RESET_ACCEPTED) != 0u) ? 1u : 0u, 0u, 0u);
}

static void carry_out(agv_core_t *core, agv_state_t from, uint32_t did) {
    follow_hold(core, (did & AGV_STEP_TRIPPED) != 0u);
    if (from != agv_core_state(core)) {
        carry_out_transition(core, from, did);
    }
    if ((did & (AGV_STEP_RESET_ACCEPTED | AGV_STEP_RESET_REFUSED | AGV_STEP_STARTUP_TIMED_OUT)) != 0u) {
        record_answer(core, did);
    }
    agv_faults_level(core, AGV_FAULT_SAFE_STATE_UNCONFIRMED, core->machine.safe_state_unconfirmed);
    agv_faults_level(core, AGV_FAULT_STARTUP_TIMEOUT,
                     core->machine.startup_reported && (core->machine.state == (uint8_t)AGV_STATE_INIT));
}

/* The output opens before anything that may take time, and closes after everything else is done. */
static void switch_output(const agv_core_t *core, bool was_closed, bool close) {
    if ((close != was_closed) && (core->machine.output_closed == close)) {
        hal_safety_output_set(core->hal, close);
    }
}

bool agv_core_react(agv_core_t *core) {
    const agv_state_t from = agv_core_state(core);
    const bool was_closed = core->machine.output_closed;
    const uint8_t was_latched = core->machine.latched;
    const uint8_t unresettable = core->machine.unresettable;
    agv_core_report_faults(core);
    const uint32_t did = agv_state_machine_step(core, facts_of(core));
    switch_output(core, was_closed, false);
    carry_out(core, from, did);
    agv_core_report_faults(core);
    if ((was_latched != core->machine.latched) || (unresettable != core->machine.unresettable)) {
        agv_core_store_latch(core);
    }
    switch_output(core, was_closed, true);
    if (was_closed != core->machine.output_closed) {
        agv_core_record(core, AGV_EVENT_OUTPUT, core->machine.output_closed ? 1u : 0u, 0u, 0u);
    }
    return (did & AGV_STEP_TRIPPED) != 0u;
}
