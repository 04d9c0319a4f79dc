#include "agv/watch.h"

#include "agv/core.h"

/* The setting that is the limit of each, in the order of agv_watch_t. */
static const uint8_t limits[AGV_WATCH_COUNT] = {AGV_SETTING_bus_off_recovery_ms,
                                                AGV_SETTING_bus_off_recovery_ms,
                                                AGV_SETTING_standstill_ms,
                                                AGV_SETTING_engaged_grace_ms,
                                                AGV_SETTING_steering_deviation_ms,
                                                AGV_SETTING_throttle_in_park_ms,
                                                AGV_SETTING_init_hold_ms,
                                                AGV_SETTING_reset_hold_ms,
                                                AGV_SETTING_reset_hold_ms,
                                                AGV_SETTING_park_timeout_ms,
                                                AGV_SETTING_event_hold_ms,
                                                AGV_SETTING_event_hold_ms,
                                                AGV_SETTING_event_hold_ms,
                                                AGV_SETTING_event_hold_ms,
                                                AGV_SETTING_event_hold_ms,
                                                AGV_SETTING_event_hold_ms,
                                                AGV_SETTING_event_hold_ms,
                                                AGV_SETTING_event_hold_ms,
                                                AGV_SETTING_watchdog_period_ms,
                                                AGV_SETTING_mode_invalid_ms,
                                                AGV_SETTING_ai_never_seen_timeout_ms,
                                                AGV_SETTING_wrong_id_set_ms,
                                                AGV_SETTING_wrong_id_set_ms,
                                                AGV_SETTING_startup_timeout_ms,
                                                AGV_SETTING_confirm_timeout_ms,
                                                AGV_SETTING_confirm_timeout_ms,
                                                AGV_SETTING_tx_stalled_ms,
                                                AGV_SETTING_tx_stalled_ms,
                                                AGV_SETTING_tx_stalled_ms,
                                                AGV_SETTING_tx_stalled_ms,
                                                AGV_SETTING_ai_heartbeat_timeout_ms,
                                                AGV_SETTING_gear_command_timeout_ms,
                                                AGV_SETTING_throttle_command_timeout_ms,
                                                AGV_SETTING_steering_command_timeout_ms,
                                                AGV_SETTING_vcu_heartbeat_timeout_ms,
                                                AGV_SETTING_gear_status_timeout_ms,
                                                AGV_SETTING_throttle_status_timeout_ms,
                                                AGV_SETTING_eps_heartbeat_timeout_ms,
                                                AGV_SETTING_eps_status_timeout_ms,
                                                AGV_SETTING_steering_position_timeout_ms,
                                                AGV_SETTING_wheel_speed_timeout_ms};

void agv_watch_start_at(agv_core_t *core, uint32_t watch, uint32_t since_ms) {
    agv_timer_start(&core->watches[watch], since_ms);
}

void agv_watch_start(agv_core_t *core, uint32_t watch) {
    agv_watch_start_at(core, watch, core->now_ms);
}

void agv_watch_stop(agv_core_t *core, uint32_t watch) {
    agv_timer_stop(&core->watches[watch]);
}

bool agv_watch_reached(agv_core_t *core, uint32_t watch) {
    const bool is_deadline = watch >= (uint32_t)AGV_WATCH_UNFED;
    const uint32_t limit_ms = agv_config_get(&core->config, limits[watch]);
    return agv_timer_reached(&core->watches[watch], core->now_ms, limit_ms + (is_deadline ? 1u : 0u));
}

bool agv_watch_while(agv_core_t *core, uint32_t watch, bool condition) {
    agv_timer_while(&core->watches[watch], condition, core->now_ms);
    return agv_watch_reached(core, watch);
}

bool agv_watch_runs(const agv_core_t *core, uint32_t watch) {
    return agv_timer_runs(&core->watches[watch]);
}
