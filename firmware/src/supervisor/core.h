/**
 * @file core.h
 * The memory of one supervisor: the structs of its modules side by side. Known to supervisor*.c alone (scripts/tools/check-layers.sh):
 * each struct is written by the source of its own module, which is handed it.
 */
#ifndef AGV_CORE_H
#define AGV_CORE_H

#include <stdbool.h>
#include <stdint.h>

#include "agv/supervisor.h"
#include "base/fault_monitor.h"
#include "base/timers.h"
#include "decide/confirmation.h"
#include "decide/hold.h"
#include "decide/reset_button.h"
#include "decide/state_machine.h"
#include "decide/stopping.h"
#include "keep/led.h"
#include "observe/bus.h"
#include "observe/commands.h"
#include "observe/hardware.h"
#include "observe/intrusion.h"
#include "observe/liveness.h"
#include "observe/mode.h"
#include "observe/motion_checks.h"
#include "observe/status_checks.h"
#include "observe/vehicle.h"
#include "transmit/gateway.h"
#include "transmit/transmitter.h"

/** The memory. It holds no pointers: a flipped bit in one could point anywhere, and their size depends on the platform. */
typedef struct {
    agv_timers_t timers;
    agv_config_t config;
    agv_counters_t counters;
    /* The members below are reset at every start, also after a corruption. */
    uint32_t config_checksum; /**< agv_config_checksum at the start */
    agv_ids_t ids;            /**< derived from config; also a second copy in case the configuration is corrupted */
    uint16_t status_frame_id; /**< second copy, as above */
    uint8_t topology;         /**< second copy, as above */
    uint8_t id_set;           /**< second copy, as above */
    uint8_t park;             /**< second copy, as above */
    agv_state_machine_t machine;
    agv_fault_monitor_t faults;
    agv_liveness_t liveness;
    agv_mode_t mode;
    agv_confirmation_t confirmation;
    agv_vehicle_t vehicle;
    agv_status_checks_t status_checks;
    agv_motion_checks_t motion_checks;
    agv_intrusion_t intrusion;
    agv_commands_t commands;
    agv_stopping_t stopping;
    agv_reset_button_t reset_button;
    agv_reset_button_t reset_pin;
    agv_hold_t hold;
    agv_hardware_t hardware;
    agv_bus_t buses[HAL_CAN_SIDES];
    agv_gateway_t gateway;
    agv_transmitter_t transmitter;
    agv_led_t led;
    uint32_t last_tick_ms;
    uint16_t store_credit_ms; /**< time until one more write to flash is allowed (INT-3) */
    uint8_t store_credits;    /**< number of writes to flash allowed now */
    uint8_t checked_in;       /**< activities that have checked in since the watchdog was fed (TIM-3) */
    int8_t led_code;          /**< LED code of agv_fault_monitor_shown */
    bool stalled;             /**< at the last tick a frame had waited for longer than tx_stalled_ms */
    bool stall_begins;        /**< the stall has begun, and its frames were not withdrawn yet */
} agv_core_t;

_Static_assert(sizeof(agv_core_t) <= AGV_SUPERVISOR_MEMORY, "the core does not fit: raise AGV_SUPERVISOR_MEMORY");
_Static_assert(AGV_SUPERVISOR_MEMORY % sizeof(uint64_t) == 0u, "whole pairs of words: all of it is under the seal");

/** The core of a supervisor. */
static inline agv_core_t *agv_core_of(agv_supervisor_t *supervisor) {
    /* NOLINTNEXTLINE(bugprone-casting-through-void): the memory is aligned and as large as the core, asserted above */
    return (agv_core_t *)(void *)supervisor->memory;
}

/** The core of a supervisor, to read. */
static inline const agv_core_t *agv_core_read(const agv_supervisor_t *supervisor) {
    /* NOLINTNEXTLINE(bugprone-casting-through-void): the memory is aligned and as large as the core, asserted above */
    return (const agv_core_t *)(const void *)supervisor->memory;
}

/** Whether the topology is a gateway. */
static inline bool agv_core_is_gateway(const agv_core_t *core) {
    return core->config.topology != (uint16_t)AGV_TOPOLOGY_SHARED;
}

#endif
