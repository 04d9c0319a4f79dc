#include "ui/summary.h"

#include <inttypes.h>
#include <stdint.h>
#include <stdio.h>

#include "agv/names.h"
#include "text/units.h"

void summary_print_time(const events_summary_t *summary, const char *name, const char *more) {
    (void)printf("%s%s: %" PRIu64 ".%03" PRIu64 " s\n", name, more, summary->t_ms / MS_PER_S, summary->t_ms % MS_PER_S);
}

void summary_print_frames(const events_summary_t *summary, bool shadow) {
    const agv_counters_t *counters = &summary->counters;
    uint64_t rejected = 0;
    for (size_t i = 0; i < AGV_REJECTED_KINDS; i++) {
        rejected += counters->rejected[i];
    }
    (void)printf("frames: %" PRIu32 " received, %" PRIu64 " of them rejected, %" PRIu32 " dropped; %" PRIu32 " sent",
                 counters->received, rejected, counters->dropped, counters->sent);
    if (shadow) {
        (void)printf(", %" PRIu32 " held back in shadow mode", counters->shadowed);
    }
    (void)printf("\n");
}

void summary_print_state(const events_summary_t *summary) {
    const char *state = agv_state_name(summary->final_state);
    const char *reason = agv_fault_name(summary->first_reason);
    (void)printf("final state: %s, first reason: %s\n", (state != NULL) ? state : "corrupt",
                 (reason != NULL) ? reason : "none");
}
