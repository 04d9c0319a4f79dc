/**
 * @file intrusion.h
 * Detection of a rogue node that sends the AI computer's commands: they then come too fast (SUP-6, COMMAND_TOO_FAST).
 */
#ifndef AGV_INTRUSION_H
#define AGV_INTRUSION_H

#include <stdbool.h>
#include <stdint.h>

#include "agv/config.h"
#include "agv/protocol.h"
#include "base/fault_monitor.h"
#include "base/score.h"
#include "observe/liveness.h"

/** Scores of gaps between commands that are shorter than half the cycle. */
typedef struct {
    agv_score_t fast_gaps[AGV_COMMAND_COUNT];
} agv_intrusion_t;

/** Score a well-formed command. @param gap_ms since the previous one; AGV_AGE_MAX: unknown, not scored */
void agv_intrusion_command(agv_intrusion_t *intrusion, const agv_config_t *config, uint32_t command, uint32_t gap_ms);

/**
 * Set or end the fault. The score of a command whose deadline has expired is set to 0. Call at every tick and after every
 * command.
 */
void agv_intrusion_evaluate(agv_intrusion_t *intrusion, agv_fault_monitor_t *faults, const agv_timers_t *timers,
                            const agv_config_t *config, const agv_liveness_t *liveness);

#endif
