#include "transmit/gateway.h"

#include "agv/codec.h"

/* Longer pauses give no more slew than this. */
#define SLEW_TIME_MAX_MS 1000u

bool agv_gateway_passes(const agv_config_t *config, agv_state_t state, uint32_t command) {
    return (state == AGV_STATE_ACTIVE) ||
           ((state == AGV_STATE_STANDBY) && ((command == (uint32_t)AGV_MSG_TURN_SIGNAL_COMMAND) ||
                                             (config->gateway_in_manual == (uint16_t)AGV_IN_MANUAL_ALL)));
}

void agv_gateway_restart(agv_gateway_t *gateway) {
    gateway->sent = false;
}

/* In counts of the wire. */
static uint32_t throttle_max(const agv_config_t *config, agv_state_t state) {
    return (state == AGV_STATE_ACTIVE) ? ((config->throttle_ceiling_pct * AGV_THROTTLE_MAX_COUNTS) / 100u) : 0u;
}

static int32_t clamp(int32_t value, int32_t lowest, int32_t highest) {
    if (value < lowest) {
        return lowest;
    }
    return (value > highest) ? highest : value;
}

/* What the first command may start from: the angle that the steering has, a cycle ago. */
static void begin_slew(agv_gateway_t *gateway, const agv_vehicle_t *vehicle, uint32_t now_ms, uint32_t wanted_raw) {
    if (!gateway->sent) {
        gateway->sent_raw = vehicle->angle_known ? vehicle->angle_raw : (uint16_t)wanted_raw;
        gateway->sent_ms = now_ms - agv_message_cycle_ms(AGV_MSG_STEERING_COMMAND);
        gateway->sent = true;
    }
}

/* Raw angles: a step is a tenth of a degree. */
static uint32_t limit_slew(agv_gateway_t *gateway, uint32_t rate_ddeg_s, uint32_t now_ms, uint32_t wanted_raw) {
    uint32_t limited_raw = wanted_raw;
    if (rate_ddeg_s != 0u) {
        const uint32_t since_ms = now_ms - gateway->sent_ms;
        const uint32_t time_ms = (since_ms < SLEW_TIME_MAX_MS) ? since_ms : SLEW_TIME_MAX_MS;
        const int32_t step = (int32_t)((rate_ddeg_s * time_ms) / 1000u);
        limited_raw =
            (uint32_t)clamp((int32_t)wanted_raw, (int32_t)gateway->sent_raw - step, (int32_t)gateway->sent_raw + step);
        if ((step == 0) && (limited_raw != wanted_raw)) {
            return limited_raw; /* time goes on adding up until it makes a whole step */
        }
    }
    gateway->sent_raw = (uint16_t)limited_raw;
    gateway->sent_ms = now_ms;
    return limited_raw;
}

void agv_gateway_limit(agv_gateway_t *gateway, const agv_config_t *config, const agv_vehicle_t *vehicle,
                       agv_state_t state, uint32_t now_ms, uint32_t command, uint8_t data[AGV_DLC]) {
    for (uint32_t i = 0u; i < AGV_DLC; i++) {
        data[i] &= agv_command_bits[command][i];
    }
    if (command == (uint32_t)AGV_MSG_THROTTLE_COMMAND) {
        const uint32_t max_counts = throttle_max(config, state);
        data[0] = (uint8_t)((data[0] < max_counts) ? data[0] : max_counts);
    } else if (command == (uint32_t)AGV_MSG_STEERING_COMMAND) {
        const uint32_t wanted_raw = agv_angle_read(data);
        begin_slew(gateway, vehicle, now_ms, wanted_raw);
        agv_angle_write(data, limit_slew(gateway, config->steering_slew_ddeg_s, now_ms, wanted_raw));
    } else {
        /* as received */
    }
}
