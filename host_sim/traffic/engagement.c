#include "traffic/engagement.h"

#include "agv/codec.h"
#include "text/units.h"

enum { BOTH = AGV_VCU_FLAG_MANUAL | AGV_VCU_FLAG_AUTOPILOT };

static void begin(engagement_t *engagement, const agv_config_t *config, uint64_t t_us) {
    const uint64_t off_ms = (t_us / US_PER_MS) - (engagement->ended_us / US_PER_MS);
    engagement->is_continued = engagement->has_begun && (off_ms <= config->reengage_ms);
    engagement->began_us = engagement->is_continued ? engagement->began_us : t_us;
    engagement->is_engaged = true;
    engagement->has_begun = true;
}

void engagement_end(engagement_t *engagement, uint64_t t_us) {
    if (engagement->is_engaged) {
        engagement->is_engaged = false;
        engagement->ended_us = t_us;
    }
}

bool engagement_take(engagement_t *engagement, const agv_config_t *config, uint8_t flags, uint64_t t_us) {
    const bool was_engaged = engagement->is_engaged;
    const uint32_t mode = flags & (uint32_t)BOTH;
    const bool is_off = (mode & (uint32_t)AGV_VCU_FLAG_AUTOPILOT) == 0;
    engagement->off_frames = is_off ? engagement->off_frames + 1 : 0;
    if ((mode == AGV_VCU_FLAG_AUTOPILOT) && !was_engaged) {
        begin(engagement, config, t_us);
    } else if (engagement->off_frames >= config->mode_frames) {
        engagement_end(engagement, t_us);
    } else {
        /* as before */
    }
    return engagement->is_engaged != was_engaged;
}
