#include "observe/commands.h"

#include "agv/codec.h"

void agv_commands_take(agv_commands_t *commands, uint32_t command, const uint8_t data[AGV_DLC]) {
    commands->known |= (uint8_t)agv_message_bit(command);
    if (command == (uint32_t)AGV_MSG_STEERING_COMMAND) {
        commands->angle_raw = (uint16_t)agv_angle_read(data);
    } else if (command == (uint32_t)AGV_MSG_THROTTLE_COMMAND) {
        commands->throttle = data[0];
    } else if (command == (uint32_t)AGV_MSG_GEAR_COMMAND) {
        commands->gear = data[0];
    } else {
        commands->autopilot_off = (data[4] & AGV_SIGNAL_AUTOPILOT_OFF) != 0u;
    }
}

void agv_commands_forget(agv_commands_t *commands) {
    *commands = (agv_commands_t){0};
}

void agv_commands_forget_gear(agv_commands_t *commands) {
    commands->gear = 0u;
}

bool agv_commands_has(const agv_commands_t *commands, uint32_t command) {
    return (commands->known & agv_message_bit(command)) != 0u;
}
