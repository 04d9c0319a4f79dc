#include "agv/codec.h"
#include "agv/core.h"

#include <stddef.h>

/* Deadlines of messages (SUP-3). */
static const struct {
    uint8_t message;
    uint8_t setting;
    uint8_t fault;
    bool only_engaged;
} deadlines[] = {
    {AGV_MSG_EPS_STATUS, AGV_SETTING_eps_status_timeout_ms, AGV_FAULT_EPS_STATUS_TIMEOUT, false},
    {AGV_MSG_GEAR_STATUS, AGV_SETTING_gear_status_timeout_ms, AGV_FAULT_GEAR_STATUS_TIMEOUT, false},
    {AGV_MSG_THROTTLE_STATUS, AGV_SETTING_throttle_status_timeout_ms, AGV_FAULT_THROTTLE_STATUS_TIMEOUT, false},
    {AGV_MSG_WHEEL_SPEED, AGV_SETTING_wheel_speed_timeout_ms, AGV_FAULT_WHEEL_SPEED_TIMEOUT, false},
    {AGV_MSG_STEERING_POSITION, AGV_SETTING_steering_position_timeout_ms, AGV_FAULT_STEERING_POSITION_TIMEOUT, false},
    {AGV_MSG_GEAR_COMMAND, AGV_SETTING_gear_command_timeout_ms, AGV_FAULT_GEAR_COMMAND_TIMEOUT, true},
    {AGV_MSG_THROTTLE_COMMAND, AGV_SETTING_throttle_command_timeout_ms, AGV_FAULT_THROTTLE_COMMAND_TIMEOUT, true},
    {AGV_MSG_STEERING_COMMAND, AGV_SETTING_steering_command_timeout_ms, AGV_FAULT_STEERING_COMMAND_TIMEOUT, true}};

/* Heartbeats (SUP-2), in the order of agv_node_t; the fault "stuck" follows the fault "lost". */
static const struct {
    uint8_t setting;
    uint8_t lost;
} heartbeats[AGV_NODE_COUNT] = {{AGV_SETTING_vcu_heartbeat_timeout_ms, AGV_FAULT_VCU_HEARTBEAT_LOST},
                                {AGV_SETTING_eps_heartbeat_timeout_ms, AGV_FAULT_EPS_HEARTBEAT_LOST},
                                {AGV_SETTING_ai_heartbeat_timeout_ms, AGV_FAULT_AI_HEARTBEAT_LOST}};

#define DEADLINE_COUNT (sizeof deadlines / sizeof deadlines[0])

static void level(agv_core_t *core, agv_fault_t fault, bool cause) {
    agv_faults_level(&core->monitor.faults, fault, cause);
}

void agv_monitor_start(agv_core_t *core) {
    core->monitor = (agv_monitor_t){0};
    agv_liveness_start(&core->monitor.liveness, core->now_ms);
}

void agv_monitor_other_id_set(agv_core_t *core, agv_message_t message) {
    agv_timer_start(&core->monitor.other_set[(message == AGV_MSG_TURN_SIGNAL_COMMAND) ? 0 : 1], core->now_ms);
}

void agv_monitor_steering_commanded(agv_core_t *core, int32_t angle_ddeg) {
    core->monitor.vehicle.command_ddeg = (int16_t)angle_ddeg;
    core->monitor.vehicle.command_known = agv_monitor_engaged(core);
}

void agv_monitor_disengage(agv_core_t *core) {
    for (uint32_t fault = AGV_FAULT_EPS_MODE_OFF; fault <= (uint32_t)AGV_FAULT_STEERING_ANGLE_INVALID; fault++) {
        level(core, (agv_fault_t)fault, false);
    }
    level(core, AGV_FAULT_VCU_AI_CAN_LOST, false);
    agv_timer_stop(&core->monitor.engaged);
    core->monitor.vehicle.command_known = false;
    core->monitor.faults.changed = true; /* the class of AI_HEARTBEAT_* */
}

void agv_monitor_forget_ai(agv_core_t *core) {
    agv_liveness_forget(&core->monitor.liveness, AGV_NODE_AI);
    core->monitor.ai_alarm_armed = false;
    level(core, AGV_FAULT_AI_HEARTBEAT_LOST, false);
    level(core, AGV_FAULT_AI_HEARTBEAT_STUCK, false);
}

bool agv_monitor_engaged(const agv_core_t *core) {
    return core->monitor.vehicle.mode == (uint8_t)AGV_MODE_ENGAGED;
}

bool agv_monitor_settled(agv_core_t *core) {
    return agv_timer_reached(&core->monitor.engaged, core->now_ms, core->config.engaged_grace_ms);
}

bool agv_monitor_is_trip(const agv_core_t *core, agv_fault_t fault) {
    const bool heartbeat = (fault == AGV_FAULT_AI_HEARTBEAT_LOST) || (fault == AGV_FAULT_AI_HEARTBEAT_STUCK);
    const bool only_warns =
        heartbeat && !agv_monitor_engaged(core) && (core->config.ai_lost_in_manual == (uint16_t)AGV_AI_LOST_WARN);
    return !only_warns && agv_config_is_trip(&core->config, fault);
}

bool agv_monitor_messages_fresh(const agv_core_t *core) {
    bool fresh = true;
    for (uint32_t i = 0u; i < DEADLINE_COUNT; i++) {
        if (!deadlines[i].only_engaged && agv_config_is_trip(&core->config, (agv_fault_t)deadlines[i].fault) &&
            !agv_liveness_fresh(&core->monitor.liveness, (agv_message_t)deadlines[i].message)) {
            fresh = false;
        }
    }
    return fresh;
}

bool agv_monitor_standstill(agv_core_t *core) {
    return agv_timer_reached(&core->monitor.vehicle.slow, core->now_ms, core->config.standstill_ms);
}

bool agv_monitor_in_park(const agv_core_t *core) {
    return agv_liveness_fresh(&core->monitor.liveness, AGV_MSG_GEAR_STATUS) &&
           (core->monitor.vehicle.gear == (uint8_t)AGV_GEAR_P);
}

bool agv_monitor_autopilot_off(const agv_core_t *core) {
    return agv_liveness_alive(&core->monitor.liveness, AGV_NODE_VCU) && !agv_monitor_engaged(core) &&
           !agv_timer_runs(&core->monitor.vehicle.both_modes);
}

static bool eps_is_faulty(const agv_core_t *core) {
    bool faulty = false;
    for (uint32_t i = 0u; i < (uint32_t)AGV_FAULT_COUNT; i++) {
        if (((agv_fault_flags((agv_fault_t)i) & AGV_FAULT_FLAG_OF_EPS) != 0u) &&
            agv_faults_is_active(&core->monitor.faults, (agv_fault_t)i)) {
            faulty = true;
        }
    }
    return faulty;
}

bool agv_monitor_steering_holdable(const agv_core_t *core) {
    return agv_liveness_alive(&core->monitor.liveness, AGV_NODE_EPS) &&
           agv_liveness_fresh(&core->monitor.liveness, AGV_MSG_EPS_STATUS) && core->monitor.vehicle.eps_in_angle_mode &&
           (core->monitor.vehicle.mode != (uint8_t)AGV_MODE_MANUAL) && !eps_is_faulty(core);
}

/* Both mode bits for too long: the mode is none. */
static void judge_mode(agv_core_t *core) {
    const bool invalid =
        agv_timer_exceeded(&core->monitor.vehicle.both_modes, core->now_ms, core->config.mode_invalid_ms);
    if (invalid) {
        if (agv_monitor_engaged(core)) {
            agv_monitor_disengage(core);
        }
        core->monitor.vehicle.mode = (uint8_t)AGV_MODE_NONE;
    }
    level(core, AGV_FAULT_MODE_INVALID, invalid);
}

static void judge_heartbeats(agv_core_t *core) {
    agv_monitor_t *const monitor = &core->monitor;
    const bool unseen = agv_liveness_heartbeat(&monitor->liveness, AGV_NODE_AI) == AGV_HEARTBEAT_UNSEEN;
    agv_timer_while(&monitor->ai_awaited, unseen && agv_monitor_engaged(core), core->now_ms);
    const bool never_seen =
        agv_timer_exceeded(&monitor->ai_awaited, core->now_ms, core->config.ai_never_seen_timeout_ms);
    for (uint32_t node = 0u; node < (uint32_t)AGV_NODE_COUNT; node++) {
        const agv_fault_t lost = (agv_fault_t)heartbeats[node].lost;
        agv_liveness_judge_beat(&monitor->liveness, (agv_node_t)node, core->now_ms,
                                agv_config_get(&core->config, heartbeats[node].setting));
        const agv_heartbeat_state_t state = agv_liveness_heartbeat(&monitor->liveness, (agv_node_t)node);
        const bool absent = never_seen && (lost == AGV_FAULT_AI_HEARTBEAT_LOST);
        level(core, lost, (state == AGV_HEARTBEAT_LOST) || absent);
        level(core, (agv_fault_t)((uint32_t)lost + 1u), state == AGV_HEARTBEAT_STUCK);
    }
}

static void judge_deadlines(agv_core_t *core) {
    const bool engaged = agv_monitor_engaged(core);
    for (uint32_t i = 0u; i < DEADLINE_COUNT; i++) {
        const bool expired = agv_liveness_judge(&core->monitor.liveness, (agv_message_t)deadlines[i].message,
                                                core->now_ms, agv_config_get(&core->config, deadlines[i].setting));
        level(core, (agv_fault_t)deadlines[i].fault, expired && (engaged || !deadlines[i].only_engaged));
    }
}

/* The difference must shrink by steering_gain_ddeg in every steering_deviation_ms; each such gain starts them anew. */
static void judge_steering(agv_core_t *core, bool settled) {
    agv_monitor_t *const monitor = &core->monitor;
    const int32_t signed_ddeg = (int32_t)monitor->vehicle.angle_ddeg - (int32_t)monitor->vehicle.command_ddeg;
    const int32_t ddeg = (signed_ddeg < 0) ? -signed_ddeg : signed_ddeg;
    const bool known = monitor->vehicle.command_known && monitor->vehicle.angle_known;
    const bool off = settled && known && (ddeg > (int32_t)core->config.steering_deviation_ddeg);
    const bool gained = ddeg <= ((int32_t)monitor->steering_off_ddeg - (int32_t)core->config.steering_gain_ddeg);
    if (gained || !off) {
        agv_timer_stop(&monitor->steering_off);
    }
    if (off && (!agv_timer_runs(&monitor->steering_off) || (ddeg > (int32_t)monitor->steering_off_ddeg))) {
        monitor->steering_off_ddeg = (uint16_t)ddeg;
    }
    agv_timer_while(&monitor->steering_off, off, core->now_ms);
    level(core, AGV_FAULT_STEERING_DEVIATION,
          agv_timer_reached(&monitor->steering_off, core->now_ms, core->config.steering_deviation_ms));
}

static void judge_throttle(agv_core_t *core, bool settled) {
    agv_timer_t *const timer = &core->monitor.throttle_in_park;
    agv_timer_while(timer, settled && core->monitor.vehicle.throttle_on && agv_monitor_in_park(core), core->now_ms);
    level(core, AGV_FAULT_THROTTLE_IN_PARK, agv_timer_reached(timer, core->now_ms, core->config.throttle_in_park_ms));
}

/* The other set's identifier is heard while the own one is silent (P1). */
static bool is_other_set(agv_core_t *core, uint32_t which, agv_message_t message) {
    agv_timer_t *const heard = &core->monitor.other_set[which];
    const uint32_t limit_ms = core->config.wrong_id_set_ms;
    return agv_timer_runs(heard) && !agv_timer_exceeded(heard, core->now_ms, limit_ms) &&
           (agv_liveness_age_ms(&core->monitor.liveness, message, core->now_ms) > limit_ms);
}

static void judge_id_set(agv_core_t *core) {
    const bool command = is_other_set(core, 0u, AGV_MSG_TURN_SIGNAL_COMMAND);
    const bool status = is_other_set(core, 1u, AGV_MSG_VEHICLE_STATUS);
    level(core, AGV_FAULT_WRONG_ID_SET, command || status);
}

void agv_monitor_tick(agv_core_t *core) {
    agv_liveness_tick(&core->monitor.liveness, core->now_ms);
    agv_faults_tick(&core->monitor.faults, core->now_ms, core->config.event_hold_ms);
    judge_mode(core);
    judge_heartbeats(core);
    judge_deadlines(core);
    if (!agv_liveness_fresh(&core->monitor.liveness, AGV_MSG_WHEEL_SPEED)) {
        agv_timer_stop(&core->monitor.vehicle.slow);
    }
    const bool settled = agv_monitor_settled(core);
    judge_steering(core, settled);
    judge_throttle(core, settled);
    judge_id_set(core);
}
