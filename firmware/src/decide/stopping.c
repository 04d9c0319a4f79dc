#include "decide/stopping.h"

/* The vehicle moves if a wheel turns at this speed for this time in all, until the wheels have stood for long. */
enum { MOVING_MM_S = 100, MOVING_MS = 200 };

void agv_stopping_start(agv_stopping_t *stopping, agv_timers_t *timers) {
    *stopping = (agv_stopping_t){0};
    stopping->stood = agv_vehicle_wheels_stand(timers);
    agv_timer_start(timers, AGV_TIMER_STOP);
}

void agv_stopping_step(agv_stopping_t *stopping, const agv_timers_t *timers, const agv_vehicle_t *vehicle,
                       uint32_t elapsed_ms) {
    const uint32_t seen_ms = vehicle->wheels_fresh ? elapsed_ms : 0u; /* a slow 101h hides nothing either */
    agv_budget_gather(&stopping->moved, agv_vehicle_may_move(vehicle, MOVING_MM_S), seen_ms, MOVING_MS);
    if (agv_vehicle_wheels_stand(timers)) {
        if (!stopping->stood || agv_timer_reached(timers, AGV_TIMER_WHEELS_STOOD)) {
            stopping->moved = (agv_budget_t){0}; /* the way to the stop, and what was long ago */
        }
        stopping->stood = true;
        stopping->not_stopping = false;
        stopping->moving = false;
        return;
    }
    if (!stopping->stood && agv_timer_reached(timers, AGV_TIMER_STOP)) {
        stopping->not_stopping = true;
    }
    if (stopping->stood && (stopping->moved.value_ms == (uint16_t)MOVING_MS)) {
        stopping->moving = true;
    }
}
