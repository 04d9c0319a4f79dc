/**
 * @file image.h
 * The image in a build with a bootloader (MCUboot): when it is confirmed, and when an update is accepted. Without a bootloader
 * all of this does nothing.
 */
#ifndef AGV_APP_IMAGE_H
#define AGV_APP_IMAGE_H

#include "agv/supervisor.h"

#if defined(CONFIG_AGV_IMAGE)

/**
 * Call it after each supervise_once(). At the first STANDBY of a run the image is confirmed, by a thread of lower priority:
 * until then MCUboot brings the image before it back at the next reset.
 */
void image_follow(const agv_supervisor_t *supervisor);

#else

static inline void image_follow(const agv_supervisor_t *supervisor) {
    (void)supervisor;
}

#endif

#endif
