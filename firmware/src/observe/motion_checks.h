/**
 * @file motion_checks.h
 * Checks whether the vehicle follows its commands (SUP-5, SUP-10, SUP-11), and whether its two speeds agree (SUP-12).
 * Each check has a time budget (score.h).
 */
#ifndef AGV_MOTION_CHECKS_H
#define AGV_MOTION_CHECKS_H

#include <stdbool.h>
#include <stdint.h>

#include "agv/config.h"
#include "base/fault_monitor.h"
#include "base/score.h"
#include "observe/commands.h"
#include "observe/vehicle.h"

/** The budgets. */
typedef enum {
    AGV_BUDGET_STEERING,
    AGV_BUDGET_THROTTLE,
    AGV_BUDGET_GEAR,
    AGV_BUDGET_AUTOPILOT_OFF,
    AGV_BUDGET_THROTTLE_IN_PARK,
    AGV_BUDGET_SPEED, /**< counts always; the others only while driving is judged */
    AGV_BUDGET_COUNT
} agv_budget_name_t;

/**
 * Progress of the vehicle towards a command, in 0.1 degrees or counts of 050h. Enough of it clears a budget. It counts from
 * 0 while the budget is 0. For some time after progress has cleared the budget, steps back count at any time, so a vehicle
 * that hunts, or one good frame in many, makes no progress. During this time a second count follows motion beyond the limit
 * alone, so that small motion around the command does not reduce the next progress.
 */
typedef struct {
    int16_t gained;
    int16_t gained_beyond;  /**< the second count; 0 at other times */
    uint16_t steps_back_ms; /**< for so long within the limit, steps back still count */
} agv_progress_t;

/** State of the checks. */
typedef struct {
    agv_budget_t budgets[AGV_BUDGET_COUNT];
    agv_progress_t steering;
    agv_progress_t throttle;
    bool reported; /**< one of the faults was set at the last evaluation */
} agv_motion_checks_t;

/** Inputs of the checks. */
typedef struct {
    const agv_config_t *config;
    const agv_vehicle_t *vehicle;
    const agv_commands_t *commands;
    bool judged;
    bool gear_fresh; /**< 0A3h is fresh */
} agv_motion_facts_t;

/** Handle a valid 067h: the measured angle changed from @p before_raw to that of the vehicle. */
void agv_motion_checks_angle(agv_motion_checks_t *checks, const agv_motion_facts_t *facts, uint32_t before_raw);

/** Handle a valid 050h: the throttle status changed from @p before to that of the vehicle. */
void agv_motion_checks_throttle(agv_motion_checks_t *checks, const agv_motion_facts_t *facts, uint32_t before);

/** Add the time since the last tick to the budgets. Call at every tick. */
void agv_motion_checks_tick(agv_motion_checks_t *checks, const agv_motion_facts_t *facts, uint32_t elapsed_ms);

/** Set or end the faults. Those of judged checks end when driving is no longer judged. Call once per pass. */
void agv_motion_checks_evaluate(agv_motion_checks_t *checks, agv_fault_monitor_t *faults, bool judged);

/**
 * Whether standing wheels in 101h are doubted (FSM-12): SPEED_IMPLAUSIBLE is active, and the speed of 363h does not agree with
 * 101h now. Without fresh 101h or a live VCU nothing agrees.
 */
bool agv_motion_checks_doubts_wheels(const agv_motion_checks_t *checks, const agv_vehicle_t *vehicle);

/** Reset the budgets of the judged checks, because an engagement began. */
void agv_motion_checks_engage(agv_motion_checks_t *checks);

#endif
