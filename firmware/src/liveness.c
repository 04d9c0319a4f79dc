#include "agv/liveness.h"

#define ALL_MESSAGES ((uint16_t)((1u << (uint32_t)AGV_MSG_COUNT) - 1u))

static const uint8_t heartbeat_message[AGV_NODE_COUNT] = {AGV_MSG_VEHICLE_STATUS, AGV_MSG_STEERING_STATUS,
                                                          AGV_MSG_TURN_SIGNAL_COMMAND};

static uint16_t bit_of(agv_message_t message) {
    return (uint16_t)(1u << (uint32_t)message);
}

/* Frames may be handed over late or stamped after the tick: what lies in the future has the age 0. */
static uint32_t age(uint32_t now_ms, uint32_t then_ms) {
    const uint32_t difference = now_ms - then_ms;
    return (difference > (UINT32_MAX / 2u)) ? 0u : difference;
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
    const bool known = ((liveness->heard & bit) != 0u) && ((liveness->recent & bit) != 0u);
    const uint32_t gap_ms = known ? age(time_ms, liveness->last_ms[message]) : AGV_AGE_MAX;
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
    if (!heartbeat->counter_known) {
        heartbeat->counter_known = true;
        heartbeat->counter = counter;
        if (heartbeat->state == AGV_HEARTBEAT_UNSEEN) {
            heartbeat->state = AGV_HEARTBEAT_BASELINE;
            /* The AI's deadline begins when it is first seen, the others' began at the start. */
            heartbeat->changed_ms = (node == AGV_NODE_AI) ? time_ms : heartbeat->changed_ms;
        }
    } else if (heartbeat->counter == counter) {
        heartbeat->repeated = true;
    } else {
        heartbeat->counter = counter;
        heartbeat->repeated = false;
        heartbeat->changed_ms = time_ms;
        heartbeat->state = AGV_HEARTBEAT_ALIVE;
    }
}

void agv_liveness_forget(agv_liveness_t *liveness, agv_node_t node) {
    liveness->heartbeats[node].state = AGV_HEARTBEAT_UNSEEN;
}

static void judge_message(agv_liveness_t *liveness, agv_message_t message, uint16_t timeout_ms, uint32_t now_ms) {
    if (age(now_ms, liveness->deadline_ms[message]) > timeout_ms) {
        liveness->expired |= bit_of(message);
    }
}

static void judge_messages(agv_liveness_t *liveness, const agv_config_t *config, uint32_t now_ms) {
    judge_message(liveness, AGV_MSG_GEAR_COMMAND, config->gear_command_timeout_ms, now_ms);
    judge_message(liveness, AGV_MSG_THROTTLE_COMMAND, config->throttle_command_timeout_ms, now_ms);
    judge_message(liveness, AGV_MSG_STEERING_COMMAND, config->steering_command_timeout_ms, now_ms);
    judge_message(liveness, AGV_MSG_GEAR_STATUS, config->gear_status_timeout_ms, now_ms);
    judge_message(liveness, AGV_MSG_THROTTLE_STATUS, config->throttle_status_timeout_ms, now_ms);
    judge_message(liveness, AGV_MSG_EPS_STATUS, config->eps_status_timeout_ms, now_ms);
    judge_message(liveness, AGV_MSG_STEERING_POSITION, config->steering_position_timeout_ms, now_ms);
    judge_message(liveness, AGV_MSG_WHEEL_SPEED, config->wheel_speed_timeout_ms, now_ms);
}

static void judge_heartbeat(agv_liveness_t *liveness, agv_node_t node, uint16_t timeout_ms, uint32_t now_ms) {
    agv_heartbeat_t *heartbeat = &liveness->heartbeats[node];
    const agv_message_t message = (agv_message_t)heartbeat_message[node];
    const bool awaited = (node != AGV_NODE_AI) || (heartbeat->state != AGV_HEARTBEAT_UNSEEN);
    const bool running = (heartbeat->state != AGV_HEARTBEAT_LOST) && (heartbeat->state != AGV_HEARTBEAT_STUCK);
    if (awaited && running && (age(now_ms, heartbeat->changed_ms) > timeout_ms)) {
        const uint32_t two_cycles_ms = 2u * agv_message_cycle_ms(message);
        const bool stuck = heartbeat->repeated && (agv_liveness_age_ms(liveness, message, now_ms) <= two_cycles_ms);
        heartbeat->state = stuck ? AGV_HEARTBEAT_STUCK : AGV_HEARTBEAT_LOST;
    }
}

void agv_liveness_tick(agv_liveness_t *liveness, const agv_config_t *config, uint32_t now_ms) {
    for (uint32_t i = 0u; i < (uint32_t)AGV_MSG_COUNT; i++) {
        if (age(now_ms, liveness->last_ms[i]) > AGV_AGE_LIMIT_MS) {
            liveness->recent &= (uint16_t)~bit_of((agv_message_t)i);
        }
    }
    judge_messages(liveness, config, now_ms);
    judge_heartbeat(liveness, AGV_NODE_VCU, config->vcu_heartbeat_timeout_ms, now_ms);
    judge_heartbeat(liveness, AGV_NODE_EPS, config->eps_heartbeat_timeout_ms, now_ms);
    judge_heartbeat(liveness, AGV_NODE_AI, config->ai_heartbeat_timeout_ms, now_ms);
}

bool agv_liveness_fresh(const agv_liveness_t *liveness, agv_message_t message) {
    return (liveness->heard & (uint16_t)~liveness->expired & bit_of(message)) != 0u;
}

bool agv_liveness_expired(const agv_liveness_t *liveness, agv_message_t message) {
    return (liveness->expired & bit_of(message)) != 0u;
}

uint32_t agv_liveness_age_ms(const agv_liveness_t *liveness, agv_message_t message, uint32_t now_ms) {
    const bool recent = (liveness->recent & bit_of(message)) != 0u;
    return recent ? age(now_ms, liveness->last_ms[message]) : AGV_AGE_MAX;
}

agv_heartbeat_state_t agv_liveness_heartbeat(const agv_liveness_t *liveness, agv_node_t node) {
    return (agv_heartbeat_state_t)liveness->heartbeats[node].state;
}
