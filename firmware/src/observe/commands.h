/**
 * @file commands.h
 * The last valid commands of the AI computer in this engagement. The vehicle's reports are compared with them (SUP-10,
 * SUP-11). On a shared bus they are the received commands, in a gateway the forwarded ones.
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
    uint8_t gear;       /**< 168h, agv_gear_t; 0: none yet, or forgotten */
    uint8_t known;      /**< bit n: a valid command n was received in this engagement */
    bool autopilot_off; /**< 43Fh requests autopilot off */
} agv_commands_t;

/** Take over a valid command. */
void agv_commands_take(agv_commands_t *commands, uint32_t command, const uint8_t data[AGV_DLC]);

/** Forget all commands, because an engagement began. */
void agv_commands_forget(agv_commands_t *commands);

/** Forget the commanded gear, because autopilot was left or entered: the operator may have changed it. */
void agv_commands_forget_gear(agv_commands_t *commands);

/** Whether a valid command of this kind was received in this engagement. A gear may be forgotten since: `gear` is 0 then. */
bool agv_commands_has(const agv_commands_t *commands, uint32_t command);

#endif
