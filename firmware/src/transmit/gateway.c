#include "transmit/gateway.h"

#include "agv/codec.h"

/* The rate limits count at most this time since the last command. */
#define RATE_TIME_MAX_MS 1000u

bool agv_gateway_may_wait(const agv_gateway_facts_t *facts, uint32_t command) {
    if (command == (uint32_t)AGV_MSG_TURN_SIGNAL_COMMAND) {
        return !agv_state_commands_safe(facts->state);
    }
    if (facts->state == AGV_STATE_ACTIVE) {
        return facts->autopilot;
    }
    return (facts->state == AGV_STATE_STANDBY) && !facts->autopilot &&
           (facts->config->gateway_in_manual == (uint16_t)AGV_IN_MANUAL_ALL);
}

/* Whether a gear may be engaged at standstill only: D and R, and P of a vehicle that does not guard it against speed (FSM-1). */
static bool needs_standstill(const agv_config_t *config, uint8_t gear) {
    if (gear == (uint8_t)AGV_GEAR_P) {
        return config->park == (uint16_t)AGV_PARK_AT_STANDSTILL;
    }
    return ((gear == (uint8_t)AGV_GEAR_D) || (gear == (uint8_t)AGV_GEAR_R)) &&
           (config->gear_change == (uint16_t)AGV_GEAR_CHANGE_AT_STANDSTILL);
}

/* Whether a gear is engaged already. A silent 0A3h does not say which one is. That it is P must not depend on 0A3h alone. */
static bool is_engaged(const agv_gateway_facts_t *facts, uint8_t gear) {
    const uint8_t engaged = facts->gear_fresh ? facts->vehicle->gear : facts->gear_sent;
    return (gear == engaged) && ((gear != (uint8_t)AGV_GEAR_P) || (gear == facts->gear_sent));
}

/* Whether a command changes to such a gear in motion. */
static bool changes_gear_in_motion(const agv_gateway_facts_t *facts, uint8_t gear) {
    return needs_standstill(facts->config, gear) && !is_engaged(facts, gear) && !facts->standstill;
}

void agv_gateway_follow_gear(agv_gateway_t *gateway, const agv_gateway_facts_t *facts, uint32_t command,
                             const uint8_t data[AGV_DLC]) {
    if ((command != (uint32_t)AGV_MSG_GEAR_COMMAND) || !agv_gateway_may_wait(facts, command)) {
        return;
    }
    gateway->gear_waits = changes_gear_in_motion(facts, data[0]) && (data[0] != facts->gear_sent);
}

/* A slew limit does not start at an angle that is out of date: the command would turn the steering there. */
static bool lacks_angle(const agv_gateway_t *gateway, const agv_gateway_facts_t *facts) {
    return (facts->config->steering_slew_ddeg_s != 0u) && !gateway->steering_known && !facts->angle_fresh;
}

bool agv_gateway_passes(const agv_gateway_t *gateway, const agv_gateway_facts_t *facts, uint32_t command,
                        const uint8_t data[AGV_DLC]) {
    if (command == (uint32_t)AGV_MSG_GEAR_COMMAND) {
        return agv_gateway_may_wait(facts, command) && !changes_gear_in_motion(facts, data[0]);
    }
    return agv_gateway_may_wait(facts, command) &&
           ((command != (uint32_t)AGV_MSG_STEERING_COMMAND) || !lacks_angle(gateway, facts));
}

void agv_gateway_restart(agv_gateway_t *gateway) {
    *gateway = (agv_gateway_t){.gear_waits = gateway->gear_waits};
}

static int32_t clamp(int32_t value, int32_t lowest, int32_t highest) {
    if (value < lowest) {
        return lowest;
    }
    return (value > highest) ? highest : value;
}

/* The whole steps that a rate, in 1 / @p scale of a step a second, has made since it was counted. The rest is kept. */
static uint32_t take_steps(agv_gateway_rate_t *rate, uint32_t per_s, uint32_t scale, uint32_t now_ms) {
    const uint32_t since_ms = now_ms - rate->counted_ms;
    const uint32_t time_ms = (since_ms < RATE_TIME_MAX_MS) ? since_ms : RATE_TIME_MAX_MS;
    const uint32_t parts = rate->rest + (per_s * time_ms);
    rate->counted_ms = now_ms;
    rate->rest = (uint16_t)(parts % scale);
    return parts / scale;
}

/* A command that its rate does not limit: nothing is kept for the next one. */
static void reach(agv_gateway_rate_t *rate, uint32_t value, uint32_t now_ms) {
    *rate = (agv_gateway_rate_t){.counted_ms = now_ms, .value = (uint16_t)value};
}

/* In counts; 5 counts are 2 %. The first command may rise from 0 by the change of one cycle. */
static uint32_t limit_throttle(agv_gateway_t *gateway, const agv_gateway_facts_t *facts, uint32_t wanted) {
    agv_gateway_rate_t *const rate = &gateway->throttle;
    const uint32_t rise_pct_s = facts->config->throttle_rise_pct_s;
    const uint32_t ceiling = ((uint32_t)facts->config->throttle_ceiling_pct * AGV_THROTTLE_MAX_COUNTS) / 100u;
    const uint32_t highest = gateway->gear_waits ? 0u : ceiling;
    const uint32_t allowed = (wanted < highest) ? wanted : highest;
    if (facts->state != AGV_STATE_ACTIVE) {
        return 0u;
    }
    if (!gateway->throttle_known) {
        gateway->throttle_known = true;
        reach(rate, 0u, facts->now_ms - agv_message_cycle_ms(AGV_MSG_THROTTLE_COMMAND));
    }
    if (rise_pct_s != 0u) {
        const uint32_t risen = rate->value + take_steps(rate, rise_pct_s * 5u, 2000u, facts->now_ms);
        if (risen < allowed) {
            rate->value = (uint16_t)risen;
            return risen;
        }
    }
    reach(rate, allowed, facts->now_ms);
    return allowed;
}

/* Above a speed the angle is limited to both sides of the centre. */
static uint32_t limit_to_speed(const agv_gateway_facts_t *facts, uint32_t wanted_raw) {
    const int32_t max_ddeg = (int32_t)facts->config->steering_fast_max_ddeg;
    const bool fast = !facts->vehicle->wheels_fresh ||
                      agv_vehicle_wheel_turns(facts->vehicle, (uint32_t)facts->config->fast_mm_s + 1u);
    if ((max_ddeg == 0) || !fast) {
        return wanted_raw;
    }
    return (uint32_t)clamp((int32_t)wanted_raw, AGV_ANGLE_RAW_CENTRE - max_ddeg, AGV_ANGLE_RAW_CENTRE + max_ddeg);
}

/*
 * The limit starts one cycle ago. When a command passes without an EPS in angle control, the limit starts again at the next
 * command. This ends when driving is judged and a command has passed to an EPS in angle control: otherwise the commands would
 * never leave the measured angle of an EPS that is stuck (SUP-10).
 */
static void begin_slew(agv_gateway_t *gateway, const agv_gateway_facts_t *facts) {
    if (!gateway->steering_known) {
        reach(&gateway->steering, facts->vehicle->angle_raw,
              facts->now_ms - agv_message_cycle_ms(AGV_MSG_STEERING_COMMAND));
    }
    gateway->steering_known = facts->vehicle->eps_in_angle_mode || (facts->judged && gateway->steering_known);
}

/* Raw angles: a step is a tenth of a degree. */
static uint32_t limit_slew(agv_gateway_t *gateway, const agv_gateway_facts_t *facts, uint32_t wanted_raw) {
    agv_gateway_rate_t *const rate = &gateway->steering;
    const uint32_t slew_ddeg_s = facts->config->steering_slew_ddeg_s;
    begin_slew(gateway, facts);
    if (slew_ddeg_s != 0u) {
        const int32_t from = (int32_t)rate->value;
        const int32_t step = (int32_t)take_steps(rate, slew_ddeg_s, 1000u, facts->now_ms);
        const uint32_t slewed_raw = (uint32_t)clamp((int32_t)wanted_raw, from - step, from + step);
        if (slewed_raw != wanted_raw) {
            rate->value = (uint16_t)slewed_raw;
            return slewed_raw;
        }
    }
    reach(rate, wanted_raw, facts->now_ms);
    return wanted_raw;
}

bool agv_gateway_limit(agv_gateway_t *gateway, const agv_gateway_facts_t *facts, uint32_t command,
                       uint8_t data[AGV_DLC]) {
    for (uint32_t i = 0u; i < AGV_DLC; i++) {
        data[i] &= agv_command_bits[command][i];
    }
    if (command == (uint32_t)AGV_MSG_THROTTLE_COMMAND) {
        const uint32_t wanted = data[0];
        data[0] = (uint8_t)limit_throttle(gateway, facts, wanted);
        return data[0] != wanted;
    }
    if (command == (uint32_t)AGV_MSG_STEERING_COMMAND) {
        const uint32_t wanted_raw = agv_angle_read(data);
        const uint32_t raw = limit_slew(gateway, facts, limit_to_speed(facts, wanted_raw));
        agv_angle_write(data, raw);
        return raw != wanted_raw;
    }
    return false; /* as received */
}
