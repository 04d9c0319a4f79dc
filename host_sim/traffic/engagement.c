#include "traffic/engagement.h"

#include "agv/codec.h"

enum { BOTH = AGV_VCU_FLAG_MANUAL | AGV_VCU_FLAG_AUTOPILOT };

bool engagement_take(engagement_t *engagement, const agv_config_t *config, uint8_t flags) {
    const bool was_engaged = engagement->is_engaged;
    const uint32_t mode = flags & (uint32_t)BOTH;
    const bool is_off = (mode & (uint32_t)AGV_VCU_FLAG_AUTOPILOT) == 0;
    engagement->off_frames = is_off ? engagement->off_frames + 1 : 0;
    if (mode == AGV_VCU_FLAG_AUTOPILOT) {
        engagement->is_engaged = true;
    } else if (engagement->off_frames >= config->mode_frames) {
        engagement->is_engaged = false;
    } else {
        /* as before */
    }
    return engagement->is_engaged != was_engaged;
}
