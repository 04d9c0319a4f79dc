#include "agv/liveness.h"

#include "agv/core.h"

/* In the order of agv_node_t: the message, and which of its bytes is the alive counter. */
static const struct {
    uint8_t message;
    uint8_t counter_at;
} carriers[AGV_NODE_COUNT] = {
    {AGV_MSG_VEHICLE_STATUS, 7u}, {AGV_MSG_STEERING_STATUS, 0u}, {AGV_MSG_TURN_SIGNAL_COMMAND, 7u}};

static uint32_t deadline_of(uint32_t message) {
    return (uint32_t)AGV_WATCH_MESSAGE + message;
}

void agv_liveness_start(agv_core_t *core) {
    for (uint32_t i = 0u; i < (uint32_t)AGV_MSG_COUNT; i++) {
        core->liveness.last_ms[i] = core->now_ms;
        agv_watch_start(core, deadline_of(i));
    }
    agv_watch_stop(core, deadline_of(AGV_MSG_TURN_SIGNAL_COMMAND));
}

uint32_t agv_liveness_arrived(agv_core_t *core, uint32_t message, uint32_t time_ms) {
    agv_liveness_t *const liveness = &core->liveness;
    const uint32_t last_ms = liveness->last_ms[message];
    const bool known = liveness->seen[message] == AGV_SEEN_HEARD;
    liveness->last_ms[message] = time_ms;
    liveness->seen[message] = AGV_SEEN_HEARD;
    return known ? agv_age_ms(time_ms, last_ms) : AGV_AGE_MAX;
}

/* Returns whether the deadline begins anew. */
static bool beat(agv_core_t *core, uint32_t node, uint8_t counter) {
    agv_heartbeat_t *const heartbeat = &core->liveness.heartbeats[node];
    const bool same = heartbeat->counter == counter;
    heartbeat->counter = counter;
    if (!heartbeat->counter_known) {
        heartbeat->counter_known = true;
        if (node != (uint32_t)AGV_NODE_AI) {
            return false; /* proves nothing */
        }
        /* The AI's deadline begins when it is first seen, the others' began at the start. */
        heartbeat->state = AGV_HEARTBEAT_BASELINE;
        return true;
    }
    heartbeat->repeated = same;
    if (!same) {
        heartbeat->state = AGV_HEARTBEAT_ALIVE;
    }
    return !same;
}

void agv_liveness_refresh(agv_core_t *core, uint32_t message, const hal_can_frame_t *frame) {
    bool anew = true;
    for (uint32_t node = 0u; node < (uint32_t)AGV_NODE_COUNT; node++) {
        if (carriers[node].message == message) {
            anew = beat(core, node, frame->data[carriers[node].counter_at]);
        }
    }
    if (anew) {
        agv_watch_start_at(core, deadline_of(message), frame->time_ms);
    }
}

bool agv_liveness_judge(agv_core_t *core, uint32_t message) {
    if (agv_age_ms(core->now_ms, core->liveness.last_ms[message]) > AGV_AGE_LIMIT_MS) {
        core->liveness.seen[message] |= AGV_SEEN_OLD;
    }
    return agv_watch_reached(core, deadline_of(message));
}

agv_heartbeat_state_t agv_liveness_judge_beat(agv_core_t *core, uint32_t node) {
    agv_heartbeat_t *const heartbeat = &core->liveness.heartbeats[node];
    const uint32_t message = carriers[node].message;
    const bool running = heartbeat->state <= (uint8_t)AGV_HEARTBEAT_ALIVE;
    if (running && agv_watch_reached(core, deadline_of(message))) {
        const uint32_t age_ms = agv_age_ms(core->now_ms, core->liveness.last_ms[message]);
        const bool recent = age_ms <= (2u * agv_message_cycle_ms(message));
        heartbeat->state = (uint8_t)((heartbeat->repeated && recent) ? AGV_HEARTBEAT_STUCK : AGV_HEARTBEAT_LOST);
    }
    return (agv_heartbeat_state_t)heartbeat->state;
}

bool agv_liveness_fresh(const agv_core_t *core, uint32_t message) {
    return ((core->liveness.seen[message] & AGV_SEEN_HEARD) != 0u) && agv_watch_is_within(core, deadline_of(message));
}

uint32_t agv_liveness_age_ms(const agv_core_t *core, uint32_t message) {
    const bool old = (core->liveness.seen[message] & AGV_SEEN_OLD) != 0u;
    return old ? AGV_AGE_MAX : agv_age_ms(core->now_ms, core->liveness.last_ms[message]);
}
