/*
 * A port that accepts everything, and keeps the last sent frame of one identifier.
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
