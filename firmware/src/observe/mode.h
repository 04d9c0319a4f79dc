/**
 * @file mode.h
 * The mode that 363h byte 7 reports: manual, engaged, one engagement, judged (defined in docs/requirements.md); and the
 * faults of the mode itself (MODE_INVALID; SUP-9).
 */
#ifndef AGV_MODE_H
#define AGV_MODE_H

#include <stdbool.h>
#include <stdint.h>

#include "agv/config.h"
#include "base/fault_monitor.h"
#include "base/score.h"
#include "base/timers.h"

/** The mode of one vehicle. */
typedef struct {
    uint8_t bits;       /**< of the last 363h: AGV_VCU_FLAG_MANUAL, AGV_VCU_FLAG_AUTOPILOT */
    uint8_t off_frames; /**< consecutive 363h without the autopilot bit */
    uint8_t oldest;     /**< index of the oldest of the last three engagements */
    bool heard;         /**< a 363h was received */
    bool engaged;
    bool manual;
    agv_budget_t manual_spent; /**< how long manual was reported while engaged */
    agv_budget_t both_spent;   /**< how long the timer of "both mode bits" had run, while they are not both set */
    agv_budget_t none_spent;   /**< the same for "no valid mode" */
} agv_mode_t;

/** Change of the engagement. */
typedef enum {
    AGV_MODE_SAME,
    AGV_MODE_BEGAN,     /**< an engagement began */
    AGV_MODE_CONTINUED, /**< engaged again within reengage_ms: the previous engagement continues */
    AGV_MODE_ENDED      /**< the engagement ended */
} agv_mode_change_t;

/**
 * Handle the flags (byte 7) of a received 363h.
 * @param vcu_alive the VCU is alive with this frame; otherwise no engagement begins
 * @param time_ms   receive time of the frame
 */
agv_mode_change_t agv_mode_report(agv_mode_t *mode, agv_timers_t *timers, const agv_config_t *config, uint32_t flags,
                                  bool vcu_alive, uint32_t time_ms);

/** Add the time since the last tick; end the engagement on MODE_INVALID and on loss of the VCU. Call at every tick. */
agv_mode_change_t agv_mode_tick(agv_mode_t *mode, agv_timers_t *timers, const agv_config_t *config, bool vcu_alive,
                                uint32_t elapsed_ms);

/** Count an engagement that began or continued in STANDBY or ACTIVE. The fourth within mode_flapping_ms trips (SUP-9). */
void agv_mode_count_engagement(agv_mode_t *mode, agv_timers_t *timers, agv_fault_monitor_t *faults);

/**
 * Set or end MODE_INVALID and MODE_NONE (SUP-9). Call at every tick. The condition of each must last for its time. A ms
 * without the condition subtracts only half a ms from that time, so that occasional good frames do not hide the fault.
 * Manual that flickers while engaged, and never ends the engagement, is MODE_FLAPPING: driving would not be judged. Its
 * budget is 250 ms, or half of mode_frames deadlines of 363h if that is more.
 * @param supervising the state is STANDBY or ACTIVE
 */
void agv_mode_check(agv_mode_t *mode, agv_timers_t *timers, agv_fault_monitor_t *faults, const agv_config_t *config,
                    bool supervising, bool standstill);

/** Whether the autopilot is engaged. */
bool agv_mode_is_engaged(const agv_mode_t *mode);

/** Whether the vehicle is in manual mode. */
bool agv_mode_is_manual(const agv_mode_t *mode);

/** Whether driving is judged: engaged_grace_ms after the engagement, while the last 363h has the autopilot bit. */
bool agv_mode_is_judged(const agv_mode_t *mode, const agv_timers_t *timers);

/** Whether the last 363h reports autopilot, and not also manual (TOP-2). */
bool agv_mode_reports_autopilot(const agv_mode_t *mode);

/** Whether the last 363h has both mode bits. Such a frame confirms nothing. */
bool agv_mode_is_ambiguous(const agv_mode_t *mode);

#endif
