#include "agv/codec.h"
#include "agv/monitor.h"

#define BIT(name) agv_fault_bit(AGV_FAULT_##name)
#define WHEN(condition, name) agv_fault_when((condition), AGV_FAULT_##name)

enum { OTHER_TURN_SIGNAL_COMMAND = 0, OTHER_VEHICLE_STATUS = 1 };

void agv_monitor_start(agv_monitor_t *monitor, uint32_t now_ms) {
    *monitor = (agv_monitor_t){0};
    agv_liveness_start(&monitor->liveness, now_ms);
}

void agv_monitor_other_id_set(agv_monitor_t *monitor, agv_message_t message, uint32_t stamp_ms) {
    const uint32_t which = (message == AGV_MSG_TURN_SIGNAL_COMMAND) ? OTHER_TURN_SIGNAL_COMMAND : OTHER_VEHICLE_STATUS;
    monitor->other_set_ms[which] = stamp_ms;
    monitor->other_set_recent |= (uint8_t)(1u << which);
}

void agv_monitor_steering_sent(agv_monitor_t *monitor, int16_t angle_ddeg) {
    monitor->vehicle.command_ddeg = angle_ddeg;
    monitor->vehicle.command_known = true;
}

void agv_monitor_forget_ai(agv_monitor_t *monitor) {
    agv_liveness_forget(&monitor->liveness, AGV_NODE_AI);
    monitor->ai_alarm_armed = false;
    agv_faults_levels(&monitor->faults, BIT(AI_HEARTBEAT_LOST) | BIT(AI_HEARTBEAT_STUCK), 0u);
}

static bool is_engaged(const agv_monitor_t *monitor) {
    return monitor->vehicle.mode == (uint8_t)AGV_MODE_ENGAGED;
}

bool agv_monitor_settled(agv_monitor_t *monitor, const agv_config_t *config, uint32_t now_ms) {
    return agv_timer_reached(&monitor->engaged, now_ms, config->engaged_grace_ms);
}

agv_fault_set_t agv_monitor_trip_classes(const agv_monitor_t *monitor, const agv_config_t *config) {
    const agv_fault_set_t heartbeat = BIT(AI_HEARTBEAT_LOST) | BIT(AI_HEARTBEAT_STUCK);
    const bool only_warns = !is_engaged(monitor) && (config->ai_lost_in_manual == (uint16_t)AGV_AI_LOST_WARN);
    return only_warns ? (config->trips & ~heartbeat) : config->trips;
}

bool agv_monitor_alive(const agv_monitor_t *monitor, agv_node_t node) {
    return agv_liveness_heartbeat(&monitor->liveness, node) == AGV_HEARTBEAT_ALIVE;
}

bool agv_monitor_messages_fresh(const agv_monitor_t *monitor, const agv_config_t *config) {
    static const struct {
        uint8_t message;
        uint8_t timeout;
    } rows[] = {{AGV_MSG_EPS_STATUS, AGV_FAULT_EPS_STATUS_TIMEOUT},
                {AGV_MSG_GEAR_STATUS, AGV_FAULT_GEAR_STATUS_TIMEOUT},
                {AGV_MSG_THROTTLE_STATUS, AGV_FAULT_THROTTLE_STATUS_TIMEOUT},
                {AGV_MSG_WHEEL_SPEED, AGV_FAULT_WHEEL_SPEED_TIMEOUT},
                {AGV_MSG_STEERING_POSITION, AGV_FAULT_STEERING_POSITION_TIMEOUT}};
    bool fresh = true;
    for (uint32_t i = 0u; i < (sizeof rows / sizeof rows[0]); i++) {
        const bool trips = (config->trips & agv_fault_bit((agv_fault_t)rows[i].timeout)) != 0u;
        if (trips && !agv_liveness_fresh(&monitor->liveness, (agv_message_t)rows[i].message)) {
            fresh = false;
        }
    }
    return fresh;
}

bool agv_monitor_standstill(agv_monitor_t *monitor, const agv_config_t *config, uint32_t now_ms) {
    return agv_timer_reached(&monitor->vehicle.slow, now_ms, config->standstill_ms);
}

bool agv_monitor_in_park(const agv_monitor_t *monitor) {
    return agv_liveness_fresh(&monitor->liveness, AGV_MSG_GEAR_STATUS) &&
           (monitor->vehicle.gear == (uint8_t)AGV_GEAR_P);
}

bool agv_monitor_autopilot_off(const agv_monitor_t *monitor) {
    const bool contradictory = monitor->vehicle.both_modes.phase != (uint8_t)AGV_TIMER_STOPPED;
    return agv_monitor_alive(monitor, AGV_NODE_VCU) && !is_engaged(monitor) && !contradictory;
}

bool agv_monitor_steering_holdable(const agv_monitor_t *monitor) {
    return agv_monitor_alive(monitor, AGV_NODE_EPS) && ((monitor->faults.active & agv_faults_of_eps) == 0u) &&
           agv_liveness_fresh(&monitor->liveness, AGV_MSG_EPS_STATUS) && monitor->vehicle.eps_in_angle_mode &&
           (monitor->vehicle.mode != (uint8_t)AGV_MODE_MANUAL);
}

/* Both mode bits for too long: the mode is none (SUP, MODE_INVALID). */
static agv_fault_set_t judge_mode(agv_monitor_t *monitor, const agv_config_t *config, uint32_t now_ms) {
    const bool invalid = agv_timer_exceeded(&monitor->vehicle.both_modes, now_ms, config->mode_invalid_ms);
    if (invalid) {
        monitor->vehicle.mode = (uint8_t)AGV_MODE_NONE;
        agv_timer_stop(&monitor->engaged);
    }
    return WHEN(invalid, MODE_INVALID);
}

static agv_fault_set_t judge_heartbeats(agv_monitor_t *monitor, const agv_config_t *config, uint32_t now_ms) {
    const agv_heartbeat_state_t vcu = agv_liveness_heartbeat(&monitor->liveness, AGV_NODE_VCU);
    const agv_heartbeat_state_t eps = agv_liveness_heartbeat(&monitor->liveness, AGV_NODE_EPS);
    const agv_heartbeat_state_t ai = agv_liveness_heartbeat(&monitor->liveness, AGV_NODE_AI);
    agv_timer_while(&monitor->ai_awaited, is_engaged(monitor) && (ai == AGV_HEARTBEAT_UNSEEN), now_ms);
    const bool never_seen = agv_timer_exceeded(&monitor->ai_awaited, now_ms, config->ai_never_seen_timeout_ms);
    return WHEN(vcu == AGV_HEARTBEAT_LOST, VCU_HEARTBEAT_LOST) | WHEN(vcu == AGV_HEARTBEAT_STUCK, VCU_HEARTBEAT_STUCK) |
           WHEN(eps == AGV_HEARTBEAT_LOST, EPS_HEARTBEAT_LOST) | WHEN(eps == AGV_HEARTBEAT_STUCK, EPS_HEARTBEAT_STUCK) |
           WHEN((ai == AGV_HEARTBEAT_LOST) || never_seen, AI_HEARTBEAT_LOST) |
           WHEN(ai == AGV_HEARTBEAT_STUCK, AI_HEARTBEAT_STUCK);
}

static agv_fault_set_t judge_deadlines(const agv_monitor_t *monitor) {
    const agv_liveness_t *liveness = &monitor->liveness;
    const bool engaged = is_engaged(monitor);
    return WHEN(agv_liveness_expired(liveness, AGV_MSG_EPS_STATUS), EPS_STATUS_TIMEOUT) |
           WHEN(agv_liveness_expired(liveness, AGV_MSG_GEAR_STATUS), GEAR_STATUS_TIMEOUT) |
           WHEN(agv_liveness_expired(liveness, AGV_MSG_THROTTLE_STATUS), THROTTLE_STATUS_TIMEOUT) |
           WHEN(agv_liveness_expired(liveness, AGV_MSG_WHEEL_SPEED), WHEEL_SPEED_TIMEOUT) |
           WHEN(agv_liveness_expired(liveness, AGV_MSG_STEERING_POSITION), STEERING_POSITION_TIMEOUT) |
           WHEN(engaged && agv_liveness_expired(liveness, AGV_MSG_GEAR_COMMAND), GEAR_COMMAND_TIMEOUT) |
           WHEN(engaged && agv_liveness_expired(liveness, AGV_MSG_THROTTLE_COMMAND), THROTTLE_COMMAND_TIMEOUT) |
           WHEN(engaged && agv_liveness_expired(liveness, AGV_MSG_STEERING_COMMAND), STEERING_COMMAND_TIMEOUT);
}

static uint16_t steering_difference_ddeg(const agv_vehicle_t *vehicle) {
    const int32_t difference = (int32_t)vehicle->angle_ddeg - (int32_t)vehicle->command_ddeg;
    return (uint16_t)((difference < 0) ? -difference : difference);
}

/* The difference must shrink by steering_gain_ddeg in every steering_deviation_ms; each such gain starts them anew. */
static agv_fault_set_t judge_steering(agv_monitor_t *monitor, const agv_config_t *config, bool settled,
                                      uint32_t now_ms) {
    const uint16_t difference = steering_difference_ddeg(&monitor->vehicle);
    const bool known = monitor->vehicle.command_known && monitor->vehicle.angle_known;
    const bool off = settled && known && (difference > config->steering_deviation_ddeg);
    const bool starts = monitor->steering_off.phase == (uint8_t)AGV_TIMER_STOPPED;
    agv_timer_while(&monitor->steering_off, off, now_ms);
    if (off && (starts || (difference > monitor->steering_off_ddeg))) {
        monitor->steering_off_ddeg = difference;
    } else if (off && ((monitor->steering_off_ddeg - difference) >= (int32_t)config->steering_gain_ddeg)) {
        monitor->steering_off_ddeg = difference;
        agv_timer_start(&monitor->steering_off, now_ms);
    } else {
        /* no gain yet */
    }
    return WHEN(agv_timer_reached(&monitor->steering_off, now_ms, config->steering_deviation_ms), STEERING_DEVIATION);
}

static agv_fault_set_t judge_throttle(agv_monitor_t *monitor, const agv_config_t *config, bool settled,
                                      uint32_t now_ms) {
    const bool pulling = settled && monitor->vehicle.throttle_on && agv_monitor_in_park(monitor);
    agv_timer_while(&monitor->throttle_in_park, pulling, now_ms);
    return WHEN(agv_timer_reached(&monitor->throttle_in_park, now_ms, config->throttle_in_park_ms), THROTTLE_IN_PARK);
}

static bool wrong_id(agv_monitor_t *monitor, const agv_config_t *config, uint32_t which, agv_message_t message,
                     uint32_t now_ms) {
    const uint8_t bit = (uint8_t)(1u << which);
    if ((now_ms - monitor->other_set_ms[which]) > config->wrong_id_set_ms) {
        monitor->other_set_recent &= (uint8_t)~bit;
    }
    return ((monitor->other_set_recent & bit) != 0u) &&
           (agv_liveness_age_ms(&monitor->liveness, message, now_ms) > config->wrong_id_set_ms);
}

static agv_fault_set_t judge_id_set(agv_monitor_t *monitor, const agv_config_t *config, uint32_t now_ms) {
    if (monitor->other_set_recent == 0u) {
        return 0u;
    }
    const bool command = wrong_id(monitor, config, OTHER_TURN_SIGNAL_COMMAND, AGV_MSG_TURN_SIGNAL_COMMAND, now_ms);
    const bool status = wrong_id(monitor, config, OTHER_VEHICLE_STATUS, AGV_MSG_VEHICLE_STATUS, now_ms);
    return WHEN(command || status, WRONG_ID_SET);
}

void agv_monitor_tick(agv_monitor_t *monitor, const agv_config_t *config, uint32_t now_ms) {
    const agv_fault_set_t judged =
        BIT(MODE_INVALID) | BIT(VCU_HEARTBEAT_LOST) | BIT(VCU_HEARTBEAT_STUCK) | BIT(EPS_HEARTBEAT_LOST) |
        BIT(EPS_HEARTBEAT_STUCK) | BIT(AI_HEARTBEAT_LOST) | BIT(AI_HEARTBEAT_STUCK) | BIT(EPS_STATUS_TIMEOUT) |
        BIT(GEAR_STATUS_TIMEOUT) | BIT(THROTTLE_STATUS_TIMEOUT) | BIT(WHEEL_SPEED_TIMEOUT) |
        BIT(STEERING_POSITION_TIMEOUT) | BIT(GEAR_COMMAND_TIMEOUT) | BIT(THROTTLE_COMMAND_TIMEOUT) |
        BIT(STEERING_COMMAND_TIMEOUT) | BIT(STEERING_DEVIATION) | BIT(THROTTLE_IN_PARK) | BIT(WRONG_ID_SET);
    agv_liveness_tick(&monitor->liveness, config, now_ms);
    agv_faults_tick(&monitor->faults, now_ms, config->event_hold_ms);
    if (agv_liveness_expired(&monitor->liveness, AGV_MSG_WHEEL_SPEED)) {
        agv_timer_stop(&monitor->vehicle.slow);
    }
    const agv_fault_set_t mode = judge_mode(monitor, config, now_ms);
    const bool settled = agv_monitor_settled(monitor, config, now_ms);
    agv_faults_levels(&monitor->faults, judged,
                      mode | judge_heartbeats(monitor, config, now_ms) | judge_deadlines(monitor) |
                          judge_steering(monitor, config, settled, now_ms) |
                          judge_throttle(monitor, config, settled, now_ms) | judge_id_set(monitor, config, now_ms));
}
