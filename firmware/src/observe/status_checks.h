/**
 * @file status_checks.h
 * Faults that the content of a frame is: fault bits and alarms (SUP-4), EPS mode and invalid values (SUP-5), commands that
 * come too fast (SUP-6).
 */
#ifndef AGV_STATUS_CHECKS_H
#define AGV_STATUS_CHECKS_H

#include <stdbool.h>
#include <stdint.h>

#include "agv/config.h"
#include "agv/protocol.h"
#include "decide/fault_monitor.h"

/** Frames are counted in a row: each row is one fault bit, one value or one command. */
enum {
    AGV_ROW_EPS_FAULTS = 0,      /**< eight: the fault bits of 167h */
    AGV_ROW_EPS_SUPPLY_LAST = 2, /**< the first three of them are those of the supply */
    AGV_ROW_VCU_ALARMS = 8,      /**< eight: the alarm bits of 363h */
    AGV_ROW_EPS_MODE = 16,
    AGV_ROW_GEAR_STATUS,
    AGV_ROW_THROTTLE_STATUS,
    AGV_ROW_STEERING_ANGLE,
    AGV_ROW_FAST_GAPS, /**< and the three after it: one a command */
    AGV_ROW_COUNT = AGV_ROW_FAST_GAPS + (int)AGV_COMMAND_COUNT
};

/** What is counted. */
typedef struct {
    uint8_t in_a_row[AGV_ROW_COUNT];
    bool ai_alarm_armed; /**< VCU alarm bit 3 was clear with the AI alive (SUP-8) */
    bool after_gap;      /**< this frame came more than two cycles after the one before */
} agv_status_checks_t;

/** What the checks go by. */
typedef struct {
    const agv_config_t *config;
    bool engaged;
    bool settled;  /**< engaged for engaged_grace_ms: the checks of SUP-5 count */
    bool ai_alive;
} agv_status_facts_t;

/** A frame of a message begins to be checked. @param gap_ms since the one before, AGV_AGE_MAX: unknown */
void agv_status_checks_frame(agv_status_checks_t *checks, uint32_t message, uint32_t gap_ms);

/** 363h: alarms. */
void agv_status_checks_vehicle(agv_status_checks_t *checks, agv_fault_monitor_t *faults,
                               const agv_status_facts_t *facts, const uint8_t data[AGV_DLC]);

/** 167h: mode and fault bits. */
void agv_status_checks_eps(agv_status_checks_t *checks, agv_fault_monitor_t *faults, const agv_status_facts_t *facts,
                           const uint8_t data[AGV_DLC], bool valid);

/** 0A3h, 050h, 067h: whether the value is one that the protocol knows. */
void agv_status_checks_value(agv_status_checks_t *checks, agv_fault_monitor_t *faults, const agv_status_facts_t *facts,
                             uint32_t message, bool valid);

/** A command: its gap to the one before (SUP-6). */
void agv_status_checks_rate(agv_status_checks_t *checks, agv_fault_monitor_t *faults, agv_timers_t *timers,
                            const agv_config_t *config, uint32_t command, uint32_t gap_ms);

/** The autopilot was disengaged: what only counts while engaged ends. */
void agv_status_checks_disengage(agv_status_checks_t *checks, agv_fault_monitor_t *faults);

/** A reset was accepted: VCU alarm bit 3 does not count before it was clear with the AI alive (SUP-8). */
void agv_status_checks_forget_ai(agv_status_checks_t *checks);

#endif
