/**
 * @file vehicle_show.h
 * What `host_sim vehicle` prints: a line for every event, and below them, on a terminal, a line that shows what the
 * vehicle is doing. Under that one is typed.
 */
#ifndef HOST_SIM_VEHICLE_SHOW_H
#define HOST_SIM_VEHICLE_SHOW_H

#include <stdbool.h>
#include <stdint.h>

#include "vehicle/vehicle.h"

/** Change it through the functions. */
typedef struct {
    bool is_live;        /**< standard output is a terminal */
    bool is_typed;       /**< standard input is one, too */
    bool is_drawn;       /**< the status line stands above the cursor's */
    bool has_begun;      /**< nodes that start with the run are no event */
    uint64_t draw_ms;    /**< when to draw it anew */
    vehicle_view_t view; /**< the last one */
} vehicle_show_t;

/** Nothing shown yet. @param view the vehicle as it is now */
void vehicle_show_init(vehicle_show_t *show, const vehicle_view_t *view);

/** Print an event: actor and action. */
void vehicle_show_event(vehicle_show_t *show, uint64_t t_ms, const char *who, const char *format, ...)
    __attribute__((format(printf, 4, 5)));

/** The vehicle is in this state now: print what has changed, draw the status line if it is time. */
void vehicle_show_view(vehicle_show_t *show, uint64_t t_ms, const vehicle_view_t *view);

/** Print the status as a line. */
void vehicle_show_status(vehicle_show_t *show);

/** Make room for what is printed otherwise. @param line_typed whether Enter was pressed on a terminal just now */
void vehicle_show_clear(vehicle_show_t *show, bool line_typed);

#endif
