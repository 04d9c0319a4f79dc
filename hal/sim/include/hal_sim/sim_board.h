/**
 * @file sim_board.h
 * The hard-wired parts of a simulated board (HW-1 to HW-4): contact of the safety output with its feedback, emergency stop,
 * reset button, second clock, self-test. All zero: a board without any of them, in which nothing fails.
 */
#ifndef HAL_SIM_SIM_BOARD_H
#define HAL_SIM_SIM_BOARD_H

#include <stdbool.h>
#include <stdint.h>

/** Time after which the contact of the safety output follows its command, ms. */
enum { SIM_BOARD_RELAY_MS = 10 };

/** State of the contact of the safety output. */
typedef enum {
    SIM_CONTACT_WORKS,
    SIM_CONTACT_WELDED,    /**< does not open */
    SIM_CONTACT_STUCK_OPEN /**< does not close */
} sim_contact_t;

/** The parts. Set the members at any time. */
typedef struct {
    bool has_feedback;
    bool has_emergency_stop;
    bool has_reset_button;
    bool has_second_clock;
    bool stop_is_open; /**< the circuit of the emergency stop is open: somebody pressed it, or a wire broke */
    bool button_is_down;
    uint8_t contact;           /**< sim_contact_t */
    bool feedback_is_inverted; /**< the feedback reads the opposite: wired to the wrong contact */
    int16_t clock_permille;    /**< by how much the first clock runs slow (above 0) or fast, against the second one */
    uint32_t failed;           /**< HAL_SELF_TEST_* bits of the parts that fail their test from now on */
} sim_board_t;

#endif
