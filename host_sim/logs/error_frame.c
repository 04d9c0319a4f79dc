#include "logs/error_frame.h"

#include <stdint.h>

#include "logs/candump_line.h"

void error_frame_act(hal_t *hal, hal_can_side_t side, const hal_can_frame_t *frame) {
    const uint8_t details = ((frame->id & CANDUMP_ERROR_CONTROLLER) != 0) ? frame->data[1] : 0;
    if ((details & CANDUMP_CONTROLLER_RX_OVERFLOW) != 0) {
        sim_hal_add_overrun(hal, side);
    }
    if ((frame->id & CANDUMP_ERROR_BUS_OFF) != 0) {
        sim_hal_set_can_state(hal, side, HAL_CAN_BUS_OFF);
        return;
    }
    if (((frame->id & CANDUMP_ERROR_RESTARTED) != 0) || ((details & CANDUMP_CONTROLLER_ACTIVE) != 0)) {
        sim_hal_set_can_state(hal, side, HAL_CAN_ERROR_ACTIVE);
    }
    hal_can_status_t status;
    hal_can_status(hal, side, &status);
    if (status.state == HAL_CAN_BUS_OFF) {
        return;
    }
    if ((details & CANDUMP_CONTROLLER_PASSIVE) != 0) {
        sim_hal_set_can_state(hal, side, HAL_CAN_ERROR_PASSIVE);
    } else if ((details & CANDUMP_CONTROLLER_WARNING) != 0) {
        sim_hal_set_can_state(hal, side, HAL_CAN_ERROR_ACTIVE);
    }
}
