#include "traffic/watch.h"

#include "common/message_facts.h"
#include "text/units.h"

void watch_init(traffic_watch_t *watch, const agv_config_t *config, uint32_t message) {
    const bool is_command = (message < AGV_COMMAND_COUNT) && (message != AGV_MSG_TURN_SIGNAL_COMMAND);
    watch->when = is_command ? TRAFFIC_ENGAGED : TRAFFIC_ALWAYS;
    watch->setting = message_deadline_setting(message);
    watch->deadline_ms = agv_config_get(config, watch->setting);
}

static void add_gap(traffic_watch_t *watch, uint64_t gap_us) {
    const uint64_t deadline_us = (uint64_t)watch->deadline_ms * US_PER_MS;
    gaps_add(&watch->gaps, watch->since_us, gap_us);
    if (gap_us > deadline_us) {
        watch->late_at_us = (watch->late == 0) ? watch->since_us + deadline_us : watch->late_at_us;
        watch->late++;
    }
}

void watch_restart(traffic_watch_t *watch, uint64_t t_us) {
    if (watch->is_running) {
        add_gap(watch, t_us - watch->since_us);
    }
    watch->is_running = watch->is_running || (watch->when == TRAFFIC_ALWAYS);
    watch->since_us = t_us;
}

void watch_start(traffic_watch_t *watch, uint64_t t_us) {
    watch->is_running = true;
    watch->since_us = t_us;
}

void watch_resume(traffic_watch_t *watch, uint64_t began_us) {
    watch_start(watch, (watch->since_us > began_us) ? watch->since_us : began_us);
}

void watch_stop(traffic_watch_t *watch, uint64_t t_us) {
    if (watch->is_running && (t_us - watch->since_us > (uint64_t)watch->deadline_ms * US_PER_MS)) {
        add_gap(watch, t_us - watch->since_us);
    }
    watch->is_running = false;
}
