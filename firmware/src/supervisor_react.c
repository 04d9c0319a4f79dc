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

void agv_core_record_missing(const agv_core_t *core, agv_event_kind_t kind, uint8_t accepted, uint8_t missing) {
    agv_entry_t entry = {.kind = (uint8_t)kind, .a = accepted, .missing = missing};
    add_entry(core, &entry);
}

void agv_core_store_latch(const agv_core_t *core) {
    agv_latch_write(core->hal, agv_state_is_latched(agv_core_state(core)), (agv_fault_t)core->machine.first_reason,
                    (agv_fault_t)core->machine.unresettable);
}

/* The new marks of a fault, as it stands now. */
static uint8_t judge_marks(const agv_core_t *core, agv_fault_t fault, uint8_t marks) {
    uint8_t now = marks & (AGV_MARK_ACTIVE | AGV_MARK_LATCHED);
    if ((now & AGV_MARK_ACTIVE) != 0u) {
        now |= AGV_MARK_REPORTED;
        if (agv_monitor_is_trip(core, fault)) {
            now |= AGV_MARK_TRIPPING;
            now |= agv_state_is_latched(agv_core_state(core)) ? AGV_MARK_LATCHED : 0u;
        }
    }
    return now;
}

static void keep_first(agv_fault_t *kept, agv_fault_t fault) {
    if (*kept == AGV_FAULT_NONE) {
        *kept = fault;
    }
}

static void sum_up_trip(agv_core_t *core, agv_fault_t fault) {
    const uint8_t flags = agv_fault_flags(fault);
    if ((flags & AGV_FAULT_FLAG_FROM_AI) != 0u) {
        core->ai_cause = true;
    } else {
        keep_first(&core->cause, fault);
    }
    if ((flags & AGV_FAULT_FLAG_UNRESETTABLE) != 0u) {
        keep_first(&core->forever, fault);
    }
}

/* Raised, raised again with another class, or ended. */
static void record_change(agv_core_t *core, agv_fault_t fault, uint8_t before, uint8_t now) {
    const bool active = (now & AGV_MARK_ACTIVE) != 0u;
    const bool trip = ((active ? now : before) & AGV_MARK_TRIPPING) != 0u;
    if (((before ^ now) & (AGV_MARK_REPORTED | AGV_MARK_TRIPPING)) == 0u) {
        return;
    }
    if (active && !trip) {
        core->counters.warnings++;
    }
    agv_core_record(core, AGV_EVENT_FAULT, (uint8_t)fault, (uint8_t)(trip ? AGV_CLASS_TRIP : AGV_CLASS_WARN),
                    (uint8_t)(active ? 1u : 0u));
}

/* From the highest rank down, so that the first one found is the one that counts. */
static agv_fault_t report_all(agv_core_t *core) {
    agv_fault_t raised = AGV_FAULT_NONE;
    agv_fault_t trip = AGV_FAULT_NONE;
    agv_fault_t warning = AGV_FAULT_NONE;
    for (uint32_t i = 0u; i < (uint32_t)AGV_FAULT_COUNT; i++) {
        const agv_fault_t fault = (agv_fault_t)i;
        const uint8_t before = core->monitor.faults.marks[i];
        const uint8_t now = judge_marks(core, fault, before);
        if (now == 0u && before == 0u) {
            continue;
        }
        core->monitor.faults.marks[i] = now;
        record_change(core, fault, before, now);
        if ((now & AGV_MARK_TRIPPING) != 0u) {
            sum_up_trip(core, fault);
            if ((before & AGV_MARK_TRIPPING) == 0u) {
                keep_first(&raised, fault);
            }
        }
        keep_first(((now & (AGV_MARK_TRIPPING | AGV_MARK_LATCHED)) != 0u) ? &trip : &warning,
                   (now != 0u) ? fault : AGV_FAULT_NONE);
    }
    core->led_code = agv_led_code((trip != AGV_FAULT_NONE) ? trip : warning);
    return raised;
}

agv_fault_t agv_core_report_faults(agv_core_t *core) {
    if (!core->monitor.faults.changed) {
        return AGV_FAULT_NONE;
    }
    core->monitor.faults.changed = false;
    core->cause = AGV_FAULT_NONE;
    core->forever = AGV_FAULT_NONE;
    core->ai_cause = false;
    return report_all(core);
}

static uint8_t missing_of_vehicle(agv_core_t *core) {
    const agv_liveness_t *const liveness = &core->monitor.liveness;
    uint8_t missing = 0u;
    missing |= agv_liveness_alive(liveness, AGV_NODE_VCU) ? 0u : AGV_MISSING_VCU_HEARTBEAT;
    missing |= agv_liveness_alive(liveness, AGV_NODE_EPS) ? 0u : AGV_MISSING_EPS_HEARTBEAT;
    missing |= agv_monitor_standstill(core) ? 0u : AGV_MISSING_STANDSTILL;
    missing |= (core->monitor.vehicle.mode == (uint8_t)AGV_MODE_MANUAL) ? 0u : AGV_MISSING_MANUAL;
    missing |= agv_monitor_messages_fresh(core) ? 0u : AGV_MISSING_MESSAGES;
    return missing;
}

static bool output_is_unsafe(agv_core_t *core) {
    const agv_faults_t *const faults = &core->monitor.faults;
    return agv_timer_exceeded(&core->unfed, core->now_ms, core->config.watchdog_period_ms) ||
           agv_faults_is_active(faults, AGV_FAULT_BUS_OFF) || agv_faults_is_active(faults, AGV_FAULT_TX_STALLED);
}

static agv_step_t step(agv_core_t *core, agv_fault_t raised) {
    const agv_situation_t situation = {
        .raised = raised,
        .cause = core->cause,
        .forever = core->forever,
        .missing = missing_of_vehicle(core),
        .ai_cause = core->ai_cause,
        .engaged = agv_monitor_engaged(core),
        .ai_alive = agv_liveness_alive(&core->monitor.liveness, AGV_NODE_AI),
        .autopilot_off = agv_monitor_autopilot_off(core),
        .in_park = agv_monitor_in_park(core),
        .button = core->monitor.vehicle.button_pressed,
        .button_known = agv_liveness_heard(&core->monitor.liveness, AGV_MSG_VEHICLE_STATUS),
        .output_unsafe = output_is_unsafe(core),
    };
    return agv_state_machine_step(&core->machine, &core->config, &situation, core->now_ms);
}

/* The angle of the moment of the trip; without one, the first valid angle after it (FSM-10). */
static void follow_hold(agv_core_t *core, bool tripped) {
    const agv_vehicle_t *const vehicle = &core->monitor.vehicle;
    const uint16_t complement = (uint16_t)~core->hold.raw;
    if (tripped || !agv_state_is_latched(agv_core_state(core))) {
        core->hold.raw = 0u;
        core->hold.check = 0u;
    }
    if (agv_state_is_latched(agv_core_state(core)) && vehicle->angle_known &&
        (tripped || (core->hold.check != complement))) {
        core->hold.raw = (uint16_t)(vehicle->angle_ddeg + AGV_ANGLE_RAW_CENTRE);
        core->hold.check = (uint16_t)~core->hold.raw;
    }
}

/* INIT or SAFE to STANDBY: what was latched is over, and nothing of it may still be sent. */
static void leave_safe_commands(agv_core_t *core, bool reset) {
    agv_transmitter_discard(core, AGV_SET_COMMANDS);
    hal_can_purge(core->hal, HAL_CAN_VEHICLE);
    for (uint32_t i = 0u; i < (uint32_t)AGV_FAULT_COUNT; i++) {
        core->monitor.faults.marks[i] &= (uint8_t)~AGV_MARK_LATCHED;
    }
    if (reset) {
        agv_monitor_forget_ai(core);
    }
}

static void send_all_at_once(agv_core_t *core) {
    agv_transmitter_discard(core, AGV_SET_COMMANDS);
    hal_can_purge(core->hal, HAL_CAN_VEHICLE);
    agv_transmitter_burst(core);
}

static void carry_out_transition(agv_core_t *core, const agv_step_t *taken) {
    const uint8_t reason = taken->tripped ? core->machine.first_reason : (uint8_t)AGV_FAULT_NONE;
    const agv_state_t from = (agv_state_t)taken->from;
    if (taken->tripped) {
        send_all_at_once(core);
    } else if (agv_state_commands_safe(from) && !agv_state_commands_safe(agv_core_state(core))) {
        leave_safe_commands(core, taken->reset_accepted);
    } else if (from == AGV_STATE_ACTIVE) {
        /* Motion commands that wait for a stalled side must not reach a vehicle that a human drives. */
        agv_transmitter_discard(core, AGV_SET_COMMANDS);
    } else {
        /* nothing to send or to forget */
    }
    core->gateway.sent = false;          /* the slew limit begins anew with every engagement */
    core->monitor.faults.changed = true; /* what is latched, and for how long, goes by the state */
    agv_core_record(core, AGV_EVENT_STATE, taken->from, core->machine.state, reason);
    if (agv_state_is_latched(from) != agv_state_is_latched(agv_core_state(core))) {
        agv_core_store_latch(core);
    }
}

static void carry_out(agv_core_t *core, const agv_step_t *taken) {
    agv_faults_t *const faults = &core->monitor.faults;
    follow_hold(core, taken->tripped);
    if (taken->from != core->machine.state) {
        carry_out_transition(core, taken);
    }
    if (taken->reset_accepted || taken->reset_refused) {
        agv_core_record_missing(core, AGV_EVENT_RESET, (uint8_t)(taken->reset_accepted ? 1u : 0u),
                                taken->reset_accepted ? 0u : taken->missing);
    }
    if (taken->startup_timed_out) {
        agv_core_record_missing(core, AGV_EVENT_STARTUP, 0u, taken->missing);
    }
    agv_faults_level(faults, AGV_FAULT_SAFE_STATE_UNCONFIRMED, core->machine.safe_state_unconfirmed);
    agv_faults_level(faults, AGV_FAULT_STARTUP_TIMEOUT,
                     core->machine.startup_reported && (core->machine.state == (uint8_t)AGV_STATE_INIT));
}

/* The output opens before anything that may take time, and closes after everything else is done. */
static void switch_output(agv_core_t *core, bool was_closed, bool close) {
    if ((close != was_closed) && (core->machine.output_closed == close)) {
        hal_safety_output_set(core->hal, close);
    }
}

bool agv_core_react(agv_core_t *core) {
    const bool was_closed = core->machine.output_closed;
    const uint8_t unresettable = core->machine.unresettable;
    const agv_fault_t raised = agv_core_report_faults(core);
    const agv_step_t taken = step(core, raised);
    switch_output(core, was_closed, false);
    carry_out(core, &taken);
    (void)agv_core_report_faults(core);
    if (unresettable != core->machine.unresettable) {
        agv_core_store_latch(core);
    }
    switch_output(core, was_closed, true);
    if (was_closed != core->machine.output_closed) {
        agv_core_record(core, AGV_EVENT_OUTPUT, (uint8_t)(core->machine.output_closed ? 1u : 0u), 0u, 0u);
    }
    return taken.tripped;
}
