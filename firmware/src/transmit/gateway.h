/**
 * @file gateway.h
 * Which AI commands the gateway forwards to the vehicle, and how it limits them (TOP-2): throttle ceiling, throttle rise,
 * steering slew, and steering limit above a speed. Forwarded commands have their reserved bits set to 0. The transmitter
 * decides when they are sent.
 */
#ifndef AGV_GATEWAY_H
#define AGV_GATEWAY_H

#include <stdbool.h>
#include <stdint.h>

#include "agv/state.h"
#include "observe/vehicle.h"

/** A value whose rate of change is limited. */
typedef struct {
    uint32_t counted_ms; /**< the limit has counted the time up to here */
    uint16_t rest;       /**< remainder of the last division: fraction of a step, in 1/scale */
    uint16_t value;      /**< the last command after the limit: throttle in counts, angle raw (P5) */
} agv_gateway_rate_t;

/** The rate limits, and whether a gear waits. All zero: no command was checked. */
typedef struct {
    agv_gateway_rate_t steering;
    agv_gateway_rate_t throttle;
    bool steering_known; /**< steering is valid: the slew limit goes on from it */
    bool throttle_known; /**< throttle is valid */
    bool gear_waits;     /**< the last 168h is dropped until standstill: throttle 0 until then */
} agv_gateway_t;

/** Inputs of the gateway. */
typedef struct {
    const agv_config_t *config;
    const agv_vehicle_t *vehicle;
    agv_state_t state;
    uint32_t now_ms;
    uint8_t gear_sent; /**< gear of the last 168h sent since the state became ACTIVE; 0: none */
    bool gear_fresh;   /**< 0A3h is fresh */
    bool angle_fresh;  /**< the last valid 067h is at most hold_age_ms old */
    bool autopilot;    /**< the last 363h reports autopilot */
    bool standstill;
    bool judged; /**< driving is judged (Words) */
} agv_gateway_facts_t;

/**
 * Note whether a received 168h asks for a gear that has to wait for standstill: D or R (gear_change), P (park: at_standstill).
 * While it waits, 075h is forwarded with throttle 0, so that the throttle does not drive the vehicle on in the old gear. A gear
 * that was sent before does not wait: then the vehicle deviates from it (SUP-11). Call for each command, before the others.
 */
void agv_gateway_follow_gear(agv_gateway_t *gateway, const agv_gateway_facts_t *facts, uint32_t command,
                             const uint8_t data[AGV_DLC]);

/**
 * Whether a command may be forwarded now, also after it has waited. It depends on state and mode. A gear may need standstill;
 * with a slew limit, the first 065h needs a measured angle from which the slew starts.
 */
bool agv_gateway_passes(const agv_gateway_t *gateway, const agv_gateway_facts_t *facts, uint32_t command,
                        const uint8_t data[AGV_DLC]);

/** Whether a waiting command may still be sent. */
bool agv_gateway_may_wait(const agv_gateway_facts_t *facts, uint32_t command);

/** Restart the rate limits, because the state changed. Whether a gear waits is decided by the next 168h. */
void agv_gateway_restart(agv_gateway_t *gateway);

/**
 * Limit a command and clear its reserved bits.
 * @param data in: the received payload, with values in range; out: the payload to send
 * @return whether a limit changed the command
 */
bool agv_gateway_limit(agv_gateway_t *gateway, const agv_gateway_facts_t *facts, uint32_t command,
                       uint8_t data[AGV_DLC]);

#endif
