/**
 * @file mode.h
 * The mode that 363h byte 7 reports: manual, engaged, one engagement, judged (the words of docs/requirements.md), and what
 * is wrong with the mode itself (MODE_INVALID; SUP-9).
 */
#ifndef AGV_MODE_H
#define AGV_MODE_H

#include <stdbool.h>
#include <stdint.h>

#include "agv/config.h"
#include "base/score.h"
#include "base/timers.h"
#include "decide/fault_monitor.h"

/** The mode of one vehicle. */
typedef struct {
    uint8_t bits;       /**< of the last 363h: AGV_VCU_FLAG_MANUAL, AGV_VCU_FLAG_AUTOPILOT */
    uint8_t off_frames; /**< 363h in a row without the autopilot bit */
    uint8_t oldest;     /**< which of the last three engagements is the oldest */
    bool heard;         /**< there was a 363h */
    bool engaged;
    bool manual;
    agv_budget_t both_spent; /**< what the timer of both mode bits has run for, while they are not both set */
    agv_budget_t none_spent; /**< the same of neither mode bit */
} agv_mode_t;

/** What became of the engagement. */
typedef enum {
    AGV_MODE_SAME,
    AGV_MODE_BEGAN,     /**< an engagement began */
    AGV_MODE_CONTINUED, /**< engaged again within reengage_ms: the engagement of before goes on */
    AGV_MODE_ENDED
} agv_mode_change_t;

/**
 * A 363h with these flags (byte 7) arrived.
 * @param vcu_alive the frame leaves the VCU alive: without that no engagement begins
 * @param time_ms   receive time of the frame
 */
agv_mode_change_t agv_mode_report(agv_mode_t *mode, agv_timers_t *timers, const agv_config_t *config, uint32_t flags,
                                  bool vcu_alive, uint32_t time_ms);

/** The time has passed: MODE_INVALID and the loss of the VCU end the engagement. Call at every tick. */
agv_mode_change_t agv_mode_tick(agv_mode_t *mode, agv_timers_t *timers, bool vcu_alive, uint32_t elapsed_ms);

/** SUP-9: an engagement began or was continued in STANDBY or ACTIVE. The fourth within mode_flapping_ms is a fault. */
void agv_mode_count_engagement(agv_mode_t *mode, agv_timers_t *timers, agv_fault_monitor_t *faults);

/**
 * SUP-9, MODE_INVALID: set the faults of the mode. Call at every tick. Each has a time for which its condition has to last.
 * A ms without the condition takes half a ms off what has passed, so a right frame now and then does not hide the fault.
 * @param supervising the state is STANDBY or ACTIVE
 */
void agv_mode_check(agv_mode_t *mode, agv_timers_t *timers, agv_fault_monitor_t *faults, const agv_config_t *config,
                    bool supervising, bool standstill);

/** Engaged. */
bool agv_mode_is_engaged(const agv_mode_t *mode);

/** Manual. */
bool agv_mode_is_manual(const agv_mode_t *mode);

/** Judged: from engaged_grace_ms after the engagement on, and while the last 363h has the autopilot bit. */
bool agv_mode_is_judged(const agv_mode_t *mode, const agv_timers_t *timers);

/** Whether the last 363h reports autopilot, and not manual too (TOP-2). */
bool agv_mode_reports_autopilot(const agv_mode_t *mode);

/** Whether the last 363h has both mode bits: it confirms nothing. */
bool agv_mode_is_ambiguous(const agv_mode_t *mode);

#endif
