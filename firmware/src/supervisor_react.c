#include "hal/safety_output.h"
#include "supervisor_internal.h"

#include "agv/codec.h"
#include "agv/latch.h"

static agv_state_t state_of(const agv_core_t *core) {
    return (agv_state_t)core->machine.state;
}

static bool angle_is_held(const agv_core_t *core) {
    const uint16_t complement = (uint16_t)~core->hold.raw;
    return core->hold.check == complement;
}

static uint8_t wanted_commands(const agv_core_t *core) {
    uint8_t wanted = 0u;
    if (agv_state_commands_safe(state_of(core))) {
        wanted = (1u << AGV_MSG_TURN_SIGNAL_COMMAND) | (1u << AGV_MSG_THROTTLE_COMMAND);
        if (core->machine.park_released) {
            wanted |= 1u << AGV_MSG_GEAR_COMMAND;
        }
        if (agv_state_is_latched(state_of(core)) && angle_is_held(core) &&
            agv_monitor_steering_holdable(&core->monitor)) {
            wanted |= 1u << AGV_MSG_STEERING_COMMAND;
        }
    }
    return wanted;
}

agv_outlet_t agv_core_outlet(agv_core_t *core, const agv_ports_t *ports) {
    const agv_config_t *config = &core->config;
    const agv_outlet_t outlet = {
        .hal = ports->hal,
        .gate = {.state = core->machine.state,
                 .id_set = (uint8_t)config->id_set,
                 .gateway = config->topology == (uint16_t)AGV_TOPOLOGY_GATEWAY,
                 .pass_all_in_manual = config->gateway_in_manual == (uint16_t)AGV_IN_MANUAL_ALL,
                 .shadow = config->shadow == (uint16_t)AGV_SHADOW_ON,
                 .throttle_max_counts = agv_gateway_throttle_max_counts(config),
                 .status_id = config->status_frame_id,
                 .hold_raw = core->hold.raw,
                 .hold_check = core->hold.check},
        .counters = &core->counters,
        .now_ms = core->now_ms,
        .override_gap_ms = config->override_gap_ms,
        .wanted = wanted_commands(core),
        .frozen_heartbeat = config->own_heartbeat == (uint16_t)AGV_OWN_HEARTBEAT_FROZEN,
        .vehicle_side_off = agv_bus_is_off(&core->buses[HAL_CAN_VEHICLE]),
    };
    return outlet;
}

void agv_core_record(const agv_core_t *core, const agv_ports_t *ports, const agv_event_t *what) {
    agv_event_t event = *what;
    event.time_ms = core->now_ms;
    event.state = core->machine.state;
    event.first_reason = core->machine.first_reason;
    agv_recorder_add(ports->recorder, &event);
}

void agv_core_store_latch(const agv_core_t *core, const agv_ports_t *ports) {
    const agv_state_machine_t *machine = &core->machine;
    agv_latch_write(ports->hal, agv_state_is_latched(state_of(core)), (agv_fault_t)machine->first_reason,
                    (agv_fault_t)machine->unresettable);
}

static void record_fault(const agv_core_t *core, const agv_ports_t *ports, agv_fault_t fault, bool trip, bool active) {
    const agv_event_t event = {.kind = AGV_EVENT_FAULT,
                               .a = (uint8_t)fault,
                               .b = (uint8_t)(trip ? AGV_CLASS_TRIP : AGV_CLASS_WARN),
                               .c = (uint8_t)(active ? 1u : 0u)};
    agv_core_record(core, ports, &event);
}

agv_fault_set_t agv_core_report_faults(agv_core_t *core, const agv_ports_t *ports) {
    const agv_fault_set_t classes = agv_monitor_trip_classes(&core->monitor, &core->config);
    const agv_fault_set_t were_trips = core->monitor.faults.tripping;
    const agv_fault_changes_t changes = agv_faults_report(&core->monitor.faults, classes);
    agv_fault_set_t rest = changes.raised | changes.ended;
    while (rest != 0u) {
        const agv_fault_t fault = agv_fault_highest(rest);
        const agv_fault_set_t bit = agv_fault_bit(fault);
        const bool raised = (changes.raised & bit) != 0u;
        const bool trip = ((raised ? classes : were_trips) & bit) != 0u;
        if (raised && !trip) {
            core->counters.warnings++;
        }
        record_fault(core, ports, fault, trip, raised);
        rest &= ~bit;
    }
    return changes.trips;
}

static agv_situation_t situation_of(agv_core_t *core, agv_fault_set_t raised_trips) {
    agv_monitor_t *monitor = &core->monitor;
    const agv_config_t *config = &core->config;
    const agv_fault_set_t unsafe = agv_fault_bit(AGV_FAULT_BUS_OFF) | agv_fault_bit(AGV_FAULT_TX_STALLED);
    const bool unfed = agv_timer_exceeded(&core->unfed, core->now_ms, config->watchdog_period_ms);
    const agv_situation_t situation = {
        .raised_trips = raised_trips,
        .active_trips = monitor->faults.tripping,
        .vcu_alive = agv_monitor_alive(monitor, AGV_NODE_VCU),
        .eps_alive = agv_monitor_alive(monitor, AGV_NODE_EPS),
        .ai_alive = agv_monitor_alive(monitor, AGV_NODE_AI),
        .messages_fresh = agv_monitor_messages_fresh(monitor, config),
        .manual = monitor->vehicle.mode == (uint8_t)AGV_MODE_MANUAL,
        .engaged = monitor->vehicle.mode == (uint8_t)AGV_MODE_ENGAGED,
        .standstill = agv_monitor_standstill(monitor, config, core->now_ms),
        .autopilot_off = agv_monitor_autopilot_off(monitor),
        .in_park = agv_monitor_in_park(monitor),
        .button = monitor->vehicle.button_pressed,
        .output_unsafe = unfed || ((monitor->faults.active & unsafe) != 0u),
    };
    return situation;
}

/* The angle of the moment of the trip; without one, the first valid angle after it. */
static void follow_hold(agv_core_t *core, bool tripped) {
    const agv_vehicle_t *vehicle = &core->monitor.vehicle;
    const bool latched = agv_state_is_latched(state_of(core));
    if (!latched) {
        core->hold = (agv_hold_t){0};
    } else if ((tripped || !angle_is_held(core)) && vehicle->angle_known) {
        core->hold.raw = (uint16_t)(vehicle->angle_ddeg + AGV_ANGLE_RAW_CENTRE);
        core->hold.check = (uint16_t)~core->hold.raw;
    } else {
        /* held, or nothing known yet */
    }
}

static void report_step(agv_core_t *core, const agv_ports_t *ports, const agv_step_t *step) {
    if (step->from != core->machine.state) {
        const agv_event_t event = {.kind = AGV_EVENT_STATE,
                                   .a = step->from,
                                   .b = core->machine.state,
                                   .c = step->tripped ? core->machine.first_reason : (uint8_t)AGV_FAULT_NONE};
        agv_core_record(core, ports, &event);
    }
    if (step->reset_accepted || step->reset_refused) {
        const agv_event_t event = {
            .kind = AGV_EVENT_RESET, .a = (uint8_t)(step->reset_accepted ? 1u : 0u), .missing = step->missing};
        agv_core_record(core, ports, &event);
    }
    if (step->startup_timed_out) {
        const agv_event_t event = {.kind = AGV_EVENT_STARTUP, .missing = step->missing};
        agv_core_record(core, ports, &event);
    }
}

static void switch_output(agv_core_t *core, const agv_ports_t *ports, bool was_closed) {
    const bool closed = core->machine.output_closed;
    if (closed != was_closed) {
        const agv_event_t event = {.kind = AGV_EVENT_OUTPUT, .a = (uint8_t)(closed ? 1u : 0u)};
        hal_safety_output_set(ports->hal, closed);
        agv_core_record(core, ports, &event);
    }
}

static void send_all_at_once(agv_core_t *core, const agv_ports_t *ports) {
    agv_outlet_t outlet = agv_core_outlet(core, ports);
    agv_transmitter_discard(&core->transmitter, &core->counters);
    hal_can_purge(ports->hal, HAL_CAN_VEHICLE);
    agv_transmitter_burst(&core->transmitter, &outlet);
    if (outlet.park_sent) {
        agv_state_machine_park_sent(&core->machine, core->now_ms);
    }
}

static void leave_latch(agv_core_t *core, const agv_ports_t *ports, const agv_step_t *step) {
    if (agv_state_commands_safe((agv_state_t)step->from) && !agv_state_commands_safe(state_of(core))) {
        agv_transmitter_discard(&core->transmitter, &core->counters);
        hal_can_purge(ports->hal, HAL_CAN_VEHICLE);
        core->monitor.faults.latched = 0u;
    }
    if (step->reset_accepted) {
        agv_monitor_forget_ai(&core->monitor);
    }
}

static void carry_out(agv_core_t *core, const agv_ports_t *ports, const agv_step_t *step, agv_fault_set_t trips) {
    if (agv_state_is_latched(state_of(core))) {
        core->monitor.faults.latched |= trips;
    }
    follow_hold(core, step->tripped);
    if (core->machine.state != (uint8_t)AGV_STATE_ACTIVE) {
        core->gateway = (agv_gateway_t){0};
    }
    leave_latch(core, ports, step);
    if (step->tripped) {
        send_all_at_once(core, ports);
    }
    report_step(core, ports, step);
    if (agv_state_is_latched((agv_state_t)step->from) != agv_state_is_latched(state_of(core))) {
        agv_core_store_latch(core, ports);
    }
}

bool agv_core_react(agv_core_t *core, const agv_ports_t *ports) {
    const agv_fault_set_t own =
        agv_fault_bit(AGV_FAULT_SAFE_STATE_UNCONFIRMED) | agv_fault_bit(AGV_FAULT_STARTUP_TIMEOUT);
    const bool was_closed = core->machine.output_closed;
    const uint8_t unresettable = core->machine.unresettable;
    const agv_fault_set_t trips = agv_core_report_faults(core, ports);
    const agv_situation_t situation = situation_of(core, trips);
    const agv_step_t step = agv_state_machine_step(&core->machine, &core->config, &situation, core->now_ms);
    carry_out(core, ports, &step, trips);
    if (unresettable != core->machine.unresettable) {
        agv_core_store_latch(core, ports);
    }
    agv_faults_levels(&core->monitor.faults, own, agv_state_machine_faults(&core->machine));
    core->monitor.faults.latched |=
        agv_core_report_faults(core, ports) & (agv_state_is_latched(state_of(core)) ? ~(agv_fault_set_t)0u : 0u);
    switch_output(core, ports, was_closed);
    return step.tripped;
}

void agv_core_after_sending(agv_core_t *core, const agv_ports_t *ports, const agv_outlet_t *outlet) {
    if (outlet->park_sent) {
        agv_state_machine_park_sent(&core->machine, core->now_ms);
    }
    if (outlet->refused) {
        agv_faults_event(&core->monitor.faults, AGV_FAULT_TX_GATE_REFUSED, core->now_ms);
        (void)agv_core_react(core, ports);
    }
}
