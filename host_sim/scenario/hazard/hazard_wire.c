/* What was on the wire last: status of the vehicle, commands of the AI computer, the mode. */
#include <stdlib.h>
#include <string.h>

#include "scenario/hazard/hazard.h"
#include "text/units.h"

enum { THROTTLE_MAX = 250, ANGLE_MAX = 18000, FALL_COUNTS = 25, FAST_CAP = 3, RISES_MS = 120 };
enum { MODE_BYTE = 6, MANUAL_BIT = 0x40, AUTOPILOT_BIT = 0x80, REENGAGE_MS = 100, SWING_MARGIN_MS = 200 };

static uint16_t word_at(const uint8_t *data, unsigned at) {
    return (uint16_t)(data[at] | ((uint32_t)data[at + 1] << 8));
}

static bool is_gear(uint8_t gear) {
    return (gear == AGV_GEAR_P) || (gear == AGV_GEAR_R) || (gear == AGV_GEAR_N) || (gear == AGV_GEAR_D);
}

static bool is_usable(agv_message_t message, const uint8_t *data) {
    switch (message) {
    case AGV_MSG_GEAR_COMMAND:
    case AGV_MSG_GEAR_STATUS:
        return is_gear(data[0]);
    case AGV_MSG_THROTTLE_COMMAND:
    case AGV_MSG_THROTTLE_STATUS:
        return data[0] <= THROTTLE_MAX;
    case AGV_MSG_STEERING_COMMAND:
        return word_at(data, 0) <= ANGLE_MAX;
    case AGV_MSG_STEERING_STATUS:
        return word_at(data, 2) <= ANGLE_MAX;
    default:
        return true;
    }
}

/** Byte of the alive counter; -1: the message has none. */
static int counter_of(agv_message_t message) {
    switch (message) {
    case AGV_MSG_VEHICLE_STATUS:
    case AGV_MSG_TURN_SIGNAL_COMMAND:
        return AGV_DLC - 1;
    case AGV_MSG_STEERING_STATUS:
        return 0;
    default:
        return -1;
    }
}

static void note(hazard_t *hazard, agv_message_t message, const uint8_t data[AGV_DLC]) {
    hazard_message_t *seen = &hazard->messages[message];
    const int counter = counter_of(message);

    if (seen->has && (counter >= 0) && (seen->data[counter] != data[counter])) {
        seen->changed_ms = hazard->t_ms;
    }
    seen->has = true;
    seen->seen_ms = hazard->t_ms;
    seen->seen_us = hazard->t_us;
    memcpy(seen->data, data, AGV_DLC);
    if (is_usable(message, data)) {
        seen->has_valid = true;
        seen->valid_ms = hazard->t_ms;
        memcpy(seen->valid, data, AGV_DLC);
    }
}

/**
 * At an engagement the vehicle uses the last throttle command. A stalled transmitter sends no other, and opens the output; nor does
 * a supervisor that hangs, until its watchdog resets it.
 */
static void check_newest_throttle(hazard_t *hazard) {
    const uint32_t deadline_ms = hazard->config->throttle_command_timeout_ms;

    const bool can_send = !hazard_is_stalled(hazard) && !hazard->view.is_halted;

    if (hazard->gateway && hazard->closed && !hazard->trip.tripped && can_send && hazard->throttle_is_newest &&
        (hazard->t_ms - hazard->throttle_ms > deadline_ms + REENGAGE_MS)) {
        hazard_found(hazard, HAZARD_FALSE_COMMAND, "an old throttle command is the latest one at an engagement");
    }
}

bool hazard_is_hearing(const hazard_t *hazard) {
    scenario_controller_t controller;

    scenario_testbed_controller(hazard->testbed, HAL_CAN_VEHICLE, &controller);
    return !hazard->view.is_halted && (controller.status.state != HAL_CAN_BUS_OFF);
}

/** What manual drops. */
static void note_manual(hazard_t *hazard, bool manual) {
    hazard_mode_t *mode = &hazard->mode;

    if (mode->manual && !manual && mode->heard) {
        mode->handback_ms = hazard->t_ms;
        hazard->hold.first.any = false;
        hazard->hold.perhaps.any = false;
        hazard->hold.before.any = false;
    }
    if (manual) {
        mode->heard = (mode->manual && mode->heard) || hazard_is_hearing(hazard);
        mode->manual_ms = hazard->t_ms;
    }
    if (manual && mode->heard) {
        hazard_hold_drop(hazard);
    }
}

/** Its grace time is for every engagement but the one that is too many in mode_flapping_ms. */
static void begin_engagement(hazard_t *hazard) {
    hazard_mode_t *mode = &hazard->mode;
    uint64_t *oldest_ms = &mode->begun_ms[mode->begun_count % HAZARD_ENGAGEMENTS];

    mode->engaged_ms = hazard->t_ms;
    mode->graced =
        (mode->begun_count < HAZARD_ENGAGEMENTS) || (hazard->t_ms - *oldest_ms > hazard->config->mode_flapping_ms);
    if (!hazard->trip.tripped) {
        *oldest_ms = hazard->t_ms;
        mode->begun_count++;
    }
    if (mode->graced) {
        hazard_rows_engage(hazard);
    }
}

/** Both bits neither begin an engagement nor end it. */
static void follow_engagement(hazard_t *hazard, bool autopilot, bool alone) {
    hazard_mode_t *mode = &hazard->mode;

    if (alone && !mode->engaged) {
        if ((mode->begun_count == 0) || (hazard->t_ms - mode->ended_ms >= hazard->config->reengage_ms)) {
            begin_engagement(hazard);
        }
        mode->engaged = true;
    }
    mode->clear_frames = autopilot ? 0 : mode->clear_frames + 1;
    if (mode->engaged && (mode->clear_frames >= hazard->config->mode_frames)) {
        mode->engaged = false;
        mode->ended_ms = hazard->t_ms;
    }
}

static void note_mode(hazard_t *hazard, uint8_t bits) {
    hazard_mode_t *mode = &hazard->mode;
    const bool autopilot = (bits & AUTOPILOT_BIT) != 0;
    const bool manual = !autopilot && ((bits & MANUAL_BIT) != 0);

    if (autopilot && !mode->autopilot && (hazard->t_ms - mode->clear_ms >= REENGAGE_MS)) {
        check_newest_throttle(hazard);
        memset(hazard->is_commanded, 0, sizeof hazard->is_commanded);
    }
    follow_engagement(hazard, autopilot, autopilot && ((bits & MANUAL_BIT) == 0));
    if (!autopilot && mode->autopilot) {
        mode->clear_ms = hazard->t_ms;
    }
    note_manual(hazard, manual);
    mode->autopilot = autopilot;
    mode->manual = manual;
    mode->both = autopilot && ((bits & MANUAL_BIT) != 0);
}

/** Whether 050h was commanded to rise shortly before. */
static bool may_have_risen(const hazard_t *hazard) {
    return (hazard->throttle_rises_ms != 0) && (hazard->t_ms - hazard->throttle_rises_ms <= RISES_MS);
}

/**
 * 050h may be above its command while it comes down. Where it goes up again, it did not come down; unless it was commanded to
 * rise: then its falls add up.
 */
static void note_throttle(hazard_t *hazard, uint8_t value) {
    if ((value > hazard->throttle_seen) && may_have_risen(hazard)) {
        hazard->throttle_high = (uint16_t)(hazard->throttle_high + (value - hazard->throttle_seen));
    }
    hazard->throttle_seen = value;
    if ((value + FALL_COUNTS <= hazard->throttle_high) || (hazard->throttle_high_ms == 0)) {
        hazard->throttle_before = hazard->throttle_high;
        hazard->throttle_before_ms = hazard->throttle_high_ms;
        hazard->throttle_high = value;
        hazard->throttle_high_ms = hazard->t_ms;
    }
    if ((hazard->throttle_before_ms != 0) && (value >= hazard->throttle_before)) {
        hazard->throttle_high_ms = hazard->throttle_before_ms;
    }
    hazard->throttle_high = (value > hazard->throttle_high) ? value : hazard->throttle_high;
}

/**
 * 065h swings: its angles differ by more than the limit within the time of SUP-10. A reading that moves with it looks like a
 * steering that follows.
 */
static bool is_command_swinging(const hazard_t *hazard) {
    return (hazard->swung_ms != 0) &&
           (hazard->t_ms - hazard->swung_ms <= (uint64_t)hazard->config->steering_deviation_ms + SWING_MARGIN_MS);
}

static void note_command_angle(hazard_t *hazard, uint16_t angle_raw) {
    hazard->lowest_raw = (angle_raw < hazard->lowest_raw) ? angle_raw : hazard->lowest_raw;
    hazard->highest_raw = (angle_raw > hazard->highest_raw) ? angle_raw : hazard->highest_raw;
    if ((uint32_t)hazard->highest_raw > hazard->lowest_raw + hazard->config->steering_deviation_ddeg) {
        hazard->swung_ms = hazard->is_commanded[AGV_MSG_STEERING_COMMAND] ? hazard->t_ms : 0;
        hazard->lowest_raw = angle_raw;
        hazard->highest_raw = angle_raw;
    }
}

/**
 * The steering moves if the sum of its movements is four fifths of the supervisor's limit, on the wire and, unless 065h swings,
 * really.
 */
static void note_angle(hazard_t *hazard) {
    const int32_t angle_ddeg = hazard_measured_ddeg(hazard);

    hazard_hold_measured(hazard, angle_ddeg);
    hazard->moved_ddeg += abs(angle_ddeg - hazard->still_at_ddeg);
    hazard->still_at_ddeg = angle_ddeg;
    hazard->really_moved_ddeg += abs(hazard_angle_ddeg(hazard) - hazard->really_at_ddeg);
    hazard->really_at_ddeg = hazard_angle_ddeg(hazard);
    const bool on_wire = is_command_swinging(hazard) || (hazard->really_moved_ddeg > hazard->moved_ddeg);
    const int32_t moved_ddeg = on_wire ? hazard->moved_ddeg : hazard->really_moved_ddeg;
    if (moved_ddeg * 5 >= hazard->config->steering_gain_ddeg * 4) {
        hazard->moved_ddeg = 0;
        hazard->really_moved_ddeg = 0;
        hazard->still_since_ms = hazard->t_ms;
    }
}

void hazard_wire_status(hazard_t *hazard, agv_message_t message, const hal_can_frame_t *frame) {
    if ((frame->flags != 0) || (frame->length != AGV_DLC)) {
        return;
    }
    note(hazard, message, frame->data);
    hazard_eps_status(hazard, message, frame->data);
    if (message == AGV_MSG_VEHICLE_STATUS) {
        note_mode(hazard, frame->data[MODE_BYTE]);
        hazard_safe_reported(hazard, frame->data);
    } else if (message == AGV_MSG_THROTTLE_STATUS) {
        note_throttle(hazard, frame->data[0]);
    } else if ((message == AGV_MSG_STEERING_STATUS) && is_usable(message, frame->data)) {
        note_angle(hazard);
    } else {
        /* noted */
    }
    hazard_rows_frame(hazard, message, frame->data);
}

/** Gaps of less than half the cycle, less those that are not. */
static void note_gap(hazard_t *hazard, agv_message_t message) {
    hazard_message_t *seen = &hazard->messages[message];
    const uint64_t gap_us = hazard->t_us - seen->seen_us;
    const int32_t cap = FAST_CAP * (int32_t)hazard->config->command_too_fast_gaps;

    if (seen->has) {
        seen->fast += (gap_us < (uint64_t)agv_message_cycle_ms(message) * US_PER_MS / 2) ? 1 : -1;
        seen->fast = (seen->fast < 0) ? 0 : seen->fast;
        seen->fast = (seen->fast > cap) ? cap : seen->fast;
    }
}

static void note_recent(hazard_t *hazard, agv_message_t message, uint16_t value) {
    hazard_recent_t *recent = &hazard->recent[message];

    recent->at_ms[recent->next % HAZARD_RECENT] = hazard->t_ms;
    recent->value[recent->next % HAZARD_RECENT] = value;
    recent->next++;
}

/** A throttle that is commanded as high as it is may rise: then an earlier fall still counts. */
void hazard_commanded(hazard_t *hazard, agv_message_t message, uint16_t value) {
    if ((message == AGV_MSG_THROTTLE_COMMAND) && (value >= hazard->messages[AGV_MSG_THROTTLE_STATUS].valid[0])) {
        hazard->throttle_before_ms = 0;
    }
    if ((message == AGV_MSG_THROTTLE_COMMAND) && (value > hazard->throttle_seen)) {
        hazard->throttle_rises_ms = hazard->t_ms;
    }
    if (message == AGV_MSG_STEERING_COMMAND) {
        note_command_angle(hazard, value);
    }
    hazard->commanded[message] = value;
    hazard->is_commanded[message] = true;
}

/** A gateway whose AI side is in bus-off hears nothing there, and passes nothing. */
static bool is_deaf_to_ai(const hazard_t *hazard) {
    scenario_controller_t controller;
    scenario_testbed_controller(hazard->testbed, HAL_CAN_AI, &controller);
    return hazard->gateway && (controller.status.state == HAL_CAN_BUS_OFF);
}

void hazard_wire_command(hazard_t *hazard, agv_message_t message, const hal_can_frame_t *frame) {
    const bool whole = (frame->flags == 0) && (frame->length == AGV_DLC);

    if ((!whole || !is_usable(message, frame->data)) && !is_deaf_to_ai(hazard)) {
        hazard->has_bad_command = hazard->has_bad_command || hazard->mode.autopilot;
        hazard->bad_command_ms = hazard->mode.autopilot ? hazard->t_ms : hazard->bad_command_ms;
    }
    if (!whole) {
        return;
    }
    const uint16_t value = (message == AGV_MSG_STEERING_COMMAND) ? word_at(frame->data, 0) : frame->data[0];
    note_gap(hazard, message);
    note(hazard, message, frame->data);
    if (is_usable(message, frame->data)) {
        note_recent(hazard, message, value);
        if (!hazard->gateway) {
            hazard_commanded(hazard, message, value);
        }
    }
    if (message == AGV_MSG_TURN_SIGNAL_COMMAND) {
        agv_turn_signal_command_t command;
        (void)agv_unpack_turn_signal_command(&command, frame->data);
        hazard->asked_off_ms = command.autopilot_off ? hazard->t_ms : 0;
        if (command.autopilot_off && command.turn_left_on && command.turn_right_on && command.headlight_on) {
            hazard->asked_all_ms[command.alive_counter] = hazard->t_ms;
        }
    }
}
