/* A node that is dead, hangs or reports an impossible value, while the vehicle moves on (H1, H6). One row a condition. */
#include <stdlib.h>
#include <string.h>

#include "scenario/hazard/hazard.h"

enum { STEP_MS = 10, MARGIN_MS = 1500, MOVING_MM_S = 300, REACTED_MS = 350, REENGAGE_MS = 100, MANUAL_WEIGHT = 2 };
enum { SCORE_CAP = 4, EVENT_MS = 400, STILL_MARGIN_MS = 200, DEVIATION_DDEG = 50, CLOSE = 16 };
enum { THROTTLE_SPARE = 10, FALL_MS = 700, EPS_ANGLE_MODE = 0x01, MODE_BYTE = 6, MODE_BITS = 0xC0 };

/** How a row is evaluated. */
typedef enum {
    SILENT, /**< no frame of the message (a command: no usable one) within `setting` */
    STUCK,  /**< its alive counter did not change within `setting` */
    SCORE,  /**< more bad frames than good ones: `setting` of them */
    LEVEL   /**< a condition, for `setting` */
} form_t;

typedef bool condition_fn(const hazard_t *hazard);
typedef bool frame_fn(const uint8_t data[AGV_DLC], uint8_t mask);

typedef struct {
    const char *name;
    form_t form;
    bool engaged; /**< counts while 363h reports autopilot, and after the grace time */
    agv_message_t message;
    uint16_t setting;  /**< AGV_SETTING_*, NO_SETTING */
    agv_fault_t fault; /**< that must be a trip in this configuration; AGV_FAULT_NONE: it always is */
    frame_fn *is_bad;
    uint8_t mask;
    condition_fn *holds;
} row_t;

static bool has_bit(const uint8_t data[AGV_DLC], uint8_t mask) {
    return (data[AGV_DLC - 1] & mask) != 0;
}

static bool has_alarm(const uint8_t data[AGV_DLC], uint8_t mask) {
    return (data[4] & mask) != 0;
}

static bool is_no_angle_control(const uint8_t data[AGV_DLC], uint8_t mask) {
    return data[3] != mask;
}

static bool is_no_gear(const uint8_t data[AGV_DLC], uint8_t mask) {
    (void)mask;
    return (data[0] != AGV_GEAR_P) && (data[0] != AGV_GEAR_R) && (data[0] != AGV_GEAR_N) && (data[0] != AGV_GEAR_D);
}

static bool is_above(const uint8_t data[AGV_DLC], uint8_t mask) {
    return data[0] > mask;
}

static bool is_no_angle(const uint8_t data[AGV_DLC], uint8_t mask) {
    (void)mask;
    return (data[2] | ((uint32_t)data[3] << 8)) > 18000;
}

static uint8_t throttle_of(const hazard_t *hazard) {
    return hazard->messages[AGV_MSG_THROTTLE_STATUS].valid[0];
}

/** 0 while 0A3h is silent, or its last frame has no valid gear. */
static uint8_t gear_of(const hazard_t *hazard) {
    const hazard_message_t *seen = &hazard->messages[AGV_MSG_GEAR_STATUS];
    const bool is_silent = hazard->t_ms - seen->seen_ms > hazard->config->gear_status_timeout_ms;
    return (is_silent || (seen->valid_ms != seen->seen_ms)) ? 0 : seen->valid[0];
}

static bool is_steering_stuck(const hazard_t *hazard) {
    const int32_t told_ddeg = (int32_t)hazard->commanded[AGV_MSG_STEERING_COMMAND] - 9000;
    const int32_t limit_ddeg = (int32_t)hazard->config->steering_deviation_ddeg + DEVIATION_DDEG;

    return hazard->is_commanded[AGV_MSG_STEERING_COMMAND] &&
           (hazard->t_ms - hazard->still_since_ms >
            (uint64_t)hazard->config->steering_deviation_ms + STILL_MARGIN_MS) &&
           (abs(hazard_measured_ddeg(hazard) - told_ddeg) > limit_ddeg);
}

static bool is_at_idle(const hazard_t *hazard) {
    return throttle_of(hazard) <= hazard->config->throttle_idle_counts;
}

static bool is_throttle_in_park(const hazard_t *hazard) {
    return (gear_of(hazard) == AGV_GEAR_P) && !is_at_idle(hazard);
}

static bool is_throttle_too_high(const hazard_t *hazard) {
    const uint32_t highest = hazard->commanded[AGV_MSG_THROTTLE_COMMAND] + hazard->config->throttle_deviation_counts;

    return hazard->is_commanded[AGV_MSG_THROTTLE_COMMAND] && (throttle_of(hazard) > highest + THROTTLE_SPARE) &&
           (hazard->t_ms - hazard->throttle_high_ms > FALL_MS);
}

static bool is_driven_in_other_gear(const hazard_t *hazard) {
    const uint8_t gear = gear_of(hazard);

    return hazard->is_commanded[AGV_MSG_GEAR_COMMAND] && !is_at_idle(hazard) &&
           ((gear == AGV_GEAR_D) || (gear == AGV_GEAR_R)) &&
           ((uint16_t)gear != hazard->commanded[AGV_MSG_GEAR_COMMAND]);
}

/** D or R is commanded and not reported, and the throttle is at idle. */
static bool is_gear_awaited(const hazard_t *hazard) {
    const uint16_t commanded = hazard->commanded[AGV_MSG_GEAR_COMMAND];

    return hazard->is_commanded[AGV_MSG_GEAR_COMMAND] && is_at_idle(hazard) &&
           ((commanded == AGV_GEAR_D) || (commanded == AGV_GEAR_R)) && ((uint16_t)gear_of(hazard) != commanded);
}

static bool is_off_ignored(const hazard_t *hazard) {
    return hazard->asked_off_ms != 0;
}

/** Neither, or both, while a speed is reported. */
static bool is_without_mode(const hazard_t *hazard) {
    const hazard_message_t *status = &hazard->messages[AGV_MSG_VEHICLE_STATUS];
    return status->has && !hazard_is_at_standstill(hazard) &&
           (((status->data[MODE_BYTE] & MODE_BITS) == 0) || hazard->mode.both);
}

static bool is_in_both_modes(const hazard_t *hazard) {
    return hazard->mode.both;
}

static bool is_command_too_fast(const hazard_t *hazard) {
    bool fast = false;

    for (unsigned m = 0; m < AGV_COMMAND_COUNT; m++) {
        fast = fast || (hazard->messages[m].fast >= 2 * (int32_t)hazard->config->command_too_fast_gaps);
    }
    return fast;
}

static bool is_command_bad(const hazard_t *hazard) {
    return hazard->has_bad_command && (hazard->t_ms - hazard->bad_command_ms < EVENT_MS);
}

static bool is_stalled(const hazard_t *hazard, hal_can_side_t side) {
    scenario_controller_t controller;
    scenario_testbed_controller(hazard->testbed, side, &controller);
    return controller.is_stalled;
}

static bool is_transmitter_dead(const hazard_t *hazard) {
    return is_stalled(hazard, HAL_CAN_VEHICLE);
}

/** The AI computer receives nothing, but its commands still arrive. */
static bool is_ai_side_dead(const hazard_t *hazard) {
    return hazard->gateway && is_stalled(hazard, HAL_CAN_AI);
}

#define NONE AGV_MSG_NONE
#define NO_SETTING AGV_SETTING_COUNT
static const row_t ROWS[] = {
    {"the VCU is silent", STUCK, false, AGV_MSG_VEHICLE_STATUS, AGV_SETTING_vcu_heartbeat_timeout_ms, AGV_FAULT_NONE,
     NULL, 0, NULL},
    {"the EPS is silent", STUCK, false, AGV_MSG_STEERING_STATUS, AGV_SETTING_eps_heartbeat_timeout_ms, AGV_FAULT_NONE,
     NULL, 0, NULL},
    {"the AI computer is silent", STUCK, true, AGV_MSG_TURN_SIGNAL_COMMAND, AGV_SETTING_ai_heartbeat_timeout_ms,
     AGV_FAULT_NONE, NULL, 0, NULL},
    {"168h is missing", SILENT, true, AGV_MSG_GEAR_COMMAND, AGV_SETTING_gear_command_timeout_ms, AGV_FAULT_NONE, NULL,
     0, NULL},
    {"075h is missing", SILENT, true, AGV_MSG_THROTTLE_COMMAND, AGV_SETTING_throttle_command_timeout_ms, AGV_FAULT_NONE,
     NULL, 0, NULL},
    {"065h is missing", SILENT, true, AGV_MSG_STEERING_COMMAND, AGV_SETTING_steering_command_timeout_ms, AGV_FAULT_NONE,
     NULL, 0, NULL},
    {"167h is missing", SILENT, false, AGV_MSG_EPS_STATUS, AGV_SETTING_eps_status_timeout_ms, AGV_FAULT_NONE, NULL, 0,
     NULL},
    {"0A3h is missing", SILENT, false, AGV_MSG_GEAR_STATUS, AGV_SETTING_gear_status_timeout_ms,
     AGV_FAULT_GEAR_STATUS_TIMEOUT, NULL, 0, NULL},
    {"050h is missing", SILENT, false, AGV_MSG_THROTTLE_STATUS, AGV_SETTING_throttle_status_timeout_ms,
     AGV_FAULT_THROTTLE_STATUS_TIMEOUT, NULL, 0, NULL},
    {"101h is missing", SILENT, false, AGV_MSG_WHEEL_SPEED, AGV_SETTING_wheel_speed_timeout_ms,
     AGV_FAULT_WHEEL_SPEED_TIMEOUT, NULL, 0, NULL},
    {"the EPS reports a fault", SCORE, false, AGV_MSG_EPS_STATUS, NO_SETTING, AGV_FAULT_NONE, has_bit, 0xE8u, NULL},
    {"the EPS reports a supply fault", SCORE, false, AGV_MSG_EPS_STATUS, AGV_SETTING_eps_supply_fault_frames,
     AGV_FAULT_NONE, has_bit, 0x07u, NULL},
    {"the VCU reports a fault of the EPS", SCORE, false, AGV_MSG_VEHICLE_STATUS, NO_SETTING, AGV_FAULT_NONE, has_alarm,
     0x30u, NULL},
    {"the VCU reports an S-driver alarm", SCORE, false, AGV_MSG_VEHICLE_STATUS, NO_SETTING, AGV_FAULT_S_DRIVER_ALARM,
     has_alarm, 0x80u, NULL},
    {"the remote signal is lost", SCORE, false, AGV_MSG_VEHICLE_STATUS, NO_SETTING, AGV_FAULT_REMOTE_SIGNAL_LOST,
     has_alarm, 0x01u, NULL},
    {"the remote power is lost", SCORE, false, AGV_MSG_VEHICLE_STATUS, NO_SETTING, AGV_FAULT_REMOTE_POWER_LOST,
     has_alarm, 0x02u, NULL},
    {"the EPS is not in angle control", SCORE, true, AGV_MSG_EPS_STATUS, AGV_SETTING_eps_mode_frames, AGV_FAULT_NONE,
     is_no_angle_control, EPS_ANGLE_MODE, NULL},
    {"0A3h has an invalid gear", SCORE, true, AGV_MSG_GEAR_STATUS, AGV_SETTING_status_invalid_frames,
     AGV_FAULT_GEAR_STATUS_INVALID, is_no_gear, 0, NULL},
    {"050h has an invalid throttle", SCORE, true, AGV_MSG_THROTTLE_STATUS, AGV_SETTING_status_invalid_frames,
     AGV_FAULT_THROTTLE_STATUS_INVALID, is_above, 250, NULL},
    {"067h has an invalid angle", SCORE, true, AGV_MSG_STEERING_STATUS, AGV_SETTING_status_invalid_frames,
     AGV_FAULT_NONE, is_no_angle, 0, NULL},
    {"the steering is stuck", LEVEL, true, NONE, AGV_SETTING_steering_deviation_ms, AGV_FAULT_NONE, NULL, 0,
     is_steering_stuck},
    {"throttle with gear P", LEVEL, true, NONE, AGV_SETTING_throttle_in_park_ms, AGV_FAULT_THROTTLE_IN_PARK, NULL, 0,
     is_throttle_in_park},
    {"more throttle than commanded", LEVEL, true, NONE, AGV_SETTING_throttle_deviation_ms, AGV_FAULT_THROTTLE_DEVIATION,
     NULL, 0, is_throttle_too_high},
    {"another gear than commanded", LEVEL, true, NONE, AGV_SETTING_gear_deviation_ms, AGV_FAULT_GEAR_DEVIATION, NULL, 0,
     is_driven_in_other_gear},
    {"autopilot off is ignored", LEVEL, true, NONE, AGV_SETTING_autopilot_off_ms, AGV_FAULT_AUTOPILOT_OFF_IGNORED, NULL,
     0, is_off_ignored},
    {"no valid mode is reported", LEVEL, false, NONE, AGV_SETTING_mode_none_ms, AGV_FAULT_NONE, NULL, 0,
     is_without_mode},
    {"both modes are reported", LEVEL, false, NONE, AGV_SETTING_mode_invalid_ms, AGV_FAULT_NONE, NULL, 0,
     is_in_both_modes},
    {"commands come too fast", LEVEL, true, NONE, NO_SETTING, AGV_FAULT_COMMAND_TOO_FAST, NULL, 0, is_command_too_fast},
    {"an invalid command", LEVEL, true, NONE, NO_SETTING, AGV_FAULT_NONE, NULL, 0, is_command_bad},
    {"the supervisor's transmitter has failed", LEVEL, false, NONE, AGV_SETTING_tx_stalled_ms, AGV_FAULT_NONE, NULL, 0,
     is_transmitter_dead},
    {"the AI side is stalled", LEVEL, true, NONE, AGV_SETTING_tx_stalled_ms, AGV_FAULT_AI_BUS_OFF, NULL, 0,
     is_ai_side_dead},
};
enum { ROW_COUNT = sizeof ROWS / sizeof ROWS[0] };
_Static_assert(sizeof ROWS / sizeof ROWS[0] <= HAZARD_ROWS_MAX, "a row has no place in hazard_t");

/** For how long it may be; @param value of its setting. */
static uint32_t limit_ms(const hazard_t *hazard, const row_t *row, uint32_t value) {
    uint32_t limit = MARGIN_MS + ((row->form == LEVEL) ? value : 0);

    limit += (row->engaged && (row->form <= STUCK)) ? hazard->config->engaged_grace_ms : 0;
    if (row->message == AGV_MSG_TURN_SIGNAL_COMMAND) {
        limit += hazard->config->ai_never_seen_timeout_ms;
    }
    if (row->holds == is_transmitter_dead) {
        limit += hazard->config->status_frame_period_ms; /* the next frame shows it */
    }
    return limit;
}

void hazard_rows_init(hazard_t *hazard) {
    for (unsigned r = 0; r < ROW_COUNT; r++) {
        const row_t *row = &ROWS[r];
        const uint32_t none = (row->form == SCORE) ? 1u : 0u;
        const uint32_t value = (row->setting == NO_SETTING) ? none : agv_config_get(hazard->config, row->setting);
        hazard->thresholds[r] = value;
        hazard->limits_ms[r] = limit_ms(hazard, row, value);
        if ((row->form == SCORE) && (hazard->score_counts[row->message] < HAZARD_SCORES_MAX)) {
            hazard->score_rows[row->message][hazard->score_counts[row->message]] = (uint8_t)r;
            hazard->score_counts[row->message]++;
        }
        const bool only_warns = (row->fault != AGV_FAULT_NONE) && !agv_config_is_trip(hazard->config, row->fault);
        const bool has_no_status_frame = hazard->config->status_frame_id == 0; /* the integrator's choice */
        hazard->off[r] = only_warns || ((row->holds == is_transmitter_dead) && has_no_status_frame);
    }
}

/** Of a command, each engagement begins the deadline anew (SUP-3); not the one that is too many in mode_flapping_ms. */
static uint64_t silent_since_ms(const hazard_t *hazard, const row_t *row) {
    const hazard_message_t *seen = &hazard->messages[row->message];
    const hazard_mode_t *mode = &hazard->mode;

    if ((uint32_t)row->message >= AGV_COMMAND_COUNT) {
        return seen->seen_ms;
    }
    return (mode->graced && (seen->valid_ms < mode->engaged_ms)) ? mode->engaged_ms : seen->valid_ms;
}

static bool holds(const hazard_t *hazard, unsigned r) {
    const row_t *row = &ROWS[r];
    const hazard_message_t *seen = &hazard->messages[(row->form == LEVEL) ? 0 : row->message];
    const uint64_t limit_ms = hazard->thresholds[r];

    switch (row->form) {
    case SILENT:
        return hazard->t_ms - silent_since_ms(hazard, row) > limit_ms;
    case STUCK:
        return hazard->t_ms - seen->changed_ms > limit_ms;
    case SCORE:
        return hazard->scores[r] >= (int32_t)hazard->thresholds[r];
    default:
        return row->holds(hazard);
    }
}

/** In the grace time of an engagement, what a node reports is not judged yet. */
static bool is_in_grace(const hazard_t *hazard, const row_t *row) {
    const hazard_mode_t *mode = &hazard->mode;

    return row->engaged && (row->form > STUCK) && mode->autopilot && mode->graced &&
           (hazard->t_ms - mode->engaged_ms < hazard->config->engaged_grace_ms);
}

void hazard_rows_frame(hazard_t *hazard, agv_message_t message, const uint8_t data[AGV_DLC]) {
    for (unsigned i = 0; i < hazard->score_counts[message]; i++) {
        const unsigned r = hazard->score_rows[message][i];
        const row_t *row = &ROWS[r];
        if (row->engaged && !hazard->mode.autopilot) {
            continue;
        }
        const bool bad = row->is_bad(data, row->mask);
        if (bad && is_in_grace(hazard, row)) {
            continue;
        }
        const int32_t cap = SCORE_CAP * (int32_t)hazard->thresholds[r];
        const int32_t score = hazard->scores[r] + (bad ? 1 : -1);
        hazard->scores[r] = (score < 0) ? 0 : (score > cap) ? cap : score;
    }
}

/**
 * Time that neither adds to a condition nor takes away: without a gear, of the conditions that it is a part of; at idle
 * with a gear that is not the commanded D or R, of that gear.
 */
static bool shows_nothing(const hazard_t *hazard, const row_t *row) {
    const bool is_of_gear = row->holds == is_driven_in_other_gear;
    return ((is_of_gear || (row->holds == is_throttle_in_park)) && (gear_of(hazard) == 0)) ||
           (is_of_gear && is_gear_awaited(hazard));
}

/** Time in which a condition holds adds up; time in which it does not takes away. */
static void add_up(hazard_t *hazard, unsigned r) {
    const row_t *row = &ROWS[r];
    const bool is_manual = row->engaged && !hazard->mode.autopilot;
    const bool long_manual = is_manual && (hazard->t_ms - hazard->mode.clear_ms >= REENGAGE_MS);
    int32_t *budget_ms = &hazard->budgets_ms[r];

    if (is_manual) {
        *budget_ms -= long_manual ? STEP_MS * MANUAL_WEIGHT : STEP_MS;
    } else if (shows_nothing(hazard, row)) {
        /* as it was */
    } else {
        *budget_ms += holds(hazard, r) ? STEP_MS : -STEP_MS;
    }
    *budget_ms = (*budget_ms < 0) ? 0 : *budget_ms;
    const uint32_t close = ((uint32_t)*budget_ms * CLOSE) / hazard->limits_ms[r];
    if (close > hazard->closeness[r]) {
        hazard->closeness[r] = (uint8_t)((close > CLOSE) ? CLOSE : close);
    }
    if (*budget_ms > (int32_t)hazard->limits_ms[r]) {
        hazard_found(hazard, (row->form <= STUCK) ? HAZARD_NOT_STOPPING : HAZARD_FALSE_NODE, row->name);
    }
}

/** Time budgets of SUP-5, SUP-10 and SUP-11: each engagement begins them anew, so each has to fill within one. */
static bool is_budget_of_engagement(const row_t *row) {
    return row->engaged && (row->form == LEVEL) && (row->setting != NO_SETTING) && (row->holds != is_ai_side_dead);
}

void hazard_rows_engage(hazard_t *hazard) {
    for (unsigned r = 0; r < ROW_COUNT; r++) {
        int32_t *budget_ms = &hazard->budgets_ms[r];
        if (ROWS[r].holds == is_steering_stuck) {
            *budget_ms = 0; /* a reading that moves to the command and back may be progress, once in each engagement */
        } else if (is_budget_of_engagement(&ROWS[r]) && (*budget_ms > MARGIN_MS)) {
            *budget_ms = (int32_t)MARGIN_MS;
        } else {
            /* goes on */
        }
    }
}

void hazard_rows_tick(hazard_t *hazard) {
    if ((hazard->t_ms % STEP_MS) != 0) {
        return;
    }
    if (!hazard->closed || hazard_is_safe_now(hazard, REACTED_MS) || (hazard_speed_mm_s(hazard) < MOVING_MM_S)) {
        memset(hazard->budgets_ms, 0, sizeof hazard->budgets_ms);
        return;
    }
    for (unsigned r = 0; r < ROW_COUNT; r++) {
        if (!hazard->off[r] && !is_in_grace(hazard, &ROWS[r])) {
            add_up(hazard, r);
        }
    }
}
