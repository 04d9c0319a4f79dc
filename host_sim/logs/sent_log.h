/**
 * @file sent_log.h
 * The frames that the supervisor sent, as a candump log: one line a frame, in the order of sending.
 *
 * A side's lines name the interface on which its first frame was received. Frames that are sent before that wait in
 * memory, and so do all later ones, in their order. If there are too many of them, and at the end, the side gets a
 * made-up name.
 */
#ifndef HOST_SIM_SENT_LOG_H
#define HOST_SIM_SENT_LOG_H

#include <stddef.h>
#include <stdint.h>

#include "hal/can.h"
#include "io/output.h"
#include "logs/candump_line.h"

#define SENT_LOG_WAITING_MAX 32768u /**< frames: 1 MiB */

/** A frame that waits for its interface's name. */
typedef struct {
    uint64_t stamp_us;
    hal_can_side_t side;
    uint16_t id;
    uint8_t length;
    uint8_t data[8];
} sent_log_frame_t;

_Static_assert(sizeof(sent_log_frame_t) <= 32, "waiting frames take 1 MiB at most");

/** The log. All zero but for `output`: nothing received yet. Some 1 MiB: not for the stack. */
typedef struct {
    output_t *output;                                          /**< NULL: nothing is written */
    char interfaces[HAL_CAN_SIDES][CANDUMP_INTERFACE_MAX + 1]; /**< "" = not known yet */
    size_t waiting_count;
    sent_log_frame_t waiting[SENT_LOG_WAITING_MAX];
} sent_log_t;

/** Name the interface of a side; only the first call for a side counts. */
void sent_log_heard(sent_log_t *log, hal_can_side_t side, const char *interface, size_t length);

/** A frame was sent. */
void sent_log_add(sent_log_t *log, hal_can_side_t side, const hal_can_frame_t *frame, uint64_t stamp_us);

/** No more is to come: write what waits. */
void sent_log_finish(sent_log_t *log);

#endif
