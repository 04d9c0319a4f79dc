/* Two reports of the speed: the wheels (101h) and the VCU (363h). Whether the supervisor can know that the vehicle moves. */
#include "hunt/hazard/hazard.h"

enum { STANDS_MM_S = 100, FRESH_MS = 100, STEP_MS = 10, DIFFERS_MM_S = 700 };

#define MM_PER_M 1000u
#define S_PER_H 3600u

static bool is_fresh(const hazard_t *hazard, agv_message_t message, uint32_t within_ms) {
    const hazard_message_t *seen = &hazard->messages[message];
    return seen->has && (hazard->t_ms - seen->seen_ms <= within_ms);
}

static bool is_slow(int32_t speed_mm_s) {
    return (speed_mm_s < STANDS_MM_S) && (speed_mm_s > -STANDS_MM_S);
}

static bool wheels_stand(const hazard_t *hazard) {
    agv_wheel_speed_t speed;

    (void)agv_unpack_wheel_speed(&speed, hazard->messages[AGV_MSG_WHEEL_SPEED].data);
    return is_slow(speed.left_mm_s) && is_slow(speed.right_mm_s);
}

static int32_t vcu_speed_mm_s(const hazard_t *hazard) {
    agv_vehicle_status_t status;

    (void)agv_unpack_vehicle_status(&status, hazard->messages[AGV_MSG_VEHICLE_STATUS].data);
    return (int32_t)(((uint32_t)status.speed_m_per_h * MM_PER_M) / S_PER_H);
}

/** 363h reports a speed at which 101h, which reports none, cannot be right. */
static bool is_contradicted(const hazard_t *hazard) {
    return is_fresh(hazard, AGV_MSG_VEHICLE_STATUS, hazard->limits.vcu_ms) &&
           (vcu_speed_mm_s(hazard) > (int32_t)DIFFERS_MM_S);
}

/** The time of the contradiction adds up, and decays while there is none. */
void hazard_speed_tick(hazard_t *hazard) {
    const int32_t full_ms = (int32_t)hazard->limits.speed_implausible_ms;
    int32_t *spent_ms = &hazard->contradicted_ms;

    if ((hazard->t_ms % (uint64_t)STEP_MS) == 0u) {
        *spent_ms += (wheels_stand(hazard) && is_contradicted(hazard)) ? STEP_MS : -STEP_MS;
        *spent_ms = (*spent_ms < 0) ? 0 : (*spent_ms > full_ms) ? full_ms : *spent_ms;
    }
}

/** 101h reports standstill, and 363h does not contradict it for long enough. */
bool hazard_is_said_to_stand(const hazard_t *hazard) {
    const bool is_doubted =
        !hazard->limits.wheels_alone && (hazard->contradicted_ms == (int32_t)hazard->limits.speed_implausible_ms);

    return is_fresh(hazard, AGV_MSG_WHEEL_SPEED, FRESH_MS) && wheels_stand(hazard) && !is_doubted;
}
