#include "live/live_status.h"

#include <inttypes.h>
#include <stdio.h>
#include <unistd.h>

#include "agv/names.h"
#include "live/live_output.h"
#include "text/units.h"
#include "ui/terminal.h"

enum { EVERY_MS = 200, TENTH_MS = 100, LINE_SIZE = 200 };

/** The fault of highest rank whose cause is there; NULL: none is. */
static const char *present_fault(const session_t *session) {
    return agv_fault_name(agv_supervisor_first_active(&session->supervisor));
}

static int format_status(char line[LINE_SIZE], const session_t *session, uint64_t now_ms) {
    const agv_supervisor_t *supervisor = &session->supervisor;
    const agv_counters_t *counters = agv_supervisor_counters(supervisor);
    const char *state = agv_state_name(agv_supervisor_state(supervisor));
    const char *reason = agv_fault_name(agv_supervisor_first_reason(supervisor));
    const char *fault = (reason != NULL) ? reason : present_fault(session);
    const int length =
        snprintf(line, LINE_SIZE,
                 "%" PRIu64 ".%" PRIu64 " s  %s%s%s  output %s  LED %d  received %" PRIu32 "  sent %" PRIu32
                 "  warnings %" PRIu32,
                 now_ms / MS_PER_S, (now_ms % MS_PER_S) / TENTH_MS, (state != NULL) ? state : "corrupt",
                 (fault != NULL) ? ": " : "", (fault != NULL) ? fault : "",
                 agv_supervisor_output_closed(supervisor) ? "closed" : "open", agv_supervisor_led_code(supervisor),
                 counters->received, counters->sent, counters->warnings);
    const int terminal = terminal_columns();
    const int width = (terminal < LINE_SIZE) ? terminal : LINE_SIZE - 1;
    return (length < width) ? length : width;
}

void live_status_show(live_status_t *status, const session_t *session, uint64_t now_ms) {
    char line[LINE_SIZE];
    if ((now_ms < status->next_ms) || !live_output_takes(STDOUT_FILENO, 0)) {
        return;
    }
    status->next_ms = now_ms + EVERY_MS;
    const int length = format_status(line, session, now_ms);
    const int rest = (status->shown > length) ? status->shown - length : 0;
    (void)printf("\r%.*s%*s", length, line, rest, "");
    (void)fflush(stdout);
    status->shown = length;
}

void live_status_end(live_status_t *status) {
    if (status->shown > 0) {
        (void)printf("\n");
        status->shown = 0;
    }
}
