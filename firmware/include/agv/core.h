/**
 * @file core.h
 * The memory of one supervisor: its modules side by side. Read it through supervisor.h.
 */
#ifndef AGV_CORE_H
#define AGV_CORE_H

#include <stdbool.h>
#include <stdint.h>

#include "agv/bus.h"
#include "agv/config.h"
#include "agv/counters.h"
#include "agv/gateway.h"
#include "agv/led.h"
#include "agv/monitor.h"
#include "agv/recorder.h"
#include "agv/state.h"
#include "agv/state_machine.h"
#include "agv/transmitter.h"
#include "agv/watch.h"
#include "hal/can.h"
#include "hal/hal.h"

/** Held steering angle (FSM-10), kept with its complement; no angle is held while the two do not fit. */
typedef struct {
    uint16_t raw;
    uint16_t check;
} agv_hold_t;

/** What stands among the faults, as last reported: faults by rank, AGV_FAULT_NONE where there is none. */
typedef struct {
    bool changed;    /**< something is to be reported */
    uint8_t raised;  /**< highest-ranking fault that became a trip since the last step */
    uint8_t cause;   /**< highest-ranking trip with a cause that does not come from the AI */
    uint8_t forever; /**< unresettable fault with a cause */
    uint8_t trip;    /**< highest-ranking trip, active or latched */
    uint8_t warning; /**< highest-ranking warning */
    bool ai_cause;   /**< a trip that comes from the AI has a cause */
    bool eps_fault;  /**< a fault is active with which the EPS is not to be commanded */
} agv_summary_t;

/** All of it. Small things that are used everywhere come first: short instructions reach them on small processors. */
typedef struct agv_core {
    /* What begins anew with every start. */
    agv_state_machine_t machine;
    agv_summary_t summary;
    int8_t led_code;    /**< of the highest-ranking fault, as last reported */
    uint8_t checked_in; /**< activities since the watchdog was fed (TIM-3) */
    agv_vehicle_t vehicle;
    uint16_t id_set; /**< second copies, for when the configuration itself is corrupted */
    agv_hold_t hold;
    uint16_t topology;
    uint32_t last_tick_ms;
    uint32_t config_checksum; /**< agv_config_checksum at the start */
    agv_gateway_t gateway;
    /* What goes on after a restart that a corruption caused: hal up to config. */
    hal_t *hal; /**< these two are set at the start of each call and NULL in between: nothing outside is */
    agv_recorder_t *recorder; /**< reached through a pointer that a flipped bit may have changed */
    uint32_t now_ms;          /**< the latest moment that was heard of */
    uint32_t now_us;          /**< the same in microseconds, wrapping */
    agv_counters_t counters;
    agv_config_t config;
    /* What begins anew with every start: led and all after it. */
    agv_led_t led;
    agv_bus_t buses[HAL_CAN_SIDES];
    agv_faults_t faults;
    agv_liveness_t liveness;
    agv_monitor_t monitor;
    agv_transmitter_t transmitter;
    agv_watches_t watches;
} agv_core_t;

/** The state. */
static inline agv_state_t agv_core_state(const agv_core_t *core) {
    return (agv_state_t)core->machine.state;
}

/** Whether the state is a latched one (state.h). */
static inline bool agv_core_is_latched(const agv_core_t *core) {
    return agv_state_is_latched(agv_core_state(core));
}

/** Whether a heartbeat is alive. */
static inline bool agv_core_alive(const agv_core_t *core, agv_node_t node) {
    return (core->liveness.heartbeats[node].state & (uint32_t)AGV_HEARTBEAT_ALIVE) != 0u;
}

/** Whether the autopilot is engaged. */
static inline bool agv_core_engaged(const agv_core_t *core) {
    return (core->vehicle.mode & (uint32_t)AGV_MODE_ENGAGED) != 0u;
}

/** Whether there are two sides. */
static inline bool agv_core_is_gateway(const agv_core_t *core) {
    return core->config.topology != (uint16_t)AGV_TOPOLOGY_SHARED;
}

/** Whether a steering angle is held. */
static inline bool agv_core_holds_angle(const agv_core_t *core) {
    const uint16_t complement = (uint16_t)~core->hold.raw;
    return core->hold.check == complement;
}

#endif
