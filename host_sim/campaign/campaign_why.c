#include "campaign/campaign_why.h"

#include "agv/names.h"
#include "common/report.h"
#include "io/output_json.h"
#include "text/units.h"

bool campaign_why_init(campaign_why_t *why, const agv_config_t *config) {
    campaign_why_free(why);
    why->why = why_new(config);
    return (why->why != NULL) || report("out of memory");
}

static void on_why_event(void *ctx, const session_event_t *event) {
    const campaign_why_t *why = ctx;
    why_event(why->why, event);
}

static void on_received(void *ctx, uint64_t t_us, hal_can_side_t side, const hal_can_frame_t *frame) {
    const campaign_why_t *why = ctx;
    why_frame(why->why, side, frame, t_us);
}

static void on_why_frame(void *ctx, uint64_t t_us, hal_can_side_t side, int from, const hal_can_frame_t *frame) {
    const campaign_why_t *why = ctx;
    if (from == SCENARIO_FROM_SUPERVISOR) {
        why_sent(why->why, side, frame, t_us);
    }
}

scenario_watch_t campaign_why_watch(campaign_why_t *why) {
    return (scenario_watch_t){
        .on_event = on_why_event, .on_frame = on_why_frame, .on_received = on_received, .ctx = why};
}

/** The trips as --why has them, but for the frames. */
static json_t *trips_of(const why_t *why) {
    const why_names_t names = {.log = NULL};
    json_t *object = why_json(why, &names);
    json_t *trips = json_incref(json_object_get(object, "trips"));
    for (size_t i = 0; i < json_array_size(trips); i++) {
        (void)json_object_del(json_array_get(trips, i), "evidence");
    }
    json_decref(object);
    return trips;
}

void campaign_why_write(campaign_why_t *why, output_t *output, const campaign_plan_t *plan) {
    why_end(why->why, (uint64_t)plan->duration_ms * US_PER_MS);
    json_t *line =
        json_pack("{s:I, s:s, s:b, s:i, s:i, s:i, s:o}", "run", (json_int_t)plan->run, "fault",
                  agv_fault_name(plan->row->fault), "gateway", (int)plan->gateway, "steps_ms", (int)plan->steps_ms,
                  "cause_ms", (int)plan->cause_ms, "engage_ms", (int)plan->engage_ms, "trips", trips_of(why->why));
    output_json(output, line, 0);
}

void campaign_why_free(campaign_why_t *why) {
    why_free(why->why);
    why->why = NULL;
}
