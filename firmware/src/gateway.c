#include "agv/gateway.h"

#include "agv/codec.h"

/* Longer pauses give no more slew than this. */
#define SLEW_TIME_MAX_MS 1000u

bool agv_gateway_passes(const agv_config_t *config, agv_state_t state, agv_message_t command) {
    if (state == AGV_STATE_ACTIVE) {
        return true;
    }
    return (state == AGV_STATE_STANDBY) &&
           ((command == AGV_MSG_TURN_SIGNAL_COMMAND) || (config->gateway_in_manual == (uint16_t)AGV_IN_MANUAL_ALL));
}

uint8_t agv_gateway_throttle_max_counts(const agv_config_t *config) {
    return (uint8_t)(((uint32_t)config->throttle_ceiling_pct * AGV_THROTTLE_MAX_COUNTS) / 100u);
}

static int32_t clamp(int32_t value, int32_t lowest, int32_t highest) {
    if (value < lowest) {
        return lowest;
    }
    return (value > highest) ? highest : value;
}

static int32_t limit_slew(agv_gateway_t *gateway, const agv_config_t *config, const agv_gateway_facts_t *facts,
                          int32_t wanted_ddeg) {
    const uint32_t cycle_ms = agv_message_cycle_ms(AGV_MSG_STEERING_COMMAND);
    int32_t limited_ddeg = wanted_ddeg;
    if (!gateway->sent) {
        gateway->sent_ddeg = facts->measured_known ? facts->measured_ddeg : (int16_t)wanted_ddeg;
        gateway->sent_ms = facts->now_ms - cycle_ms;
        gateway->sent = true;
    }
    if (config->steering_slew_ddeg_s != 0u) {
        const uint32_t since_ms = facts->now_ms - gateway->sent_ms;
        const uint32_t time_ms = (since_ms < SLEW_TIME_MAX_MS) ? since_ms : SLEW_TIME_MAX_MS;
        const int32_t step_ddeg = (int32_t)((config->steering_slew_ddeg_s * time_ms) / 1000u);
        limited_ddeg = clamp(wanted_ddeg, gateway->sent_ddeg - step_ddeg, gateway->sent_ddeg + step_ddeg);
        if ((step_ddeg == 0) && (limited_ddeg != wanted_ddeg)) {
            return limited_ddeg; /* time goes on adding up until it makes a whole step */
        }
    }
    gateway->sent_ddeg = (int16_t)limited_ddeg;
    gateway->sent_ms = facts->now_ms;
    return limited_ddeg;
}

int16_t agv_gateway_limit(agv_gateway_t *gateway, const agv_config_t *config, agv_state_t state, agv_message_t command,
                          const agv_gateway_facts_t *facts, uint8_t data[AGV_DLC]) {
    agv_turn_signal_command_t signals;
    agv_gear_command_t gear;
    agv_throttle_command_t throttle;
    agv_steering_command_t steering = {0};
    switch (command) {
    case AGV_MSG_TURN_SIGNAL_COMMAND:
        (void)agv_unpack_turn_signal_command(&signals, data);
        (void)agv_pack_turn_signal_command(data, &signals);
        break;
    case AGV_MSG_GEAR_COMMAND:
        (void)agv_unpack_gear_command(&gear, data);
        (void)agv_pack_gear_command(data, &gear);
        break;
    case AGV_MSG_THROTTLE_COMMAND: {
        const uint32_t max_counts = (state == AGV_STATE_ACTIVE) ? agv_gateway_throttle_max_counts(config) : 0u;
        const uint16_t max_permille = (uint16_t)(max_counts * AGV_THROTTLE_PERMILLE_PER_COUNT);
        (void)agv_unpack_throttle_command(&throttle, data);
        throttle.throttle_permille =
            (throttle.throttle_permille < max_permille) ? throttle.throttle_permille : max_permille;
        (void)agv_pack_throttle_command(data, &throttle);
        break;
    }
    default:
        (void)agv_unpack_steering_command(&steering, data);
        steering.angle_ddeg = limit_slew(gateway, config, facts, steering.angle_ddeg);
        (void)agv_pack_steering_command(data, &steering);
        break;
    }
    return (int16_t)steering.angle_ddeg;
}
