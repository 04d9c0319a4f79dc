/* hal/can.h: the CAN controllers. */
#include "hal/can.h"

#include "hal_template/hal_template.h"

bool hal_template_receive(hal_t *hal, hal_can_side_t side, hal_can_frame_t *frame) {
    (void)hal;
    (void)side;
    (void)frame;
    /*
     * TODO: take a frame from the queue that the receive interrupt fills.
     * - time_ms is stamped in the interrupt (or by the hardware), not here: a backlog must not look fresh.
     * - Extended, remote and FD frames are handed over too, with their flag: they are counted.
     * - data beyond length is 0.
     * - When the queue was full, or the controller reports a lost frame, count overrun_count.
     */
    return false;
}

bool hal_can_send(hal_t *hal, hal_can_side_t side, const hal_can_frame_t *frame) {
    (void)hal;
    (void)side;
    (void)frame;
    /*
     * TODO: put it in a free mailbox (mailboxes: lowest identifier first; of two with one identifier the older first) or
     * in a queue that the transmit interrupt empties. Never wait. Remember when it was taken: tx_pending_ms.
     * false: no room, bus-off, no such side.
     */
    return false;
}

void hal_can_purge(hal_t *hal, hal_can_side_t side) {
    (void)hal;
    (void)side;
    /*
     * TODO: empty the queue and ask the controller to abort every mailbox. Do not wait for the abort; a frame that is
     * being shifted out may still leave, but must not be tried again.
     */
}

void hal_can_recover(hal_t *hal, hal_can_side_t side) {
    (void)hal;
    (void)side;
    /* TODO: only in bus-off: start the recovery (128 times 11 recessive bits); the state shows when it is over. */
}

void hal_can_status(hal_t *hal, hal_can_side_t side, hal_can_status_t *status) {
    *status = (hal_can_status_t){.state = HAL_CAN_ERROR_ACTIVE};
    if ((unsigned)side < HAL_CAN_SIDES) {
        /*
         * TODO: read the error state from the controller, and the age of the oldest frame that was taken and has not left.
         * Count bus_off_count in the interrupt: a bus-off that is over when somebody looks is still one.
         */
        *status = hal->can_status[side];
    }
}
