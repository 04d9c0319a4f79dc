#include "hal/safety_output.h"
#include "keep/latch.h"
#include "observe/deadlines.h"
#include "supervisor/supervisor_internal.h"

static void record(const agv_core_t *core, const agv_ports_t *ports, const agv_entry_t *entry) {
    agv_recorder_add(ports->recorder, entry, core->timers.now_ms);
}

void agv_core_record(const agv_core_t *core, const agv_ports_t *ports, uint32_t kind, uint32_t a, uint32_t b,
                     uint32_t c) {
    const agv_entry_t entry = {.kind = (uint8_t)kind,
                               .a = (uint8_t)a,
                               .b = (uint8_t)b,
                               .c = (uint8_t)c,
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

bool agv_core_is_supervising(const agv_core_t *core) {
    return (core->machine.state == (uint8_t)AGV_STATE_STANDBY) || (core->machine.state == (uint8_t)AGV_STATE_ACTIVE);
}

agv_motion_facts_t agv_core_motion_facts(const agv_core_t *core) {
    return (agv_motion_facts_t){.config = &core->config,
                                .vehicle = &core->vehicle,
                                .commands = &core->commands,
                                .judged = agv_mode_is_judged(&core->mode, &core->timers),
                                .gear_fresh = agv_liveness_fresh(&core->liveness, &core->timers, AGV_MSG_GEAR_STATUS)};
}

agv_gateway_facts_t agv_core_gateway_facts(const agv_core_t *core) {
    return (agv_gateway_facts_t){.config = &core->config,
                                 .vehicle = &core->vehicle,
                                 .state = (agv_state_t)core->machine.state,
                                 .now_ms = core->timers.now_ms,
                                 .gear_sent =
                                     (core->machine.state == (uint8_t)AGV_STATE_ACTIVE) ? core->commands.gear : 0u,
                                 .gear_fresh = agv_liveness_fresh(&core->liveness, &core->timers, AGV_MSG_GEAR_STATUS),
                                 .angle_fresh = agv_timer_is_within(&core->timers, AGV_TIMER_ANGLE),
                                 .autopilot = agv_mode_reports_autopilot(&core->mode),
                                 .standstill = agv_vehicle_is_at_standstill(&core->timers),
                                 .judged = agv_mode_is_judged(&core->mode, &core->timers)};
}

/*
 * FSM-10: EPS alive and without a fault, in angle control, its measured angle valid, manual not reported. A stale 167h is a
 * fault of the EPS.
 */
static bool eps_takes_angles(const agv_core_t *core) {
    return agv_liveness_alive(&core->liveness, AGV_NODE_EPS) && core->vehicle.eps_in_angle_mode &&
           agv_status_checks_angle_is_usable(&core->status_checks) && !agv_mode_is_manual(&core->mode) &&
           !core->faults.summary.eps_fault;
}

/* FSM-10: moreover the wheels have not stood for long. */
static bool is_holdable(const agv_core_t *core) {
    return eps_takes_angles(core) && !agv_timer_reached(&core->timers, AGV_TIMER_WHEELS_STOOD);
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
                             .passive = agv_fault_monitor_is_active(&core->faults, AGV_FAULT_ERROR_PASSIVE),
                             .config_checksum = core->config_checksum,
                             .version = ports->version};
}

/* FSM-4: the faults that open the output at once. */
static const uint8_t output_faults[] = {AGV_FAULT_BUS_OFF,
                                        AGV_FAULT_TX_STALLED,
                                        AGV_FAULT_EMERGENCY_STOP,
                                        AGV_FAULT_SAFE_STATE_UNCONFIRMED,
                                        AGV_FAULT_VEHICLE_NOT_STOPPING,
                                        AGV_FAULT_MOVING_WHILE_SAFE};

static bool output_is_unsafe(const agv_core_t *core) {
    bool unsafe = agv_timer_reached(&core->timers, AGV_TIMER_WATCHDOG_FED);
    for (uint32_t i = 0u; i < (sizeof output_faults / sizeof output_faults[0]); i++) {
        unsafe = unsafe || agv_fault_monitor_is_active(&core->faults, output_faults[i]);
    }
    return unsafe;
}

static uint32_t bit_if(bool condition, uint32_t bit) {
    return condition ? bit : 0u;
}

/* A step that comes later than this after the last one is preceded by frames that are handled late. */
enum { STEP_USUAL_MS = 10 };

/* Ticks evaluate the heartbeats. A frame that is handled late may come after a deadline that no tick has seen yet. */
static bool is_alive_now(const agv_core_t *core, agv_node_t node, uint32_t message) {
    const bool late = (core->timers.now_ms - core->last_tick_ms) > (uint32_t)STEP_USUAL_MS;
    return agv_liveness_alive(&core->liveness, node) &&
           (!late || agv_liveness_fresh(&core->liveness, &core->timers, message));
}

static uint32_t vcu_facts(const agv_core_t *core) {
    if (!is_alive_now(core, AGV_NODE_VCU, AGV_MSG_VEHICLE_STATUS)) {
        return 0u;
    }
    const bool off = !agv_mode_is_engaged(&core->mode) && !agv_mode_is_ambiguous(&core->mode);
    /* After a late step the deadlines have not been evaluated. */
    return bit_if(off, AGV_FACT_AUTOPILOT_OFF) | bit_if(!agv_core_step_is_late(core), AGV_FACT_VCU_ALIVE);
}

/*
 * INIT waits only for a 050h that reports throttle. A reset also needs a 050h that is valid and not silent: if
 * THROTTLE_STATUS_TIMEOUT is a trip, AGV_FACT_MESSAGES covers its silence; if it only warns, this function checks it.
 */
static bool throttle_is_idle(const agv_core_t *core) {
    const bool unseen = !core->vehicle.throttle_known ||
                        (agv_fault_monitor_is_active(&core->faults, AGV_FAULT_THROTTLE_STATUS_TIMEOUT) &&
                         !agv_config_is_trip(&core->config, AGV_FAULT_THROTTLE_STATUS_TIMEOUT));
    return ((core->machine.state == (uint8_t)AGV_STATE_INIT) || !unseen) &&
           agv_vehicle_throttle_is_idle(&core->vehicle, &core->config);
}

/* The facts for INIT, TRIPPED and SAFE. */
static uint32_t safe_state_facts(const agv_core_t *core) {
    const agv_timers_t *const timers = &core->timers;
    return vcu_facts(core) | bit_if(is_alive_now(core, AGV_NODE_EPS, AGV_MSG_STEERING_STATUS), AGV_FACT_EPS_ALIVE) |
           bit_if(agv_mode_is_manual(&core->mode), AGV_FACT_MANUAL) |
           bit_if(agv_vehicle_is_at_standstill(timers), AGV_FACT_STANDSTILL) |
           bit_if(agv_vehicle_is_slow(&core->vehicle, &core->config), AGV_FACT_SLOW) |
           bit_if(throttle_is_idle(core), AGV_FACT_IDLE) | bit_if(agv_core_is_in_park(core), AGV_FACT_IN_PARK) |
           bit_if(core->machine.output_closed || agv_hardware_output_reads_open(&core->hardware),
                  AGV_FACT_OUTPUT_OPEN) |
           bit_if(agv_deadlines_messages_fresh(&core->liveness, timers, &core->config), AGV_FACT_MESSAGES);
}

static uint32_t facts_of(const agv_core_t *core) {
    const uint32_t facts = bit_if(agv_mode_is_engaged(&core->mode), AGV_FACT_ENGAGED) |
                           bit_if(agv_liveness_alive(&core->liveness, AGV_NODE_AI), AGV_FACT_AI_ALIVE) |
                           bit_if(agv_vehicle_wheels_stand(&core->timers), AGV_FACT_WHEELS_STAND);
    return agv_core_is_supervising(core) ? facts : (facts | safe_state_facts(core));
}

/* The checks whose result depends on the current mode or time. */
static void evaluate_checks(agv_core_t *core) {
    const bool judged = agv_mode_is_judged(&core->mode, &core->timers);
    agv_status_checks_evaluate(&core->status_checks, &core->faults, agv_mode_is_engaged(&core->mode), judged);
    agv_motion_checks_evaluate(&core->motion_checks, &core->faults, judged);
}

/* In TRIPPED and SAFE: whether the vehicle confirms and stops (FSM-4, FSM-12). A reset is refused while it does not. */
static void evaluate_safe_state(agv_core_t *core, uint32_t facts, uint32_t elapsed_ms) {
    agv_confirmation_step(&core->confirmation, &core->timers, &core->config, elapsed_ms,
                          (facts & AGV_FACT_AUTOPILOT_OFF) != 0u, (facts & AGV_FACT_IN_PARK) != 0u);
    agv_stopping_step(&core->stopping, &core->timers, &core->vehicle, elapsed_ms);
    agv_fault_monitor_set(&core->faults, AGV_FAULT_SAFE_STATE_UNCONFIRMED, core->confirmation.unconfirmed);
    agv_fault_monitor_set(&core->faults, AGV_FAULT_VEHICLE_NOT_STOPPING, core->stopping.not_stopping);
    agv_fault_monitor_set(&core->faults, AGV_FAULT_MOVING_WHILE_SAFE, core->stopping.moving);
}

static void evaluate_faults(agv_core_t *core, uint32_t facts, uint32_t elapsed_ms, agv_fault_changes_t *changes) {
    const bool ai_loss_warns =
        ((facts & AGV_FACT_ENGAGED) == 0u) && (core->config.ai_lost_in_manual == (uint16_t)AGV_AI_LOST_WARN);
    if (is_latched(core)) {
        evaluate_safe_state(core, facts, elapsed_ms);
    }
    agv_fault_monitor_set(&core->faults, AGV_FAULT_STARTUP_TIMEOUT,
                          agv_state_machine_is_startup_late(&core->machine, &core->timers));
    agv_fault_monitor_evaluate(&core->faults, &core->config.trips, ai_loss_warns, changes);
}

/*
 * A press of a button, in TRIPPED and SAFE (FSM-3, HW-3). When a step is late, it is not known for how long a condition has
 * held: no more than the usual time counts.
 */
static agv_press_result_t evaluate_press(agv_core_t *core, uint32_t facts, uint32_t elapsed_ms, uint32_t *missing) {
    if (!is_latched(core)) {
        return AGV_PRESS_NOTHING;
    }
    const uint32_t lacking = agv_state_machine_lacks_for_reset(&core->machine, &core->faults.summary, facts);
    const uint32_t held_ms = (elapsed_ms < (uint32_t)STEP_USUAL_MS) ? elapsed_ms : (uint32_t)STEP_USUAL_MS;
    const agv_press_result_t remote =
        agv_reset_button_step(&core->reset_button, &core->timers, &core->config, held_ms, lacking, missing);
    if (core->config.reset_input == (uint16_t)AGV_RESET_INPUT_CAN) {
        return remote;
    }
    uint32_t missing_pin = 0u;
    const agv_press_result_t pin =
        agv_reset_button_step(&core->reset_pin, &core->timers, &core->config, held_ms, lacking, &missing_pin);
    if ((remote == AGV_PRESS_RESETS) || (pin == AGV_PRESS_NOTHING)) {
        return remote;
    }
    *missing = missing_pin;
    return pin;
}

void agv_core_await_safe_state(agv_core_t *core, bool at_tick) {
    agv_confirmation_start(&core->confirmation, &core->timers, at_tick);
    agv_stopping_start(&core->stopping, &core->timers);
    agv_reset_button_trip(&core->reset_button, &core->timers);
    agv_reset_button_trip(&core->reset_pin, &core->timers);
}

/*
 * FSM-10: the held angle is dropped while the EPS takes no angles or the operator steers, and after 2 s without 065h. A late
 * tick replaces an angle that was taken since the last one. Returns whether a 065h that may no longer be sent waits in a
 * stalled transmitter.
 */
static bool follow_hold(agv_core_t *core, uint32_t elapsed_ms) {
    const bool stalled = agv_fault_monitor_is_active(&core->faults, AGV_FAULT_TX_STALLED);
    if (!is_latched(core) || !eps_takes_angles(core)) {
        agv_hold_drop(&core->hold);
    }
    if (!is_latched(core)) {
        return false;
    }
    agv_hold_renew(&core->hold, &core->vehicle, &core->timers, core->config.hold_age_ms, elapsed_ms);
    agv_hold_follow(&core->hold, &core->timers, elapsed_ms);
    return agv_hold_is_stuck(&core->hold, stalled, is_holdable(core));
}

/*
 * SUP-7: while safe commands are sent, no frame that cannot leave keeps them back, and none leaves later with an old value.
 * Returns whether all frames were withdrawn. In INIT there may be no other node yet: then the frames wait for one.
 */
static bool withdraw_frames(agv_core_t *core, hal_t *hal, uint32_t elapsed_ms) {
    const bool stuck = follow_hold(core, elapsed_ms);
    const bool starts =
        (core->machine.state == (uint8_t)AGV_STATE_INIT) && agv_liveness_alive(&core->liveness, AGV_NODE_VCU);
    const bool begins = core->stall_begins && (is_latched(core) || starts);
    core->stall_begins = core->stall_begins && !begins;
    if (stuck || begins) {
        agv_hold_withdrawn(&core->hold);
        agv_transmitter_withdraw(&core->transmitter, &core->timers, !begins);
        hal_can_purge(hal, HAL_CAN_VEHICLE);
    }
    return stuck || begins;
}

/*
 * Update hold, checks of the safe state and limits. Returns whether the safe commands must be sent anew.
 */
static bool follow_state(agv_core_t *core, hal_t *hal, uint32_t what, uint32_t elapsed_ms) {
    if ((what & AGV_ACTION_TRIP) != 0u) {
        core->stall_begins = false; /* the trip withdraws all frames */
        agv_core_await_safe_state(core, elapsed_ms != 0u);
        agv_hold_trip(&core->hold, &core->vehicle, &core->timers);
    }
    const bool withdrawn = withdraw_frames(core, hal, elapsed_ms);
    if ((what & AGV_ACTION_RESET_ACCEPTED) != 0u) {
        agv_liveness_forget_ai(&core->liveness);
        agv_deadlines_forget_ai(&core->faults);
        agv_timer_stop(&core->timers, AGV_TIMER_DISENGAGED); /* the next engagement is a new one */
    }
    if ((what & AGV_ACTION_STATE) != 0u) {
        agv_gateway_restart(&core->gateway);
        agv_commands_forget_gear(&core->commands);
    }
    return withdrawn || ((what & AGV_ACTION_TRIP) != 0u);
}

/* A change of state drops every waiting motion command, the end of standstill a waiting gear that needs standstill. */
static bool may_wait_on(agv_core_t *core, const agv_gateway_facts_t *facts, uint32_t command, bool state_changed) {
    const uint8_t *const data = agv_transmitter_passed(&core->transmitter, command);
    if (state_changed && (command != (uint32_t)AGV_MSG_TURN_SIGNAL_COMMAND)) {
        return false;
    }
    agv_gateway_follow_gear(&core->gateway, facts, command, data);
    return agv_gateway_passes(&core->gateway, facts, command, data);
}

static void drop_what_may_not_wait(agv_core_t *core, bool state_changed) {
    const agv_gateway_facts_t facts = agv_core_gateway_facts(core);
    for (uint32_t i = 0u; i < AGV_COMMAND_COUNT; i++) {
        if (((core->transmitter.kept & agv_message_bit(i)) != 0u) && !may_wait_on(core, &facts, i, state_changed)) {
            agv_transmitter_drop(&core->transmitter, &core->timers, i);
        }
    }
}

static void carry_out_at_once(agv_core_t *core, const agv_ports_t *ports, uint32_t what, uint32_t elapsed_ms) {
    if ((what & AGV_ACTION_OPEN_OUTPUT) != 0u) {
        hal_safety_output_set(ports->hal, false);
    }
    const bool send_all = follow_state(core, ports->hal, what, elapsed_ms);
    if ((what & AGV_ACTION_DISCARD) != 0u) {
        agv_transmitter_discard(&core->transmitter, &core->timers, HAL_CAN_VEHICLE);
    }
    if ((what & AGV_ACTION_PURGE) != 0u) {
        hal_can_purge(ports->hal, HAL_CAN_VEHICLE);
    }
    if (core->transmitter.kept != 0u) {
        drop_what_may_not_wait(core, (what & AGV_ACTION_STATE) != 0u);
    }
    const agv_tx_orders_t orders = agv_core_orders(core, ports);
    if (send_all) {
        agv_transmitter_burst(&core->transmitter, &orders);
    }
    if (((what & AGV_ACTION_END_ENGAGEMENT) != 0u) && agv_core_is_gateway(core)) {
        agv_transmitter_end_engagement(&core->transmitter, &orders);
    }
}

agv_pass_t agv_core_decide(agv_core_t *core, const agv_ports_t *ports, uint32_t elapsed_ms) {
    uint32_t missing = 0u;
    agv_pass_t pass;
    evaluate_checks(core);
    uint32_t facts = facts_of(core);
    evaluate_faults(core, facts, elapsed_ms, &pass.faults);
    facts |= output_is_unsafe(core) ? AGV_FACT_OUTPUT_UNSAFE : 0u;
    const agv_press_result_t press = evaluate_press(core, facts, elapsed_ms, &missing);
    facts |= (press == AGV_PRESS_RESETS) ? AGV_FACT_RESET : 0u;
    pass.actions = agv_state_machine_step(&core->machine, &core->timers, &core->config, &core->faults.summary, facts);
    if (press == AGV_PRESS_IN_VAIN) {
        pass.actions.what |= AGV_ACTION_RESET_REFUSED;
        pass.actions.missing = (uint16_t)missing;
    }
    carry_out_at_once(core, ports, pass.actions.what, elapsed_ms);
    return pass;
}

/* From now on the vehicle is compared with the forwarded commands (SUP-5). */
static void note_forwarded_commands(agv_core_t *core, uint32_t passed) {
    for (uint32_t i = 0u; i < AGV_COMMAND_COUNT; i++) {
        if (((passed >> i) & 1u) != 0u) {
            agv_commands_take(&core->commands, i, agv_transmitter_passed(&core->transmitter, i));
        }
    }
}

void agv_core_take_tx_report(agv_core_t *core) {
    if (!agv_transmitter_has_report(&core->transmitter)) {
        return;
    }
    const agv_tx_report_t report = agv_transmitter_take_report(&core->transmitter);
    core->counters.sent += report.sent;
    core->counters.shadowed += report.shadowed;
    core->counters.dropped += report.dropped;
    core->counters.gate_refused += report.refused;
    core->counters.skipped_slots += report.skipped_slots;
    note_forwarded_commands(core, report.passed);
    if (report.refused != 0u) {
        agv_fault_monitor_event(&core->faults, &core->timers,
                                AGV_FAULT_TX_GATE_REFUSED); /* evaluated at the next call */
    }
    if (report.park_sent && is_latched(core)) {
        agv_confirmation_park_sent(&core->confirmation);
    }
    if (report.hold_sent) {
        agv_hold_handed_over(&core->hold);
    }
}

static void record_fault(agv_core_t *core, const agv_ports_t *ports, const agv_fault_changes_t *changes, uint32_t fault,
                         agv_entry_t *entry) {
    const bool active = agv_fault_is_in(&core->faults.active, fault);
    const agv_fault_set_t *const trips = active ? &core->faults.tripping : &changes->was_trip;
    const bool trip = agv_fault_is_in(trips, fault);
    if (active && !trip) {
        core->counters.warnings++;
    }
    entry->a = (uint8_t)fault;
    entry->b = (uint8_t)(trip ? AGV_CLASS_TRIP : AGV_CLASS_WARN);
    entry->c = active ? 1u : 0u;
    entry->missing = (fault == (uint32_t)AGV_FAULT_SELF_TEST_FAILED) ? core->hardware.failed : 0u;
    record(core, ports, entry);
}

/* Record the faults that were raised or ended, with the state before the step. */
static void record_faults(agv_core_t *core, const agv_ports_t *ports, const agv_pass_t *pass) {
    agv_entry_t entry = {
        .kind = AGV_EVENT_FAULT, .state = pass->actions.from, .first_reason = pass->actions.first_reason};
    for (uint32_t word = 0u; word < AGV_FAULT_WORDS; word++) {
        uint32_t changed = pass->faults.changed.words[word];
        for (uint32_t fault = word * 32u; changed != 0u; fault++) {
            if ((changed & 1u) != 0u) {
                record_fault(core, ports, &pass->faults, fault, &entry);
            }
            changed >>= 1u;
        }
    }
}

/* Record the answer to a press of the reset button, or that INIT takes too long. */
static void record_answer(const agv_core_t *core, const agv_ports_t *ports, agv_actions_t actions) {
    agv_entry_t entry = {.kind = AGV_EVENT_RESET,
                         .missing = actions.missing,
                         .state = core->machine.state,
                         .first_reason = core->machine.first_reason};
    if ((actions.what & AGV_ACTION_RESET_ACCEPTED) != 0u) {
        entry.a = 1u;
        record(core, ports, &entry);
    }
    if ((actions.what & AGV_ACTION_RESET_REFUSED) != 0u) {
        record(core, ports, &entry);
    }
    if ((actions.what & AGV_ACTION_STARTUP_LATE) != 0u) {
        entry.kind = AGV_EVENT_STARTUP;
        record(core, ports, &entry);
    }
}

static void conclude_actions(agv_core_t *core, const agv_ports_t *ports, agv_actions_t actions) {
    const uint32_t what = actions.what;
    if ((what & AGV_ACTION_UNLATCH) != 0u) {
        agv_fault_monitor_forget(&core->faults);
    }
    if ((what & AGV_ACTION_STORE_LATCH) != 0u) {
        agv_core_store_latch(core, ports);
    }
    if ((what & AGV_ACTION_STATE) != 0u) {
        agv_core_record(core, ports, AGV_EVENT_STATE, actions.from, core->machine.state,
                        ((what & AGV_ACTION_TRIP) != 0u) ? core->machine.first_reason : (uint32_t)AGV_FAULT_NONE);
    }
    record_answer(core, ports, actions);
    if ((what & AGV_ACTION_CLOSE_OUTPUT) != 0u) {
        hal_safety_output_set(ports->hal, core->machine.output_closed);
    }
    if ((what & (AGV_ACTION_OPEN_OUTPUT | AGV_ACTION_CLOSE_OUTPUT)) != 0u) {
        agv_core_record(core, ports, AGV_EVENT_OUTPUT, core->machine.output_closed ? 1u : 0u, 0u, 0u);
    }
}

void agv_core_conclude(agv_core_t *core, const agv_ports_t *ports, const agv_pass_t *pass) {
    agv_core_take_tx_report(core);
    if (pass->faults.any) {
        record_faults(core, ports, pass);
    }
    conclude_actions(core, ports, pass->actions);
    if ((pass->actions.what == 0u) && !pass->faults.any) {
        return;
    }
    if (is_latched(core)) {
        agv_fault_monitor_latch(&core->faults);
    }
    core->led_code = (int8_t)agv_led_code(agv_fault_monitor_shown(&core->faults));
}
