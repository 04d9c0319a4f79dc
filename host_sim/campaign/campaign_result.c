#include "campaign/campaign_result.h"

#include <jansson.h>
#include <stdlib.h>

#include "agv/names.h"
#include "common/report.h"
#include "io/output_json.h"

enum { FIRST_ROOM = 1024 };

bool campaign_samples_add(campaign_samples_t *samples, const campaign_sample_t *sample) {
    if (samples->count == samples->room) {
        const size_t room = (samples->room == 0) ? (size_t)FIRST_ROOM : samples->room * 2;
        campaign_sample_t *larger = realloc(samples->samples, room * sizeof *larger);
        if (larger == NULL) {
            return report("out of memory");
        }
        samples->samples = larger;
        samples->room = room;
    }
    samples->samples[samples->count] = *sample;
    samples->count++;
    return true;
}

void campaign_samples_free(campaign_samples_t *samples) {
    free(samples->samples);
    samples->samples = NULL;
}

static int32_t since_cause(const campaign_check_t *check, uint64_t t_us) {
    const bool none = (t_us == CAMPAIGN_NEVER) || (t_us < check->cause_us); /* it had opened by itself before */
    return none ? CAMPAIGN_NO_TIME : (int32_t)((int64_t)t_us - (int64_t)check->cause_us);
}

campaign_sample_t campaign_sample_of(const campaign_check_t *check) {
    return (campaign_sample_t){
        .row = (uint8_t)(check->plan->row - CAMPAIGN_ROWS),
        .broken = check->broken != CAMPAIGN_SOUND,
        .safe_us = since_cause(check, check->first_safe_us),
        .confirmed_us = since_cause(check, check->confirmed_us),
        .opened_us = since_cause(check, check->opened_us),
    };
}

static json_t *fault_or_null(int fault) {
    const char *name = ((fault >= 0) && (fault < AGV_FAULT_COUNT)) ? agv_fault_name((agv_fault_t)fault) : NULL;
    return (name != NULL) ? json_string(name) : json_null();
}

static json_t *time_or_null(int32_t us) {
    return (us != CAMPAIGN_NO_TIME) ? json_integer(us) : json_null();
}

void campaign_write_part(output_t *output, const campaign_part_t *part) {
    const campaign_row_t *only = part->causes.only;
    output_json(output,
                json_pack("{s:i, s:s, s:I, s:I, s:i, s:i, s:o, s:b, s:o}", "campaign", 1, "version", HOST_SIM_VERSION,
                          "runs", (json_int_t)part->runs, "seed", (json_int_t)part->seed, "shard", (int)part->shard,
                          "shards", (int)part->shards, "fault", fault_or_null((only != NULL) ? (int)only->fault : -1),
                          "newly_engaged", (int)part->causes.newly_engaged, "planted",
                          json_null() /* kept for results of older versions */),
                0);
}

void campaign_write_run(output_t *output, const campaign_check_t *check) {
    const campaign_plan_t *plan = check->plan;
    const campaign_sample_t sample = campaign_sample_of(check);
    json_t *object =
        json_pack("{s:I, s:o, s:s, s:s, s:I, s:b, s:s, s:s, s:b, s:i, s:i}", "run", (json_int_t)plan->run, "fault",
                  fault_or_null((int)plan->row->fault), "topology", plan->gateway ? "gateway" : "shared", "id_set",
                  plan->table_ids ? "table" : "heading", "bitrate", (json_int_t)plan->bitrate, "park_guard",
                  (int)plan->park_guard, "park", plan->at_standstill ? "at_standstill" : "at_once", "mode",
                  plan->engaged ? "autopilot" : "manual", "bunched", (int)plan->bunched, "tick_phase_us",
                  (int)plan->tick_phase_us, "cause_ms", (int)plan->cause_ms);
    (void)json_object_set_new(object, "bound_us", json_integer((json_int_t)plan->bound_us));
    (void)json_object_set_new(object, "safe_us", time_or_null(sample.safe_us));
    (void)json_object_set_new(object, "confirmed_us", time_or_null(sample.confirmed_us));
    (void)json_object_set_new(object, "opened_us", time_or_null(sample.opened_us));
    (void)json_object_set_new(object, "bus_off", json_boolean(check->bus_off));
    (void)json_object_set_new(object, "reason", fault_or_null(check->reason));
    (void)json_object_set_new(object, "broken",
                              sample.broken ? json_string(campaign_break_name(check->broken)) : json_null());
    output_json(output, object, 0);
}
