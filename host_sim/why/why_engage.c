/* The engagement of the autopilot, as 363h reports it (SUP-9). */
#include "agv/codec.h"
#include "agv/state.h"
#include "text/units.h"
#include "why/why_internal.h"

void why_engage_start(why_t *why) {
    why->engagement.began_us = WHY_NEVER;
    why->engagement.ended_us = WHY_NEVER;
    why->engagement.judged_us = WHY_NEVER;
}

uint64_t why_judged_us(const why_t *why) {
    return ((why->facts.mode_bits & AGV_VCU_FLAG_AUTOPILOT) != 0) ? why->engagement.judged_us : WHY_NEVER;
}

/** Whether an engagement follows the one before so soon that it is the same. */
static bool continues(const why_t *why, uint64_t t_us) {
    const uint64_t reengage_us = (uint64_t)why->config.reengage_ms * US_PER_MS;
    return (why->engagement.ended_us != WHY_NEVER) && (t_us <= why->engagement.ended_us + reengage_us);
}

static void begin(why_t *why, const why_evidence_t *frame) {
    why_engagement_t *engagement = &why->engagement;
    engagement->engaged = true;
    engagement->off_frames = 0;
    engagement->frames[engagement->count % WHY_ENGAGEMENTS] = *frame;
    engagement->count++;
    if (!continues(why, frame->t_us)) {
        engagement->began_us = frame->t_us;
        why_track_engage(why);
        why_budget_engage(why);
    }
    engagement->judged_us = engagement->began_us + ((uint64_t)why->config.engaged_grace_ms * US_PER_MS);
}

static void end(why_t *why, uint64_t t_us) {
    why->engagement.engaged = false;
    why->engagement.ended_us = t_us;
    why->engagement.judged_us = WHY_NEVER;
}

/** Manual that flickers while engaged (MODE_FLAPPING): the time since the last frame, and a first frame. */
static void follow_flicker(const why_t *why, why_engagement_t *engagement, const why_evidence_t *frame, bool manual) {
    const uint32_t before = why->facts.mode_bits & (AGV_VCU_FLAG_MANUAL | AGV_VCU_FLAG_AUTOPILOT);
    const uint64_t elapsed_us = frame->t_us - engagement->at_us;
    const uint64_t less_us = elapsed_us / 2;
    engagement->at_us = frame->t_us;
    if (!engagement->engaged) {
        engagement->manual_us = 0;
    } else if (before == AGV_VCU_FLAG_MANUAL) {
        engagement->manual_us += elapsed_us;
    } else {
        engagement->manual_us -= (engagement->manual_us > less_us) ? less_us : engagement->manual_us;
    }
    if (manual && (engagement->manual_us == 0)) {
        engagement->manual = *frame;
    }
}

void why_engage_frame(why_t *why, const why_evidence_t *frame) {
    why_engagement_t *engagement = &why->engagement;
    const uint32_t bits = frame->frame.data[6] & (AGV_VCU_FLAG_MANUAL | AGV_VCU_FLAG_AUTOPILOT);
    const uint64_t alive_until_us = why_fresh_until_us(why, AGV_MSG_VEHICLE_STATUS);
    why_budget_advance(why, frame->t_us);
    if (engagement->engaged && (alive_until_us != 0) && (alive_until_us <= frame->t_us)) {
        end(why, alive_until_us);
    }
    follow_flicker(why, engagement, frame, bits == AGV_VCU_FLAG_MANUAL);
    if (bits == (AGV_VCU_FLAG_MANUAL | AGV_VCU_FLAG_AUTOPILOT)) {
        engagement->off_frames = 0; /* the mode before remains */
    } else if ((bits & AGV_VCU_FLAG_AUTOPILOT) != 0) {
        engagement->off_frames = 0;
        if (!engagement->engaged) {
            begin(why, frame);
        }
    } else if (engagement->engaged) {
        engagement->off_frames++;
        if (engagement->off_frames >= why->config.mode_frames) {
            end(why, frame->t_us);
        }
    } else {
        /* manual, as before */
    }
}

void why_engage_state(why_t *why, const agv_event_t *event, uint64_t t_us) {
    if (event->a == AGV_STATE_ACTIVE) {
        end(why, t_us);
    }
    if ((event->b == AGV_STATE_ACTIVE) && !continues(why, t_us)) {
        why->engagement.began_us = t_us;
    }
}
