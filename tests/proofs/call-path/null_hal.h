/* A port that accepts everything and keeps nothing: that of hal/template accepts no frame. */
#ifndef NULL_HAL_H
#define NULL_HAL_H

#include "hal/can.h"

struct hal {
    char nothing; /* a struct has a member */
};

#endif
