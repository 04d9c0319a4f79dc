/* The controller's state, from its error frames, from the kernel's reports and from whether the interface is up. */
#include <linux/can/error.h>

#include "linux_hal_internal.h"

enum { CONTROLLER_DETAILS = 1 }; /* byte of an error frame with the bits CAN_ERR_CRTL_* */

/* Looks that must find bus-off over: the error frame that says so, read between them, goes first. */
enum { LOOKS_RESTARTED = 2 };

static void enter_bus_off(linux_hal_side_t *side) {
    if (side->state != HAL_CAN_BUS_OFF) {
        side->bus_offs++;
    }
    side->state = HAL_CAN_BUS_OFF;
    side->looks_restarted = 0;
    linux_hal_queue_discard(side);
}

void linux_hal_controller_error(linux_hal_side_t *side, const hal_can_frame_t *frame) {
    const unsigned details = ((frame->id & CAN_ERR_CRTL) != 0) ? frame->data[CONTROLLER_DETAILS] : 0;
    if ((details & CAN_ERR_CRTL_RX_OVERFLOW) != 0) {
        side->overruns++;
    }
    if ((frame->id & CAN_ERR_BUSOFF) != 0) {
        enter_bus_off(side);
        return;
    }
    if ((frame->id & CAN_ERR_RESTARTED) != 0) {
        enter_bus_off(side); /* there was one, even if its error frame was lost */
    }
    if ((frame->id & CAN_ERR_RESTARTED) != 0 || (details & CAN_ERR_CRTL_ACTIVE) != 0) {
        side->state = HAL_CAN_ERROR_ACTIVE;
    }
    if (side->state == HAL_CAN_BUS_OFF) {
        return;
    }
    if ((details & (CAN_ERR_CRTL_RX_PASSIVE | CAN_ERR_CRTL_TX_PASSIVE)) != 0) {
        side->state = HAL_CAN_ERROR_PASSIVE;
    } else if ((details & (CAN_ERR_CRTL_RX_WARNING | CAN_ERR_CRTL_TX_WARNING)) != 0) {
        side->state = HAL_CAN_ERROR_ACTIVE;
    }
}

void linux_hal_controller_asked(linux_hal_side_t *side, hal_can_state_t state) {
    if (state == HAL_CAN_BUS_OFF) {
        enter_bus_off(side);
    } else if (side->state == HAL_CAN_BUS_OFF) {
        side->looks_restarted++;
        if (side->looks_restarted == LOOKS_RESTARTED) {
            side->state = state;
        }
    }
}

/* A report may be older than an error frame that was read. So the kernel is asked. That may block, so it is only done when one of
 * the two says bus-off. */
void linux_hal_controller_look(linux_hal_side_t *side) {
    hal_can_state_t state;
    if (!side->is_up || !linux_can_state(&side->can, &state)) {
        return;
    }
    if ((state == HAL_CAN_BUS_OFF || side->state == HAL_CAN_BUS_OFF) && linux_can_ask(&side->can) &&
        linux_can_state(&side->can, &state)) {
        linux_hal_controller_asked(side, state);
    }
}

void linux_hal_controller_down(linux_hal_side_t *side) {
    enter_bus_off(side);
    side->is_up = false;
}

void linux_hal_controller_up(linux_hal_side_t *side) {
    side->state = HAL_CAN_ERROR_ACTIVE;
    side->is_up = true;
}

hal_can_state_t linux_hal_controller_state(const linux_hal_side_t *side) {
    return side->is_up ? side->state : HAL_CAN_BUS_OFF;
}
