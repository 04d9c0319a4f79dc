#include "agv/supervisor.h"

#include <string.h>

#include "agv/checksum.h"
#include "supervisor/supervisor_internal.h"

/* Every call begins with a check of the whole memory (INT-5). */
static agv_core_t *open_core(agv_supervisor_t *supervisor, const agv_ports_t *ports, uint32_t time_ms,
                             uint32_t time_us) {
    agv_core_t *const core = agv_core_of(supervisor);
    const bool intact = (supervisor->seal == agv_seal(supervisor->memory, sizeof supervisor->memory)) &&
                        agv_state_machine_is_sound(&core->machine);
    if (intact) {
        agv_timers_advance(&core->timers, &core->config, time_ms, time_us);
    } else {
        agv_timers_set_time(&core->timers, time_ms);
        agv_core_begin_corrupted(core, ports);
    }
    return core;
}

static void close_core(agv_supervisor_t *supervisor) {
    supervisor->seal = agv_seal(supervisor->memory, sizeof supervisor->memory);
}

void agv_supervisor_start(agv_supervisor_t *supervisor, const agv_ports_t *ports, const agv_config_t *config,
                          uint32_t now_ms) {
    agv_core_t *const core = agv_core_of(supervisor);
    uint32_t found = 0u;
    (void)memset(supervisor->memory, 0, sizeof supervisor->memory);
    agv_timers_set_time(&core->timers, now_ms);
    core->config = *config;
    agv_core_keep_wiring(core);
    if (!agv_core_check_config(core, true)) {
        found |= AGV_FOUND_CONFIG_INVALID;
    }
    agv_recorder_start(ports->recorder);
    agv_core_begin(core, ports, found);
    close_core(supervisor);
}

void agv_supervisor_frame(agv_supervisor_t *supervisor, const agv_ports_t *ports, hal_can_side_t side,
                          const hal_can_frame_t *frame) {
    agv_core_t *const core = open_core(supervisor, ports, frame->time_ms, frame->time_us);
    agv_core_frame(core, ports, side, frame);
    close_core(supervisor);
}

void agv_supervisor_tick(agv_supervisor_t *supervisor, const agv_ports_t *ports, uint32_t now_ms) {
    agv_core_t *const core = open_core(supervisor, ports, now_ms, 0u);
    agv_core_tick(core, ports, supervisor->receive_alive);
    supervisor->receive_alive = false;
    close_core(supervisor);
}

void agv_supervisor_receive_alive(agv_supervisor_t *supervisor) {
    supervisor->receive_alive = true;
}
