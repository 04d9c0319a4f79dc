/**
 * @file error_frame.h
 * What an error frame of SocketCAN does to the simulated controller of its side.
 */
#ifndef HOST_SIM_ERROR_FRAME_H
#define HOST_SIM_ERROR_FRAME_H

#include "hal/can.h"
#include "hal_sim/sim_hal.h"

/** Let an error frame act. Bus-off lasts until a frame shows its end. @param frame has the flag HAL_CAN_ERROR */
void error_frame_act(hal_t *hal, hal_can_side_t side, const hal_can_frame_t *frame);

#endif
