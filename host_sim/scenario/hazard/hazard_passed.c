/* Gateway: commands that the supervisor lets through, and those of foreign senders (H3, H7). */
#include "scenario/hazard/hazard.h"

#include "common/message_facts.h"

enum { MARGIN_MS = 100, IN_FLIGHT_MS = 60, ANSWER_MS = 100, SLOT_MS = 100, SAFE_MS = 300, DROP_RATE = 2 };
enum { NOMINAL_PER_S = 10 + 10 + 10 + 40, SPARE_PER_S = 8 };

/** Whether the AI side carried this value (of a throttle: this or a higher one) lately. */
bool hazard_was_sent(const hazard_t *hazard, agv_message_t message, uint16_t value) {
    const hazard_recent_t *recent = &hazard->recent[message];
    const uint32_t count = (recent->next < HAZARD_RECENT) ? recent->next : (uint32_t)HAZARD_RECENT;
    const uint64_t within_ms = (uint64_t)agv_config_get(hazard->config, message_deadline_setting(message)) + MARGIN_MS;

    for (uint32_t i = 1; i <= count; i++) {
        const uint32_t at = (recent->next - i) % HAZARD_RECENT;
        if (hazard->t_ms - recent->at_ms[at] > within_ms) {
            return false;
        }
        if ((recent->value[at] == value) || ((message == AGV_MSG_THROTTLE_COMMAND) && (recent->value[at] > value))) {
            return true;
        }
    }
    return false;
}

static uint16_t value_of(agv_message_t message, const hal_can_frame_t *frame) {
    return (message == AGV_MSG_STEERING_COMMAND) ? (uint16_t)(frame->data[0] | ((uint32_t)frame->data[1] << 8))
                                                 : frame->data[0];
}

static bool is_motion(agv_message_t message, uint16_t value) {
    return ((message == AGV_MSG_GEAR_COMMAND) && (value != AGV_GEAR_P)) ||
           ((message == AGV_MSG_THROTTLE_COMMAND) && (value != 0)) || (message == AGV_MSG_STEERING_COMMAND);
}

void hazard_passed(hazard_t *hazard, agv_message_t message, const hal_can_frame_t *frame) {
    const uint16_t value = value_of(message, frame);
    const bool is_limited = hazard->limits_steering && hazard_hold_is_limited(hazard, value);

    if (!hazard_is_safe_now(hazard, SAFE_MS)) {
        hazard->passed[hazard->passed_at]++;
    }
    if (message == AGV_MSG_TURN_SIGNAL_COMMAND) {
        return;
    }
    hazard_commanded(hazard, message, value);
    if (message == AGV_MSG_STEERING_COMMAND) {
        hazard->untaken = hazard_eps_in_angle_control(hazard) ? 0 : hazard->untaken + 1;
    }
    if (message == AGV_MSG_THROTTLE_COMMAND) {
        hazard->throttle_is_newest = value != 0;
        hazard->throttle_ms = hazard->t_ms;
    }
    const bool is_hold = (message == AGV_MSG_STEERING_COMMAND) &&
                         (hazard->trip.tripped || hazard_is_safe_now(hazard, SAFE_MS) || is_limited);
    if (is_motion(message, value) && !is_hold && !hazard_was_sent(hazard, message, value) && (hazard->false_ms == 0)) {
        hazard->false_ms = hazard->t_ms; /* 065h of a hold leaves before the other safe commands */
        hazard->false_is_065h = message == AGV_MSG_STEERING_COMMAND;
    }
}

/** Something came at @p since_ms that the safe commands have to follow. @return whether they do not */
static bool is_unanswered(const hazard_t *hazard, uint64_t *since_ms, uint32_t within_ms) {
    if (*since_ms == 0) {
        return false;
    }
    if (!hazard->closed || (hazard->trip.last_ms >= *since_ms)) {
        *since_ms = 0;
        return false;
    }
    return hazard->t_ms - *since_ms > within_ms;
}

/** A controller that is error-passive sends again what was destroyed. */
static void follow_stall(hazard_t *hazard) {
    scenario_controller_t controller;

    scenario_testbed_controller(hazard->testbed, HAL_CAN_VEHICLE, &controller);
    if (controller.is_stalled || (controller.status.state != HAL_CAN_ERROR_ACTIVE)) {
        hazard->stalled_ms = hazard->t_ms;
    }
}

bool hazard_is_stalled(const hazard_t *hazard) {
    return (hazard->stalled_ms != 0) && (hazard->t_ms - hazard->stalled_ms <= MARGIN_MS);
}

/**
 * A command on the vehicle side is followed by the safe ones at once, if they leave the controller. A supervisor that hangs sends
 * them, or opens the output, when it runs again, after the period of its watchdog at the latest.
 */
static uint32_t answer_ms(const hazard_t *hazard) {
    const uint32_t hang_ms = hazard->config->watchdog_period_ms;
    const uint32_t stall_ms = hazard_is_stalled(hazard) ? hazard->config->tx_stalled_ms : (uint32_t)MARGIN_MS;
    return (uint32_t)ANSWER_MS + ((hang_ms > stall_ms) ? hang_ms : stall_ms);
}

/** The safe commands follow a 065h of theirs; where they are stalled, the output opens. */
static uint32_t in_flight_ms(const hazard_t *hazard) {
    const bool waits = hazard->false_is_065h && hazard_is_stalled(hazard);
    return (uint32_t)IN_FLIGHT_MS + (waits ? hazard->config->tx_stalled_ms : 0);
}

void hazard_passed_tick(hazard_t *hazard) {
    if (!hazard->gateway) {
        return;
    }
    follow_stall(hazard);
    if (is_unanswered(hazard, &hazard->foreign_ms, answer_ms(hazard))) {
        hazard_found(hazard, HAZARD_FALSE_COMMAND, "a rogue node's command is not overridden");
    }
    if (is_unanswered(hazard, &hazard->false_ms, in_flight_ms(hazard))) {
        hazard_found(hazard, HAZARD_FALSE_COMMAND, "the supervisor sent a command that the AI computer did not send");
    }
    if ((hazard->t_ms % SLOT_MS) != 0) {
        return;
    }
    uint32_t sum = 0;
    for (unsigned i = 0; i < HAZARD_FLOOD_SLOTS; i++) {
        sum += hazard->passed[i];
    }
    if (sum > (uint32_t)((DROP_RATE * NOMINAL_PER_S) + SPARE_PER_S)) {
        hazard_found(hazard, HAZARD_FLOOD, "the vehicle's bus is flooded through the gateway");
    }
    hazard->passed_at = (hazard->passed_at + 1) % HAZARD_FLOOD_SLOTS;
    hazard->passed[hazard->passed_at] = 0;
}
