#include "agv/codec.h"
#include "agv/latch.h"
#include "hal/safety_output.h"
#include "supervisor_internal.h"

static void add_entry(const agv_core_t *core, agv_entry_t *entry) {
    entry->state = core->machine.state;
    entry->first_reason = core->machine.first_reason;
    agv_recorder_add(core->recorder, entry, core->now_ms);
}

void agv_core_record(const agv_core_t *core, agv_event_kind_t kind, uint8_t a, uint8_t b, uint8_t c) {
    agv_entry_t entry = {.kind = (uint8_t)kind, .a = a, .b = b, .c = c};
    add_entry(core, &entry);
}

void agv_core_store_latch(const agv_core_t *core) {
    agv_latch_write(core->hal, core->machine.latched, (agv_fault_t)core->machine.first_reason,
                    (agv_fault_t)core->machine.unresettable);
}

/* The new marks of a fault, as it stands now. */
static uint32_t judge_marks(const agv_core_t *core, agv_fault_t fault, uint32_t marks) {
    uint32_t now = marks & (AGV_MARK_ACTIVE | AGV_MARK_LATCHED);
    if ((now & AGV_MARK_ACTIVE) != 0u) {
        now |= AGV_MARK_REPORTED;
        if (agv_monitor_is_trip(core, fault)) {
            now |= AGV_MARK_TRIPPING;
            now |= agv_core_is_latched(core) ? AGV_MARK_LATCHED : 0u;
        }
    }
    return now;
}

static void keep_first(uint8_t *kept, agv_fault_t fault) {
    if (*kept > (uint8_t)fault) {
        *kept = (uint8_t)fault;
    }
}

static void sum_up(agv_core_t *core, agv_fault_t fault, uint32_t before, uint32_t now) {
    agv_summary_t *const summary = &core->summary;
    const uint32_t flags = agv_fault_flags(fault);
    if ((now & AGV_MARK_ACTIVE) != 0u) {
        summary->active_flags |= (uint8_t)flags;
    }
    if ((now & AGV_MARK_TRIPPING) != 0u) {
        if ((flags & AGV_FAULT_FLAG_FROM_AI) != 0u) {
            summary->ai_cause = true;
        } else {
            keep_first(&summary->cause, fault);
        }
        if ((flags & AGV_FAULT_FLAG_UNRESETTABLE) != 0u) {
            keep_first(&summary->forever, fault);
        }
        if ((before & AGV_MARK_TRIPPING) == 0u) {
            keep_first(&summary->raised, fault);
        }
    }
    keep_first(((now & (AGV_MARK_TRIPPING | AGV_MARK_LATCHED)) != 0u) ? &summary->trip : &summary->warning, fault);
}

/* Raised, raised again with another class, or ended. */
static void record_change(agv_core_t *core, agv_fault_t fault, uint32_t before, uint32_t now) {
    const uint32_t active = now & AGV_MARK_ACTIVE;
    const bool trip = (((active != 0u) ? now : before) & AGV_MARK_TRIPPING) != 0u;
    if ((active != 0u) && !trip) {
        core->counters.warnings++;
    }
    agv_core_record(core, AGV_EVENT_FAULT, (uint8_t)fault, (uint8_t)(trip ? AGV_CLASS_TRIP : AGV_CLASS_WARN),
                    (uint8_t)active);
}

/* From the highest rank down. */
static void report_all(agv_core_t *core) {
    for (uint32_t i = 0u; i < (uint32_t)AGV_FAULT_COUNT; i++) {
        const agv_fault_t fault = (agv_fault_t)i;
        const uint32_t before = core->faults.marks[i];
        const uint32_t now = judge_marks(core, fault, before);
        core->faults.marks[i] = (uint8_t)now;
        if (((before ^ now) & (AGV_MARK_REPORTED | AGV_MARK_TRIPPING)) != 0u) {
            record_change(core, fault, before, now);
        }
        if (now != 0u) {
            sum_up(core, fault, before, now);
        }
    }
}

void agv_core_report_faults(agv_core_t *core) {
    agv_summary_t *const summary = &core->summary;
    if (!core->summary.changed) {
        summary->raised = AGV_FAULT_NONE;
        return;
    }
    *summary = (agv_summary_t){.raised = AGV_FAULT_NONE,
                               .cause = AGV_FAULT_NONE,
                               .forever = AGV_FAULT_NONE,
                               .trip = AGV_FAULT_NONE,
                               .warning = AGV_FAULT_NONE};
    report_all(core);
    core->led_code =
        agv_led_code((agv_fault_t)((summary->trip != (uint8_t)AGV_FAULT_NONE) ? summary->trip : summary->warning));
}

_Static_assert(((AGV_MODE_MANUAL >> 1) == AGV_FACT_MANUAL) && ((AGV_MODE_ENGAGED >> 1) == AGV_FACT_ENGAGED),
               "the mode as a fact is its bits, one place further down");

static bool output_is_unsafe(agv_core_t *core) {
    return agv_watch_reached(core, AGV_WATCH_UNFED) || agv_faults_is_active(core, AGV_FAULT_BUS_OFF) ||
           agv_faults_is_active(core, AGV_FAULT_TX_STALLED);
}

static uint32_t facts_of(agv_core_t *core) {
    uint32_t facts = (uint32_t)core->vehicle.mode >> 1u;
    facts |= agv_core_alive(core, AGV_NODE_VCU) ? AGV_FACT_VCU_ALIVE : 0u;
    facts |= agv_core_alive(core, AGV_NODE_EPS) ? AGV_FACT_EPS_ALIVE : 0u;
    facts |= agv_core_alive(core, AGV_NODE_AI) ? AGV_FACT_AI_ALIVE : 0u;
    facts |= agv_monitor_standstill(core) ? AGV_FACT_STANDSTILL : 0u;
    facts |= agv_monitor_messages_fresh(core) ? AGV_FACT_MESSAGES : 0u;
    facts |= agv_monitor_autopilot_off(core) ? AGV_FACT_AUTOPILOT_OFF : 0u;
    facts |= agv_monitor_in_park(core) ? AGV_FACT_IN_PARK : 0u;
    facts |= core->vehicle.button * AGV_FACT_BUTTON_DOWN; /* or UP, or neither */
    facts |= output_is_unsafe(core) ? AGV_FACT_OUTPUT_UNSAFE : 0u;
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
        core->hold.raw = (uint16_t)(vehicle->angle_ddeg + AGV_ANGLE_RAW_CENTRE);
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
        agv_transmitter_discard(core, AGV_SET_COMMANDS);
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
    agv_core_record(core, AGV_EVENT_STATE, (uint8_t)from, core->machine.state,
                    tripped ? core->machine.first_reason : (uint8_t)AGV_FAULT_NONE);
}

/* A press of the reset button was answered, or INIT has lasted too long. */
static void record_answer(const agv_core_t *core, uint32_t did) {
    const bool startup = (did & AGV_STEP_STARTUP_TIMED_OUT) != 0u;
    agv_entry_t entry = {.kind = (uint8_t)(startup ? AGV_EVENT_STARTUP : AGV_EVENT_RESET),
                         .a = (uint8_t)(((did & AGV_STEP_RESET_ACCEPTED) != 0u) ? 1u : 0u),
                         .missing = (uint8_t)(did & AGV_MISSING_ALL)};
    add_entry(core, &entry);
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
        agv_core_record(core, AGV_EVENT_OUTPUT, (uint8_t)(core->machine.output_closed ? 1u : 0u), 0u, 0u);
    }
    return (did & AGV_STEP_TRIPPED) != 0u;
}
