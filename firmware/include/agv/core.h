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
#include "agv/timer.h"
#include "agv/transmitter.h"
#include "hal/can.h"
#include "hal/hal.h"

/** Held steering angle (FSM-10), kept with its complement; no angle is held while the two do not fit. */
typedef struct {
    uint16_t raw;
    uint16_t check;
} agv_hold_t;

/** All of it. */
typedef struct agv_core {
    agv_config_t config;
    hal_t *hal; /**< these two are set at the start of each call and NULL in between: nothing outside is */
    agv_recorder_t *recorder; /**< reached through a pointer that a flipped bit may have changed */
    agv_monitor_t monitor;
    agv_state_machine_t machine;
    agv_transmitter_t transmitter;
    agv_gateway_t gateway;
    agv_bus_t buses[HAL_CAN_SIDES];
    agv_led_t led;
    agv_hold_t hold;
    agv_counters_t counters;
    agv_timer_t unfed;        /**< since the hardware watchdog was fed */
    uint32_t config_checksum; /**< agv_config_checksum at the start */
    uint32_t now_ms;          /**< the latest moment that was heard of */
    uint32_t now_us;          /**< the same in microseconds, wrapping */
    uint32_t last_tick_ms;
    int8_t led_code;    /**< of the highest-ranking fault, as last reported */
    uint8_t checked_in; /**< activities since the watchdog was fed (TIM-3) */
    uint8_t id_set;     /**< second copies, for when the configuration itself is corrupted */
    uint8_t topology;
    agv_fault_t cause;   /**< as last reported: highest-ranking trip with a cause that does not come from the AI */
    agv_fault_t forever; /**< unresettable fault with a cause */
    bool ai_cause;       /**< a trip that comes from the AI has a cause */
} agv_core_t;

/** The state. */
static inline agv_state_t agv_core_state(const agv_core_t *core) {
    return (agv_state_t)core->machine.state;
}

/** Whether there are two sides. */
static inline bool agv_core_is_gateway(const agv_core_t *core) {
    return core->config.topology == (uint16_t)AGV_TOPOLOGY_GATEWAY;
}

#endif
