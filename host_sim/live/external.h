/**
 * @file external.h
 * An external supervisor: another program on the same CAN interfaces, for example the firmware built for Linux.
 *
 * A command starts it. It prints its events on standard output as JSON Lines (events.h); other lines are ignored. Its
 * frames are those that are received and that the vehicle did not send (external_vehicle_sent()).
 */
#ifndef HOST_SIM_EXTERNAL_H
#define HOST_SIM_EXTERNAL_H

#include <stdbool.h>
#include <stdint.h>

#include "hal/can.h"
#include "hal_linux/linux_clock.h"
#include "live/node.h"
#include "session/session.h"

typedef struct external external_t;

/** How one is made. */
typedef struct {
    const char *command;                   /**< for the shell */
    const char *interfaces[HAL_CAN_SIDES]; /**< the AI side: NULL on the shared bus */
    const linux_clock_t *clock;            /**< of all times */
    uint64_t delay_us; /**< frames are reported so late: the event that comes with a frame is read after it */
    session_observer_fn *on_event;
    node_sent_fn *on_sent; /**< at_us by the clock */
    void *ctx;             /**< of both */
} external_config_t;

/**
 * Listen on the interfaces. The program does not run yet.
 * @return NULL: that was reported
 */
external_t *external_open(const external_config_t *config);

/** Start the program. @return false: reported */
bool external_start(external_t *external);

/** Wait for its first event. @return false: timeout, or it has ended; reported */
bool external_wait(external_t *external);

/** The vehicle has sent a frame. */
void external_vehicle_sent(external_t *external, hal_can_side_t side, const hal_can_frame_t *frame);

/**
 * Report received frames and events; call it every millisecond, after external_vehicle_sent().
 * @return false: it has ended, or there were too many frames; reported
 */
bool external_listen(external_t *external);

/** Whether the last event of its safety output was "closed". */
bool external_output_closed(const external_t *external);

/** Report the frames that are not reported yet. */
void external_finish(external_t *external);

/** Stop it, and listen no more; NULL: nothing. */
void external_close(external_t *external);

#endif
