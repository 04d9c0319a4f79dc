#include "agv/liveness.h"

#include "agv/core.h"

static const uint8_t heartbeat_message[AGV_NODE_COUNT] = {AGV_MSG_VEHICLE_STATUS, AGV_MSG_STEERING_STATUS,
                                                          AGV_MSG_TURN_SIGNAL_COMMAND};

void agv_liveness_start(agv_core_t *core) {
    for (uint32_t i = 0u; i < (uint32_t)AGV_MSG_COUNT; i++) {
        core->liveness.messages[i].last_ms = core->now_ms;
        core->liveness.messages[i].deadline_ms = core->now_ms;
    }
    for (uint32_t i = 0u; i < (uint32_t)AGV_NODE_COUNT; i++) {
        core->liveness.heartbeats[i].changed_ms = core->now_ms;
    }
}

uint32_t agv_liveness_arrived(agv_core_t *core, uint32_t message, uint32_t time_ms) {
    agv_message_age_t *const age = &core->liveness.messages[message];
    const bool known = age->heard && !age->old;
    const uint32_t gap_ms = known ? agv_age_ms(time_ms, age->last_ms) : AGV_AGE_MAX;
    age->last_ms = time_ms;
    age->heard = true;
    age->old = false;
    return gap_ms;
}

void agv_liveness_refresh(agv_core_t *core, uint32_t message, uint32_t time_ms) {
    core->liveness.messages[message].deadline_ms = time_ms;
    core->liveness.messages[message].expired = false;
}

void agv_liveness_beat(agv_core_t *core, agv_node_t node, uint8_t counter, uint32_t time_ms) {
    agv_heartbeat_t *const heartbeat = &core->liveness.heartbeats[node];
    const bool same = heartbeat->counter == counter;
    heartbeat->counter = counter;
    if (!heartbeat->counter_known) {
        heartbeat->counter_known = true;
        if (node != AGV_NODE_AI) {
            return; /* proves nothing */
        }
        /* The AI's deadline begins when it is first seen, the others' began at the start. */
        heartbeat->state = AGV_HEARTBEAT_BASELINE;
    } else {
        heartbeat->repeated = same;
        if (same) {
            return;
        }
        heartbeat->state = AGV_HEARTBEAT_ALIVE;
    }
    heartbeat->changed_ms = time_ms;
}

bool agv_liveness_judge(agv_core_t *core, uint32_t message, uint32_t timeout_ms) {
    agv_message_age_t *const age = &core->liveness.messages[message];
    if (agv_age_ms(core->now_ms, age->last_ms) > AGV_AGE_LIMIT_MS) {
        age->old = true;
    }
    if (agv_age_ms(core->now_ms, age->deadline_ms) > timeout_ms) {
        age->expired = true;
    }
    return age->expired;
}

agv_heartbeat_state_t agv_liveness_judge_beat(agv_core_t *core, uint32_t node, uint32_t timeout_ms) {
    agv_heartbeat_t *const heartbeat = &core->liveness.heartbeats[node];
    const agv_message_t message = (agv_message_t)heartbeat_message[node];
    const bool awaited = (node != (uint32_t)AGV_NODE_AI) || (heartbeat->state != (uint8_t)AGV_HEARTBEAT_UNSEEN);
    const bool running = heartbeat->state <= (uint8_t)AGV_HEARTBEAT_ALIVE;
    if (awaited && running && (agv_age_ms(core->now_ms, heartbeat->changed_ms) > timeout_ms)) {
        const bool recent = agv_liveness_age_ms(core, message) <= (2u * (uint32_t)agv_message_cycle_ms(message));
        heartbeat->state = (uint8_t)((heartbeat->repeated && recent) ? AGV_HEARTBEAT_STUCK : AGV_HEARTBEAT_LOST);
    }
    return (agv_heartbeat_state_t)heartbeat->state;
}

bool agv_liveness_fresh(const agv_core_t *core, uint32_t message) {
    const agv_message_age_t *const age = &core->liveness.messages[message];
    return age->heard && !age->expired;
}

uint32_t agv_liveness_age_ms(const agv_core_t *core, uint32_t message) {
    const agv_message_age_t *const age = &core->liveness.messages[message];
    return age->old ? AGV_AGE_MAX : agv_age_ms(core->now_ms, age->last_ms);
}
