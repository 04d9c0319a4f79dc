#include "agv/supervisor.h"

#include "agv/checksum.h"
#include "hal/led.h"
#include "hal/store.h"
#include "hal/watchdog.h"
#include "supervisor_internal.h"

/* Activities that check in before the hardware watchdog is fed (TIM-3). */
enum { CHECKED_RECEIVE = 1, CHECKED_STEP = 2, CHECKED_SEND = 4, CHECKED_ALL = 7 };

static bool is_intact(const agv_supervisor_t *supervisor) {
    return (supervisor->seal == agv_seal(&supervisor->core, sizeof supervisor->core)) &&
           agv_state_machine_is_sound(&supervisor->core.machine);
}

static void seal(agv_supervisor_t *supervisor) {
    supervisor->seal = agv_seal(&supervisor->core, sizeof supervisor->core);
}

static void check_memory(agv_supervisor_t *supervisor, const agv_ports_t *ports, uint32_t now_ms) {
    if (!is_intact(supervisor)) {
        agv_core_restart_corrupted(&supervisor->core, ports, now_ms);
    }
}

/* The supervisor's time never goes backwards, whatever stamps frames carry. */
static void advance(agv_core_t *core, uint32_t moment_ms) {
    if ((moment_ms - core->now_ms) <= (UINT32_MAX / 2u)) {
        core->now_ms = moment_ms;
    }
}

static uint32_t step_time(agv_core_t *core, uint32_t now_ms) {
    advance(core, now_ms);
    const uint32_t elapsed_ms = core->now_ms - core->last_tick_ms;
    core->last_tick_ms = core->now_ms;
    if (elapsed_ms > ((uint32_t)core->config.watchdog_period_ms + 1u)) {
        agv_faults_event(&core->monitor.faults, AGV_FAULT_STEP_OVERRUN, core->now_ms);
    }
    return elapsed_ms;
}

static agv_bus_report_t look_at_bus(agv_core_t *core, const agv_ports_t *ports, hal_can_side_t side) {
    hal_can_status_t status;
    hal_can_status(ports->hal, side, &status);
    return agv_bus_tick(&core->buses[side], &status, core->config.bus_off_recovery_ms, core->config.tx_stalled_ms,
                        core->now_ms);
}

static void recover(agv_core_t *core, const agv_ports_t *ports, hal_can_side_t side) {
    if (side == HAL_CAN_VEHICLE) {
        agv_transmitter_discard(&core->transmitter, &core->counters);
    } else {
        agv_transmitter_discard_ai(&core->transmitter, &core->counters);
    }
    hal_can_purge(ports->hal, side);
    hal_can_recover(ports->hal, side);
}

/* SUP-7. Returns whether the vehicle side has come back from bus-off. */
static bool judge_buses(agv_core_t *core, const agv_ports_t *ports) {
    const agv_fault_set_t judged = agv_fault_bit(AGV_FAULT_BUS_OFF) | agv_fault_bit(AGV_FAULT_TX_STALLED) |
                                   agv_fault_bit(AGV_FAULT_ERROR_PASSIVE) | agv_fault_bit(AGV_FAULT_AI_BUS_OFF);
    const bool gateway = core->config.topology == (uint16_t)AGV_TOPOLOGY_GATEWAY;
    const agv_bus_report_t vehicle = look_at_bus(core, ports, HAL_CAN_VEHICLE);
    agv_bus_report_t ai = {0};
    if (gateway) {
        ai = look_at_bus(core, ports, HAL_CAN_AI);
    }
    if (vehicle.off) {
        agv_transmitter_discard(&core->transmitter, &core->counters);
    }
    if (vehicle.ask_recovery) {
        recover(core, ports, HAL_CAN_VEHICLE);
    }
    if (ai.ask_recovery) {
        recover(core, ports, HAL_CAN_AI);
    }
    if (vehicle.overrun || ai.overrun) {
        agv_faults_event(&core->monitor.faults, AGV_FAULT_RX_OVERRUN, core->now_ms);
    }
    const bool waits = agv_transmitter_stalled(&core->transmitter, core->now_ms, core->config.tx_stalled_ms);
    agv_faults_levels(&core->monitor.faults, judged,
                      agv_fault_when(vehicle.off, AGV_FAULT_BUS_OFF) |
                          agv_fault_when(vehicle.stalled || waits, AGV_FAULT_TX_STALLED) |
                          agv_fault_when(vehicle.passive || ai.passive, AGV_FAULT_ERROR_PASSIVE) |
                          agv_fault_when(ai.off || ai.stalled, AGV_FAULT_AI_BUS_OFF));
    return vehicle.recovered;
}

static void send_status_frame(agv_core_t *core, agv_outlet_t *outlet) {
    const uint32_t checksum = core->config_checksum;
    const uint8_t data[AGV_DLC] = {core->machine.state,
                                   core->machine.first_reason,
                                   (uint8_t)(core->machine.output_closed ? 1u : 0u),
                                   0u, /* alive counter, filled in by the transmitter */
                                   (uint8_t)checksum,
                                   (uint8_t)(checksum >> 8u),
                                   (uint8_t)(checksum >> 16u),
                                   (uint8_t)(checksum >> 24u)};
    agv_transmitter_status(&core->transmitter, outlet, data, core->config.status_frame_period_ms);
}

static void transmit(agv_core_t *core, const agv_ports_t *ports, bool all_at_once) {
    agv_outlet_t outlet = agv_core_outlet(core, ports);
    if (all_at_once && (outlet.wanted != 0u)) {
        agv_transmitter_burst(&core->transmitter, &outlet);
    }
    agv_transmitter_tick(&core->transmitter, &outlet);
    send_status_frame(core, &outlet);
    agv_core_after_sending(core, ports, &outlet);
    core->checked_in |= CHECKED_SEND;
}

static void show_led(agv_core_t *core, const agv_ports_t *ports, uint32_t elapsed_ms) {
    const agv_faults_t *faults = &core->monitor.faults;
    const int8_t code = agv_led_code(faults->tripping | faults->latched, faults->active);
    if (agv_led_tick(&core->led, code, core->config.shadow == (uint16_t)AGV_SHADOW_ON, elapsed_ms)) {
        hal_led_set(ports->hal, core->led.on);
    }
}

/* INT-3: flash may stall the processor, so only where no reaction can be due. One event a tick. */
static void store_events(agv_core_t *core, const agv_ports_t *ports) {
    const bool standing = (core->machine.state == (uint8_t)AGV_STATE_STANDBY) &&
                          agv_monitor_standstill(&core->monitor, &core->config, core->now_ms);
    agv_event_t event;
    if (((core->machine.state == (uint8_t)AGV_STATE_SAFE) || standing) &&
        agv_recorder_next_to_store(ports->recorder, &event)) {
        (void)hal_store_append(ports->hal, &event, sizeof event);
        agv_recorder_stored(ports->recorder, event.sequence);
    }
}

static void feed_watchdog(agv_core_t *core, const agv_ports_t *ports) {
    if (core->checked_in == (uint8_t)CHECKED_ALL) {
        core->checked_in = 0u;
        agv_timer_start(&core->unfed, core->now_ms);
        hal_watchdog_feed(ports->hal);
    }
}

void agv_supervisor_start(agv_supervisor_t *supervisor, const agv_ports_t *ports, const agv_config_t *config,
                          bool self_test_passed, uint32_t now_ms) {
    agv_core_start(&supervisor->core, ports, config, self_test_passed, now_ms);
    seal(supervisor);
}

void agv_supervisor_frame(agv_supervisor_t *supervisor, const agv_ports_t *ports, hal_can_side_t side,
                          const hal_can_frame_t *frame) {
    agv_core_t *core = &supervisor->core;
    check_memory(supervisor, ports, frame->time_ms);
    advance(core, frame->time_ms);
    agv_core_frame(core, ports, side, frame);
    seal(supervisor);
}

void agv_supervisor_tick(agv_supervisor_t *supervisor, const agv_ports_t *ports, uint32_t now_ms) {
    agv_core_t *core = &supervisor->core;
    check_memory(supervisor, ports, now_ms);
    const uint32_t elapsed_ms = step_time(core, now_ms);
    core->checked_in |= CHECKED_STEP;
    const bool recovered = judge_buses(core, ports);
    agv_monitor_tick(&core->monitor, &core->config, core->now_ms);
    (void)agv_core_react(core, ports);
    transmit(core, ports, recovered);
    feed_watchdog(core, ports);
    show_led(core, ports, elapsed_ms);
    store_events(core, ports);
    seal(supervisor);
}

void agv_supervisor_receive_alive(agv_supervisor_t *supervisor) {
    const uint8_t before = supervisor->core.checked_in;
    supervisor->core.checked_in |= CHECKED_RECEIVE;
    if (supervisor->core.checked_in != before) {
        seal(supervisor);
    }
}

agv_state_t agv_supervisor_state(const agv_supervisor_t *supervisor) {
    return (agv_state_t)supervisor->core.machine.state;
}

agv_fault_t agv_supervisor_first_reason(const agv_supervisor_t *supervisor) {
    return (agv_fault_t)supervisor->core.machine.first_reason;
}

agv_fault_set_t agv_supervisor_active_faults(const agv_supervisor_t *supervisor) {
    return supervisor->core.monitor.faults.active;
}

agv_fault_set_t agv_supervisor_active_trips(const agv_supervisor_t *supervisor) {
    return supervisor->core.monitor.faults.tripping;
}

bool agv_supervisor_output_closed(const agv_supervisor_t *supervisor) {
    return supervisor->core.machine.output_closed;
}

int8_t agv_supervisor_led_code(const agv_supervisor_t *supervisor) {
    return supervisor->core.led.code;
}

const agv_counters_t *agv_supervisor_counters(const agv_supervisor_t *supervisor) {
    return &supervisor->core.counters;
}

const agv_config_t *agv_supervisor_config(const agv_supervisor_t *supervisor) {
    return &supervisor->core.config;
}
