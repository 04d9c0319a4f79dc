#include "agv/codec.h"
#include "agv/latch.h"
#include "hal/led.h"
#include "hal/reset.h"
#include "hal/safety_output.h"
#include "supervisor_internal.h"

#include <string.h>

/* Known answers: the codec packs what the document says, the gate lets P out and D not. */
static bool self_test(void) {
    static const uint8_t centre[AGV_DLC] = {0x28u, 0x23u}; /* 9000 */
    const agv_steering_command_t straight = {.angle_ddeg = 0};
    const agv_gate_t tripped = {.state = AGV_STATE_TRIPPED};
    const hal_can_frame_t park = {.id = 0x168u, .length = AGV_DLC, .data = {8u}};
    const hal_can_frame_t drive = {.id = 0x168u, .length = AGV_DLC, .data = {1u}};
    uint8_t data[AGV_DLC];
    return agv_pack_steering_command(data, &straight) && (memcmp(data, centre, AGV_DLC) == 0) &&
           agv_gate_allows(&tripped, HAL_CAN_VEHICLE, &park) && !agv_gate_allows(&tripped, HAL_CAN_VEHICLE, &drive);
}

/* What the start itself finds: faults to begin with, and the reason that an earlier run was tripped for. */
typedef struct {
    agv_fault_set_t causes;
    agv_fault_t kept_reason;
    bool restarted;
    bool store_invalid;
} findings_t;

static void look_at_latch(findings_t *findings, const agv_ports_t *ports) {
    agv_latch_t latch;
    const agv_latch_found_t found = agv_latch_read(ports->hal, &latch);
    findings->store_invalid = found == AGV_LATCH_CORRUPT;
    if ((found == AGV_LATCH_VALID) && findings->restarted) {
        findings->causes |= agv_fault_bit((agv_fault_t)latch.unresettable);
        if ((latch.latched != (uint8_t)AGV_LATCH_OPEN) && (latch.first_reason < (uint8_t)AGV_FAULT_COUNT)) {
            findings->kept_reason = (agv_fault_t)latch.first_reason;
        }
    }
}

static findings_t look_around(const agv_ports_t *ports, bool config_valid, bool self_test_passed, bool corrupted) {
    const bool power_on = hal_reset_cause(ports->hal) == HAL_RESET_POWER_ON;
    findings_t findings = {.kept_reason = AGV_FAULT_NONE, .restarted = !power_on || corrupted};
    look_at_latch(&findings, ports);
    findings.causes |= agv_fault_when(!config_valid, AGV_FAULT_CONFIG_INVALID) |
                       agv_fault_when(!self_test_passed || !self_test(), AGV_FAULT_SELF_TEST_FAILED) |
                       agv_fault_when(corrupted, AGV_FAULT_MEMORY_CORRUPTED);
    if (findings.restarted && !corrupted && (findings.kept_reason == AGV_FAULT_NONE)) {
        findings.causes |= agv_fault_bit(AGV_FAULT_SUPERVISOR_RESET);
    }
    return findings;
}

static void begin_faults(agv_core_t *core, const findings_t *findings) {
    agv_faults_t *faults = &core->monitor.faults;
    agv_faults_levels(faults, agv_faults_unresettable, findings->causes);
    if ((findings->causes & agv_fault_bit(AGV_FAULT_SUPERVISOR_RESET)) != 0u) {
        agv_faults_event(faults, AGV_FAULT_SUPERVISOR_RESET, core->now_ms);
    }
    if (findings->store_invalid) {
        agv_faults_event(faults, AGV_FAULT_STORE_INVALID, core->now_ms);
    }
    faults->latched = findings->causes | agv_fault_bit(findings->kept_reason);
}

static void begin_modules(agv_core_t *core, const agv_ports_t *ports) {
    hal_can_status_t status;
    agv_monitor_start(&core->monitor, core->now_ms);
    agv_transmitter_start(&core->transmitter, core->now_ms);
    agv_timer_start(&core->unfed, core->now_ms);
    for (uint32_t side = 0u; side < (uint32_t)HAL_CAN_SIDES; side++) {
        hal_can_status(ports->hal, (hal_can_side_t)side, &status);
        agv_bus_start(&core->buses[side], &status);
    }
}

static void begin_state(agv_core_t *core, const findings_t *findings) {
    const agv_fault_t found = agv_fault_highest(findings->causes);
    const agv_fault_t reason = (findings->kept_reason != AGV_FAULT_NONE) ? findings->kept_reason : found;
    agv_state_machine_start(&core->machine, reason, core->now_ms);
    core->machine.unresettable = (uint8_t)agv_fault_highest(findings->causes & agv_faults_unresettable);
    core->machine.park_released = core->config.park == (uint16_t)AGV_PARK_AT_ONCE;
}

static void announce(agv_core_t *core, const agv_ports_t *ports) {
    const agv_event_t state = {.kind = AGV_EVENT_STATE, .b = core->machine.state, .c = core->machine.first_reason};
    const agv_event_t output = {.kind = AGV_EVENT_OUTPUT};
    hal_safety_output_set(ports->hal, false);
    agv_core_record(core, ports, &state);
    agv_core_record(core, ports, &output);
    (void)agv_core_report_faults(core, ports);
    agv_core_store_latch(core, ports);
}

static void send_first(agv_core_t *core, const agv_ports_t *ports) {
    agv_outlet_t outlet = agv_core_outlet(core, ports);
    hal_can_purge(ports->hal, HAL_CAN_VEHICLE);
    agv_transmitter_burst(&core->transmitter, &outlet);
    agv_core_after_sending(core, ports, &outlet);
}

static void show_led(agv_core_t *core, const agv_ports_t *ports) {
    const agv_faults_t *faults = &core->monitor.faults;
    const int8_t code = agv_led_code(faults->tripping | faults->latched, faults->active);
    (void)agv_led_tick(&core->led, code, core->config.shadow == (uint16_t)AGV_SHADOW_ON, 0u);
    hal_led_set(ports->hal, core->led.on);
}

/* core->config and core->now_ms stand; everything else begins. */
static void begin(agv_core_t *core, const agv_ports_t *ports, const findings_t *findings) {
    core->last_tick_ms = core->now_ms;
    core->config_checksum = agv_config_checksum(&core->config);
    core->id_set = (uint8_t)core->config.id_set;
    core->topology = (uint8_t)core->config.topology;
    begin_modules(core, ports);
    begin_faults(core, findings);
    begin_state(core, findings);
    announce(core, ports);
    send_first(core, ports);
    show_led(core, ports);
}

/* The defaults, but on the identifiers and the wiring that this vehicle has, if they are known. */
static agv_config_t built_in_config(uint16_t id_set, uint16_t topology) {
    agv_config_t config;
    agv_config_defaults(&config);
    if (id_set == (uint16_t)AGV_ID_SET_TABLE) {
        config.id_set = id_set;
    }
    if (topology == (uint16_t)AGV_TOPOLOGY_GATEWAY) {
        config.topology = topology;
    }
    return config;
}

void agv_core_start(agv_core_t *core, const agv_ports_t *ports, const agv_config_t *config, bool self_test_passed,
                    uint32_t now_ms) {
    const bool config_valid = agv_config_check(config).problem == AGV_CONFIG_OK;
    const findings_t findings = look_around(ports, config_valid, self_test_passed, false);
    (void)memset(core, 0, sizeof *core);
    core->config = config_valid ? *config : built_in_config(config->id_set, config->topology);
    core->now_ms = now_ms;
    agv_recorder_start(ports->recorder);
    begin(core, ports, &findings);
}

void agv_core_restart_corrupted(agv_core_t *core, const agv_ports_t *ports, uint32_t now_ms) {
    const agv_config_t config = core->config;
    const agv_counters_t counters = core->counters;
    const uint8_t alive_counter = core->transmitter.alive_counter;
    const uint16_t id_set = core->id_set;
    const uint16_t topology = core->topology;
    const bool config_valid =
        (agv_config_checksum(&config) == core->config_checksum) && (agv_config_check(&config).problem == AGV_CONFIG_OK);
    const findings_t findings = look_around(ports, true, true, true);
    (void)memset(core, 0, sizeof *core);
    core->config = config_valid ? config : built_in_config(id_set, topology);
    core->counters = counters;
    core->transmitter.alive_counter = alive_counter;
    core->now_ms = now_ms;
    begin(core, ports, &findings);
}
