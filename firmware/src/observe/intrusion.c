#include "observe/intrusion.h"

static bool is_silence(const agv_config_t *config, uint32_t command, uint32_t age_ms) {
    return age_ms > agv_timer_limit_ms(config, (uint32_t)AGV_TIMER_MESSAGE + command);
}

void agv_intrusion_command(agv_intrusion_t *intrusion, const agv_config_t *config, uint32_t command, uint32_t gap_ms) {
    agv_score_t *const score = &intrusion->fast_gaps[command];
    const bool fast = gap_ms < ((agv_message_cycle_ms(command) + 1u) / 2u);
    if (is_silence(config, command, gap_ms)) {
        *score = (agv_score_t){0};
    } else {
        agv_score_add(score, fast, config->command_too_fast_gaps);
    }
}

void agv_intrusion_evaluate(agv_intrusion_t *intrusion, agv_fault_monitor_t *faults, const agv_timers_t *timers,
                            const agv_config_t *config, const agv_liveness_t *liveness) {
    bool too_fast = false;
    for (uint32_t i = 0u; i < AGV_COMMAND_COUNT; i++) {
        agv_score_t *const score = &intrusion->fast_gaps[i];
        if ((score->value != 0u) && is_silence(config, i, agv_liveness_age_ms(liveness, timers, i))) {
            *score = (agv_score_t){0};
        }
        too_fast = too_fast || score->present;
    }
    agv_fault_monitor_set(faults, AGV_FAULT_COMMAND_TOO_FAST, too_fast);
}
