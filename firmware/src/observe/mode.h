/**
 * @file mode.h
 * The mode that 363h byte 7 reports (manual, engaged), and what follows from it over time: the engagement and its grace,
 * both mode bits at once (MODE_INVALID).
 */
#ifndef AGV_MODE_H
#define AGV_MODE_H

#include <stdbool.h>
#include <stdint.h>

#include "agv/codec.h"
#include "base/timers.h"

/** Mode. While both bits are set the mode before stands, until MODE_INVALID; then it is none. */
typedef enum {
    AGV_MODE_NONE = 0,
    AGV_MODE_MANUAL = AGV_VCU_FLAG_MANUAL,
    AGV_MODE_ENGAGED = AGV_VCU_FLAG_AUTOPILOT
} agv_mode_value_t;

/** The mode of one vehicle. */
typedef struct {
    uint8_t value; /**< agv_mode_value_t */
} agv_mode_t;

/** What became of the engagement. */
typedef enum { AGV_MODE_SAME, AGV_MODE_BEGAN, AGV_MODE_ENDED } agv_mode_change_t;

/** A 363h with these flags (byte 7) arrived. */
agv_mode_change_t agv_mode_report(agv_mode_t *mode, agv_timers_t *timers, uint32_t flags, uint32_t time_ms);

/** Evaluate what depends on time. Call at every tick. */
agv_mode_change_t agv_mode_tick(agv_mode_t *mode, agv_timers_t *timers);

/** Whether the autopilot is engaged. */
bool agv_mode_is_engaged(const agv_mode_t *mode);

/** Whether manual is reported. */
bool agv_mode_is_manual(const agv_mode_t *mode);

/** Whether the engagement has lasted for engaged_grace_ms: the checks of SUP-5 count. */
bool agv_mode_is_settled(const agv_timers_t *timers);

/** Whether both mode bits have been set for too long. */
bool agv_mode_is_invalid(const agv_timers_t *timers);

/** Whether the last 363h had both mode bits: it confirms nothing. */
bool agv_mode_is_ambiguous(const agv_timers_t *timers);

#endif
