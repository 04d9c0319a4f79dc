#include "oracle.h"

#include <stdio.h>
#include <string.h>

#include "frame_bytes.h"

const uint8_t SAFE_SIGNALS[SAFE_SIGNALS_BYTES] = {0, 0, 0, 0, 0x70, 0, 0};
const uint8_t SAFE_PARK[8] = {8};
const uint8_t SAFE_THROTTLE[8] = {0};

static bool bytes_are(const hal_can_frame_t *frame, const uint8_t *expected, unsigned bytes) {
    return memcmp(frame->data, expected, bytes) == 0;
}

static bool zeros_from(const hal_can_frame_t *frame, unsigned first) {
    static const uint8_t zeros[8] = {0};
    return memcmp(&frame->data[first], zeros, 8 - first) == 0;
}

void oracle_configure(oracle_t *oracle, const agv_config_t *config) {
    const bool table = config->id_set == AGV_ID_SET_TABLE;
    oracle->gateway = config->topology == AGV_TOPOLOGY_GATEWAY;
    oracle->pass_all_in_manual = config->gateway_in_manual == AGV_IN_MANUAL_ALL;
    oracle->signal_id = table ? 0x201u : 0x43Fu;
    oracle->vehicle_id = table ? 0x203u : 0x363u;
    oracle->own_status_id = config->status_frame_id;
    oracle->hold_age_ms = config->hold_age_ms;
    oracle->mode_invalid_ms = config->mode_invalid_ms;
    oracle->angle_frames = config->status_invalid_frames;
}

void oracle_restart(oracle_t *oracle) {
    oracle->angle_known = false;
    oracle->angles = 0;
    oracle->angle_score = 0;
    oracle->angle_unusable = false;
    oracle->held_sent_ms = oracle->now_ms;
    oracle->ticked_ms = oracle->now_ms;
    oracle->latched = false;
    oracle->held = false;
    oracle->manual = false;
    oracle->mode_bits = 0;
    oracle->both_halves = 0;
    oracle->ending = false;
    oracle->before = AGV_STATE_INIT;
}

/* While both bits are set the previous mode stays valid for a limited time. */
static bool manual_is_reported(const oracle_t *oracle) {
    const bool invalid =
        (oracle->mode_bits == 0xC0u) && ((oracle->now_ms - oracle->both_since_ms) > oracle->mode_invalid_ms);
    return oracle->manual && !invalid;
}

static void hold(oracle_t *oracle) {
    oracle->held = true;
    oracle->held_since_tick = !oracle->in_tick;
    oracle->held_raw = oracle->angle_raw;
}

/*
 * After 2 s without 065h, and when the EPS could not take angles, a new angle may be held, within the time that the supervisor
 * needs to detect this. A tick may come so late that the EPS is only just alive. The last 065h that the controller accepted may
 * not have left: then the one before counts.
 */
enum { ANEW_MS = 2000 - 25, SURELY_ANEW_MS = 2700, RECENT_MS = 50 };

/* Deadlines of 067h and 167h, less what a late tick may hide. */
enum { EPS_GAP_MS = 45, EPS_STATUS_GAP_MS = 55, EPS_ALARMS = 0x30 };

static bool is_recent(const oracle_t *oracle, uint16_t raw) {
    bool recent = false;
    for (uint32_t i = 0; (i < ORACLE_ANGLES) && (i < oracle->angles); i++) {
        recent = recent || ((oracle->recent_raw[i] == raw) && (oracle->now_ms - oracle->recent_ms[i] <= RECENT_MS));
    }
    return recent;
}

/* Whether 065h may carry this angle. A new angle is held from then on. */
static bool may_hold(oracle_t *oracle, uint16_t raw) {
    const uint32_t unsent_ms = oracle->now_ms - oracle->held_sent_ms;
    const bool kept = oracle->held && (raw == oracle->held_raw) && (unsent_ms <= SURELY_ANEW_MS);
    const bool may_change = (unsent_ms >= ANEW_MS) || oracle->eps_was_unfit;
    const bool anew = oracle->held && may_change && is_recent(oracle, raw);
    if (kept || anew) {
        oracle->eps_was_unfit = false;
        oracle->held_raw = raw;
        oracle->held_sent_ms = oracle->now_ms;
    }
    return kept || anew;
}

/* FSM-10: the last valid angle before the trip is held, unless it is too old. Manual mode drops the held angle. */
static void follow(oracle_t *oracle, agv_state_t state) {
    const bool latched = is_latched(state);
    if (latched && !oracle->latched) {
        oracle->held_sent_ms = oracle->now_ms;
    }
    if (latched && !oracle->latched && oracle->angle_known &&
        ((oracle->now_ms - oracle->angle_ms) <= oracle->hold_age_ms)) {
        hold(oracle);
    }
    if (!latched || oracle->angle_unusable || manual_is_reported(oracle)) {
        oracle->held = false;
    }
    if (state != oracle->before) {
        const bool waits = oracle->ending && (state == AGV_STATE_ACTIVE); /* the HAL has not accepted the frame yet */
        oracle->ending = waits || ((oracle->before == AGV_STATE_ACTIVE) && (state == AGV_STATE_STANDBY));
    }
    oracle->before = state;
    oracle->latched = latched;
}

/* An angle of the frames before a late tick is outdated: the newest is held, if it is not too old. */
void oracle_tick(oracle_t *oracle, uint32_t now_ms) {
    const bool late = (now_ms - oracle->ticked_ms) > oracle->hold_age_ms;
    oracle->now_ms = now_ms;
    oracle->ticked_ms = now_ms;
    if (late && oracle->held && oracle->held_since_tick) {
        oracle->held = (now_ms - oracle->angle_ms) <= oracle->hold_age_ms;
        oracle->held_raw = oracle->angle_raw;
    }
    oracle->held_since_tick = false;
    oracle->in_tick = true;
}

/* STEERING_ANGLE_INVALID: a bad 067h counts 2, a good one takes 1 off. */
static void score_angle(oracle_t *oracle, bool bad) {
    const uint32_t full = 2 * oracle->angle_frames;
    if (bad) {
        oracle->angle_score = ((oracle->angle_score + 2) < full) ? (oracle->angle_score + 2) : full;
    } else if ((oracle->angle_score != 0) && (oracle->angle_frames > 1)) {
        oracle->angle_score--;
    } else {
        oracle->angle_score = 0;
    }
    oracle->angle_unusable = (oracle->angle_score == full) || (oracle->angle_unusable && (oracle->angle_score != 0));
    oracle->held = oracle->held && !oracle->angle_unusable;
}

/* If no angle is held, the first usable angle after the trip is. */
static void on_angle(oracle_t *oracle, const hal_can_frame_t *frame) {
    const uint16_t raw = word_at(&frame->data[2]);
    score_angle(oracle, raw > 18000);
    if (raw > 18000) {
        return;
    }
    oracle->angle_known = true;
    oracle->angle_raw = raw;
    oracle->angle_ms = frame->time_ms;
    oracle->recent_raw[oracle->angles % ORACLE_ANGLES] = raw;
    oracle->recent_ms[oracle->angles % ORACLE_ANGLES] = frame->time_ms;
    oracle->angles++;
    if (oracle->latched && !oracle->held && !oracle->angle_unusable && !manual_is_reported(oracle)) {
        hold(oracle);
    }
}

static void unfit_if(oracle_t *oracle, bool unfit) {
    oracle->eps_was_unfit = oracle->eps_was_unfit || unfit;
}

static void on_eps_counter(oracle_t *oracle, const hal_can_frame_t *frame) {
    const bool silent = (frame->time_ms - oracle->eps_ms) > EPS_GAP_MS;
    unfit_if(oracle, silent || (frame->data[0] != (uint8_t)(oracle->eps_counter + 1)));
    if (frame->data[0] != oracle->eps_counter) {
        oracle->eps_ms = frame->time_ms;
    }
    oracle->eps_counter = frame->data[0];
}

static void on_eps_status(oracle_t *oracle, const hal_can_frame_t *frame) {
    const bool silent = (frame->time_ms - oracle->eps_status_ms) > EPS_STATUS_GAP_MS;
    oracle->eps_status_ms = frame->time_ms;
    unfit_if(oracle, silent || (frame->data[3] != 1) || (frame->data[7] != 0));
}

/* MODE_INVALID: a millisecond without both bits takes half a millisecond off. */
static void on_both_modes(oracle_t *oracle, bool both, uint32_t time_ms) {
    const uint32_t past_ms = time_ms - oracle->both_since_ms;
    const uint32_t left = (past_ms < oracle->both_halves) ? (oracle->both_halves - past_ms) : 0;
    if (both && (oracle->mode_bits != 0xC0u)) {
        oracle->both_halves = (left > 1) ? left : 0;
        oracle->both_since_ms = time_ms - ((oracle->both_halves + 1) / 2);
    } else if (!both && (oracle->mode_bits == 0xC0u)) {
        const uint32_t spent_ms = (past_ms < oracle->mode_invalid_ms) ? past_ms : oracle->mode_invalid_ms;
        oracle->both_halves = (2 * spent_ms) - (oracle->both_halves % 2);
        oracle->both_since_ms = time_ms;
    }
}

static void on_mode(oracle_t *oracle, const hal_can_frame_t *frame) {
    unfit_if(oracle, (frame->data[4] & EPS_ALARMS) != 0);
    const uint8_t bits = (uint8_t)(frame->data[6] & 0xC0u);
    on_both_modes(oracle, bits == 0xC0u, frame->time_ms);
    if (bits != 0xC0u) {
        oracle->manual = bits == 0x40u;
    }
    oracle->mode_bits = bits;
}

void oracle_heard(oracle_t *oracle, hal_can_side_t side, const hal_can_frame_t *frame) {
    oracle->in_tick = false;
    if ((int32_t)(frame->time_ms - oracle->now_ms) > 0) {
        oracle->now_ms = frame->time_ms;
    }
    if ((side != HAL_CAN_VEHICLE) || (frame->flags != 0) || (frame->length != 8)) {
        return;
    }
    if (frame->id == 0x067u) {
        on_eps_counter(oracle, frame);
        on_angle(oracle, frame);
    } else if (frame->id == 0x167u) {
        on_eps_status(oracle, frame);
    } else if (frame->id == oracle->vehicle_id) {
        on_mode(oracle, frame);
    } else {
        /* other messages do not matter */
    }
}

static bool safe_to_vehicle(oracle_t *oracle, const hal_can_frame_t *frame, agv_state_t state) {
    if (frame->id == oracle->signal_id) {
        return bytes_are(frame, SAFE_SIGNALS, SAFE_SIGNALS_BYTES); /* any counter */
    }
    switch (frame->id) {
    case 0x168u:
        return bytes_are(frame, SAFE_PARK, 8);
    case 0x075u:
        return bytes_are(frame, SAFE_THROTTLE, 8);
    case 0x065u:
        return (state != AGV_STATE_INIT) && zeros_from(frame, 2) && may_hold(oracle, word_at(frame->data));
    default:
        return false;
    }
}

/* Commands that move the vehicle pass only while the last 363h reports autopilot. The end of an engagement is reported
 * once. */
static bool may_move(const oracle_t *oracle, agv_state_t state) {
    return (state == AGV_STATE_ACTIVE) ? (oracle->mode_bits == 0x80u) : oracle->pass_all_in_manual;
}

static bool passed_to_vehicle(oracle_t *oracle, const hal_can_frame_t *frame, agv_state_t state) {
    const bool all = may_move(oracle, state);
    const uint8_t gear = frame->data[0];
    if (oracle->ending && (frame->id == 0x075u) && zeros_from(frame, 0)) {
        oracle->ending = false;
        return true;
    }
    if (frame->id == oracle->signal_id) {
        return ((frame->data[4] & 0x0Fu) == 0) && (word_at(&frame->data[0]) == 0) && (word_at(&frame->data[2]) == 0) &&
               (word_at(&frame->data[5]) == 0);
    }
    switch (frame->id) {
    case 0x168u:
        return all && is_gear(gear) && zeros_from(frame, 1);
    case 0x075u:
        oracle->ending = oracle->ending && !all; /* a newer engagement has begun */
        return all && (frame->data[0] <= ((state == AGV_STATE_ACTIVE) ? 250u : 0u)) && zeros_from(frame, 1);
    case 0x065u:
        return all && (word_at(frame->data) <= 18000) && zeros_from(frame, 2);
    default:
        return false;
    }
}

static bool is_status(const oracle_t *oracle, uint32_t id) {
    return (id == oracle->vehicle_id) || (id == 0x0A3u) || (id == 0x050u) || (id == 0x067u) || (id == 0x167u) ||
           (id == 0x267u) || (id == 0x101u);
}

static bool may_leave(oracle_t *oracle, hal_can_side_t side, const hal_can_frame_t *frame, agv_state_t state) {
    if ((frame->flags != 0) || (frame->length != 8)) {
        return false;
    }
    if (side == HAL_CAN_AI) {
        return oracle->gateway && is_status(oracle, frame->id);
    }
    if ((oracle->own_status_id != 0) && (frame->id == oracle->own_status_id)) {
        return true;
    }
    if (commands_safe(state)) {
        return safe_to_vehicle(oracle, frame, state);
    }
    return oracle->gateway && passed_to_vehicle(oracle, frame, state);
}

void oracle_sent(oracle_t *oracle, hal_can_side_t side, const hal_can_frame_t *frame, agv_state_t state) {
    follow(oracle, state);
    if (commands_safe(state)) {
        oracle->judged++;
    } else {
        oracle->others++;
    }
    if (!may_leave(oracle, side, frame, state)) {
        if (oracle->forbidden == 0) {
            oracle->first_forbidden = *frame;
            oracle->first_side = side;
            oracle->first_state = state;
        }
        oracle->forbidden++;
    }
}

void oracle_returned(oracle_t *oracle, agv_state_t state) {
    follow(oracle, state);
}

const char *oracle_verdict(const oracle_t *oracle) {
    static char text[160];
    const hal_can_frame_t *frame = &oracle->first_forbidden;
    if (oracle->forbidden == 0) {
        return "";
    }
    (void)snprintf(text, sizeof text,
                   "%u forbidden, first in state %02Xh to side %d: %03X#%02X%02X%02X%02X%02X%02X%02X%02X (held %d: %u)",
                   (unsigned)oracle->forbidden, (unsigned)oracle->first_state, (int)oracle->first_side,
                   (unsigned)frame->id, frame->data[0], frame->data[1], frame->data[2], frame->data[3], frame->data[4],
                   frame->data[5], frame->data[6], frame->data[7], oracle->held ? 1 : 0, (unsigned)oracle->held_raw);
    return text;
}
