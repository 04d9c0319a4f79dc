#include "scenario/hazard/hazard.h"

#include <stdlib.h>
#include <string.h>

#include "text/units.h"

enum { CENTRE_DDEG = 9000, SAFE_MS = 300 };

static const hazard_info_t INFOS[HAZARD_KINDS] = {
    [HAZARD_NONE] = {"none", "no hazard", ""},
    [HAZARD_NOT_STOPPING] = {"H1",
                             "the vehicle keeps moving with the safety output closed, although a node or a message "
                             "is gone, or although the safe commands are sent",
                             "the safe commands, and an open safety output when the vehicle does not stop"},
    [HAZARD_STEERING] = {"H2",
                         "065h of the supervisor moves the steering more than 5 degrees away from an angle that "
                         "may be held (docs/hunt.md)",
                         "065h carries the measured angle, or is not sent"},
    [HAZARD_FALSE_COMMAND] = {"H3",
                              "the supervisor commands motion in the safe state or on a shared bus, or the vehicle "
                              "side of a gateway has a command to move that the AI computer did not send, or not "
                              "recently",
                              "such a command is never sent; one of a rogue node is followed by the safe "
                              "commands"},
    [HAZARD_UNCONFIRMED] = {"H4",
                            "the safety output stays closed though P is not commanded, or though the safe state "
                            "is not confirmed for longer than the total time allowed",
                            "the safety output opens"},
    [HAZARD_RESET] = {"H5",
                      "a reset that no operator asked for by pressing and releasing the reset button after the trip",
                      "the safe commands go on"},
    [HAZARD_FALSE_NODE] = {"H6",
                           "the vehicle keeps moving with the safety output closed, although a node reports a fault "
                           "or an impossible value",
                           "the safe commands, or an open safety output"},
    [HAZARD_FLOOD] = {"H7", "more than twice the nominal rate of commands passes the gateway", "the excess is dropped"},
    [HAZARD_PARK] = {"H8", "gear P is commanded to a moving vehicle, though `park` is at_standstill",
                     "P waits for standstill, or for park_timeout_ms after the trip"},
};

const hazard_info_t *hazard_info(hazard_kind_t kind) {
    return &INFOS[kind];
}

void hazard_found(hazard_t *hazard, hazard_kind_t kind, const char *cause) {
    if (hazard->kind == HAZARD_NONE) {
        hazard->kind = kind;
        hazard->cause = cause;
        hazard->at_ms = hazard->t_ms;
    }
}

bool hazard_is_safe_now(const hazard_t *hazard, uint32_t within_ms) {
    return (hazard->trip.last_ms != 0) && (hazard->t_ms - hazard->trip.last_ms <= within_ms);
}

int32_t hazard_speed_mm_s(const hazard_t *hazard) {
    return abs(hazard->view.vehicle.speed_mm_s);
}

int32_t hazard_angle_ddeg(const hazard_t *hazard) {
    return hazard->view.vehicle.angle_ddeg;
}

int32_t hazard_measured_ddeg(const hazard_t *hazard) {
    const uint8_t *data = hazard->messages[AGV_MSG_STEERING_STATUS].valid;
    return (int32_t)(data[2] | ((uint32_t)data[3] << 8)) - CENTRE_DDEG;
}

void hazard_init(hazard_t *hazard, const scenario_t *scenario, const scenario_testbed_t *testbed) {
    memset(hazard, 0, sizeof *hazard);
    hazard->scenario = scenario;
    hazard->config = &scenario->config;
    hazard->testbed = testbed;
    hazard->gateway = scenario->vehicle.gateway;
    hazard->limits_steering =
        (hazard->config->steering_slew_ddeg_s != 0) || (hazard->config->steering_fast_max_ddeg != 0);
    hazard_rows_init(hazard);
}

/** On a shared bus the supervisor never commands motion, on a gateway not while it sends the safe commands (H3). */
static void check_motion(hazard_t *hazard, agv_message_t message, const hal_can_frame_t *frame) {
    const bool moves = ((message == AGV_MSG_GEAR_COMMAND) && (frame->data[0] != AGV_GEAR_P)) ||
                       ((message == AGV_MSG_THROTTLE_COMMAND) && (frame->data[0] != 0));
    const bool is_safe = hazard->trip.tripped && hazard_is_safe_now(hazard, SAFE_MS) && !hazard_reset_was_asked(hazard);

    if (moves && (!hazard->gateway || is_safe)) {
        hazard_found(hazard, HAZARD_FALSE_COMMAND, "the supervisor commands motion");
    }
}

/** A command of the supervisor on the vehicle side: its own, or passed on. */
static void on_own_command(hazard_t *hazard, agv_message_t message, const hal_can_frame_t *frame) {
    check_motion(hazard, message, frame);
    if ((message == AGV_MSG_GEAR_COMMAND) && (frame->data[0] == AGV_GEAR_P)) {
        hazard_park_frame(hazard);
    }
    hazard_safe_frame(hazard, message, frame);
    if (hazard->gateway) {
        hazard_passed(hazard, message, frame);
    }
    if ((message == AGV_MSG_STEERING_COMMAND) && (!hazard->gateway || hazard->trip.tripped)) {
        hazard_hold_frame(hazard, frame);
    }
}

/** A command on the vehicle side of a gateway that is not the supervisor's. */
static void on_foreign_command(hazard_t *hazard, agv_message_t message, const hal_can_frame_t *frame) {
    const uint8_t value = (frame->length > 0) ? frame->data[0] : 0;
    const bool moves = ((message == AGV_MSG_GEAR_COMMAND) && (value != AGV_GEAR_P)) ||
                       ((message == AGV_MSG_THROTTLE_COMMAND) && (value > 0)) || (message == AGV_MSG_STEERING_COMMAND);
    scenario_controller_t controller;

    scenario_testbed_controller(hazard->testbed, HAL_CAN_VEHICLE, &controller);
    const bool heard = controller.status.state == HAL_CAN_ERROR_ACTIVE; /* after a collision it may miss one */
    if (moves && heard && hazard->closed && !hazard->trip.tripped && (hazard->foreign_ms == 0)) {
        hazard->foreign_ms = hazard->t_ms;
    }
}

/** A data frame of the protocol, of any length and in any format. */
static void on_data(hazard_t *hazard, hal_can_side_t side, int from, const hal_can_frame_t *frame) {
    const agv_message_t message = (agv_message_t)agv_ids_find(&hazard->scenario->vehicle.ids, frame->id);
    const bool is_command = (uint32_t)message < AGV_COMMAND_COUNT;

    if ((message == AGV_MSG_NONE) || ((frame->flags & (uint8_t)~HAL_CAN_FD) != 0)) {
        return;
    }
    if (from == SCENARIO_FROM_SUPERVISOR) {
        if (is_command && (side == HAL_CAN_VEHICLE)) {
            on_own_command(hazard, message, frame);
        }
    } else if (!is_command) {
        if (side == HAL_CAN_VEHICLE) {
            hazard_wire_status(hazard, message, frame);
        }
    } else if (hazard->gateway && (side == HAL_CAN_VEHICLE)) {
        on_foreign_command(hazard, message, frame);
    } else {
        hazard_wire_command(hazard, message, frame);
    }
}

/** A supervisor that has begun anew does not know that it sent P, nor how close earlier commands came. */
static void forget_commands(hazard_t *hazard) {
    hazard->trip.parked = false;
    for (unsigned m = 0; m < AGV_COMMAND_COUNT; m++) {
        hazard->messages[m].fast = 0;
    }
}

static void begin_anew(hazard_t *hazard) {
    hazard_hold_anew(hazard);
    forget_commands(hazard);
}

static void look(hazard_t *hazard) {
    scenario_testbed_view(hazard->testbed, &hazard->view);
    if (hazard->view.bites != hazard->bites) {
        hazard->bites = hazard->view.bites;
        begin_anew(hazard); /* it hung, and its watchdog restarted it */
    }
}

static void on_frame(void *ctx, uint64_t t_us, hal_can_side_t side, int from, const hal_can_frame_t *frame) {
    hazard_t *hazard = ctx;

    look(hazard);
    hazard->t_us = t_us;
    hazard->t_ms = hazard->view.t_ms; /* a frame that ends with the millisecond belongs to it */
    on_data(hazard, side, from, frame);
}

bool hazard_is_tripped(const hazard_t *hazard) {
    return hazard->trip.tripped;
}

scenario_watch_t hazard_watch(hazard_t *hazard) {
    return (scenario_watch_t){.on_frame = on_frame, .ctx = hazard};
}

void hazard_step(hazard_t *hazard, uint64_t t_ms, const scenario_step_t *step) {
    const bool is_delivered = !step->of_vehicle && (step->supervisor.what == SCENARIO_DELIVER);
    const bool is_fd =
        step->of_vehicle && (step->vehicle.what == VEHICLE_DO_SEND) && ((step->vehicle.frame.flags & HAL_CAN_FD) != 0);

    const bool is_restart = !step->of_vehicle && (step->supervisor.what == SCENARIO_RESTART);
    const bool is_flip = !step->of_vehicle && (step->supervisor.what == SCENARIO_FLIP_BIT);

    look(hazard);
    hazard->t_ms = t_ms;
    hazard->t_us = t_ms * US_PER_MS;
    if (is_restart) {
        begin_anew(hazard);
    }
    if (is_flip) {
        hazard_hold_perhaps_anew(hazard);
        forget_commands(hazard);
    }
    if (is_delivered) {
        on_data(hazard, step->supervisor.side, VEHICLE_ROGUE, &step->supervisor.frame);
    } else if (is_fd) {
        on_data(hazard, step->vehicle.side, VEHICLE_ROGUE, &step->vehicle.frame);
    } else {
        /* the wire shows it */
    }
}

void hazard_tick(hazard_t *hazard, uint64_t t_ms) {
    look(hazard);
    hazard->t_ms = t_ms;
    hazard->closed = hazard->view.output_closed;
    hazard_speed_tick(hazard);
    hazard_safe_tick(hazard);
    hazard_hold_tick(hazard);
    hazard_passed_tick(hazard);
    hazard_rows_tick(hazard);
}
