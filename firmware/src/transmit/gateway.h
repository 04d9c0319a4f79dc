/**
 * @file gateway.h
 * What the gateway passes on from the AI side to the vehicle (TOP-2): which commands in which state, packed anew with
 * reserved bits as 0, limited by throttle ceiling and steering slew.
 */
#ifndef AGV_GATEWAY_H
#define AGV_GATEWAY_H

#include <stdbool.h>
#include <stdint.h>

#include "agv/state.h"
#include "observe/vehicle.h"

/** Memory of the steering slew limit. All zero: no command was sent since the engagement. */
typedef struct {
    uint32_t sent_ms;  /**< when the last command was limited */
    uint16_t sent_raw; /**< and to what */
    bool sent;
} agv_gateway_t;

/** Whether a command passes in this state. */
bool agv_gateway_passes(const agv_config_t *config, agv_state_t state, uint32_t command);

/** The state changed: the slew limit begins anew. */
void agv_gateway_restart(agv_gateway_t *gateway);

/**
 * Make the payload that is passed on.
 * @param data in: as received, values in range; out: what to send
 */
void agv_gateway_limit(agv_gateway_t *gateway, const agv_config_t *config, const agv_vehicle_t *vehicle,
                       agv_state_t state, uint32_t now_ms, uint32_t command, uint8_t data[AGV_DLC]);

#endif
