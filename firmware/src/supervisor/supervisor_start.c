#include <stddef.h>
#include <string.h>

#include "agv/codec.h"
#include "hal/reset.h"
#include "hal/safety_output.h"
#include "hal/self_test.h"
#include "keep/latch.h"
#include "supervisor/supervisor_internal.h"
#include "transmit/gate.h"

/*
 * Test codec and gate against each other: the gate must allow gear P as packed by the codec, and refuse D.
 * Returns HAL_SELF_TEST_* bits.
 */
static uint32_t self_test(const agv_core_t *core) {
    const agv_gate_t tripped = {.config = &core->config, .ids = &core->ids, .state = AGV_STATE_TRIPPED};
    hal_can_frame_t frame = {.id = core->ids.of[AGV_MSG_GEAR_COMMAND], .length = AGV_DLC, .data = {AGV_GEAR_P}};
    if (!agv_value_is_valid(AGV_MSG_GEAR_COMMAND, frame.data) || /* GCOVR_EXCL_BR_LINE: P is known */
        !agv_gate_allows(&tripped, HAL_CAN_VEHICLE, &frame)) {   /* GCOVR_EXCL_BR_LINE: and passes */
        return HAL_SELF_TEST_CORE;                               /* GCOVR_EXCL_LINE: never here */
    }
    frame.data[0] = AGV_GEAR_D;
    return agv_gate_allows(&tripped, HAL_CAN_VEHICLE, &frame) ? HAL_SELF_TEST_CORE
                                                              : 0u; /* GCOVR_EXCL_BR_LINE: D never passes here */
}

/* Reset everything except the time, the configuration and the counters. */
static void begin_modules(agv_core_t *core, hal_t *hal) {
    const size_t anew = offsetof(agv_core_t, config_checksum);
    (void)memset(&((unsigned char *)core)[anew], 0, sizeof *core - anew);
    core->config_checksum = agv_config_checksum(&core->config);
    core->last_tick_ms = core->timers.now_ms;
    agv_core_keep_wiring(core);
    agv_timers_start(&core->timers);
    agv_timer_start(&core->timers, AGV_TIMER_WATCHDOG_FED);
    agv_fault_monitor_start(&core->faults);
    core->reset_pin.is_pin = true;
    agv_liveness_start(&core->liveness, &core->timers);
    agv_transmitter_start(&core->transmitter, core->timers.now_ms);
    agv_bus_start(&core->buses[HAL_CAN_VEHICLE], hal, HAL_CAN_VEHICLE);
    agv_bus_start(&core->buses[HAL_CAN_AI], hal, HAL_CAN_AI);
}

/* Read the latch of the run before the reset (FSM-7). Returns the reason of its trip, or AGV_FAULT_NONE. */
static uint32_t begin_from_latch(agv_core_t *core, hal_t *hal, bool restarted) {
    agv_latch_t latch;
    const agv_latch_found_t found = agv_latch_read(hal, &latch);
    if (found == AGV_LATCH_CORRUPT) {
        agv_fault_monitor_event(&core->faults, &core->timers, AGV_FAULT_STORE_INVALID);
    }
    if ((found != AGV_LATCH_VALID) || !restarted) {
        return AGV_FAULT_NONE;
    }
    agv_fault_monitor_set(&core->faults, latch.unresettable, true);
    return (latch.first_reason < (uint8_t)AGV_FAULT_COUNT) ? latch.first_reason : (uint32_t)AGV_FAULT_NONE;
}

/* The highest-ranking active fault down to SUPERVISOR_RESET; AGV_FAULT_NONE if there is none. */
static uint32_t first_found(const agv_core_t *core) {
    for (uint32_t fault = 0u; fault <= (uint32_t)AGV_FAULT_SUPERVISOR_RESET; fault++) {
        if (agv_fault_monitor_is_active(&core->faults, fault)) {
            return fault;
        }
    }
    return AGV_FAULT_NONE;
}

/* Start in INIT; in TRIPPED if an earlier run was tripped, or if a fault found now requires it. */
static void begin_state(agv_core_t *core, const agv_ports_t *ports, uint32_t kept_reason, agv_pass_t *pass) {
    const uint32_t found = first_found(core);
    agv_state_machine_start(&core->machine, &core->timers, &core->config,
                            (kept_reason != (uint32_t)AGV_FAULT_NONE) ? kept_reason : found);
    agv_core_record(core, ports, AGV_EVENT_STATE, 0u, core->machine.state, core->machine.first_reason);
    agv_core_record(core, ports, AGV_EVENT_OUTPUT, 0u, 0u, 0u);
    agv_fault_monitor_latch_one(&core->faults, kept_reason);
    agv_fault_monitor_evaluate(&core->faults, &core->config.trips,
                               core->config.ai_lost_in_manual == (uint16_t)AGV_AI_LOST_WARN, &pass->faults);
    pass->actions = (agv_actions_t){.from = core->machine.state, .first_reason = core->machine.first_reason};
    agv_state_machine_forbid_reset(&core->machine, core->faults.summary.unresettable);
    agv_core_await_safe_state(core, true);
}

static void raise_found(agv_core_t *core, uint32_t found) {
    for (uint32_t fault = 0u; (found >> fault) != 0u; fault++) {
        agv_fault_monitor_set(&core->faults, fault, ((found >> fault) & 1u) != 0u);
    }
}

void agv_core_begin(agv_core_t *core, const agv_ports_t *ports, uint32_t found) {
    const bool corrupted = (found & AGV_FOUND_CORRUPTED) != 0u;
    const bool powered_on = !corrupted && (hal_reset_cause(ports->hal) == HAL_RESET_POWER_ON);
    const bool trips = core->config.after_power_on == (uint16_t)AGV_AFTER_POWER_ON_TRIPPED;
    hal_safety_output_set(ports->hal, false);
    begin_modules(core, ports->hal);
    raise_found(core, found);
    agv_hardware_self_test(&core->hardware, &core->faults, ports->hal, self_test(core));
    const uint32_t kept_reason = begin_from_latch(core, ports->hal, !powered_on);
    if ((!powered_on || trips) && !corrupted && (kept_reason == (uint32_t)AGV_FAULT_NONE)) {
        agv_fault_monitor_event(&core->faults, &core->timers, AGV_FAULT_SUPERVISOR_RESET);
    }
    agv_pass_t pass;
    begin_state(core, ports, kept_reason, &pass);
    agv_core_store_latch(core, ports);
    hal_can_purge(ports->hal, HAL_CAN_VEHICLE);
    const agv_tx_orders_t orders = agv_core_orders(core, ports);
    agv_transmitter_burst(&core->transmitter, &orders);
    agv_transmitter_status(&core->transmitter, &orders);
    agv_core_conclude(core, ports, &pass);
    agv_core_show_led(core, ports, 0u);
}

void agv_core_keep_wiring(agv_core_t *core) {
    agv_config_ids(&core->config, &core->ids);
    core->status_frame_id = core->config.status_frame_id;
    core->topology = (uint8_t)core->config.topology;
    core->id_set = (uint8_t)core->config.id_set;
    core->park = (uint8_t)core->config.park;
}

/*
 * Use the defaults, with topology, identifiers and `park` of this vehicle if these are valid. Without the status frame, if
 * the identifiers are not valid, or its own is the one of a message.
 */
static void use_default_config(agv_core_t *core) {
    agv_config_t *const config = &core->config;
    agv_config_defaults(config);
    config->topology = (core->topology == (uint8_t)AGV_TOPOLOGY_GATEWAY) ? AGV_TOPOLOGY_GATEWAY : config->topology;
    config->id_set = (core->id_set == (uint8_t)AGV_ID_SET_TABLE) ? (uint16_t)AGV_ID_SET_TABLE : config->id_set;
    config->park = (core->park == (uint8_t)AGV_PARK_AT_STANDSTILL) ? (uint16_t)AGV_PARK_AT_STANDSTILL : config->park;
    config->status_frame_id = core->status_frame_id;
    for (uint32_t i = 0u; i < (uint32_t)AGV_MSG_COUNT; i++) {
        if (core->ids.of[i] != agv_message_id(i, config->id_set)) {
            (void)agv_config_set(config, (uint32_t)AGV_SETTING_ID + i, core->ids.of[i]);
        }
    }
    if (agv_config_check(config).problem != AGV_CONFIG_OK) {
        config->status_frame_id = 0u;
    }
    if (agv_config_check(config).problem != AGV_CONFIG_OK) {
        for (uint32_t i = 0u; i < (uint32_t)AGV_MSG_COUNT; i++) {
            (void)agv_config_set(config, (uint32_t)AGV_SETTING_ID + i, agv_message_id(i, AGV_ID_SET_HEADING));
        }
    }
    agv_config_ids(config, &core->ids);
}

bool agv_core_check_config(agv_core_t *core, bool intact) {
    const bool stands = intact && (agv_config_check(&core->config).problem == AGV_CONFIG_OK);
    if (!stands) {
        use_default_config(core);
    }
    return stands;
}

void agv_core_begin_corrupted(agv_core_t *core, const agv_ports_t *ports) {
    (void)agv_core_check_config(core, agv_config_checksum(&core->config) == core->config_checksum);
    agv_core_begin(core, ports, AGV_FOUND_CORRUPTED);
}
