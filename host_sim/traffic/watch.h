/**
 * @file watch.h
 * What the deadline of a message measures: the gaps between the frames that restart it.
 */
#ifndef HOST_SIM_WATCH_H
#define HOST_SIM_WATCH_H

#include "traffic/traffic.h"

/** Set up the deadline of a message of the protocol (below AGV_MSG_COUNT). */
void watch_init(traffic_watch_t *watch, const agv_config_t *config, uint32_t message);

/** A frame restarts the deadline. */
void watch_restart(traffic_watch_t *watch, uint64_t t_us);

/** The deadline starts afresh (an engagement begins). */
void watch_start(traffic_watch_t *watch, uint64_t t_us);

/** The deadline runs on (an engagement is continued), from this time at the earliest. */
void watch_resume(traffic_watch_t *watch, uint64_t began_us);

/** The deadline stops (an engagement or the run is over). A silence that is late counts. */
void watch_stop(traffic_watch_t *watch, uint64_t t_us);

#endif
