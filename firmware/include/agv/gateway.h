/**
 * @file gateway.h
 * What the gateway passes on from the AI side to the vehicle (TOP-2): which commands in which state, packed anew with
 * reserved bits as 0, limited by throttle ceiling and steering slew.
 */
#ifndef AGV_GATEWAY_H
#define AGV_GATEWAY_H

#include <stdbool.h>
#include <stdint.h>

#include "agv/config.h"
#include "agv/protocol.h"
#include "agv/state.h"

/** Memory of the steering slew limit. All zero: no command was sent since the engagement. */
typedef struct {
    uint32_t sent_ms;  /**< when the last command was limited */
    int16_t sent_ddeg; /**< and to what */
    bool sent;
} agv_gateway_t;

/** What a limit needs to know. */
typedef struct {
    uint32_t now_ms;
    int16_t measured_ddeg; /**< steering angle; where the first command may start from */
    bool measured_known;
} agv_gateway_facts_t;

/** Whether a command passes in a state. */
bool agv_gateway_passes(const agv_config_t *config, agv_state_t state, agv_message_t command);

/**
 * Make the payload that is passed on.
 * @param data in: as received, values in range; out: what to send
 * @return for 065h the angle that is sent in 0.1 degree, else 0
 */
int16_t agv_gateway_limit(agv_gateway_t *gateway, const agv_config_t *config, agv_state_t state, agv_message_t command,
                          const agv_gateway_facts_t *facts, uint8_t data[AGV_DLC]);

/** The throttle ceiling in counts of the wire, 0..250. */
uint8_t agv_gateway_throttle_max_counts(const agv_config_t *config);

#endif
