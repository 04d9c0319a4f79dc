/**
 * @file monitor.h
 * Judges what arrives and what does not: keeps the vehicle's reported state and the ages up to date, and says which
 * faults have a cause (SUP-1 to SUP-6, SUP-8, P1). One handler a message in monitor_frames.c, the rules that depend on
 * time in monitor_timed.c.
 */
#ifndef AGV_MONITOR_H
#define AGV_MONITOR_H

#include <stdbool.h>
#include <stdint.h>

#include "agv/config.h"
#include "agv/faults.h"
#include "agv/liveness.h"
#include "agv/protocol.h"
#include "agv/timer.h"
#include "agv/vehicle.h"

/** Counters of bad frames in a row, and of fast gaps. */
typedef struct {
    uint8_t under_voltage;
    uint8_t over_voltage;
    uint8_t excessive_current;
    uint8_t eps_mode;
    uint8_t gear_status;
    uint8_t throttle_status;
    uint8_t steering_angle;
    uint8_t fast_gaps[AGV_COMMAND_COUNT];
} agv_in_a_row_t;

/** Everything that is known and wrong. */
typedef struct {
    agv_liveness_t liveness;
    agv_faults_t faults;
    agv_vehicle_t vehicle;
    agv_timer_t engaged;          /**< runs while engaged; limit engaged_grace_ms */
    agv_timer_t ai_awaited;       /**< runs while engaged with an AI never seen */
    agv_timer_t steering_off;     /**< runs while the steering is off its command and does not gain */
    agv_timer_t throttle_in_park; /**< runs while 050h is above 0 in gear P */
    uint32_t other_set_ms[2];     /**< last frame with the other ID set's 43Fh, 363h */
    uint16_t steering_off_ddeg;   /**< difference from which a gain is counted */
    uint8_t other_set_recent;     /**< bit 0, 1: heard within wrong_id_set_ms */
    bool ai_alarm_armed;          /**< VCU alarm bit 3 was clear with the AI alive (SUP-8) */
    agv_in_a_row_t in_a_row;
} agv_monitor_t;

/** A frame of the right shape, as the handlers see it. */
typedef struct {
    const uint8_t *data; /**< 8 bytes */
    uint32_t stamp_ms;   /**< its receive time: ages are counted from it */
    uint32_t now_ms;     /**< the supervisor's time, never older than an earlier one: timers start at it */
    bool after_gap;      /**< more than two cycles after the one before: counts in a row restart (SUP-4) */
} agv_monitor_frame_t;

/** Nothing known; deadlines begin now. */
void agv_monitor_start(agv_monitor_t *monitor, uint32_t now_ms);

/**
 * A frame of the right shape with a message of the chosen ID set.
 * @return false when it is a command with a value out of range: drop it.
 */
bool agv_monitor_frame(agv_monitor_t *monitor, const agv_config_t *config, agv_message_t message,
                       const agv_monitor_frame_t *frame);

/** A frame of the right shape with an identifier that only the other ID set has. */
void agv_monitor_other_id_set(agv_monitor_t *monitor, agv_message_t message, uint32_t stamp_ms);

/** The steering command that the gateway sent on (SUP-5). */
void agv_monitor_steering_sent(agv_monitor_t *monitor, int16_t angle_ddeg);

/** Judge all that depends on time. Call at every tick, after the frames stamped up to it. */
void agv_monitor_tick(agv_monitor_t *monitor, const agv_config_t *config, uint32_t now_ms);

/** A reset was accepted: the AI computer counts as never seen (SUP-8). */
void agv_monitor_forget_ai(agv_monitor_t *monitor);

/** Which faults are trips at the moment: the configured classes, and SUP-8 for the AI's heartbeat. */
agv_fault_set_t agv_monitor_trip_classes(const agv_monitor_t *monitor, const agv_config_t *config);

/** Whether VCU, EPS or AI is alive: its counter changed within the deadline. */
bool agv_monitor_alive(const agv_monitor_t *monitor, agv_node_t node);

/** Whether every status message whose silence trips is fresh. */
bool agv_monitor_messages_fresh(const agv_monitor_t *monitor, const agv_config_t *config);

/** Whether the vehicle stands still (both wheels slow for standstill_ms, on fresh 101h). */
bool agv_monitor_standstill(agv_monitor_t *monitor, const agv_config_t *config, uint32_t now_ms);

/** Whether fresh 0A3h reports P. */
bool agv_monitor_in_park(const agv_monitor_t *monitor);

/** Whether a VCU that is alive reports the autopilot as not engaged, in an unambiguous way. */
bool agv_monitor_autopilot_off(const agv_monitor_t *monitor);

/** Whether the steering may be held: EPS alive and without a fault, in angle control, manual not reported (FSM-10). */
bool agv_monitor_steering_holdable(const agv_monitor_t *monitor);

/** Used by the two halves of the monitor. */
bool agv_monitor_settled(agv_monitor_t *monitor, const agv_config_t *config, uint32_t now_ms);

#endif
