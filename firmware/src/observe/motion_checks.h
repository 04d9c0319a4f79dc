/**
 * @file motion_checks.h
 * Whether the vehicle does what it was told (SUP-5, SUP-10, SUP-11), and whether its two speeds agree (SUP-12). Each is a
 * budget of time (score.h).
 */
#ifndef AGV_MOTION_CHECKS_H
#define AGV_MOTION_CHECKS_H

#include <stdbool.h>
#include <stdint.h>

#include "agv/config.h"
#include "base/score.h"
#include "decide/fault_monitor.h"
#include "observe/commands.h"
#include "observe/vehicle.h"

/** The budgets. */
typedef enum {
    AGV_BUDGET_STEERING,
    AGV_BUDGET_THROTTLE,
    AGV_BUDGET_GEAR,
    AGV_BUDGET_AUTOPILOT_OFF,
    AGV_BUDGET_THROTTLE_IN_PARK,
    AGV_BUDGET_SPEED, /**< the one that is not judged: it counts always */
    AGV_BUDGET_COUNT
} agv_budget_name_t;

/** State of the checks. */
typedef struct {
    agv_budget_t budgets[AGV_BUDGET_COUNT];
    int16_t steering_gain_ddeg; /**< by which the steering has come nearer by its own motion */
    int16_t throttle_drop;      /**< counts by which 050h has come down */
    bool reported;              /**< one of the faults was set at the last evaluation */
} agv_motion_checks_t;

/** What the checks go by. */
typedef struct {
    const agv_config_t *config;
    const agv_vehicle_t *vehicle;
    const agv_commands_t *commands;
    bool judged;
    bool gear_fresh; /**< 0A3h is fresh */
} agv_motion_facts_t;

/** A valid 067h: the measured angle moved from @p before_raw to that of the vehicle. */
void agv_motion_checks_angle(agv_motion_checks_t *checks, const agv_motion_facts_t *facts, uint32_t before_raw);

/** A valid 050h: the throttle status moved from @p before to that of the vehicle. */
void agv_motion_checks_throttle(agv_motion_checks_t *checks, const agv_motion_facts_t *facts, uint32_t before);

/** Time has passed. Call at every tick. */
void agv_motion_checks_tick(agv_motion_checks_t *checks, const agv_motion_facts_t *facts, uint32_t elapsed_ms);

/** Set the faults: what is judged ends when it is no longer. Call in every call. */
void agv_motion_checks_evaluate(agv_motion_checks_t *checks, agv_fault_monitor_t *faults, bool judged);

/** An engagement began: the budgets of what is judged begin at 0. */
void agv_motion_checks_engage(agv_motion_checks_t *checks);

#endif
