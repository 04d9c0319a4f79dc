/**
 * @file scenario_bus.h
 * A scenario file played on real CAN interfaces, in real time: the supervisor as a node (node.h), the vehicle as others
 * (vehicle_bus.h), evaluated as on the simulated bus.
 *
 * A computer is no clock: every time that the scenario expects is widened by a tolerance, and every time in which
 * something must hold throughout, or must not be, is narrowed by it. Counts stay as they are.
 */
#ifndef HOST_SIM_SCENARIO_BUS_H
#define HOST_SIM_SCENARIO_BUS_H

#include <stdbool.h>
#include <stdint.h>

#include "hal/can.h"
#include "io/events.h"
#include "live/node.h"
#include "scenario/check/scenario_check.h"
#include "scenario/scenario.h"
#include "session/session.h"

/** Where and how strictly. */
typedef struct {
    const char *interfaces[HAL_CAN_SIDES]; /**< the AI side: NULL, there is one interface only */
    uint32_t tolerance_ms;
    const char
        *command; /**< starts a supervisor that is another program (external.h); NULL: it is one of this program */
} scenario_bus_t;

/** More callbacks for the supervisor's events and frames. */
typedef struct {
    session_observer_fn *on_event; /**< or NULL */
    void *event_ctx;
    node_sent_fn *on_sent; /**< or NULL; at_us is the time of the run */
    void *sent_ctx;
} scenario_bus_watch_t;

/** Whether the interfaces are there. @return false: one is not; was reported */
bool scenario_bus_check(const scenario_bus_t *bus);

/**
 * Why a scenario cannot be shown on these interfaces.
 * @return NULL: it can
 */
const char *scenario_bus_leaves_out(const scenario_bus_t *bus, const scenario_t *scenario);

/**
 * Widen and narrow the times of a scenario's expectations, and drop what cannot be seen from outside of another
 * program: its counters. Once, before it is played.
 */
void scenario_bus_tolerate(const scenario_bus_t *bus, scenario_t *scenario);

/**
 * Play a scenario; takes its duration_ms. check->scenario must be it, and tolerated. What another program is the
 * supervisor of, its configuration included, is not looked into.
 * @param summary is filled in
 * @return false: not to its end (a signal, an interface that is gone); was reported
 */
bool scenario_bus_play(const scenario_bus_t *bus, scenario_check_t *check, const scenario_bus_watch_t *watch,
                       events_summary_t *summary);

#endif
