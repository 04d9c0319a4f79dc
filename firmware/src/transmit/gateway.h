/**
 * @file gateway.h
 * Which AI command the gateway passes on to the vehicle, and how it is limited (TOP-2): packed anew with reserved bits as
 * 0, within the envelope of throttle ceiling, throttle rise, steering slew and steering limit above a speed. When it goes
 * is up to the transmitter.
 */
#ifndef AGV_GATEWAY_H
#define AGV_GATEWAY_H

#include <stdbool.h>
#include <stdint.h>

#include "agv/state.h"
#include "observe/vehicle.h"

/** What the rate limits start from. All zero: no command was limited since the engagement. */
typedef struct {
    uint32_t steering_ms;  /**< when the last 065h was limited */
    uint32_t throttle_ms;  /**< when the last 075h was limited */
    uint16_t steering_raw; /**< and to what */
    uint8_t throttle;      /**< and to what, counts */
    bool steering_known;
    bool throttle_known;
} agv_gateway_t;

/** What the gateway goes by. */
typedef struct {
    const agv_config_t *config;
    const agv_vehicle_t *vehicle;
    agv_state_t state;
    uint32_t now_ms;
    bool autopilot; /**< the last 363h reports autopilot */
    bool standstill;
} agv_gateway_facts_t;

/** Whether a command passes: by state, mode and, for D and R, standstill. */
bool agv_gateway_passes(const agv_gateway_facts_t *facts, uint32_t command, const uint8_t data[AGV_DLC]);

/** Whether a command that waits may still leave. */
bool agv_gateway_may_wait(const agv_gateway_facts_t *facts, uint32_t command);

/** The state changed: the rate limits begin anew. */
void agv_gateway_restart(agv_gateway_t *gateway);

/**
 * Make the payload that is passed on.
 * @param data in: as received, values in range; out: what to send
 * @return whether the envelope changed it
 */
bool agv_gateway_limit(agv_gateway_t *gateway, const agv_gateway_facts_t *facts, uint32_t command,
                       uint8_t data[AGV_DLC]);

#endif
