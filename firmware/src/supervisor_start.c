#include <stddef.h>
#include <string.h>

#include "agv/codec.h"
#include "agv/gate.h"
#include "agv/latch.h"
#include "hal/reset.h"
#include "hal/safety_output.h"
#include "supervisor_internal.h"

/*
 * Codec and gate against each other: the P that the codec knows is what the gate, in raw bytes, lets out; D is not.
 * Returns what was found wrong.
 */
static uint32_t self_test(const agv_config_t *config) {
    const agv_gate_t tripped = {.config = config, .state = AGV_STATE_TRIPPED};
    hal_can_frame_t frame = {.id = 0x168u, .length = AGV_DLC, .data = {AGV_GEAR_P}};
    if (!agv_value_is_valid(AGV_MSG_GEAR_COMMAND, frame.data) || /* GCOVR_EXCL_BR_LINE: P is known */
        !agv_gate_allows(&tripped, HAL_CAN_VEHICLE, &frame)) {   /* GCOVR_EXCL_BR_LINE: and passes */
        return AGV_FOUND_SELF_TEST_FAILED;                       /* GCOVR_EXCL_LINE: never here */
    }
    frame.data[0] = AGV_GEAR_D;
    return agv_gate_allows(&tripped, HAL_CAN_VEHICLE, &frame) ? AGV_FOUND_SELF_TEST_FAILED
                                                              : 0u; /* GCOVR_EXCL_BR_LINE: D never passes here */
}

static void begin_modules(agv_core_t *core) {
    const size_t anew = offsetof(agv_core_t, led);
    (void)memset(core, 0, offsetof(agv_core_t, hal));
    (void)memset(&((unsigned char *)core)[anew], 0, sizeof *core - anew);
    core->last_tick_ms = core->now_ms;
    core->config_checksum = agv_config_checksum(&core->config);
    agv_core_keep_wiring(core);
    agv_monitor_start(core);
    agv_transmitter_start(core);
    agv_watch_start(core, AGV_WATCH_UNFED);
    agv_bus_start(core, HAL_CAN_VEHICLE);
    agv_bus_start(core, HAL_CAN_AI);
}

/* The latch outlives a reset (FSM-7). Returns the reason that an earlier run was tripped for; AGV_FAULT_NONE. */
static uint32_t begin_from_latch(agv_core_t *core, bool restarted) {
    agv_latch_t latch;
    const agv_latch_found_t found = agv_latch_read(core->hal, &latch);
    if (found == AGV_LATCH_CORRUPT) {
        agv_faults_event(core, AGV_FAULT_STORE_INVALID);
    }
    if ((found != AGV_LATCH_VALID) || !restarted) {
        return AGV_FAULT_NONE;
    }
    agv_faults_level(core, latch.unresettable, true);
    return (latch.first_reason < (uint8_t)AGV_FAULT_COUNT) ? latch.first_reason : (uint32_t)AGV_FAULT_NONE;
}

/* The highest-ranking active fault down to SUPERVISOR_RESET; AGV_FAULT_NONE when there is none. */
static uint32_t first_active(const agv_core_t *core) {
    for (uint32_t fault = 0u; fault <= (uint32_t)AGV_FAULT_SUPERVISOR_RESET; fault++) {
        if (agv_faults_is_active(core, fault)) {
            return fault;
        }
    }
    return AGV_FAULT_NONE;
}

/* INIT, or TRIPPED when an earlier run was or when something found now is reason enough. */
static void begin_state(agv_core_t *core, uint32_t kept_reason) {
    const uint32_t found = first_active(core);
    agv_state_machine_start(core, (kept_reason != (uint32_t)AGV_FAULT_NONE) ? kept_reason : found);
    core->machine.park_released = core->config.park == (uint16_t)AGV_PARK_AT_ONCE;
    agv_core_record(core, AGV_EVENT_STATE, 0u, core->machine.state, core->machine.first_reason);
    agv_core_record(core, AGV_EVENT_OUTPUT, 0u, 0u, 0u);
    if (kept_reason != (uint32_t)AGV_FAULT_NONE) {
        core->faults.marks[kept_reason] |= AGV_MARK_LATCHED;
    }
    core->summary.changed = true;
    agv_core_report_faults(core);
    core->machine.unresettable = core->summary.forever;
}

static void raise_found(agv_core_t *core, uint32_t found) {
    for (uint32_t fault = 0u; (found >> fault) != 0u; fault++) {
        agv_faults_level(core, fault, ((found >> fault) & 1u) != 0u);
    }
}

void agv_core_begin(agv_core_t *core, uint32_t found) {
    const bool corrupted = (found & AGV_FOUND_CORRUPTED) != 0u;
    const bool restarted = corrupted || (hal_reset_cause(core->hal) != HAL_RESET_POWER_ON);
    hal_safety_output_set(core->hal, false);
    begin_modules(core);
    raise_found(core, found | self_test(&core->config));
    const uint32_t kept_reason = begin_from_latch(core, restarted);
    if (restarted && !corrupted && (kept_reason == (uint32_t)AGV_FAULT_NONE)) {
        agv_faults_event(core, AGV_FAULT_SUPERVISOR_RESET);
    }
    begin_state(core, kept_reason);
    agv_core_store_latch(core);
    hal_can_purge(core->hal, HAL_CAN_VEHICLE);
    agv_transmitter_burst(core);
    agv_core_show_led(core, 0u);
}

void agv_core_keep_wiring(agv_core_t *core) {
    core->id_set = core->config.id_set;
    core->topology = core->config.topology;
}

bool agv_core_check_config(agv_core_t *core, bool intact) {
    agv_config_t *const config = &core->config;
    const bool stands = intact && (agv_config_check(config).problem == AGV_CONFIG_OK);
    if (!stands) {
        agv_config_defaults(config);
        config->id_set = (core->id_set == (uint16_t)AGV_ID_SET_TABLE) ? (uint16_t)AGV_ID_SET_TABLE : config->id_set;
        config->topology = (core->topology == (uint16_t)AGV_TOPOLOGY_GATEWAY) ? AGV_TOPOLOGY_GATEWAY : config->topology;
    }
    return stands;
}

void agv_core_begin_corrupted(agv_core_t *core) {
    (void)agv_core_check_config(core, agv_config_checksum(&core->config) == core->config_checksum);
    agv_core_begin(core, AGV_FOUND_CORRUPTED);
}
