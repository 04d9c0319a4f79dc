/**
 * @file series_internal.h
 * What a series keeps; for series.c and series_json.c.
 */
#ifndef HOST_SIM_SERIES_INTERNAL_H
#define HOST_SIM_SERIES_INTERNAL_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "report/series.h"
#include "report/series_overview.h"
#include "report/series_read.h"

#define SERIES_RING_FRAMES 65536u /* a power of two */
#define SERIES_LOST_US 300000u    /* a signal that was not heard for so long has no value; longer than any cycle */

/** What changes by steps. Each change has its place in a lane. */
typedef enum {
    SERIES_LANE_STATE,
    SERIES_LANE_MODE,
    SERIES_LANE_GEAR,
    SERIES_LANE_GEAR_COMMAND,
    SERIES_LANE_GEAR_SENT,
    SERIES_LANE_OUTPUT,
    SERIES_LANE_LED,
    SERIES_LANE_FAULT,
    SERIES_LANE_NOTE,
    SERIES_LANES
} series_lane_t;

/** A change; a, b, c, missing: of state, output, fault and note as in agv_event_t; else `a` is the value,
 * and `c` is 1 when there is none. */
typedef struct {
    uint64_t t_us;
    uint16_t missing;
    uint8_t kind; /* agv_event_kind_t of a note */
    uint8_t a;
    uint8_t b;
    uint8_t c;
} series_change_t;

/** The changes of a lane. */
typedef struct {
    size_t count;
    uint64_t left_out;
    uint64_t seen_us; /* when its value was heard last */
    series_change_t last;
    series_change_t changes[SERIES_CHANGES_MAX];
} series_changes_t;

/** The surroundings of a trip. */
typedef struct {
    uint64_t trip_us;
    uint64_t from_us;
    uint64_t to_us;
    bool is_kept; /* `frames` was taken from the ring */
    size_t count;
    series_frame_t *frames;
} series_detail_t;

struct series {
    series_reader_t reader;
    series_ages_t ages;
    series_overview_t overview;
    uint64_t end_us;
    uint64_t due_us; /* when the next detail is complete; UINT64_MAX: none is waited for */
    series_changes_t lanes[SERIES_LANES];
    size_t detail_count;
    series_detail_t details[SERIES_DETAILS_MAX];
    uint64_t ring_next; /* number of frames that were put into the ring */
    series_frame_t ring[SERIES_RING_FRAMES];
};

#endif
