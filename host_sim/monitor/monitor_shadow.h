/**
 * @file monitor_shadow.h
 * A supervisor that only listens: the shipped core in shadow mode on the simulated port, driven by the time stamps of
 * the frames.
 */
#ifndef HOST_SIM_MONITOR_SHADOW_H
#define HOST_SIM_MONITOR_SHADOW_H

#include <stdbool.h>
#include <stdint.h>

#include "agv/config.h"
#include "hal/can.h"
#include "session/session.h"
#include "text/units.h"

/** A longer leap of time is no silence of the bus, but a program that stood still, or a log with a hole. */
#define MONITOR_LEAP_MAX_US (10u * (uint64_t)US_PER_S)

typedef struct monitor_shadow monitor_shadow_t;

/**
 * Start one. Its observer is called for each event from its start on, with times of the run.
 * @return NULL: out of memory; not reported
 */
monitor_shadow_t *monitor_shadow_new(const agv_config_t *config, session_observer_fn *fn, void *ctx, uint64_t t_us);

/** A frame was received; one with an identifier of no message is passed over. */
void monitor_shadow_frame(monitor_shadow_t *shadow, hal_can_side_t side, const hal_can_frame_t *frame, uint64_t t_us);

/** Frames of a side were lost before it could see them. */
void monitor_shadow_overrun(monitor_shadow_t *shadow, hal_can_side_t side);

/** Run its ticks up to this time. @return false: too far, the program stood still in between; start it anew */
bool monitor_shadow_time(monitor_shadow_t *shadow, uint64_t t_us);

/** Its session, to read. */
const session_t *monitor_shadow_session(const monitor_shadow_t *shadow);

/** Free it; nothing for NULL. */
void monitor_shadow_free(monitor_shadow_t *shadow);

#endif
