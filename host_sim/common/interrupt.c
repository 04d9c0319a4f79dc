#include "common/interrupt.h"

#include <poll.h>
#include <signal.h>
#include <stddef.h>

/* How long a signal may go unnoticed in a wait. */
enum { LOOK_EVERY_MS = 100 };

static const int held[] = {SIGINT, SIGTERM, SIGHUP, SIGQUIT};
static const size_t held_count = sizeof held / sizeof held[0];

static bool is_ignored(int signal) {
    struct sigaction action;
    return (sigaction(signal, NULL, &action) == 0) && (action.sa_handler == SIG_IGN);
}

static void make_set(sigset_t *set) {
    (void)sigemptyset(set);
    for (size_t i = 0; i < held_count; i++) {
        if ((held[i] != SIGHUP) || !is_ignored(SIGHUP)) { /* nohup */
            (void)sigaddset(set, held[i]);
        }
    }
}

void interrupt_hold(void) {
    sigset_t set;
    make_set(&set);
    (void)sigprocmask(SIG_BLOCK, &set, NULL);
}

void interrupt_release(void) {
    sigset_t set;
    make_set(&set);
    for (size_t i = 0; i < held_count; i++) {
        if (is_ignored(held[i]) && (sigismember(&set, held[i]) == 1)) {
            (void)signal(held[i], SIG_DFL); /* a pending one would be discarded, and half a run look like a whole one */
        }
    }
    (void)sigprocmask(SIG_UNBLOCK, &set, NULL);
}

bool interrupt_pending(void) {
    sigset_t pending;
    (void)sigemptyset(&pending);
    (void)sigpending(&pending);
    bool any = false;
    for (size_t i = 0; i < held_count; i++) {
        any = any || (sigismember(&pending, held[i]) == 1);
    }
    return any;
}

bool interrupt_wait(int fd, interrupt_for_t what) {
    struct pollfd wait = {.fd = fd, .events = (what == INTERRUPT_READ) ? POLLIN : POLLOUT, .revents = 0};
    while (!interrupt_pending()) {
        /* Ready, or an error that read() or write() will name. */
        if (poll(&wait, 1, LOOK_EVERY_MS) != 0) {
            return true;
        }
    }
    return false;
}
