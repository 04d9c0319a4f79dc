#include "agv/codec.h"
#include "agv/core.h"

/*
 * The fault of each deadline (SUP-3), in the order of agv_message_t; those of commands count while engaged. 43Fh, 363h and
 * 067h have none here: theirs are the heartbeats.
 */
static const uint8_t deadlines[AGV_MSG_COUNT] = {AGV_FAULT_NONE,
                                                 AGV_FAULT_GEAR_COMMAND_TIMEOUT,
                                                 AGV_FAULT_THROTTLE_COMMAND_TIMEOUT,
                                                 AGV_FAULT_STEERING_COMMAND_TIMEOUT,
                                                 AGV_FAULT_NONE,
                                                 AGV_FAULT_GEAR_STATUS_TIMEOUT,
                                                 AGV_FAULT_THROTTLE_STATUS_TIMEOUT,
                                                 AGV_FAULT_NONE,
                                                 AGV_FAULT_EPS_STATUS_TIMEOUT,
                                                 AGV_FAULT_STEERING_POSITION_TIMEOUT,
                                                 AGV_FAULT_WHEEL_SPEED_TIMEOUT};

/* The faults of the heartbeats (SUP-2) stand side by side: "lost" and "stuck", in the order of agv_node_t. */
_Static_assert(((int)AGV_FAULT_EPS_HEARTBEAT_LOST == (int)AGV_FAULT_VCU_HEARTBEAT_LOST + 2) &&
                   ((int)AGV_FAULT_AI_HEARTBEAT_STUCK == (int)AGV_FAULT_VCU_HEARTBEAT_LOST + 5),
               "two a node");

void agv_monitor_start(agv_core_t *core) {
    agv_liveness_start(core);
}

void agv_monitor_other_id_set(agv_core_t *core, uint32_t message) {
    agv_watch_start(core,
                    (message == (uint32_t)AGV_MSG_TURN_SIGNAL_COMMAND) ? AGV_WATCH_OTHER_43F : AGV_WATCH_OTHER_363);
}

void agv_monitor_steering_commanded(agv_core_t *core, uint32_t angle_raw) {
    core->vehicle.command_raw = (uint16_t)angle_raw;
    core->vehicle.command_known = agv_core_engaged(core);
}

void agv_monitor_disengage(agv_core_t *core) {
    for (uint32_t fault = AGV_FAULT_EPS_MODE_OFF; fault <= (uint32_t)AGV_FAULT_STEERING_ANGLE_INVALID; fault++) {
        agv_faults_level(core, fault, false);
    }
    agv_faults_level(core, AGV_FAULT_VCU_AI_CAN_LOST, false);
    for (uint32_t row = AGV_ROW_EPS_MODE; row <= (uint32_t)AGV_ROW_STEERING_ANGLE; row++) {
        core->monitor.in_a_row[row] = 0u;
    }
    agv_watch_stop(core, AGV_WATCH_ENGAGED);
    core->vehicle.command_known = false;
    core->summary.changed = true; /* the class of AI_HEARTBEAT_* */
}

void agv_monitor_forget_ai(agv_core_t *core) {
    core->liveness.heartbeats[AGV_NODE_AI].state = AGV_HEARTBEAT_UNSEEN;
    agv_watch_stop(core, (uint32_t)AGV_WATCH_MESSAGE + (uint32_t)AGV_MSG_TURN_SIGNAL_COMMAND);
    core->monitor.ai_alarm_armed = false;
    agv_faults_level(core, AGV_FAULT_AI_HEARTBEAT_LOST, false);
    agv_faults_level(core, AGV_FAULT_AI_HEARTBEAT_STUCK, false);
}

bool agv_monitor_settled(agv_core_t *core) {
    return agv_watch_reached(core, AGV_WATCH_ENGAGED);
}

bool agv_monitor_is_trip(const agv_core_t *core, uint32_t fault) {
    const bool heartbeat =
        (fault == (uint32_t)AGV_FAULT_AI_HEARTBEAT_LOST) || (fault == (uint32_t)AGV_FAULT_AI_HEARTBEAT_STUCK);
    const bool only_warns =
        heartbeat && !agv_core_engaged(core) && (core->config.ai_lost_in_manual == (uint16_t)AGV_AI_LOST_WARN);
    return !only_warns && agv_config_is_trip(&core->config, fault);
}

bool agv_monitor_messages_fresh(const agv_core_t *core) {
    bool fresh = true;
    for (uint32_t i = AGV_COMMAND_COUNT; i < (uint32_t)AGV_MSG_COUNT; i++) {
        if (!agv_liveness_fresh(core, i) && agv_config_is_trip(&core->config, deadlines[i])) {
            fresh = false;
        }
    }
    return fresh;
}

bool agv_monitor_standstill(agv_core_t *core) {
    return agv_watch_reached(core, AGV_WATCH_STANDSTILL);
}

bool agv_monitor_in_park(const agv_core_t *core) {
    return agv_liveness_fresh(core, AGV_MSG_GEAR_STATUS) && (core->vehicle.gear == (uint8_t)AGV_GEAR_P);
}

bool agv_monitor_autopilot_off(const agv_core_t *core) {
    return agv_core_alive(core, AGV_NODE_VCU) && !agv_core_engaged(core) && !agv_watch_runs(core, AGV_WATCH_BOTH_MODES);
}

bool agv_monitor_steering_holdable(const agv_core_t *core) {
    return agv_core_alive(core, AGV_NODE_EPS) && core->vehicle.eps_in_angle_mode &&
           (core->vehicle.mode != (uint8_t)AGV_MODE_MANUAL) && !core->summary.eps_fault; /* a stale 167h is one */
}

/* Both mode bits for too long: the mode is none. */
static void judge_mode(agv_core_t *core) {
    const bool invalid = agv_watch_reached(core, AGV_WATCH_BOTH_MODES);
    if (invalid) {
        if (agv_core_engaged(core)) {
            agv_monitor_disengage(core);
        }
        core->vehicle.mode = (uint8_t)AGV_MODE_NONE;
    }
    agv_faults_level(core, AGV_FAULT_MODE_INVALID, invalid);
}

static void judge_heartbeats(agv_core_t *core) {
    const bool unseen = core->liveness.heartbeats[AGV_NODE_AI].state == (uint8_t)AGV_HEARTBEAT_UNSEEN;
    const bool never_seen = agv_watch_while(core, AGV_WATCH_AI_AWAITED, unseen && agv_core_engaged(core));
    for (uint32_t node = 0u; node < (uint32_t)AGV_NODE_COUNT; node++) {
        const uint32_t lost = (uint32_t)AGV_FAULT_VCU_HEARTBEAT_LOST + (2u * node);
        const agv_heartbeat_state_t state = agv_liveness_judge_beat(core, node);
        const bool absent = never_seen && (node == (uint32_t)AGV_NODE_AI);
        agv_faults_level(core, lost, (state == AGV_HEARTBEAT_LOST) || absent);
        agv_faults_level(core, lost + 1u, state == AGV_HEARTBEAT_STUCK);
    }
}

static void judge_deadlines(agv_core_t *core) {
    for (uint32_t i = 0u; i < (uint32_t)AGV_MSG_COUNT; i++) {
        const bool counts = (i >= AGV_COMMAND_COUNT) || agv_core_engaged(core);
        agv_faults_level(core, deadlines[i], agv_liveness_judge(core, i) && counts);
    }
}

/* The difference must shrink by steering_gain_ddeg in every steering_deviation_ms; each such gain starts them anew. */
static void judge_steering(agv_core_t *core, bool settled) {
    agv_monitor_t *const monitor = &core->monitor;
    const int32_t signed_ddeg = (int32_t)core->vehicle.angle_raw - (int32_t)core->vehicle.command_raw;
    const int32_t ddeg = (signed_ddeg < 0) ? -signed_ddeg : signed_ddeg;
    const bool known = core->vehicle.command_known && core->vehicle.angle_known;
    const bool off = settled && known && (ddeg > (int32_t)core->config.steering_deviation_ddeg);
    const bool gained = ddeg <= ((int32_t)monitor->steering_off_ddeg - (int32_t)core->config.steering_gain_ddeg);
    if (gained) {
        agv_watch_stop(core, AGV_WATCH_STEERING_OFF);
    }
    if (off && (!agv_watch_runs(core, AGV_WATCH_STEERING_OFF) || (ddeg > (int32_t)monitor->steering_off_ddeg))) {
        monitor->steering_off_ddeg = (uint16_t)ddeg;
    }
    agv_faults_level(core, AGV_FAULT_STEERING_DEVIATION, agv_watch_while(core, AGV_WATCH_STEERING_OFF, off));
}

static void judge_throttle(agv_core_t *core, bool settled) {
    const bool wrong = settled && (core->vehicle.throttle > 0u) && agv_monitor_in_park(core);
    agv_faults_level(core, AGV_FAULT_THROTTLE_IN_PARK, agv_watch_while(core, AGV_WATCH_THROTTLE_IN_PARK, wrong));
}

/* The other set's identifier is heard while the own one is silent (P1). */
static bool is_other_set(agv_core_t *core, agv_watch_t heard, uint32_t message) {
    (void)agv_watch_reached(core, heard);
    return agv_watch_is_within(core, heard) && (agv_liveness_age_ms(core, message) > core->config.wrong_id_set_ms);
}

static void judge_id_set(agv_core_t *core) {
    const bool command = is_other_set(core, AGV_WATCH_OTHER_43F, AGV_MSG_TURN_SIGNAL_COMMAND);
    const bool status = is_other_set(core, AGV_WATCH_OTHER_363, AGV_MSG_VEHICLE_STATUS);
    agv_faults_level(core, AGV_FAULT_WRONG_ID_SET, command || status);
}

void agv_monitor_tick(agv_core_t *core) {
    agv_faults_tick(core);
    judge_mode(core);
    judge_deadlines(core);
    judge_heartbeats(core);
    if (!agv_liveness_fresh(core, AGV_MSG_WHEEL_SPEED)) {
        agv_watch_stop(core, AGV_WATCH_STANDSTILL);
    }
    const bool settled = agv_monitor_settled(core);
    judge_steering(core, settled);
    judge_throttle(core, settled);
    judge_id_set(core);
}
