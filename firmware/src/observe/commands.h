/**
 * @file commands.h
 * The last valid commands of the AI computer in this engagement, which the vehicle is compared with (SUP-10, SUP-11): as
 * received, in the gateway topology as sent on.
 */
#ifndef AGV_COMMANDS_H
#define AGV_COMMANDS_H

#include <stdbool.h>
#include <stdint.h>

#include "agv/protocol.h"

/** The commands. */
typedef struct {
    uint16_t angle_raw; /**< 065h, raw (P5) */
    uint8_t throttle;   /**< 075h, counts */
    uint8_t gear;       /**< 168h, agv_gear_t */
    uint8_t known;      /**< bit n: there was a valid command n in this engagement */
    bool autopilot_off; /**< 43Fh asks for autopilot off */
} agv_commands_t;

/** A valid command. */
void agv_commands_take(agv_commands_t *commands, uint32_t command, const uint8_t data[AGV_DLC]);

/** An engagement began: no command is known. */
void agv_commands_forget(agv_commands_t *commands);

/** Whether there was a valid command in this engagement. */
bool agv_commands_has(const agv_commands_t *commands, uint32_t command);

#endif
