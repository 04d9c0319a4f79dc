#include <string.h>

#include "agv/codec.h"
#include "agv/gate.h"
#include "agv/latch.h"
#include "hal/reset.h"
#include "hal/safety_output.h"
#include "supervisor_internal.h"

/* Codec and gate against each other: what the codec packs as P is what the gate, in raw bytes, lets out; D is not. */
static bool self_test(const agv_config_t *config) {
    const agv_gate_t tripped = {.config = config, .state = AGV_STATE_TRIPPED};
    const agv_gear_command_t park = {.gear = AGV_GEAR_P};
    hal_can_frame_t frame = {.id = 0x168u, .length = AGV_DLC};
    (void)agv_pack_gear_command(frame.data, &park);
    const bool let_out = agv_gate_allows(&tripped, HAL_CAN_VEHICLE, &frame);
    frame.data[0] = AGV_GEAR_D;
    return let_out && !agv_gate_allows(&tripped, HAL_CAN_VEHICLE, &frame); /* GCOVR_EXCL_BR_LINE: D never passes here */
}

static void begin_modules(agv_core_t *core) {
    hal_can_status_t status;
    agv_monitor_start(core);
    agv_transmitter_start(core);
    agv_timer_start(&core->unfed, core->now_ms);
    for (uint32_t side = 0u; side < (uint32_t)HAL_CAN_SIDES; side++) {
        hal_can_status(core->hal, (hal_can_side_t)side, &status);
        agv_bus_start(&core->buses[side], &status);
    }
    core->hold = (agv_hold_t){0};
    core->gateway = (agv_gateway_t){0};
    core->led = (agv_led_t){0};
    core->checked_in = 0u;
    core->last_tick_ms = core->now_ms;
    core->config_checksum = agv_config_checksum(&core->config);
    core->id_set = (uint8_t)core->config.id_set;
    core->topology = (uint8_t)core->config.topology;
}

/* The latch outlives a reset (FSM-7). Returns the reason that an earlier run was tripped for; AGV_FAULT_NONE. */
static agv_fault_t begin_from_latch(agv_core_t *core, bool restarted) {
    agv_faults_t *const faults = &core->monitor.faults;
    agv_latch_t latch;
    const agv_latch_found_t found = agv_latch_read(core->hal, &latch);
    if (found == AGV_LATCH_CORRUPT) {
        agv_faults_event(faults, AGV_FAULT_STORE_INVALID, core->now_ms);
    }
    if ((found != AGV_LATCH_VALID) || !restarted) {
        return AGV_FAULT_NONE;
    }
    agv_faults_level(faults, (agv_fault_t)latch.unresettable, true);
    return (latch.first_reason < (uint8_t)AGV_FAULT_COUNT) ? (agv_fault_t)latch.first_reason : AGV_FAULT_NONE;
}

/* The highest-ranking active fault above a rank; AGV_FAULT_NONE when there is none. */
static agv_fault_t first_active(const agv_core_t *core, agv_fault_t below) {
    uint32_t fault = 0u;
    while ((fault < (uint32_t)below) && !agv_faults_is_active(&core->monitor.faults, (agv_fault_t)fault)) {
        fault++;
    }
    return (fault < (uint32_t)below) ? (agv_fault_t)fault : AGV_FAULT_NONE;
}

/* INIT, or TRIPPED when an earlier run was or when something found now is reason enough. */
static void begin_state(agv_core_t *core, agv_fault_t kept_reason) {
    const agv_fault_t found = first_active(core, (agv_fault_t)((uint32_t)AGV_FAULT_SUPERVISOR_RESET + 1u));
    agv_state_machine_start(&core->machine, (kept_reason != AGV_FAULT_NONE) ? kept_reason : found, core->now_ms);
    core->machine.unresettable = (uint8_t)first_active(core, AGV_FAULT_SUPERVISOR_RESET);
    core->machine.park_released = core->config.park == (uint16_t)AGV_PARK_AT_ONCE;
    agv_core_record(core, AGV_EVENT_STATE, 0u, core->machine.state, core->machine.first_reason);
    agv_core_record(core, AGV_EVENT_OUTPUT, 0u, 0u, 0u);
    if (kept_reason != AGV_FAULT_NONE) {
        core->monitor.faults.marks[kept_reason] |= AGV_MARK_LATCHED;
    }
    core->monitor.faults.changed = true;
    (void)agv_core_report_faults(core);
}

/* What an earlier run found stays, whatever is found now. */
static void raise_if(agv_core_t *core, bool cause, agv_fault_t fault) {
    if (cause) {
        agv_faults_level(&core->monitor.faults, fault, true);
    }
}

void agv_core_begin(agv_core_t *core, bool config_valid, bool self_test_passed, bool corrupted) {
    agv_faults_t *const faults = &core->monitor.faults;
    const bool restarted = corrupted || (hal_reset_cause(core->hal) != HAL_RESET_POWER_ON);
    hal_safety_output_set(core->hal, false);
    begin_modules(core);
    const agv_fault_t kept_reason = begin_from_latch(core, restarted);
    raise_if(core, !self_test_passed || !self_test(&core->config), AGV_FAULT_SELF_TEST_FAILED);
    raise_if(core, corrupted, AGV_FAULT_MEMORY_CORRUPTED);
    raise_if(core, !config_valid, AGV_FAULT_CONFIG_INVALID);
    if (restarted && !corrupted && (kept_reason == AGV_FAULT_NONE)) {
        agv_faults_event(faults, AGV_FAULT_SUPERVISOR_RESET, core->now_ms);
    }
    begin_state(core, kept_reason);
    agv_core_store_latch(core);
    hal_can_purge(core->hal, HAL_CAN_VEHICLE);
    agv_transmitter_burst(core);
    agv_core_show_led(core, 0u);
}

void agv_core_built_in_config(agv_config_t *config, uint16_t id_set, uint16_t topology) {
    agv_config_defaults(config);
    config->id_set = (id_set == (uint16_t)AGV_ID_SET_TABLE) ? id_set : config->id_set;
    config->topology = (topology == (uint16_t)AGV_TOPOLOGY_GATEWAY) ? topology : config->topology;
}

void agv_core_begin_corrupted(agv_core_t *core) {
    const uint16_t id_set = core->id_set;
    const uint16_t topology = core->topology;
    if ((agv_config_checksum(&core->config) != core->config_checksum) ||
        (agv_config_check(&core->config).problem != AGV_CONFIG_OK)) {
        agv_core_built_in_config(&core->config, id_set, topology);
    }
    agv_core_begin(core, true, true, true);
}
