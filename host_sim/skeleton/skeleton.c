#include "skeleton/skeleton.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "agv/names.h"
#include "common/interrupt.h"
#include "io/output.h"
#include "skeleton/skeleton_plan.h"

/** All that is needed; on the heap. */
typedef struct {
    skeleton_facts_t facts;
    skeleton_plan_t plan;
    skeleton_seen_t seen;
    scenario_run_t run;
    text_t text;
    output_t output;
} work_t;

/** There is a trip that a simulated vehicle can show. @return false: reported */
static bool has_trip(const skeleton_facts_t *facts) {
    const char *log = facts->request->log;

    if ((facts->trips == 0) && (facts->states_us == 0)) {
        return report("%s: no fault to replay: nothing was supervised; host_sim replay says why", log);
    }
    if ((facts->trips == 0) || !facts->has_tripped) {
        return report("%s: no fault to replay: the supervisor did not trip", log);
    }
    if ((facts->before != AGV_STATE_STANDBY) && (facts->before != AGV_STATE_ACTIVE)) {
        return report("%s: tripped before it supervised: %s; a scenario of that needs 'self_test' or 'reset_cause'",
                      log, agv_fault_name(facts->trip.reason));
    }
    return true;
}

/** Play the plan without expectations. @return whether it trips as the log does */
static bool trips_alike(work_t *work) {
    skeleton_text(&work->text, &work->plan, NULL);
    return skeleton_play(&work->run, &work->text, &work->facts.request->config, &work->seen) &&
           work->seen.has_tripped && (work->seen.reason == (uint8_t)work->facts.trip.reason) &&
           (work->seen.trip_ms >= work->plan.cause_ms);
}

/** Find steps that bring the trip about. @return false: reported */
static bool find_cause(work_t *work) {
    work->plan.facts = &work->facts;
    skeleton_plan_times(&work->plan);
    if (skeleton_cause_by_evidence(&work->plan) && trips_alike(work)) {
        return true;
    }
    if (skeleton_cause_by_campaign(&work->plan) && trips_alike(work)) {
        return true;
    }
    return report("%s: the simulated vehicle does not show this trip: %s", work->facts.request->log,
                  agv_fault_name(work->facts.trip.reason));
}

/** Play the whole file: it must pass as it stands. @return false: reported */
static bool finish(work_t *work) {
    skeleton_seen_t again;

    work->plan.duration_ms = work->run.scenario.duration_ms;
    skeleton_text(&work->text, &work->plan, &work->seen);
    if (work->text.full) {
        return report("%s: the scenario would be too long", work->facts.request->log);
    }
    if (!skeleton_play(&work->run, &work->text, &work->facts.request->config, &again)) {
        return false;
    }
    return (work->run.check.failure_count == 0) || report("%s: the scenario does not pass as it was made: %s",
                                                          work->facts.request->log, work->run.check.failures[0]);
}

static status_t make(work_t *work, const skeleton_request_t *request) {
    if (!skeleton_facts_read(&work->facts, request)) {
        return STATUS_UNUSABLE;
    }
    if (!has_trip(&work->facts) || !find_cause(work) || !finish(work)) {
        return STATUS_UNMET;
    }
    if (!output_open(&work->output, (request->out != NULL) ? request->out : "-")) {
        return STATUS_UNUSABLE;
    }
    (void)output_write(&work->output, work->text.bytes, work->text.used);
    return output_commit(&work->output) ? STATUS_OK : STATUS_UNUSABLE;
}

/** What exists is never replaced, and a log that is read twice is no pipe. @return false: reported */
static bool check_files(const skeleton_request_t *request) {
    if (strcmp(request->log, "-") == 0) {
        return report("--from: give a file; standard input cannot be read twice");
    }
    struct stat found; /* one that is not there is for who reads it */
    if ((stat(request->log, &found) == 0) && !S_ISREG(found.st_mode)) {
        return report("--from: the log is read twice, and %s is not a regular file", request->log);
    }
    return (request->out == NULL) || output_is_stdout(request->out) || (access(request->out, F_OK) != 0) ||
           report("%s: exists already, and is not replaced", request->out);
}

status_t skeleton_make(const skeleton_request_t *request) {
    if (!check_files(request)) {
        return STATUS_UNUSABLE;
    }
    work_t *work = calloc(1, sizeof *work);
    if (work == NULL) {
        (void)report("out of memory");
        return STATUS_UNUSABLE;
    }
    const status_t status = make(work, request);
    output_discard(&work->output);
    free(work);
    interrupt_release();
    return status;
}
