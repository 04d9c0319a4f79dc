/* The safe state as the wire, the output and the operator show it: confirmed (H4), reset (H5), stopped (H1). */
#include <string.h>

#include "scenario/hazard/hazard.h"

enum { SIGNALS_BYTES = 7, IN_FLIGHT_MS = 12, GONE_MS = 700, RESET_GONE_MS = 200, PENDING_MS = 50, PRESS_SEEN_MS = 100 };
enum { CONFIRM_MARGIN_MS = 300, STALE_MARGIN_MS = 100 };
enum { ASKED_MS = 100, MOVING_MM_S = 300, MARGIN_MS = 1500, PRESS_SEEN_LESS_MS = 200 };
enum { UPS_OF_RELEASE = 2, UPS_MAX = 3 };
enum { ALARMS_BYTE = 4, FLAGS_BYTE = 6, PRESS_MARGIN_MS = 20 };

static const uint8_t SAFE_SIGNALS[SIGNALS_BYTES] = {0x00, 0x00, 0x00, 0x00, 0x70, 0x00, 0x00};

/** A press that came a moment before the trip is reported after it. */
static void forget_press(const hazard_t *hazard, hazard_button_t *button) {
    button->pressed = button->down && (hazard->t_ms - button->press_ms <= PRESS_SEEN_MS);
    button->released = false;
}

static void begin_trip(hazard_t *hazard) {
    hazard_trip_t *trip = &hazard->trip;

    trip->tripped = true;
    trip->parks = false;
    trip->parked = false;
    trip->stood = false;
    trip->first_ms = hazard->t_ms;
    trip->since_ms = trip->free_ms;
    forget_press(hazard, &trip->button);
    forget_press(hazard, &trip->reported);
    forget_press(hazard, &trip->pin);
    trip->unasked_ms = 0;
    trip->unparked_ms = 0;
    trip->engaged_ms = 0;
    trip->confirmed_ms = 0;
    hazard_hold_trip(hazard);
}

/** Gateway: the AI computer asked for the same as the safe 43Fh, which is passed on with its alive counter. */
static bool is_of_ai(const hazard_t *hazard, uint8_t counter) {
    const uint64_t asked_ms = hazard->asked_all_ms[counter];
    return hazard->gateway && (asked_ms != 0) && (hazard->t_ms - asked_ms <= ASKED_MS);
}

void hazard_safe_frame(hazard_t *hazard, agv_message_t message, const hal_can_frame_t *frame) {
    hazard_trip_t *trip = &hazard->trip;

    if ((message == AGV_MSG_GEAR_COMMAND) && (frame->data[0] == AGV_GEAR_P)) {
        trip->parks = trip->parks || trip->tripped;
    }
    if ((message != AGV_MSG_TURN_SIGNAL_COMMAND) || (memcmp(frame->data, SAFE_SIGNALS, sizeof SAFE_SIGNALS) != 0) ||
        is_of_ai(hazard, frame->data[SIGNALS_BYTES])) {
        return;
    }
    trip->last_ms = hazard->t_ms;
    if (trip->ready && !trip->tripped) {
        begin_trip(hazard);
    }
}

static bool is_fresh(const hazard_t *hazard, agv_message_t message, uint32_t deadline_ms) {
    const hazard_message_t *seen = &hazard->messages[message];
    return seen->has && (hazard->t_ms - seen->seen_ms <= (uint64_t)deadline_ms + STALE_MARGIN_MS);
}

/** What must be confirmed adds up while it is not (H4). */
static void check_confirmation(hazard_t *hazard) {
    hazard_trip_t *trip = &hazard->trip;
    const hazard_message_t *gear = &hazard->messages[AGV_MSG_GEAR_STATUS];
    const hazard_message_t *vcu = &hazard->messages[AGV_MSG_VEHICLE_STATUS];
    const bool alive = hazard->t_ms - vcu->changed_ms <=
                       (uint64_t)hazard->config->vcu_heartbeat_timeout_ms + STALE_MARGIN_MS; /* a frozen one is not */
    const bool off = alive && !hazard->mode.autopilot;
    const bool parked = gear->has_valid && (gear->valid[0] == AGV_GEAR_P) &&
                        is_fresh(hazard, AGV_MSG_GEAR_STATUS, hazard->config->gear_status_timeout_ms);

    trip->engaged_ms += off ? 0 : 1;
    trip->unparked_ms += (parked || !trip->parks) ? 0 : 1;
    trip->confirmed_ms = (off && parked) ? trip->confirmed_ms + 1 : 0;
    if (trip->confirmed_ms >= hazard->config->confirmed_ms) {
        trip->engaged_ms = 0;
        trip->unparked_ms = 0;
    }
    if (trip->engaged_ms > (uint32_t)hazard->config->confirm_timeout_ms + CONFIRM_MARGIN_MS) {
        hazard_found(hazard, HAZARD_UNCONFIRMED, "the autopilot is not confirmed as off");
    }
    if (trip->unparked_ms > (uint32_t)hazard->config->park_confirm_timeout_ms + CONFIRM_MARGIN_MS) {
        hazard_found(hazard, HAZARD_UNCONFIRMED, "gear P is not confirmed");
    }
}

static void follow_button(hazard_t *hazard, hazard_button_t *button, bool down, uint32_t least_ms) {
    if (down && !button->down && !button->is_glitch) {
        button->pressed = true;
        button->press_ms = hazard->t_ms;
    }
    button->released =
        button->released || (button->pressed && !down && button->down && (hazard->t_ms - button->press_ms >= least_ms));
    button->down = down;
}

/**
 * Button 1 as 363h reports it: late, or as not pressed though the remote signal is lost. A single 363h that reports a pressed
 * button as up is a glitch: what follows is no press. Where the alarms report that loss, nobody
 * knows.
 */
void hazard_safe_reported(hazard_t *hazard, const uint8_t data[AGV_DLC]) {
    hazard_button_t *button = &hazard->trip.reported;
    const bool down = (data[FLAGS_BYTE] & AGV_VCU_FLAG_BUTTON_1) != 0;
    const bool lost = (data[ALARMS_BYTE] & (AGV_VCU_ALARM_REMOTE_SIGNAL_LOST | AGV_VCU_ALARM_REMOTE_POWER_LOST)) != 0;

    if (!down) {
        button->ups = (button->ups < UPS_MAX) ? button->ups + 1 : button->ups;
    }
    button->is_glitch = button->ups < UPS_OF_RELEASE;
    if (down) {
        button->ups -= (button->ups != 0) ? 1 : 0;
    }
    if (down || !lost) {
        follow_button(hazard, button, down, hazard->config->reset_hold_ms - (uint32_t)PRESS_MARGIN_MS);
    } else {
        button->pressed = button->pressed && button->released;
        button->down = true;
    }
}

/** No safe command for a while, though the controller could send: they have ended. After a reset the next trip may come soon. */
static bool has_ended(hazard_t *hazard) {
    const uint32_t gone_ms = hazard_reset_was_asked(hazard) ? (uint32_t)RESET_GONE_MS : (uint32_t)GONE_MS;
    scenario_controller_t controller;

    if (!hazard->closed || hazard_is_safe_now(hazard, gone_ms)) {
        return false;
    }
    scenario_testbed_controller(hazard->testbed, HAL_CAN_VEHICLE, &controller);
    return (controller.status.state != HAL_CAN_BUS_OFF) && (controller.status.tx_pending_ms < PENDING_MS) &&
           !controller.swallows;
}

bool hazard_reset_was_asked(const hazard_t *hazard) {
    const hazard_trip_t *trip = &hazard->trip;
    const bool by_remote =
        (hazard->config->reset_input != AGV_RESET_INPUT_PIN) && (trip->button.released || trip->reported.released);
    const bool by_pin = (hazard->config->reset_input != AGV_RESET_INPUT_CAN) && trip->pin.released;
    return by_remote || by_pin;
}

static void check_reset(hazard_t *hazard, bool was_closed) {
    hazard_trip_t *trip = &hazard->trip;

    if (trip->tripped && ((hazard->closed && !was_closed) || has_ended(hazard))) {
        trip->tripped = false;
        trip->parked = false;
        if (hazard_reset_was_asked(hazard)) {
            return; /* a reset as it should be */
        }
        hazard_found(hazard, HAZARD_RESET,
                     (trip->button.pressed || trip->pin.pressed) ? "no button that may reset was released"
                                                                 : "the button was not pressed after the trip");
    }
}

/** 101h reported standstill since the trip, and is silent: nobody can know that the vehicle moves on (FSM-12). */
static bool is_silent_after_standing(const hazard_t *hazard) {
    return !is_fresh(hazard, AGV_MSG_WHEEL_SPEED, hazard->config->wheel_speed_timeout_ms) &&
           (hazard->stood_ms >= hazard->trip.first_ms);
}

/** For how long 101h has reported standstill without a break. */
static uint64_t stands_for_ms(hazard_t *hazard) {
    hazard->turned_ms = hazard_is_said_to_stand(hazard) ? hazard->turned_ms : hazard->t_ms;
    return hazard->t_ms - hazard->turned_ms;
}

/**
 * The time in which the vehicle rolls, and 101h shows it. Each standstill begins it anew up to the first one after the trip that
 * the supervisor must have seen; later only one of hold_standstill_ms does. A silent 101h changes nothing.
 */
static void follow_rolling(hazard_t *hazard) {
    hazard_trip_t *trip = &hazard->trip;
    const uint64_t stands_ms = stands_for_ms(hazard);
    const bool has_stood = stands_ms >= hazard->config->standstill_ms;

    if (!hazard->closed || !trip->tripped || (has_stood && !trip->stood) ||
        (stands_ms >= hazard->config->hold_standstill_ms)) {
        hazard->rolled_ms = 0;
    } else if ((hazard_speed_mm_s(hazard) >= MOVING_MM_S) && !hazard_is_said_to_stand(hazard) &&
               !is_silent_after_standing(hazard)) {
        hazard->rolled_ms += (hazard->rolled_ms < MARGIN_MS) ? 1 : 0;
    } else {
        /* as it was */
    }
    trip->stood = trip->stood || hazard_has_surely_stood(hazard);
}

/** The safe commands are sent, and the vehicle moves (H1). */
static void check_stopping(hazard_t *hazard) {
    follow_rolling(hazard);
    if ((hazard->t_ms - hazard->trip.first_ms > (uint64_t)hazard->config->stop_timeout_ms + MARGIN_MS) &&
        (hazard->rolled_ms >= MARGIN_MS)) {
        hazard_found(hazard, HAZARD_NOT_STOPPING, "the vehicle does not obey the safe commands");
    }
}

/** P is a part of the safe state, from the trip on or from standstill on (H4). */
static void check_park(hazard_t *hazard) {
    hazard_trip_t *trip = &hazard->trip;
    const uint32_t wait_ms = (hazard->config->park == AGV_PARK_AT_STANDSTILL) ? hazard->config->park_timeout_ms : 0;

    trip->unasked_ms += (trip->parks || (trip->free_ms != hazard->t_ms)) ? 0 : 1;
    if (!trip->parks && (trip->unasked_ms > wait_ms + (uint32_t)CONFIRM_MARGIN_MS)) {
        hazard_found(hazard, HAZARD_UNCONFIRMED, "gear P is not commanded");
    }
}

/**
 * The supervision begins when the output is closed and no safe command follows, and ends with one, or with an open
 * output.
 */
static void follow_output(hazard_t *hazard, bool was_closed) {
    hazard_trip_t *trip = &hazard->trip;

    trip->was_closed = hazard->closed;
    if (hazard->closed && !was_closed) {
        trip->closed_ms = hazard->t_ms;
    }
    if (hazard->closed && !trip->tripped && (hazard->t_ms - trip->closed_ms > IN_FLIGHT_MS) &&
        (trip->last_ms <= trip->closed_ms + IN_FLIGHT_MS)) {
        trip->ready = true;
    }
    if (!hazard->closed && was_closed && trip->ready && !trip->tripped) {
        begin_trip(hazard);
    }
}

/** The first frame after a stall leaves some ms after its end. After a hang, a trip is as old as the frame that caused it. */
static void follow_transmitter(hazard_t *hazard) {
    hazard_trip_t *trip = &hazard->trip;
    scenario_controller_t controller;

    scenario_testbed_controller(hazard->testbed, HAL_CAN_VEHICLE, &controller);
    if (controller.is_stalled || hazard->view.is_halted) {
        trip->stalled_ms = hazard->t_ms;
    } else if (hazard->t_ms - trip->stalled_ms > IN_FLIGHT_MS) {
        trip->free_ms = hazard->t_ms;
    }
}

void hazard_safe_tick(hazard_t *hazard) {
    hazard_trip_t *trip = &hazard->trip;
    const bool was_closed = trip->was_closed;

    follow_transmitter(hazard);
    follow_button(hazard, &trip->button, hazard->view.vehicle.button_1,
                  hazard->config->reset_hold_ms - (uint32_t)PRESS_SEEN_LESS_MS);
    follow_button(hazard, &trip->pin, hazard->view.pin_is_down, 0);
    check_reset(hazard, was_closed);
    follow_output(hazard, was_closed);
    const bool hangs = hazard->view.is_halted; /* the watchdog ends that, after its period */
    if (trip->tripped && hazard->closed && !hangs) {
        check_confirmation(hazard);
        check_park(hazard);
    }
    check_stopping(hazard);
}
