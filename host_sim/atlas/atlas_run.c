#include "atlas/atlas_run.h"

#include <inttypes.h>
#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>

#include "agv/names.h"
#include "agv/state.h"
#include "atlas/atlas_judge.h"
#include "atlas/atlas_scenario.h"
#include "common/interrupt.h"
#include "io/output.h"
#include "io/output_json.h"
#include "ui/progress.h"

enum { LOOK_FOR_SIGNALS_EVERY = 16, SHOWN_MAX = 20 };

/** A half that was played: it is the same for all cases that contain it. */
typedef struct {
    bool known;
    atlas_outcome_t outcome;
} half_t;

typedef struct {
    const atlas_request_t *request;
    atlas_play_t play;
    half_t firsts[2][ATLAS_STATES][AGV_FAULT_COUNT]; /**< by topology, state and fault */
    half_t seconds[2][ATLAS_STATES][ATLAS_DISTANCES][AGV_FAULT_COUNT];
    output_t results;
    uint32_t cases;
    uint32_t weak;
    uint32_t known; /**< weaker for a known reason */
} atlas_t;

static bool takes_part(const atlas_request_t *request, uint32_t number, atlas_case_t *pair) {
    return atlas_case_get(number, pair) && ((request->first == NULL) || (request->first == pair->first)) &&
           ((request->second == NULL) || (request->second == pair->second));
}

/** A half of a pair; played when it is met first. @return NULL: reported */
static const atlas_outcome_t *half_of(atlas_t *atlas, const atlas_case_t *pair, bool second) {
    const agv_fault_t fault = (second ? pair->second : pair->first)->fault;
    half_t *half = second ? &atlas->seconds[pair->gateway][pair->state][pair->distance][fault]
                          : &atlas->firsts[pair->gateway][pair->state][fault];
    if (!half->known) {
        const atlas_case_t alone = atlas_case_half(pair, second);
        if (!atlas_play(&atlas->play, &alone)) {
            return NULL;
        }
        half->outcome = atlas->play.outcome;
        half->known = true;
    }
    return &half->outcome;
}

static json_t *time_json(int32_t time_us) {
    return (time_us == ATLAS_NEVER) ? json_null() : json_integer(time_us);
}

static json_t *outcome_json(const atlas_outcome_t *outcome) {
    return json_pack("{s:s?, s:s, s:o, s:o, s:o, s:s?}", "reason",
                     (outcome->reason < 0) ? NULL : agv_fault_name((agv_fault_t)outcome->reason), "state",
                     agv_state_name((agv_state_t)outcome->state), "safe_us", time_json(outcome->safe_us), "open_us",
                     time_json(outcome->open_us), "stop_us", time_json(outcome->stop_us), "hazard",
                     (outcome->hazard == HAZARD_NONE) ? NULL : hazard_info(outcome->hazard)->name);
}

static void write_head(atlas_t *atlas) {
    const atlas_request_t *request = atlas->request;
    output_json(&atlas->results,
                json_pack("{s:i, s:s, s:i, s:i, s:s?, s:s?}", "atlas", 1, "version", HOST_SIM_VERSION, "shard",
                          (int)request->shard, "shards", (int)request->shards, "first",
                          (request->first != NULL) ? agv_fault_name(request->first->fault) : NULL, "second",
                          (request->second != NULL) ? agv_fault_name(request->second->fault) : NULL),
                JSON_COMPACT);
}

static void write_case(atlas_t *atlas, uint32_t number, const atlas_case_t *pair, const atlas_outcome_t *halves[2],
                       atlas_weakness_t weakness) {
    output_json(&atlas->results,
                json_pack("{s:i, s:s, s:s, s:s, s:s, s:i, s:o, s:o, s:o, s:s?, s:s?}", "case", (int)number, "topology",
                          pair->gateway ? "gateway" : "shared", "in", atlas_state_name(pair->state), "first",
                          agv_fault_name(pair->first->fault), "second", agv_fault_name(pair->second->fault),
                          "distance_ms", (int)ATLAS_DISTANCE_MS[pair->distance], "both",
                          outcome_json(&atlas->play.outcome), "first_alone", outcome_json(halves[0]), "second_alone",
                          outcome_json(halves[1]), "weaker",
                          (weakness == ATLAS_SOUND) ? NULL : atlas_weakness_name(weakness), "known",
                          atlas_known_reason(pair, weakness)),
                JSON_COMPACT);
}

static void show_weak(atlas_t *atlas, uint32_t number, const atlas_case_t *pair, atlas_weakness_t weakness) {
    const char *reason = atlas_known_reason(pair, weakness);
    atlas->known += (reason != NULL) ? 1 : 0;
    atlas->weak += (reason != NULL) ? 0 : 1;
    if (atlas->weak + atlas->known <= SHOWN_MAX) {
        (void)fprintf(output_is_stdout(atlas->request->results) ? stderr : stdout,
                      "%s  case %" PRIu32 ": %s, %s, %s, after %" PRIu32 " ms %s%s%s\n", atlas_weakness_name(weakness),
                      number, pair->gateway ? "gateway" : "shared", atlas_state_name(pair->state),
                      agv_fault_name(pair->first->fault), ATLAS_DISTANCE_MS[pair->distance],
                      agv_fault_name(pair->second->fault), (reason != NULL) ? "; known: " : "",
                      (reason != NULL) ? reason : "");
    }
}

/** Play a case, after its halves. @return false: reported */
static bool run_one(atlas_t *atlas, uint32_t number, const atlas_case_t *pair) {
    const atlas_outcome_t *halves[2] = {half_of(atlas, pair, false), half_of(atlas, pair, true)};
    if ((halves[0] == NULL) || (halves[1] == NULL) || !atlas_play(&atlas->play, pair)) {
        return false;
    }
    const atlas_weakness_t weakness = atlas_judge(pair, &atlas->play.outcome, halves[0], halves[1]);
    atlas->cases++;
    if (weakness != ATLAS_SOUND) {
        show_weak(atlas, number, pair, weakness);
    }
    if (atlas->results.is_open) {
        write_case(atlas, number, pair, halves, weakness);
    }
    return true;
}

/** All cases of this shard. @return false: reported, or interrupted */
static bool run_all(atlas_t *atlas) {
    const atlas_request_t *request = atlas->request;
    const uint32_t count = atlas_case_count();
    uint32_t met = 0;
    progress_t progress;
    bool good = true;

    progress_begin(&progress, count);
    for (uint32_t number = 0; good && (number < count); number++) {
        atlas_case_t pair;
        if (!takes_part(request, number, &pair)) {
            continue;
        }
        met++;
        if ((met % request->shards) != (request->shard % request->shards)) {
            continue;
        }
        good = run_one(atlas, number, &pair) && (atlas->results.error == 0);
        progress_show(&progress, number, "cases");
        if (((atlas->cases % LOOK_FOR_SIGNALS_EVERY) == 0) && interrupt_pending()) {
            good = false;
        }
    }
    progress_end(&progress);
    return good;
}

static status_t run_shard(atlas_t *atlas) {
    const char *results = atlas->request->results;
    if ((results != NULL) && !output_open(&atlas->results, results)) {
        return STATUS_UNUSABLE;
    }
    if (atlas->results.is_open) {
        write_head(atlas);
    }
    if ((!run_all(atlas) && (atlas->results.error == 0)) || !output_commit(&atlas->results)) {
        return STATUS_UNUSABLE;
    }
    (void)fprintf(output_is_stdout(results) ? stderr : stdout,
                  "%" PRIu32 " cases, %" PRIu32 " weaker than their worse baseline, %" PRIu32
                  " more for a known reason\n",
                  atlas->cases, atlas->weak, atlas->known);
    return (atlas->weak == 0) ? STATUS_OK : STATUS_UNMET;
}

/** The options leave a case. @return false: reported */
static bool has_cases(const atlas_request_t *request) {
    for (uint32_t number = 0; number < atlas_case_count(); number++) {
        atlas_case_t pair;
        if (takes_part(request, number, &pair)) {
            return true;
        }
    }
    return report("--first %s --second %s: no case: in no state can the second of these faults follow the first",
                  agv_fault_name(request->first->fault), agv_fault_name(request->second->fault));
}

static status_t show_one(uint32_t number) {
    static text_t text;
    atlas_case_t pair;
    if (!atlas_case_get(number, &pair)) {
        uint32_t next = number + 1;
        while ((next < atlas_case_count()) && !atlas_case_get(next, &pair)) {
            next++;
        }
        (void)((next < atlas_case_count())
                   ? report("--show: case %" PRIu32 " cannot happen; the next one that can is %" PRIu32, number, next)
                   : report("--show: case %" PRIu32 " cannot happen, nor can any later one", number));
        return STATUS_UNUSABLE;
    }
    text_clear(&text);
    atlas_scenario_write(&text, &pair);
    (void)printf("%sexpect: {states: any, hazards: never}\n", text.bytes);
    return STATUS_OK;
}

status_t atlas_run(const atlas_request_t *request) {
    if (request->shows_one) {
        return show_one(request->one);
    }
    if (!has_cases(request)) {
        return STATUS_UNUSABLE;
    }
    atlas_t *atlas = calloc(1, sizeof *atlas);
    if (atlas == NULL) {
        (void)report("out of memory");
        return STATUS_UNUSABLE;
    }
    atlas->request = request;
    const status_t status = run_shard(atlas);
    output_discard(&atlas->results);
    free(atlas);
    interrupt_release();
    return status;
}
