#include "agv/liveness.h"

#include "agv/timer.h"

#define ALL_MESSAGES ((uint16_t)((1u << (uint32_t)AGV_MSG_COUNT) - 1u))

static const uint8_t heartbeat_message[AGV_NODE_COUNT] = {AGV_MSG_VEHICLE_STATUS, AGV_MSG_STEERING_STATUS,
                                                          AGV_MSG_TURN_SIGNAL_COMMAND};

static uint16_t bit_of(agv_message_t message) {
    return (uint16_t)(1u << (uint32_t)message);
}

void agv_liveness_start(agv_liveness_t *liveness, uint32_t now_ms) {
    *liveness = (agv_liveness_t){.recent = ALL_MESSAGES};
    for (uint32_t i = 0u; i < (uint32_t)AGV_MSG_COUNT; i++) {
        liveness->last_ms[i] = now_ms;
        liveness->deadline_ms[i] = now_ms;
    }
    for (uint32_t i = 0u; i < (uint32_t)AGV_NODE_COUNT; i++) {
        liveness->heartbeats[i].changed_ms = now_ms;
    }
}

uint32_t agv_liveness_arrived(agv_liveness_t *liveness, agv_message_t message, uint32_t time_ms) {
    const uint16_t bit = bit_of(message);
    const bool known = (liveness->heard & liveness->recent & bit) != 0u;
    const uint32_t gap_ms = known ? agv_age_ms(time_ms, liveness->last_ms[message]) : AGV_AGE_MAX;
    liveness->last_ms[message] = time_ms;
    liveness->heard |= bit;
    liveness->recent |= bit;
    return gap_ms;
}

void agv_liveness_refresh(agv_liveness_t *liveness, agv_message_t message, uint32_t time_ms) {
    liveness->deadline_ms[message] = time_ms;
    liveness->expired &= (uint16_t)~bit_of(message);
}

void agv_liveness_beat(agv_liveness_t *liveness, agv_node_t node, uint8_t counter, uint32_t time_ms) {
    agv_heartbeat_t *heartbeat = &liveness->heartbeats[node];
    const bool first = !heartbeat->counter_known;
    heartbeat->repeated = !first && (heartbeat->counter == counter);
    heartbeat->counter = counter;
    heartbeat->counter_known = true;
    if (!first && !heartbeat->repeated) {
        heartbeat->changed_ms = time_ms;
        heartbeat->state = AGV_HEARTBEAT_ALIVE;
    } else if (first && (node == AGV_NODE_AI)) {
        /* The AI's deadline begins when it is first seen, the others' began at the start. */
        heartbeat->changed_ms = time_ms;
        heartbeat->state = AGV_HEARTBEAT_BASELINE;
    } else {
        /* proves nothing */
    }
}

void agv_liveness_forget(agv_liveness_t *liveness, agv_node_t node) {
    liveness->heartbeats[node].state = AGV_HEARTBEAT_UNSEEN;
}

void agv_liveness_tick(agv_liveness_t *liveness, uint32_t now_ms) {
    for (uint32_t i = 0u; i < (uint32_t)AGV_MSG_COUNT; i++) {
        if (agv_age_ms(now_ms, liveness->last_ms[i]) > AGV_AGE_LIMIT_MS) {
            liveness->recent &= (uint16_t)~bit_of((agv_message_t)i);
        }
    }
}

bool agv_liveness_judge(agv_liveness_t *liveness, agv_message_t message, uint32_t now_ms, uint16_t timeout_ms) {
    const uint16_t bit = bit_of(message);
    if (agv_age_ms(now_ms, liveness->deadline_ms[message]) > timeout_ms) {
        liveness->expired |= bit;
    }
    return (liveness->expired & bit) != 0u;
}

void agv_liveness_judge_beat(agv_liveness_t *liveness, agv_node_t node, uint32_t now_ms, uint16_t timeout_ms) {
    agv_heartbeat_t *heartbeat = &liveness->heartbeats[node];
    const agv_message_t message = (agv_message_t)heartbeat_message[node];
    const bool awaited = (node != AGV_NODE_AI) || (heartbeat->state != (uint8_t)AGV_HEARTBEAT_UNSEEN);
    const bool running = heartbeat->state <= (uint8_t)AGV_HEARTBEAT_ALIVE;
    if (awaited && running && (agv_age_ms(now_ms, heartbeat->changed_ms) > timeout_ms)) {
        const uint32_t two_cycles_ms = 2u * (uint32_t)agv_message_cycle_ms(message);
        const bool stuck = heartbeat->repeated && (agv_liveness_age_ms(liveness, message, now_ms) <= two_cycles_ms);
        heartbeat->state = (uint8_t)(stuck ? AGV_HEARTBEAT_STUCK : AGV_HEARTBEAT_LOST);
    }
}

bool agv_liveness_heard(const agv_liveness_t *liveness, agv_message_t message) {
    return (liveness->heard & bit_of(message)) != 0u;
}

bool agv_liveness_fresh(const agv_liveness_t *liveness, agv_message_t message) {
    return (liveness->heard & (uint16_t)~liveness->expired & bit_of(message)) != 0u;
}

uint32_t agv_liveness_age_ms(const agv_liveness_t *liveness, agv_message_t message, uint32_t now_ms) {
    const bool recent = (liveness->recent & bit_of(message)) != 0u;
    return recent ? agv_age_ms(now_ms, liveness->last_ms[message]) : AGV_AGE_MAX;
}

agv_heartbeat_state_t agv_liveness_heartbeat(const agv_liveness_t *liveness, agv_node_t node) {
    return (agv_heartbeat_state_t)liveness->heartbeats[node].state;
}

bool agv_liveness_alive(const agv_liveness_t *liveness, agv_node_t node) {
    return agv_liveness_heartbeat(liveness, node) == AGV_HEARTBEAT_ALIVE;
}
