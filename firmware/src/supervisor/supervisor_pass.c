#include "hal/safety_output.h"
#include "keep/latch.h"
#include "observe/deadlines.h"
#include "supervisor/supervisor_internal.h"

static void record(const agv_core_t *core, const agv_ports_t *ports, const agv_entry_t *entry) {
    agv_recorder_add(ports->recorder, entry, core->timers.now_ms);
}

void agv_core_record(const agv_core_t *core, const agv_ports_t *ports, uint32_t what, uint32_t a, uint32_t b,
                     uint32_t c) {
    const agv_entry_t entry = {.kind = (uint8_t)what,
                               .a = (uint8_t)a,
                               .b = (uint8_t)b,
                               .c = (uint8_t)c,
                               .missing = (uint8_t)(what >> 8u),
                               .state = core->machine.state,
                               .first_reason = core->machine.first_reason};
    record(core, ports, &entry);
}

void agv_core_store_latch(const agv_core_t *core, const agv_ports_t *ports) {
    agv_latch_write(ports->hal, core->machine.latched, core->machine.first_reason, core->machine.unresettable);
}

bool agv_core_step_is_late(const agv_core_t *core) {
    return (core->timers.now_ms - core->last_tick_ms) > ((uint32_t)core->config.watchdog_period_ms + 1u);
}

bool agv_core_is_in_park(const agv_core_t *core) {
    return agv_liveness_fresh(&core->liveness, &core->timers, AGV_MSG_GEAR_STATUS) &&
           (core->vehicle.gear == (uint8_t)AGV_GEAR_P);
}

static bool is_latched(const agv_core_t *core) {
    return agv_state_is_latched((agv_state_t)core->machine.state);
}

/* EPS alive and without a fault, in angle control, manual not reported (FSM-10). A stale 167h is a fault of the EPS. */
static bool is_holdable(const agv_core_t *core) {
    return agv_liveness_alive(&core->liveness, AGV_NODE_EPS) && core->vehicle.eps_in_angle_mode &&
           (core->mode.value != (uint8_t)AGV_MODE_MANUAL) && !core->faults.summary.eps_fault;
}

agv_tx_orders_t agv_core_orders(agv_core_t *core, const agv_ports_t *ports) {
    return (agv_tx_orders_t){.hal = ports->hal,
                             .config = &core->config,
                             .ids = &core->ids,
                             .timers = &core->timers,
                             .hold = core->hold,
                             .state = core->machine.state,
                             .first_reason = core->machine.first_reason,
                             .output_closed = core->machine.output_closed,
                             .park_released = core->machine.park_released,
                             .holdable = is_holdable(core),
                             .config_checksum = core->config_checksum};
}

static bool output_is_unsafe(const agv_core_t *core) {
    return agv_timer_reached(&core->timers, AGV_TIMER_WATCHDOG_FED) ||
           agv_fault_monitor_is_active(&core->faults, AGV_FAULT_BUS_OFF) ||
           agv_fault_monitor_is_active(&core->faults, AGV_FAULT_TX_STALLED);
}

static uint32_t alive_facts(const agv_core_t *core) {
    uint32_t facts = 0u;
    if (agv_liveness_alive(&core->liveness, AGV_NODE_VCU)) {
        const bool off = !agv_mode_is_engaged(&core->mode) && !agv_mode_is_ambiguous(&core->timers);
        facts |= off ? AGV_FACT_AUTOPILOT_OFF : 0u;
        facts |= agv_core_step_is_late(core) ? 0u : AGV_FACT_VCU_ALIVE; /* late: deadlines have not been looked at */
    }
    facts |= agv_liveness_alive(&core->liveness, AGV_NODE_EPS) ? AGV_FACT_EPS_ALIVE : 0u;
    facts |= agv_liveness_alive(&core->liveness, AGV_NODE_AI) ? AGV_FACT_AI_ALIVE : 0u;
    return facts;
}

static uint32_t button_fact(const agv_core_t *core) {
    if (core->vehicle.button == (uint8_t)AGV_BUTTON_UNKNOWN) {
        return 0u;
    }
    return (core->vehicle.button == (uint8_t)AGV_BUTTON_DOWN) ? AGV_FACT_BUTTON_DOWN : AGV_FACT_BUTTON_UP;
}

static uint32_t facts_of(const agv_core_t *core) {
    uint32_t facts = alive_facts(core) | button_fact(core);
    facts |= agv_vehicle_stands(&core->timers) ? AGV_FACT_STANDSTILL : 0u;
    facts |= output_is_unsafe(core) ? AGV_FACT_OUTPUT_UNSAFE : 0u;
    facts |= agv_deadlines_messages_fresh(&core->liveness, &core->timers, &core->config) ? AGV_FACT_MESSAGES : 0u;
    facts |= agv_core_is_in_park(core) ? AGV_FACT_IN_PARK : 0u;
    facts |= agv_mode_is_manual(&core->mode) ? AGV_FACT_MANUAL : 0u;
    facts |= agv_mode_is_engaged(&core->mode) ? AGV_FACT_ENGAGED : 0u;
    return facts;
}

static void evaluate_faults(agv_core_t *core, uint32_t facts) {
    const bool ai_loss_warns =
        ((facts & AGV_FACT_ENGAGED) == 0u) && (core->config.ai_lost_in_manual == (uint16_t)AGV_AI_LOST_WARN);
    agv_fault_monitor_set(&core->faults, AGV_FAULT_SAFE_STATE_UNCONFIRMED,
                          agv_state_machine_is_unconfirmed(&core->machine, &core->timers, facts));
    agv_fault_monitor_set(&core->faults, AGV_FAULT_STARTUP_TIMEOUT,
                          agv_state_machine_is_startup_late(&core->machine, &core->timers));
    agv_fault_monitor_evaluate(&core->faults, &core->config.trips, ai_loss_warns);
}

static void carry_out_at_once(agv_core_t *core, const agv_ports_t *ports, uint32_t what) {
    if ((what & AGV_ACTION_OPEN_OUTPUT) != 0u) {
        hal_safety_output_set(ports->hal, false);
    }
    agv_hold_step(&core->hold, &core->vehicle, (what & AGV_ACTION_TRIP) != 0u, is_latched(core));
    if ((what & AGV_ACTION_DISCARD) != 0u) {
        agv_transmitter_discard(&core->transmitter, &core->timers, HAL_CAN_VEHICLE);
    }
    if ((what & AGV_ACTION_PURGE) != 0u) {
        hal_can_purge(ports->hal, HAL_CAN_VEHICLE);
    }
    if ((what & AGV_ACTION_TRIP) != 0u) {
        const agv_tx_orders_t orders = agv_core_orders(core, ports);
        agv_transmitter_burst(&core->transmitter, &orders);
    }
    if ((what & AGV_ACTION_STATE) != 0u) {
        agv_gateway_restart(&core->gateway);
    }
}

agv_actions_t agv_core_decide(agv_core_t *core, const agv_ports_t *ports) {
    const uint32_t facts = facts_of(core);
    evaluate_faults(core, facts);
    const agv_actions_t actions =
        agv_state_machine_step(&core->machine, &core->timers, &core->config, &core->faults.summary, facts);
    carry_out_at_once(core, ports, actions.what);
    return actions;
}

void agv_core_take_tx_report(agv_core_t *core) {
    const agv_tx_report_t report = agv_transmitter_take_report(&core->transmitter);
    core->counters.sent += report.sent;
    core->counters.shadowed += report.shadowed;
    core->counters.dropped += report.dropped;
    core->counters.gate_refused += report.refused;
    core->counters.skipped_slots += report.skipped_slots;
    if (report.refused != 0u) {
        agv_fault_monitor_event(&core->faults, &core->timers,
                                AGV_FAULT_TX_GATE_REFUSED); /* evaluated at the next call */
    }
    if (report.park_sent) {
        agv_state_machine_park_sent(&core->machine, &core->timers);
    }
}

static void record_fault(agv_core_t *core, const agv_ports_t *ports, uint32_t fault, agv_entry_t *entry) {
    const bool active = agv_fault_is_in(&core->faults.active, fault);
    const agv_fault_set_t *const trips = active ? &core->faults.tripping : &core->faults.was_trip;
    const bool trip = agv_fault_is_in(trips, fault);
    if (active && !trip) {
        core->counters.warnings++;
    }
    entry->a = (uint8_t)fault;
    entry->b = (uint8_t)(trip ? AGV_CLASS_TRIP : AGV_CLASS_WARN);
    entry->c = active ? 1u : 0u;
    record(core, ports, entry);
}

void agv_core_record_faults(agv_core_t *core, const agv_ports_t *ports, uint8_t state, uint8_t first_reason) {
    agv_entry_t entry = {.kind = AGV_EVENT_FAULT, .state = state, .first_reason = first_reason};
    for (uint32_t word = 0u; word < AGV_FAULT_WORDS; word++) {
        uint32_t changed = core->faults.changed.words[word];
        for (uint32_t fault = word * 32u; changed != 0u; fault++) {
            if ((changed & 1u) != 0u) {
                record_fault(core, ports, fault, &entry);
            }
            changed >>= 1u;
        }
    }
}

/* A press of the reset button was answered, or INIT has lasted too long. */
static void record_answer(const agv_core_t *core, const agv_ports_t *ports, uint32_t what) {
    const uint32_t missing = (what & AGV_MISSING_ALL) << 8u;
    if ((what & (AGV_ACTION_RESET_ACCEPTED | AGV_ACTION_RESET_REFUSED)) != 0u) {
        agv_core_record(core, ports, AGV_EVENT_RESET | missing, ((what & AGV_ACTION_RESET_ACCEPTED) != 0u) ? 1u : 0u,
                        0u, 0u);
    }
    if ((what & AGV_ACTION_STARTUP_LATE) != 0u) {
        agv_core_record(core, ports, AGV_EVENT_STARTUP | missing, 0u, 0u, 0u);
    }
}

static void conclude_actions(agv_core_t *core, const agv_ports_t *ports, agv_actions_t actions) {
    const uint32_t what = actions.what;
    if ((what & AGV_ACTION_UNLATCH) != 0u) {
        agv_fault_monitor_forget(&core->faults);
    }
    if ((what & AGV_ACTION_RESET_ACCEPTED) != 0u) {
        agv_liveness_forget_ai(&core->liveness, &core->timers);
        agv_status_checks_forget_ai(&core->status_checks);
        agv_deadlines_forget_ai(&core->faults);
    }
    if ((what & AGV_ACTION_STORE_LATCH) != 0u) {
        agv_core_store_latch(core, ports);
    }
    if ((what & AGV_ACTION_STATE) != 0u) {
        agv_core_record(core, ports, AGV_EVENT_STATE, actions.from, core->machine.state,
                        ((what & AGV_ACTION_TRIP) != 0u) ? core->machine.first_reason : (uint32_t)AGV_FAULT_NONE);
    }
    record_answer(core, ports, what);
    if ((what & AGV_ACTION_CLOSE_OUTPUT) != 0u) {
        hal_safety_output_set(ports->hal, true);
    }
    if ((what & (AGV_ACTION_OPEN_OUTPUT | AGV_ACTION_CLOSE_OUTPUT)) != 0u) {
        agv_core_record(core, ports, AGV_EVENT_OUTPUT, core->machine.output_closed ? 1u : 0u, 0u, 0u);
    }
}

void agv_core_conclude(agv_core_t *core, const agv_ports_t *ports, agv_actions_t actions) {
    agv_core_take_tx_report(core);
    agv_core_record_faults(core, ports, actions.from, actions.first_reason);
    conclude_actions(core, ports, actions);
    if (is_latched(core)) {
        agv_fault_monitor_latch(&core->faults);
    }
    core->led_code = (int8_t)agv_led_code(agv_fault_monitor_shown(&core->faults));
}
