/* An EPS that takes no angles, as 067h, 167h and 363h show it: what it measured before is no angle to hold (H2). */
#include "agv/codec.h"
#include "scenario/hazard/hazard.h"

enum {
    ANGLE_MODE = 0x01,
    SUPPLY_BITS = 0x07,
    FAULT_BITS = 0xE8,
    VCU_ALARMS = 0x30,
    MODE_BYTE = 3,
    FAULTS_BYTE = 7,
    ALARMS_BYTE = 4
};
enum { FRAMES_MORE = 2, MARGIN_MS = 60, FRAMES_MAX = 65535 };

static void count(uint32_t *frames, bool is_bad) {
    *frames = !is_bad ? 0 : (*frames < FRAMES_MAX) ? *frames + 1 : *frames;
}

/** An angle that is invalid by its score is usable again after twice its frames. */
static void count_angle(hazard_t *hazard, const uint8_t data[AGV_DLC]) {
    hazard_eps_t *eps = &hazard->eps;
    const uint32_t frames = hazard->config->status_invalid_frames;
    const bool is_bad = !agv_value_is_valid(AGV_MSG_STEERING_STATUS, data);

    count(&eps->bad_angles, is_bad);
    count(&eps->good_angles, !is_bad);
    if (eps->bad_angles >= frames + FRAMES_MORE) {
        eps->is_angle_lost = true;
    } else if (eps->good_angles + 1 >= 2 * frames) {
        eps->is_angle_lost = false;
    }
}

/** Count consecutive frames that say so. */
void hazard_eps_status(hazard_t *hazard, agv_message_t message, const uint8_t data[AGV_DLC]) {
    hazard_eps_t *eps = &hazard->eps;

    if (!hazard_is_hearing(hazard)) {
        *eps = (hazard_eps_t){0};
    } else if (message == AGV_MSG_EPS_STATUS) {
        count(&eps->supply_frames, (data[FAULTS_BYTE] & (uint8_t)SUPPLY_BITS) != 0);
        count(&eps->bad_frames, (data[MODE_BYTE] != ANGLE_MODE) || ((data[FAULTS_BYTE] & (uint8_t)FAULT_BITS) != 0));
    } else if (message == AGV_MSG_VEHICLE_STATUS) {
        count(&eps->alarm_frames, (data[ALARMS_BYTE] & (uint8_t)VCU_ALARMS) != 0);
    } else if (message == AGV_MSG_STEERING_STATUS) {
        count_angle(hazard, data);
    } else {
        /* says nothing of it */
    }
}

static bool is_silent(const hazard_t *hazard, uint32_t margin_ms) {
    const hazard_message_t *angle = &hazard->messages[AGV_MSG_STEERING_STATUS];
    const hazard_message_t *status = &hazard->messages[AGV_MSG_EPS_STATUS];
    const uint64_t alive_ms = (uint64_t)hazard->config->eps_heartbeat_timeout_ms + margin_ms;
    const uint64_t fresh_ms = (uint64_t)hazard->config->eps_status_timeout_ms + margin_ms;

    return (hazard->t_ms - angle->changed_ms > alive_ms) || (hazard->t_ms - status->seen_ms > fresh_ms);
}

/** @param more_frames than debouncing needs */
static bool takes_none(const hazard_t *hazard, uint32_t more_frames, uint32_t margin_ms) {
    const hazard_eps_t *eps = &hazard->eps;
    const bool has_no_angle = (more_frames == 0) ? (eps->bad_angles != 0) : eps->is_angle_lost;

    return hazard_is_hearing(hazard) && (has_no_angle || is_silent(hazard, margin_ms) ||
                                         (eps->bad_frames > more_frames) || (eps->alarm_frames > more_frames) ||
                                         (eps->supply_frames >= hazard->config->eps_supply_fault_frames + more_frames));
}

/** The supervisor must know: two frames more than its debouncing needs, so that one may be lost. */
bool hazard_eps_takes_no_angle(const hazard_t *hazard) {
    return takes_none(hazard, FRAMES_MORE, MARGIN_MS);
}

/** The supervisor may know: it received each frame. */
bool hazard_eps_perhaps_takes_none(const hazard_t *hazard) {
    return takes_none(hazard, 0, 0);
}

bool hazard_eps_in_angle_control(const hazard_t *hazard) {
    return hazard->messages[AGV_MSG_EPS_STATUS].data[MODE_BYTE] == ANGLE_MODE;
}
