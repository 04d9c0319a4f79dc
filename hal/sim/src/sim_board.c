/* The hard-wired parts of a simulated board (sim_board.h), behind hal_ops.h. */
#include "hal/inputs.h"

#include "sim_hal_internal.h"

/* The contact follows its command after SIM_BOARD_RELAY_MS, unless it is welded or stuck. */
static void follow_contact(hal_t *hal, uint32_t now_ms) {
    const sim_hal_pin_t *output = &hal->safety_output;
    const bool settled = (output->changes == 0) || (now_ms - output->changed_ms >= SIM_BOARD_RELAY_MS);
    if (hal->board.contact == SIM_CONTACT_STUCK_OPEN) {
        hal->contact_closed = false;
    } else if (settled && (output->on || (hal->board.contact != SIM_CONTACT_WELDED))) {
        hal->contact_closed = output->on;
    } else {
        /* moves, or is welded */
    }
}

static uint8_t contact_if(bool exists, bool closed) {
    if (!exists) {
        return HAL_CONTACT_NONE;
    }
    return (uint8_t)(closed ? HAL_CONTACT_CLOSED : HAL_CONTACT_OPEN);
}

hal_inputs_t sim_board_inputs(hal_t *hal, uint32_t now_ms) {
    const sim_board_t *board = &hal->board;
    follow_contact(hal, now_ms);
    return (hal_inputs_t){.output_feedback =
                              contact_if(board->has_feedback, hal->contact_closed != board->feedback_is_inverted),
                          .emergency_stop = contact_if(board->has_emergency_stop, !board->stop_is_open),
                          .reset_button = contact_if(board->has_reset_button, board->button_is_down)};
}

/* Thousandths are added up, so that a deviation may change at any time. */
uint32_t sim_board_second_ms(hal_t *hal, uint32_t now_ms) {
    const uint32_t passed_ms = now_ms - hal->second_read_ms;
    hal->second_us += (uint64_t)passed_ms * (uint64_t)(1000 + hal->board.clock_permille);
    hal->second_read_ms = now_ms;
    return (uint32_t)(hal->second_us / 1000);
}
