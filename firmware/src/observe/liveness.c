#include "observe/liveness.h"

/* The message that carries a heartbeat, by node. */
static const uint8_t carriers[AGV_NODE_COUNT] = {[AGV_NODE_VCU] = AGV_MSG_VEHICLE_STATUS,
                                                 [AGV_NODE_EPS] = AGV_MSG_STEERING_STATUS,
                                                 [AGV_NODE_AI] = AGV_MSG_TURN_SIGNAL_COMMAND};

/* The index of the alive counter in data[] of each message. */
enum { NO_COUNTER = 0xFF };
static const uint8_t counters_at[AGV_MSG_COUNT] = {
#define AGV_COMMAND AGV_STATUS
#define AGV_STATUS(NAME, name, heading, table, cycle, deadline, fault, counter) [AGV_MSG_##NAME] = (counter),
#include "agv/message_table.def"
#undef AGV_COMMAND
#undef AGV_STATUS
};

static bool has(uint32_t set, uint32_t message) {
    return ((set >> message) & 1u) != 0u;
}

static uint32_t deadline_of(uint32_t message) {
    return (uint32_t)AGV_TIMER_MESSAGE + message;
}

void agv_liveness_start(agv_liveness_t *liveness, agv_timers_t *timers) {
    for (uint32_t i = 0u; i < (uint32_t)AGV_MSG_COUNT; i++) {
        liveness->last_ms[i] = timers->now_ms;
        agv_timer_start(timers, deadline_of(i));
    }
    agv_timer_stop(timers, deadline_of(AGV_MSG_TURN_SIGNAL_COMMAND));
}

uint32_t agv_liveness_arrived(agv_liveness_t *liveness, uint32_t message, uint32_t time_ms) {
    const uint32_t last_ms = liveness->last_ms[message];
    const bool known = has(liveness->heard, message) && !has(liveness->old, message);
    liveness->last_ms[message] = time_ms;
    liveness->heard |= (uint16_t)agv_message_bit(message);
    liveness->old &= (uint16_t)~agv_message_bit(message);
    return known ? agv_age_ms(time_ms, last_ms) : AGV_AGE_MAX;
}

/* Valid steps of an incrementing alive counter: up to two frames may be lost in between (SUP-2). */
enum { STEP_MAX = 3, STEPS_AFTER_WRONG = 2 };

/* Whether a counter counts as changed. */
static bool is_changed(agv_heartbeat_t *heartbeat, uint8_t counter, bool increments) {
    const uint32_t step = ((uint32_t)counter - heartbeat->counter) & 0xFFu;
    if (!increments) {
        return step != 0u;
    }
    if ((step == 0u) || (step > (uint32_t)STEP_MAX)) {
        heartbeat->steps_needed = STEPS_AFTER_WRONG;
        return false;
    }
    if (heartbeat->steps_needed > 0u) {
        heartbeat->steps_needed--;
    }
    return heartbeat->steps_needed == 0u;
}

/* Handle an alive counter. Returns whether the deadline is restarted. */
static bool evaluate_counter(agv_liveness_t *liveness, uint32_t node, uint8_t counter, bool increments) {
    agv_heartbeat_t *const heartbeat = &liveness->heartbeats[node];
    if (!heartbeat->counter_known) {
        heartbeat->counter_known = true;
        heartbeat->counter = counter;
        if (node != (uint32_t)AGV_NODE_AI) {
            return false; /* one value alone does not show life */
        }
        /* The AI's deadline begins with its first frame; the others began at the start. */
        heartbeat->state = AGV_HEARTBEAT_BASELINE;
        return true;
    }
    const bool changed = is_changed(heartbeat, counter, increments);
    heartbeat->counter = counter;
    heartbeat->repeated = !changed;
    if (changed) {
        heartbeat->state = AGV_HEARTBEAT_ALIVE;
    }
    return changed;
}

static bool counter_must_increment(const agv_config_t *config, uint32_t node) {
    const uint16_t choices[AGV_NODE_COUNT] = {
        [AGV_NODE_VCU] = config->vcu_counter, [AGV_NODE_EPS] = config->eps_counter, [AGV_NODE_AI] = config->ai_counter};
    return choices[node] == (uint16_t)AGV_COUNTER_INCREMENTS;
}

/* The node whose heartbeat a message with an alive counter carries. */
static uint32_t node_of(uint32_t message) {
    if (message == (uint32_t)AGV_MSG_VEHICLE_STATUS) {
        return AGV_NODE_VCU;
    }
    return (message == (uint32_t)AGV_MSG_STEERING_STATUS) ? AGV_NODE_EPS : AGV_NODE_AI;
}

void agv_liveness_refresh(agv_liveness_t *liveness, agv_timers_t *timers, const agv_config_t *config, uint32_t message,
                          const hal_can_frame_t *frame) {
    const uint32_t at = counters_at[message];
    const uint32_t node = node_of(message);
    if ((at == (uint32_t)NO_COUNTER) ||
        evaluate_counter(liveness, node, frame->data[at], counter_must_increment(config, node))) {
        agv_timer_start_at(timers, deadline_of(message), frame->time_ms);
    }
}

void agv_liveness_restart_commands(agv_timers_t *timers, uint32_t time_ms) {
    for (uint32_t command = AGV_MSG_GEAR_COMMAND; command < AGV_COMMAND_COUNT; command++) {
        agv_timer_start_at(timers, deadline_of(command), time_ms);
    }
}

void agv_liveness_forget_ai(agv_liveness_t *liveness) {
    agv_heartbeat_t *const heartbeat = &liveness->heartbeats[AGV_NODE_AI];
    if (heartbeat->state != (uint8_t)AGV_HEARTBEAT_UNSEEN) {
        heartbeat->state = AGV_HEARTBEAT_FORGOTTEN;
    }
}

static void expire(agv_liveness_t *liveness, const agv_timers_t *timers, uint32_t node, bool engaged) {
    agv_heartbeat_t *const heartbeat = &liveness->heartbeats[node];
    const uint32_t message = carriers[node];
    const bool running = (heartbeat->state <= (uint8_t)AGV_HEARTBEAT_ALIVE) ||
                         ((heartbeat->state == (uint8_t)AGV_HEARTBEAT_FORGOTTEN) && engaged);
    if (running && agv_timer_reached(timers, deadline_of(message))) {
        const uint32_t age_ms = agv_liveness_age_ms(liveness, timers, message);
        const bool recent = age_ms <= (2u * agv_message_cycle_ms(message));
        heartbeat->state = (uint8_t)((heartbeat->repeated && recent) ? AGV_HEARTBEAT_STUCK : AGV_HEARTBEAT_LOST);
    }
}

/* Saturate the age of one message per tick. Each is checked long before the time wraps. */
static void age_one(agv_liveness_t *liveness, const agv_timers_t *timers) {
    const uint32_t next = liveness->next_to_age;
    if (agv_age_ms(timers->now_ms, liveness->last_ms[next]) > AGV_AGE_LIMIT_MS) {
        liveness->old |= (uint16_t)agv_message_bit(next);
    }
    liveness->next_to_age = (uint8_t)((next + 1u) % (uint32_t)AGV_MSG_COUNT);
}

void agv_liveness_tick(agv_liveness_t *liveness, const agv_timers_t *timers, bool engaged) {
    age_one(liveness, timers);
    for (uint32_t node = 0u; node < (uint32_t)AGV_NODE_COUNT; node++) {
        expire(liveness, timers, node, engaged);
    }
}

agv_heartbeat_state_t agv_liveness_heartbeat(const agv_liveness_t *liveness, agv_node_t node) {
    return (agv_heartbeat_state_t)liveness->heartbeats[node].state;
}

bool agv_liveness_alive(const agv_liveness_t *liveness, agv_node_t node) {
    return liveness->heartbeats[node].state == (uint8_t)AGV_HEARTBEAT_ALIVE;
}

bool agv_liveness_fresh(const agv_liveness_t *liveness, const agv_timers_t *timers, uint32_t message) {
    return has(liveness->heard, message) && agv_timer_is_within(timers, deadline_of(message));
}

uint32_t agv_liveness_age_ms(const agv_liveness_t *liveness, const agv_timers_t *timers, uint32_t message) {
    return has(liveness->old, message) ? AGV_AGE_MAX : agv_age_ms(timers->now_ms, liveness->last_ms[message]);
}
