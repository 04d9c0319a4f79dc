#include "scenario/run/scenario_analysis.h"

static void on_received(void *ctx, uint64_t t_us, hal_can_side_t side, const hal_can_frame_t *frame) {
    analysis_frame(ctx, side, frame, t_us);
}

static void on_frame(void *ctx, uint64_t t_us, hal_can_side_t side, int from, const hal_can_frame_t *frame) {
    if (from == SCENARIO_FROM_SUPERVISOR) {
        analysis_sent(ctx, side, frame, t_us);
    }
}

scenario_watch_t scenario_analysis_watch(analysis_t *analysis) {
    return (scenario_watch_t){
        .on_event = analysis_event, .on_frame = on_frame, .on_received = on_received, .ctx = analysis};
}
