#include "agv/gateway.h"

#include "agv/codec.h"
#include "agv/core.h"

/* Longer pauses give no more slew than this. */
#define SLEW_TIME_MAX_MS 1000u

bool agv_gateway_passes(const agv_core_t *core, agv_message_t command) {
    const agv_state_t state = agv_core_state(core);
    return (state == AGV_STATE_ACTIVE) ||
           ((state == AGV_STATE_STANDBY) && ((command == AGV_MSG_TURN_SIGNAL_COMMAND) ||
                                             (core->config.gateway_in_manual == (uint16_t)AGV_IN_MANUAL_ALL)));
}

/* In counts of the wire. */
static uint32_t throttle_max(const agv_core_t *core) {
    if (core->machine.state != (uint8_t)AGV_STATE_ACTIVE) {
        return 0u;
    }
    return (core->config.throttle_ceiling_pct * AGV_THROTTLE_MAX_COUNTS) / 100u;
}

static int32_t clamp(int32_t value, int32_t lowest, int32_t highest) {
    if (value < lowest) {
        return lowest;
    }
    return (value > highest) ? highest : value;
}

/* What the first command may start from: the angle that the steering has, a cycle ago. */
static void begin_slew(agv_core_t *core, int32_t wanted_ddeg) {
    const agv_vehicle_t *const vehicle = &core->vehicle;
    agv_gateway_t *const gateway = &core->gateway;
    if (!gateway->sent) {
        gateway->sent_ddeg = vehicle->angle_known ? vehicle->angle_ddeg : (int16_t)wanted_ddeg;
        gateway->sent_ms = core->now_ms - agv_message_cycle_ms(AGV_MSG_STEERING_COMMAND);
        gateway->sent = true;
    }
}

static int32_t limit_slew(agv_core_t *core, int32_t wanted_ddeg) {
    agv_gateway_t *const gateway = &core->gateway;
    const uint32_t rate_ddeg_s = core->config.steering_slew_ddeg_s;
    int32_t limited_ddeg = wanted_ddeg;
    begin_slew(core, wanted_ddeg);
    if (rate_ddeg_s != 0u) {
        const uint32_t since_ms = core->now_ms - gateway->sent_ms;
        const uint32_t time_ms = (since_ms < SLEW_TIME_MAX_MS) ? since_ms : SLEW_TIME_MAX_MS;
        const int32_t step_ddeg = (int32_t)((rate_ddeg_s * time_ms) / 1000u);
        limited_ddeg = clamp(wanted_ddeg, gateway->sent_ddeg - step_ddeg, gateway->sent_ddeg + step_ddeg);
        if ((step_ddeg == 0) && (limited_ddeg != wanted_ddeg)) {
            return limited_ddeg; /* time goes on adding up until it makes a whole step */
        }
    }
    gateway->sent_ddeg = (int16_t)limited_ddeg;
    gateway->sent_ms = core->now_ms;
    return limited_ddeg;
}

void agv_gateway_limit(agv_core_t *core, agv_message_t command, uint8_t data[AGV_DLC]) {
    for (uint32_t i = 0u; i < AGV_DLC; i++) {
        data[i] &= agv_command_bits[command][i];
    }
    if (command == AGV_MSG_THROTTLE_COMMAND) {
        const uint32_t max_counts = throttle_max(core);
        data[0] = (uint8_t)((data[0] < max_counts) ? data[0] : max_counts);
    } else if (command == AGV_MSG_STEERING_COMMAND) {
        const int32_t ddeg = limit_slew(core, agv_angle_read(data));
        agv_angle_write(data, ddeg);
        agv_monitor_steering_commanded(core, ddeg);
    } else {
        /* as received */
    }
}
