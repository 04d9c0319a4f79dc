/* hal/can.h: the CAN controllers. */
#include "hal/can.h"

#include "hal_template/hal_template.h"

bool hal_template_receive(hal_t *hal, hal_can_side_t side, hal_can_frame_t *frame) {
    (void)hal;
    (void)side;
    (void)frame;
    /*
     * TODO: take a frame from the queue that the receive interrupt fills.
     * - Stamp time_ms in the interrupt (or by the hardware), not here, so that a backlog does not look fresh.
     * - Pass on extended, remote and FD frames too, with their flag: the supervisor counts them.
     * - Set the data bytes beyond length to 0.
     * - When the queue was full or the controller reports a lost frame, increment overrun_count.
     */
    return false;
}

bool hal_can_send(hal_t *hal, hal_can_side_t side, const hal_can_frame_t *frame) {
    (void)hal;
    (void)side;
    (void)frame;
    /*
     * TODO: put the frame in a free mailbox, or in a queue that the transmit interrupt empties. The lowest identifier
     * is sent first. In a queue the frame replaces all with its identifier that were put there more than 1 ms ago, and
     * takes over the age of the oldest. Never wait. Store the time of the request, for tx_pending_ms. Return false: no
     * room, bus-off, or the side does not exist.
     */
    return false;
}

void hal_can_purge(hal_t *hal, hal_can_side_t side) {
    (void)hal;
    (void)side;
    /*
     * TODO: empty the queue and request the abort of every mailbox. Do not wait for the abort. A frame that is being
     * transmitted may still be sent, but must not be retransmitted.
     */
}

void hal_can_recover(hal_t *hal, hal_can_side_t side) {
    (void)hal;
    (void)side;
    /* TODO: only in bus-off: start the recovery (128 times 11 recessive bits); hal_can_status() shows when it has
     * ended. */
}

void hal_can_status(hal_t *hal, hal_can_side_t side, hal_can_status_t *status) {
    *status = (hal_can_status_t){.state = HAL_CAN_ERROR_ACTIVE};
    if ((unsigned)side < HAL_CAN_SIDES) {
        /*
         * TODO: read the error state from the controller, and the age of the oldest accepted frame that is not sent
         * yet. Increment bus_off_count in the interrupt, so that a bus-off that ends before this call is counted, too.
         */
        *status = hal->can_status[side];
    }
}
