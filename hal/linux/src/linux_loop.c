#include "hal_linux/linux_loop.h"

#include <errno.h>
#include <sched.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/epoll.h>
#include <sys/mman.h>
#include <sys/signalfd.h>
#include <sys/timerfd.h>
#include <unistd.h>

enum { TICK_NS = 1000000, TICK_US = 1000, NS_PER_US = 1000, EVENTS_AT_ONCE = 8 };

/* Delay of a tick after the whole millisecond, so that the time to read the clock and set the timer never makes it
 * early. */
enum { ALIGNED_AFTER_US = 20 };

static void close_file(int *fd) {
    if (*fd >= 0) {
        (void)close(*fd);
    }
    *fd = -1;
}

/* The clock of linux_clock.h, which goes on while the computer sleeps. */
static int open_timer(void) {
    const struct itimerspec every_tick = {.it_interval = {.tv_nsec = TICK_NS}, .it_value = {.tv_nsec = TICK_NS}};
    int timer = timerfd_create(CLOCK_BOOTTIME, TFD_NONBLOCK | TFD_CLOEXEC);
    if (timer >= 0 && timerfd_settime(timer, 0, &every_tick, NULL) != 0) {
        close_file(&timer);
    }
    return timer;
}

static int open_signals(void) {
    sigset_t ends;
    (void)sigemptyset(&ends);
    (void)sigaddset(&ends, SIGINT);
    (void)sigaddset(&ends, SIGTERM);
    (void)sigaddset(&ends, SIGHUP);
    return (sigprocmask(SIG_BLOCK, &ends, NULL) == 0) ? signalfd(-1, &ends, SFD_NONBLOCK | SFD_CLOEXEC) : -1;
}

bool linux_loop_open(linux_loop_t *loop) {
    *loop = (linux_loop_t){.epoll = epoll_create1(EPOLL_CLOEXEC), .timer = open_timer(), .signals = open_signals()};
    if (loop->epoll >= 0 && loop->timer >= 0 && loop->signals >= 0 && linux_loop_add(loop, loop->timer) &&
        linux_loop_add(loop, loop->signals)) {
        return true;
    }
    const int why = errno;
    linux_loop_close(loop);
    errno = why;
    return false;
}

bool linux_loop_align(linux_loop_t *loop, uint64_t now_us) {
    const uint64_t left_us = TICK_US - (now_us % TICK_US) + ALIGNED_AFTER_US;
    const struct itimerspec aligned = {.it_interval = {.tv_nsec = TICK_NS},
                                       .it_value = {.tv_nsec = (long)left_us * NS_PER_US}};
    return timerfd_settime(loop->timer, 0, &aligned, NULL) == 0;
}

bool linux_loop_add(linux_loop_t *loop, int fd) {
    struct epoll_event event = {.events = EPOLLIN, .data = {.fd = fd}};
    return epoll_ctl(loop->epoll, EPOLL_CTL_ADD, fd, &event) == 0;
}

void linux_loop_remove(linux_loop_t *loop, int fd) {
    (void)epoll_ctl(loop->epoll, EPOLL_CTL_DEL, fd, NULL); /* fails for a closed file, which epoll has removed */
}

/* One tick, however many milliseconds have passed. */
static uint32_t take_tick(const linux_loop_t *loop) {
    uint64_t passed = 0;
    return (read(loop->timer, &passed, sizeof passed) == (ssize_t)sizeof passed) ? LINUX_LOOP_TICK : 0;
}

static uint32_t take_signal(const linux_loop_t *loop) {
    struct signalfd_siginfo signal;
    return (read(loop->signals, &signal, sizeof signal) == (ssize_t)sizeof signal) ? LINUX_LOOP_SIGNAL : 0;
}

static uint32_t take_event(const linux_loop_t *loop, const struct epoll_event *event) {
    if (event->data.fd == loop->timer) {
        return take_tick(loop);
    }
    return (event->data.fd == loop->signals) ? take_signal(loop) : LINUX_LOOP_FILE;
}

uint32_t linux_loop_wait(linux_loop_t *loop) {
    uint32_t what = 0;
    while (what == 0) {
        struct epoll_event events[EVENTS_AT_ONCE];
        const int count = epoll_wait(loop->epoll, events, EVENTS_AT_ONCE, -1);
        if (count < 0 && errno != EINTR) {
            return LINUX_LOOP_SIGNAL; /* a program that cannot wait has to end */
        }
        for (int i = 0; i < count; i++) {
            what |= take_event(loop, &events[i]);
        }
    }
    return what;
}

void linux_loop_close(linux_loop_t *loop) {
    close_file(&loop->signals);
    close_file(&loop->timer);
    close_file(&loop->epoll);
}

static bool refuse(char *error, const char *what, const char *needed) {
    (void)snprintf(error, LINUX_LOOP_ERROR_SIZE, "%s: %s; it needs %s", what, strerror(errno), needed);
    return false;
}

bool linux_loop_realtime(char *error) {
    error[0] = '\0';
    if (mlockall(MCL_CURRENT | MCL_FUTURE) != 0) {
        return refuse(error, "memory cannot be locked", "CAP_IPC_LOCK or a higher memlock limit (ulimit -l)");
    }
    const struct sched_param middle = {
        .sched_priority = (sched_get_priority_min(SCHED_FIFO) + sched_get_priority_max(SCHED_FIFO)) / 2};
    if (sched_setscheduler(0, SCHED_FIFO, &middle) != 0) {
        (void)refuse(error, "no real-time priority", "CAP_SYS_NICE or an rtprio limit (ulimit -r)");
        (void)munlockall();
        return false;
    }
    return true;
}
