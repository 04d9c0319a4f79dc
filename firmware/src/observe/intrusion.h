/**
 * @file intrusion.h
 * Commands that come too fast: a second sender of the AI computer's commands (SUP-6, COMMAND_TOO_FAST).
 */
#ifndef AGV_INTRUSION_H
#define AGV_INTRUSION_H

#include <stdbool.h>
#include <stdint.h>

#include "agv/config.h"
#include "agv/protocol.h"
#include "base/score.h"
#include "decide/fault_monitor.h"
#include "observe/liveness.h"

/** Scores of gaps shorter than half the cycle. */
typedef struct {
    agv_score_t fast_gaps[AGV_COMMAND_COUNT];
} agv_intrusion_t;

/** A well-formed command arrived. @param gap_ms since the one before; AGV_AGE_MAX: unknown, does not count */
void agv_intrusion_command(agv_intrusion_t *intrusion, const agv_config_t *config, uint32_t command, uint32_t gap_ms);

/** Set the fault; a silence longer than the deadline of a command sets its score to 0. Call at every tick and command. */
void agv_intrusion_evaluate(agv_intrusion_t *intrusion, agv_fault_monitor_t *faults, const agv_timers_t *timers,
                            const agv_config_t *config, const agv_liveness_t *liveness);

#endif
