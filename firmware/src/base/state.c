#include "agv/state.h"

bool agv_state_commands_safe(agv_state_t state) {
    return (state != AGV_STATE_STANDBY) && (state != AGV_STATE_ACTIVE);
}

bool agv_state_is_latched(agv_state_t state) {
    return agv_state_commands_safe(state) && (state != AGV_STATE_INIT);
}
