/*
 * A port that takes everything, and keeps the last frame of one identifier that was sent.
 */
#ifndef NULL_HAL_H
#define NULL_HAL_H

#include <stdbool.h>
#include <stdint.h>

#include "hal/can.h"

struct hal {
    uint32_t kept_id; /* sent to the vehicle */
    bool is_kept;
    hal_can_frame_t kept;
};

#endif
