/**
 * @file campaign_check.h
 * Checks the runs of a campaign by the frames on the wire, the safety output and the vehicle. Of what the supervisor
 * reports it uses the reason of the first trip, and that the safe state is confirmed.
 */
#ifndef HOST_SIM_CAMPAIGN_CHECK_H
#define HOST_SIM_CAMPAIGN_CHECK_H

#include <stdbool.h>
#include <stdint.h>

#include "campaign/campaign_plan.h"
#include "scenario/scenario_testbed.h"

#define CAMPAIGN_NEVER UINT64_MAX
#define CAMPAIGN_STATES_MAX 16u

/** The first condition that a run broke. */
typedef enum {
    CAMPAIGN_SOUND,
    CAMPAIGN_NOT_READY,     /**< before the cause the output was not closed, or (under way) the autopilot not engaged */
    CAMPAIGN_FALSE_TRIP,    /**< a safe command or an open output before the cause */
    CAMPAIGN_LATE,          /**< no safe frame (no open output) within the bound */
    CAMPAIGN_UNSAFE_FRAME,  /**< FSM-6: a frame that is not safe in INIT, or after the first safe one */
    CAMPAIGN_NOT_LATCHED,   /**< the output closed again, or the safe commands ended with it closed */
    CAMPAIGN_WRONG_REASON,  /**< the first reason is not what was caused, or the fault was not raised */
    CAMPAIGN_FALSE_CONFIRM, /**< SAFE, while the vehicle is not in P or not in manual */
    CAMPAIGN_NEVER_SETTLED, /**< at the end neither confirmed nor the output open */
    CAMPAIGN_BREAKS
} campaign_break_t;

/** "LATE"; "" for CAMPAIGN_SOUND. */
const char *campaign_break_name(campaign_break_t broken);

/** A change of state, as the supervisor reported it. */
typedef struct {
    uint64_t t_ms;
    uint8_t to;
    uint8_t reason;
} campaign_state_t;

typedef struct {
    const campaign_plan_t *plan;
    const scenario_testbed_t *testbed;
    uint64_t cause_us;
    uint64_t first_safe_us; /**< last bit of the first safe frame after the cause; CAMPAIGN_NEVER */
    uint64_t confirmed_us;  /**< SAFE for the first time */
    uint64_t opened_us;     /**< the output for the first time after the cause */
    uint64_t closed_us;     /**< the output for the first time */
    uint64_t last_beat_us;  /**< last 43Fh of its own since the first safe frame */
    campaign_break_t broken;
    uint64_t broken_us;
    hal_can_frame_t broken_frame; /**< CAMPAIGN_UNSAFE_FRAME */
    bool engaged;                 /**< when the cause came */
    bool raised;                  /**< the fault of the row */
    bool bus_off;                 /**< BUS_OFF was raised */
    bool was_closed;
    uint64_t heard_us; /**< the last frame of the row's message */
    bool silent;       /**< at the first trip, that was more than two of its cycles ago */
    int reason;        /**< of the first trip; -1: none */
    bool holds;
    uint16_t held; /**< angle in the first 065h of its own */
    int32_t
        reported_ddeg; /**< the angle when the steps came; the last one that 067h reported, if they make it invalid */
    bool eps_takes_angles; /**< as the last 167h said */
    bool held_later;       /**< at the trip the EPS was not in angle control (FSM-10) */
    int32_t
        angle_ddeg; /**< the angle to hold: at the trip, or when the EPS came to angle control; or the reported one */
    campaign_state_t states[CAMPAIGN_STATES_MAX];
    size_t state_count;
} campaign_check_t;

/** A command that takes the drive away: gear P, throttle 0, autopilot off. 065h, which holds the steering, is none. */
bool campaign_is_safe_command(agv_message_t message, const hal_can_frame_t *frame);

/** Whether the row of the fault has a flag, CAMPAIGN_*. */
static inline bool campaign_has_flag(const campaign_check_t *check, uint32_t flag) {
    return (check->plan->row->flags & flag) != 0;
}

void campaign_check_init(campaign_check_t *check, const campaign_plan_t *plan, const scenario_testbed_t *testbed);

/** The callbacks for events and frames. */
scenario_watch_t campaign_check_watch(campaign_check_t *check);

/** At the end of every millisecond. */
void campaign_check_tick(campaign_check_t *check, uint64_t t_ms);

/** The run is over. */
void campaign_check_finish(campaign_check_t *check);

#endif
