/* Two reports of the speed: the wheels (101h) and the VCU (363h). Whether the supervisor can know that the vehicle moves. */
#include "scenario/hazard/hazard.h"

enum { STANDS_MM_S = 100, FRESH_MS = 100, STEP_MS = 10, DIFFERS_M_PER_H = 3063 /* 0.85 m/s */ };
enum { MOVING_MM_S = 300, MARGIN_MM_S = 50, MARGIN_MS = 100, STOOD_MS = 300, SURE_MS = 300 };

static bool is_fresh(const hazard_t *hazard, agv_message_t message, uint32_t within_ms) {
    const hazard_message_t *seen = &hazard->messages[message];
    return seen->has && (hazard->t_ms - seen->seen_ms <= within_ms);
}

static bool is_below(int32_t speed_mm_s, int32_t limit_mm_s) {
    return (speed_mm_s < limit_mm_s) && (speed_mm_s > -limit_mm_s);
}

/** 101h is fresh, and reports that both wheels are slower. */
static bool wheels_are_below(const hazard_t *hazard, int32_t limit_mm_s) {
    agv_wheel_speed_t speed;

    (void)agv_unpack_wheel_speed(&speed, hazard->messages[AGV_MSG_WHEEL_SPEED].data);
    return is_fresh(hazard, AGV_MSG_WHEEL_SPEED, FRESH_MS) && is_below(speed.left_mm_s, limit_mm_s) &&
           is_below(speed.right_mm_s, limit_mm_s);
}

static uint32_t vcu_speed_m_per_h(const hazard_t *hazard) {
    agv_vehicle_status_t status;

    (void)agv_unpack_vehicle_status(&status, hazard->messages[AGV_MSG_VEHICLE_STATUS].data);
    return status.speed_m_per_h;
}

/** 101h reports standstill, and 363h a speed at which that cannot be right. */
static bool is_contradicted(const hazard_t *hazard) {
    return wheels_are_below(hazard, STANDS_MM_S) &&
           is_fresh(hazard, AGV_MSG_VEHICLE_STATUS, hazard->config->vcu_heartbeat_timeout_ms) &&
           (vcu_speed_m_per_h(hazard) > DIFFERS_M_PER_H);
}

static bool is_doubted(const hazard_t *hazard) {
    return (hazard->config->standstill_vcu_counts != AGV_STANDSTILL_VCU_ANY) &&
           (hazard->contradicted_ms == (int32_t)hazard->config->speed_implausible_ms);
}

static void follow_contradiction(hazard_t *hazard) {
    const int32_t full_ms = (int32_t)hazard->config->speed_implausible_ms;
    int32_t *spent_ms = &hazard->contradicted_ms;

    *spent_ms += is_contradicted(hazard) ? STEP_MS : -STEP_MS;
    *spent_ms = (*spent_ms < 0) ? 0 : (*spent_ms > full_ms) ? full_ms : *spent_ms;
}

/** Both reports are those of a vehicle that stands. */
static bool both_report_standstill(const hazard_t *hazard) {
    return wheels_are_below(hazard, hazard->config->standstill_speed_mm_s) &&
           (vcu_speed_m_per_h(hazard) <= hazard->config->standstill_vcu_counts);
}

/** The time of a contradiction adds up, and decays while there is none. */
void hazard_speed_tick(hazard_t *hazard) {
    const int32_t limit_mm_s = hazard->config->standstill_speed_mm_s + MARGIN_MM_S;

    if ((hazard->t_ms % STEP_MS) == 0) {
        follow_contradiction(hazard);
    }
    if (wheels_are_below(hazard, limit_mm_s) && !is_doubted(hazard)) {
        hazard->stood_ms = hazard->t_ms;
    }
    hazard->moved_ms = both_report_standstill(hazard) ? hazard->moved_ms : hazard->t_ms;
}

/** Both reports are, and have been for some time: the supervisor cannot know that the vehicle moves. */
bool hazard_is_at_standstill(const hazard_t *hazard) {
    return hazard->t_ms - hazard->moved_ms >= hazard->config->standstill_ms;
}

/** For so long that the supervisor must have seen it, too. */
bool hazard_has_surely_stood(const hazard_t *hazard) {
    return hazard->t_ms - hazard->moved_ms >= (uint64_t)hazard->config->standstill_ms + SURE_MS;
}

/** 101h reports standstill, and 363h does not contradict it for long enough. */
bool hazard_is_said_to_stand(const hazard_t *hazard) {
    return wheels_are_below(hazard, STANDS_MM_S) && !is_doubted(hazard);
}

/**
 * Since the trip, whose first frames a slow bus with destroyed frames holds up for some 70 ms. A flipped bit while it is
 * tripped begins no other time.
 */
static bool is_too_early(const hazard_t *hazard) {
    const hazard_trip_t *trip = &hazard->trip;
    return !trip->tripped || (hazard->t_ms - trip->since_ms + MARGIN_MS < hazard->config->park_timeout_ms);
}

/** The supervisor commands P, or passes it on. After a trip the first one counts: then it goes on. */
void hazard_park_frame(hazard_t *hazard) {
    const bool counts =
        (hazard->config->park == AGV_PARK_AT_STANDSTILL) && hazard->view.output_closed && !hazard->trip.parked;

    if (counts && is_too_early(hazard) && (hazard_speed_mm_s(hazard) > MOVING_MM_S) &&
        (hazard->t_ms - hazard->stood_ms > STOOD_MS)) {
        hazard_found(hazard, HAZARD_PARK, "P comes in motion");
    }
    hazard->trip.parked = hazard->trip.tripped;
}
