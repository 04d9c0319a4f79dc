/**
 * @file status_checks.h
 * Faults from the content of status frames: fault bits and alarms (SUP-4), EPS mode and invalid values (SUP-5). Faults
 * that need several frames are scored (score.h).
 */
#ifndef AGV_STATUS_CHECKS_H
#define AGV_STATUS_CHECKS_H

#include <stdbool.h>
#include <stdint.h>

#include "agv/config.h"
#include "agv/protocol.h"
#include "base/fault_monitor.h"
#include "base/score.h"

/** Number of fault bits of 167h that are scored: under voltage, over voltage, excessive current. */
#define AGV_SCORED_EPS_BITS 3u

/** The values that are scored, in the order of their messages: gear (0A3h), throttle (050h), angle (067h). */
#define AGV_SCORED_VALUES 3u

/** The scores. */
typedef struct {
    agv_score_t eps_bits[AGV_SCORED_EPS_BITS];
    agv_score_t eps_mode;
    agv_score_t values[AGV_SCORED_VALUES];
    agv_score_t hold_angle; /**< of the angle, counted also while driving is not judged (FSM-10) */
    uint8_t eps_mode_fault; /**< agv_fault_t: fault of the last EPS mode other than angle control */
    bool ai_alarm;          /**< VCU alarm bit 3 was set in the last 363h */
    bool reported;          /**< one of the faults that depend on the engagement was set at the last evaluation */
    bool ai_alarm_armed;    /**< VCU alarm bit 3 was once clear while the AI was alive (SUP-8) */
} agv_status_checks_t;

/** Check a 363h: alarms. */
void agv_status_checks_vehicle(agv_status_checks_t *checks, agv_fault_monitor_t *faults, const uint8_t data[AGV_DLC],
                               bool ai_alive);

/** Check a 167h: mode and fault bits. @param judged if false, the mode does not count */
void agv_status_checks_eps(agv_status_checks_t *checks, agv_fault_monitor_t *faults, const agv_config_t *config,
                           const uint8_t data[AGV_DLC], bool valid, bool judged);

/** Check the value of a 0A3h, 050h or 067h. @param judged if false, it only counts for the held angle */
void agv_status_checks_value(agv_status_checks_t *checks, const agv_config_t *config, uint32_t message, bool valid,
                             bool judged);

/** Set or end the faults that depend on the engagement. Call once per pass, after scores and mode are updated. */
void agv_status_checks_evaluate(agv_status_checks_t *checks, agv_fault_monitor_t *faults, bool engaged, bool judged);

/** Reset the scores of the judged checks, because an engagement began. */
void agv_status_checks_engage(agv_status_checks_t *checks);

/** Whether the measured angle is usable for the steering hold (FSM-10). */
bool agv_status_checks_angle_is_usable(const agv_status_checks_t *checks);

#endif
