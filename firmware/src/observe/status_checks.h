/**
 * @file status_checks.h
 * Faults that the content of status frames is: fault bits and alarms (SUP-4), EPS mode and invalid values (SUP-5). Faults
 * that need several frames are scored (score.h).
 */
#ifndef AGV_STATUS_CHECKS_H
#define AGV_STATUS_CHECKS_H

#include <stdbool.h>
#include <stdint.h>

#include "agv/config.h"
#include "agv/protocol.h"
#include "base/score.h"
#include "decide/fault_monitor.h"

/** How many fault bits of 167h are scored: under voltage, over voltage, excessive current. */
#define AGV_SCORED_EPS_BITS 3u

/** The values that are scored, in the order of their messages: gear (0A3h), throttle (050h), angle (067h). */
#define AGV_SCORED_VALUES 3u

/** The scores. */
typedef struct {
    agv_score_t eps_bits[AGV_SCORED_EPS_BITS];
    agv_score_t eps_mode;
    agv_score_t values[AGV_SCORED_VALUES];
    agv_score_t hold_angle; /**< of the angle, counted also while not judged (FSM-10) */
    uint8_t eps_mode_fault; /**< agv_fault_t: what the last EPS mode that was not angle control is called */
    bool ai_alarm;          /**< VCU alarm bit 3 was set in the last 363h */
    bool reported;          /**< one of the faults that depend on the engagement was set at the last evaluation */
    bool ai_alarm_armed;    /**< and was once clear with the AI alive (SUP-8) */
} agv_status_checks_t;

/** 363h: alarms. */
void agv_status_checks_vehicle(agv_status_checks_t *checks, agv_fault_monitor_t *faults, const uint8_t data[AGV_DLC],
                               bool ai_alive);

/** 167h: mode and fault bits. @param judged the mode counts */
void agv_status_checks_eps(agv_status_checks_t *checks, agv_fault_monitor_t *faults, const agv_config_t *config,
                           const uint8_t data[AGV_DLC], bool valid, bool judged);

/** 0A3h, 050h, 067h: whether the value is one that the protocol knows. @param judged it counts */
void agv_status_checks_value(agv_status_checks_t *checks, const agv_config_t *config, uint32_t message, bool valid,
                             bool judged);

/** Set the faults that depend on the engagement, too. Call in every call, when scores and mode are up to date. */
void agv_status_checks_evaluate(agv_status_checks_t *checks, agv_fault_monitor_t *faults, bool engaged, bool judged);

/** An engagement began: the scores of what is judged begin at 0. */
void agv_status_checks_engage(agv_status_checks_t *checks);

/** Whether the measured angle is usable for the steering hold (FSM-10). */
bool agv_status_checks_angle_is_usable(const agv_status_checks_t *checks);

#endif
