#include "observe/deadlines.h"

/* The fault of each deadline. Messages with an alive counter have none: their heartbeat has its own faults. */
static const uint8_t silences[AGV_MSG_COUNT] = {
#define AGV_COMMAND AGV_STATUS
#define AGV_STATUS(NAME, name, heading, table, cycle, deadline, fault, counter) [AGV_MSG_##NAME] = AGV_FAULT_##fault,
#include "agv/message_table.def"
#undef AGV_COMMAND
#undef AGV_STATUS
};

static const struct {
    uint8_t lost;
    uint8_t stuck;
} heartbeat_faults[AGV_NODE_COUNT] = {
    [AGV_NODE_VCU] = {.lost = AGV_FAULT_VCU_HEARTBEAT_LOST, .stuck = AGV_FAULT_VCU_HEARTBEAT_STUCK},
    [AGV_NODE_EPS] = {.lost = AGV_FAULT_EPS_HEARTBEAT_LOST, .stuck = AGV_FAULT_EPS_HEARTBEAT_STUCK},
    [AGV_NODE_AI] = {.lost = AGV_FAULT_AI_HEARTBEAT_LOST, .stuck = AGV_FAULT_AI_HEARTBEAT_STUCK}};

static void check_silences(agv_fault_monitor_t *faults, const agv_timers_t *timers, bool engaged) {
    for (uint32_t i = 0u; i < (uint32_t)AGV_MSG_COUNT; i++) {
        const bool counts = (i >= AGV_COMMAND_COUNT) || engaged;
        agv_fault_monitor_set(faults, silences[i],
                              counts && agv_timer_reached(timers, (uint32_t)AGV_TIMER_MESSAGE + i));
    }
}

void agv_deadlines_heartbeats(agv_fault_monitor_t *faults, const agv_timers_t *timers, const agv_liveness_t *liveness,
                              bool engaged) {
    const bool unseen = agv_liveness_heartbeat(liveness, AGV_NODE_AI) == AGV_HEARTBEAT_UNSEEN;
    /* The timer was started with the engagement, and runs on when the engagement is continued. */
    const bool never_seen = unseen && engaged && agv_timer_reached(timers, AGV_TIMER_AI_NEVER_SEEN);
    for (uint32_t node = 0u; node < (uint32_t)AGV_NODE_COUNT; node++) {
        const agv_heartbeat_state_t state = agv_liveness_heartbeat(liveness, (agv_node_t)node);
        const bool absent = never_seen && (node == (uint32_t)AGV_NODE_AI);
        agv_fault_monitor_set(faults, heartbeat_faults[node].lost, (state == AGV_HEARTBEAT_LOST) || absent);
        agv_fault_monitor_set(faults, heartbeat_faults[node].stuck, state == AGV_HEARTBEAT_STUCK);
    }
}

/* Whether the other set's identifier was received while the own one is silent (P1). */
static bool is_wrong_set(const agv_timers_t *timers, const agv_config_t *config, const agv_liveness_t *liveness,
                         uint32_t heard, uint32_t message) {
    return agv_timer_is_within(timers, heard) &&
           (agv_liveness_age_ms(liveness, timers, message) > config->wrong_id_set_ms);
}

void agv_deadlines_tick(agv_fault_monitor_t *faults, const agv_timers_t *timers, const agv_config_t *config,
                        const agv_liveness_t *liveness, bool engaged) {
    check_silences(faults, timers, engaged);
    agv_deadlines_heartbeats(faults, timers, liveness, engaged);
    agv_fault_monitor_set(
        faults, AGV_FAULT_WRONG_ID_SET,
        is_wrong_set(timers, config, liveness, AGV_TIMER_OTHER_TURN_SIGNAL, AGV_MSG_TURN_SIGNAL_COMMAND) ||
            is_wrong_set(timers, config, liveness, AGV_TIMER_OTHER_VEHICLE_STATUS, AGV_MSG_VEHICLE_STATUS));
}

void agv_deadlines_other_id_set(agv_timers_t *timers, uint32_t message) {
    agv_timer_start(timers, (message == (uint32_t)AGV_MSG_TURN_SIGNAL_COMMAND) ? AGV_TIMER_OTHER_TURN_SIGNAL
                                                                               : AGV_TIMER_OTHER_VEHICLE_STATUS);
}

void agv_deadlines_forget_ai(agv_fault_monitor_t *faults) {
    agv_fault_monitor_set(faults, heartbeat_faults[AGV_NODE_AI].lost, false);
    agv_fault_monitor_set(faults, heartbeat_faults[AGV_NODE_AI].stuck, false);
}

bool agv_deadlines_messages_fresh(const agv_liveness_t *liveness, const agv_timers_t *timers,
                                  const agv_config_t *config) {
    bool fresh = true;
    for (uint32_t i = AGV_COMMAND_COUNT; i < (uint32_t)AGV_MSG_COUNT; i++) {
        if (!agv_liveness_fresh(liveness, timers, i) && agv_config_is_trip(config, silences[i])) {
            fresh = false;
        }
    }
    return fresh;
}
