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
    uint32_t off_frames; /**< 363h in a row without autopilot mode */
} engagement_t;

/**
 * Take the byte of a 363h that has the mode. Autopilot begins an engagement, `mode_frames` in a row without it end it; with
 * both modes the one before remains.
 * @return whether the engagement began or ended
 */
bool engagement_take(engagement_t *engagement, const agv_config_t *config, uint8_t flags);

#endif
