#include "monitor/companion/monitor_companion.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include "common/report.h"
#include "monitor/companion/monitor_companion_internal.h"
#include "monitor/monitor_screen.h"

enum { NO_FILE = -1, TELL_EVERY_MS = 100, READING = 0, WRITING = 1 };

/** The three ways between program and companion. */
typedef struct {
    int control[2];
    int text[2];
    int typed[2];
} ways_t;

static void close_both(const int ends[2]) {
    for (int i = 0; i < 2; i++) {
        if (ends[i] != NO_FILE) {
            (void)close(ends[i]);
        }
    }
}

/** Nothing of it is passed on to programs that this one starts. */
static bool close_on_exec(const int ends[2]) {
    return (fcntl(ends[0], F_SETFD, FD_CLOEXEC) == 0) && (fcntl(ends[1], F_SETFD, FD_CLOEXEC) == 0);
}

static bool open_ways(ways_t *ways) {
    *ways = (ways_t){{NO_FILE, NO_FILE}, {NO_FILE, NO_FILE}, {NO_FILE, NO_FILE}};
    if ((socketpair(AF_UNIX, SOCK_SEQPACKET, 0, ways->control) == 0) && (pipe(ways->text) == 0) &&
        (pipe(ways->typed) == 0) && close_on_exec(ways->control) && close_on_exec(ways->text) &&
        close_on_exec(ways->typed)) {
        return true;
    }
    const int error = errno;
    close_both(ways->control);
    close_both(ways->text);
    close_both(ways->typed);
    return report("no screen: %s", strerror(error));
}

static void run_child(const monitor_companion_config_t *config, const ways_t *ways, pid_t parent) {
    const monitor_ends_t ends = {
        .control = ways->control[1], .text = ways->text[READING], .typed = ways->typed[WRITING], .parent = parent};
    (void)close(ways->control[0]);
    (void)close(ways->text[WRITING]);
    (void)close(ways->typed[READING]);
    exit(monitor_companion_main(config, &ends));
}

bool monitor_companion_fork(monitor_companion_t *companion, const monitor_companion_config_t *config) {
    const pid_t parent = getpid();
    ways_t ways;
    *companion = (monitor_companion_t){.child = 0};
    if (!monitor_screen_possible()) {
        return true;
    }
    if (!open_ways(&ways)) {
        return false;
    }
    (void)fflush(NULL); /* or both would write it */
    companion->child = fork();
    if (companion->child == 0) {
        run_child(config, &ways, parent);
    }
    companion->control = ways.control[0];
    companion->text = ways.text[WRITING];
    companion->typed = ways.typed[READING];
    (void)close(ways.control[1]);
    (void)close(ways.text[READING]);
    (void)close(ways.typed[WRITING]);
    if (companion->child < 0) {
        const int error = errno;
        companion->child = 0;
        (void)close(companion->control);
        (void)close(companion->text);
        (void)close(companion->typed);
        return report("no screen: %s", strerror(error));
    }
    return true;
}

static void tell(const monitor_companion_t *companion, const monitor_message_t *message) {
    (void)send(companion->control, message, sizeof *message, MSG_DONTWAIT | MSG_NOSIGNAL);
}

void monitor_companion_show(monitor_companion_t *companion) {
    if (companion->child == 0) {
        return;
    }
    const monitor_message_t message = {.kind = MONITOR_MESSAGE_SHOW};
    (void)fflush(stdout);
    companion->stdout_was = dup(STDOUT_FILENO);
    companion->stderr_was = dup(STDERR_FILENO);
    if ((companion->stdout_was < 0) || (companion->stderr_was < 0)) {
        return; /* too many files are open: it stays as without a screen */
    }
    companion->is_shown = true;
    tell(companion, &message);
    (void)dup2(companion->text, STDOUT_FILENO);
    if (isatty(companion->stderr_was) == 1) {
        (void)dup2(companion->text, STDERR_FILENO);
    }
}

void monitor_companion_event(monitor_companion_t *companion, const session_event_t *event) {
    if (companion->child != 0) {
        const monitor_message_t message = {.kind = MONITOR_MESSAGE_EVENT, .event = *event};
        tell(companion, &message);
    }
}

void monitor_companion_tell(monitor_companion_t *companion, const session_t *session, uint64_t now_ms) {
    if ((companion->child == 0) || (now_ms < companion->told_ms)) {
        return;
    }
    const agv_supervisor_t *supervisor = &session->supervisor;
    const monitor_message_t message = {
        .kind = MONITOR_MESSAGE_STATE,
        .state = {.state = agv_supervisor_state(supervisor),
                  .first_reason = agv_supervisor_first_reason(supervisor),
                  .output_closed = agv_supervisor_output_closed(supervisor),
                  .has_led = true,
                  .led_code = agv_supervisor_led_code(supervisor),
                  .faults = agv_supervisor_active_faults(supervisor)},
    };
    companion->told_ms = now_ms + TELL_EVERY_MS;
    tell(companion, &message);
}

int monitor_companion_typed(const monitor_companion_t *companion) {
    return (companion->child != 0) ? companion->typed : NO_FILE;
}

void monitor_companion_end(monitor_companion_t *companion) {
    if (companion->child == 0) {
        return;
    }
    if (companion->is_shown) {
        (void)fflush(stdout);
        (void)dup2(companion->stdout_was, STDOUT_FILENO);
        (void)dup2(companion->stderr_was, STDERR_FILENO);
        (void)close(companion->stdout_was);
        (void)close(companion->stderr_was);
    }
    (void)close(companion->control);
    (void)close(companion->text);
    while ((waitpid(companion->child, NULL, 0) < 0) && (errno == EINTR)) {
        /* once more */
    }
    (void)close(companion->typed);
    companion->child = 0;
}
