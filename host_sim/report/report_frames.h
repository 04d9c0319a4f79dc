/**
 * @file report_frames.h
 * The frames around the cause of a trip, for the report.
 */
#ifndef HOST_SIM_REPORT_FRAMES_H
#define HOST_SIM_REPORT_FRAMES_H

#include <jansson.h>

#include "agv/config.h"
#include "report/series.h"
#include "why/why.h"

#define REPORT_FRAMES_MAX 400u

/**
 * Add `frames` to a trip: [time in us, side, whether the supervisor sent it, identifier, data, message, signals, whether
 * it is of the message that tells], and `frames_left_out`, how many found no room.
 */
void report_frames_add(json_t *trip_object, const agv_config_t *config, const why_trip_t *trip, const series_t *series);

#endif
