/**
 * @file engagement.h
 * Whether the vehicle is engaged, as 363h reports it and the supervisor counts it (SUP-9).
 */
#ifndef HOST_SIM_ENGAGEMENT_H
#define HOST_SIM_ENGAGEMENT_H

#include <stdbool.h>
#include <stdint.h>

#include "agv/config.h"

/** Begin with all zero: not engaged. */
typedef struct {
    bool is_engaged;
    bool is_continued;   /**< it followed the one before within `reengage_ms`: they are one (requirements.md, Words) */
    bool has_begun;      /**< once at least */
    uint32_t off_frames; /**< 363h in a row without autopilot mode */
    uint64_t began_us;   /**< of the last one; of the first one of those that are one */
    uint64_t ended_us;
} engagement_t;

/**
 * Take the byte of a 363h that has the mode. Autopilot begins an engagement, `mode_frames` in a row without it end it; with
 * both modes the one before remains.
 * @return whether the engagement began or ended
 */
bool engagement_take(engagement_t *engagement, const agv_config_t *config, uint8_t flags, uint64_t t_us);

/** The VCU is lost: an engagement ends. */
void engagement_end(engagement_t *engagement, uint64_t t_us);

#endif
