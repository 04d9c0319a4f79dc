/* Waiting for ticks, files and signals; real-time priority, which needs rights. */
#include "hal_linux/linux_clock.h"
#include "hal_linux/linux_loop.h"

#include <errno.h>
#include <fcntl.h>
#include <sched.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "unity.h"

static linux_loop_t loop;
static int ends[2];

void setUp(void) {
    TEST_ASSERT_TRUE(linux_loop_open(&loop));
    TEST_ASSERT_EQUAL_INT(0, pipe(ends));
}

void tearDown(void) {
    linux_loop_close(&loop);
    (void)close(ends[0]);
    (void)close(ends[1]);
}

static uint64_t now_us(void) {
    struct timespec now;
    TEST_ASSERT_EQUAL_INT(0, clock_gettime(CLOCK_MONOTONIC, &now));
    return (uint64_t)now.tv_sec * 1000000 + (uint64_t)now.tv_nsec / 1000;
}

static void pause_ms(long ms) {
    const struct timespec time = {.tv_nsec = ms * 1000000};
    TEST_ASSERT_EQUAL_INT(0, nanosleep(&time, NULL));
}

enum { ROW = 10, ROWS_MAX = 2000 };

/* Duration of a series of ticks. */
static uint64_t row_us(void) {
    TEST_ASSERT_EQUAL_HEX32(LINUX_LOOP_TICK, linux_loop_wait(&loop));
    const uint64_t begin_us = now_us();
    for (unsigned ticks = 0; ticks < ROW;) {
        ticks += ((linux_loop_wait(&loop) & LINUX_LOOP_TICK) != 0) ? 1 : 0;
    }
    return now_us() - begin_us;
}

/* A busy computer makes a series longer. A late first tick makes it shorter, by less than a tick. */
void test_a_tick_every_millisecond(void) {
    uint64_t shortest_us = UINT64_MAX;
    uint64_t sum_us = 0;
    unsigned rows = 0;
    while (rows < ROWS_MAX && (rows < 10 || shortest_us > ROW * 1200)) {
        const uint64_t took_us = row_us();
        shortest_us = took_us < shortest_us ? took_us : shortest_us;
        sum_us += took_us;
        rows++;
    }
    TEST_ASSERT_TRUE(shortest_us <= ROW * 1200);
    TEST_ASSERT_TRUE(sum_us >= (uint64_t)rows * (ROW - 1) * 1000);
}

void test_a_late_program_gets_one_tick_and_not_a_burst(void) {
    unsigned most = 0;
    for (unsigned i = 0; i < 5; i++) {
        pause_ms(50);
        const uint64_t begin_us = now_us();
        TEST_ASSERT_EQUAL_HEX32(LINUX_LOOP_TICK, linux_loop_wait(&loop));
        TEST_ASSERT_EQUAL_HEX32(LINUX_LOOP_TICK, linux_loop_wait(&loop));
        TEST_ASSERT_EQUAL_HEX32(LINUX_LOOP_TICK, linux_loop_wait(&loop));
        const unsigned took_us = (unsigned)(now_us() - begin_us);
        most = (took_us > most) ? took_us : most;
        TEST_ASSERT_TRUE(took_us >= 1000); /* one that was due, up to one soon, and a whole millisecond */
    }
    TEST_ASSERT_TRUE(most < 1000000);
}

/* Shows: TIM-4 */
void test_the_timer_goes_on_while_the_computer_sleeps(void) {
    char path[64];
    char line[256] = "";
    int clock = -1;
    (void)snprintf(path, sizeof path, "/proc/self/fdinfo/%d", loop.timer);
    FILE *info = fopen(path, "r");
    TEST_ASSERT_NOT_NULL(info);
    while (fgets(line, sizeof line, info) != NULL) {
        (void)sscanf(line, "clockid: %d", &clock);
    }
    (void)fclose(info);
    TEST_ASSERT_EQUAL_INT(CLOCK_BOOTTIME, clock);
}

void test_a_file_is_reported_as_long_as_it_is_ready(void) {
    TEST_ASSERT_TRUE(linux_loop_add(&loop, ends[0]));
    TEST_ASSERT_EQUAL_HEX32(LINUX_LOOP_TICK, linux_loop_wait(&loop));
    TEST_ASSERT_EQUAL_INT(1, write(ends[1], "x", 1));
    TEST_ASSERT_BITS_HIGH(LINUX_LOOP_FILE, linux_loop_wait(&loop));
    TEST_ASSERT_BITS_HIGH(LINUX_LOOP_FILE, linux_loop_wait(&loop));
    char byte = 0;
    TEST_ASSERT_EQUAL_INT(1, read(ends[0], &byte, 1));
    TEST_ASSERT_EQUAL_HEX32(LINUX_LOOP_TICK, linux_loop_wait(&loop));
    TEST_ASSERT_EQUAL_INT(1, write(ends[1], "x", 1));
    linux_loop_remove(&loop, ends[0]);
    TEST_ASSERT_EQUAL_HEX32(LINUX_LOOP_TICK, linux_loop_wait(&loop));
    linux_loop_remove(&loop, ends[0]);
}

void test_files_that_cannot_be_watched(void) {
    const int regular = open("/proc/self/exe", O_RDONLY);
    TEST_ASSERT_TRUE(regular >= 0);
    TEST_ASSERT_FALSE(linux_loop_add(&loop, regular));
    TEST_ASSERT_EQUAL_INT(EPERM, errno);
    (void)close(regular);
    TEST_ASSERT_FALSE(linux_loop_add(&loop, -1));
    TEST_ASSERT_EQUAL_INT(EBADF, errno);
}

/* The earliest time within a millisecond of the clock at which a tick was reported; later ones are delays of the
 * computer. */
static uint64_t earliest_phase_us(const linux_clock_t *clock) {
    uint64_t earliest_us = UINT64_MAX;
    for (unsigned i = 0; i < 100; i++) {
        (void)linux_loop_wait(&loop);
        const uint64_t phase_us = linux_clock_now_us(clock) % 1000;
        earliest_us = (phase_us < earliest_us) ? phase_us : earliest_us;
    }
    return earliest_us;
}

void test_ticks_fall_just_after_whole_milliseconds_of_a_clock(void) {
    linux_clock_t clock;
    linux_clock_start(&clock);
    for (unsigned i = 0; i < 4; i++) {
        clock.start_ns -= 250000; /* another clock each time, a quarter of a millisecond apart */
        TEST_ASSERT_TRUE(linux_loop_align(&loop, linux_clock_now_us(&clock)));
        (void)linux_loop_wait(&loop); /* may have been due before */
        TEST_ASSERT_TRUE(earliest_phase_us(&clock) < 240);
    }
}

void test_a_closed_loop_cannot_be_aligned(void) {
    linux_loop_t closed = {.epoll = -1, .timer = -1, .signals = -1};
    TEST_ASSERT_FALSE(linux_loop_align(&closed, 0));
    TEST_ASSERT_EQUAL_INT(EBADF, errno);
}

/* The signal must be reported within some ticks. */
static void expect_signal(void) {
    uint32_t what = 0;
    for (unsigned i = 0; (what & LINUX_LOOP_SIGNAL) == 0 && i < 100; i++) {
        what |= linux_loop_wait(&loop);
    }
    TEST_ASSERT_BITS_HIGH(LINUX_LOOP_SIGNAL, what);
}

void test_signals_are_reported_and_do_not_end_the_program(void) {
    const int signals[] = {SIGINT, SIGTERM, SIGHUP};
    for (unsigned i = 0; i < 3; i++) {
        TEST_ASSERT_EQUAL_INT(0, kill(getpid(), signals[i]));
        expect_signal();
        TEST_ASSERT_EQUAL_HEX32(LINUX_LOOP_TICK, linux_loop_wait(&loop));
    }
    linux_loop_close(&loop);
    TEST_ASSERT_EQUAL_INT(0, kill(getpid(), SIGTERM)); /* still blocked, and reported by the next loop */
    TEST_ASSERT_TRUE(linux_loop_open(&loop));
    expect_signal();
}

void test_a_loop_that_cannot_wait_ends_the_program(void) {
    linux_loop_close(&loop);
    TEST_ASSERT_EQUAL_HEX32(LINUX_LOOP_SIGNAL, linux_loop_wait(&loop));
}

void test_a_loop_needs_files(void) {
    const struct rlimit none = {.rlim_cur = 0, .rlim_max = RLIM_INFINITY};
    struct rlimit usual;
    TEST_ASSERT_EQUAL_INT(0, getrlimit(RLIMIT_NOFILE, &usual));
    const struct rlimit no_more = {.rlim_cur = none.rlim_cur, .rlim_max = usual.rlim_max};
    linux_loop_t other;
    TEST_ASSERT_EQUAL_INT(0, setrlimit(RLIMIT_NOFILE, &no_more));
    const bool is_open = linux_loop_open(&other);
    const int why = errno;
    TEST_ASSERT_EQUAL_INT(0, setrlimit(RLIMIT_NOFILE, &usual));
    TEST_ASSERT_FALSE(is_open);
    TEST_ASSERT_EQUAL_INT(EMFILE, why);
    TEST_ASSERT_EQUAL_INT(-1, other.epoll);
}

/* Run `child` in another process, so that this one is unchanged. @return its result */
static int in_child(int (*child)(void)) {
    const pid_t pid = fork();
    if (pid == 0) {
        _exit(child());
    }
    int status = 0;
    TEST_ASSERT_TRUE(pid > 0);
    TEST_ASSERT_EQUAL_INT(pid, waitpid(pid, &status, 0));
    TEST_ASSERT_TRUE(WIFEXITED(status));
    return WEXITSTATUS(status);
}

#define LOCK_REFUSED                                                                                                   \
    "memory cannot be locked: Operation not permitted; it needs CAP_IPC_LOCK or a higher memlock limit (ulimit -l)"
#define PRIORITY_REFUSED                                                                                               \
    "no real-time priority: Operation not permitted; it needs CAP_SYS_NICE or an rtprio limit (ulimit -r)"

static int ask_without_rights(void) {
    char error[LINUX_LOOP_ERROR_SIZE] = "";
    const struct rlimit none = {0};
    if (setrlimit(RLIMIT_MEMLOCK, &none) != 0 || setrlimit(RLIMIT_RTPRIO, &none) != 0 ||
        (geteuid() == 0 && setuid(65534) != 0)) {
        return 3;
    }
    if (linux_loop_realtime(error) || sched_getscheduler(0) != SCHED_OTHER) {
        return 2;
    }
    /* The address sanitizer makes mlockall() do nothing: then it is the priority that is refused. */
    return (strcmp(error, LOCK_REFUSED) == 0 || strcmp(error, PRIORITY_REFUSED) == 0) ? 0 : 1;
}

void test_real_time_is_refused_in_one_line_without_the_rights(void) {
    TEST_ASSERT_EQUAL_INT(0, in_child(ask_without_rights));
}

/* With the rights it is granted, otherwise it is refused and nothing changes. This depends on the user. */
static int ask_with_what_rights_there_are(void) {
    char error[LINUX_LOOP_ERROR_SIZE] = "";
    if (!linux_loop_realtime(error)) {
        return (error[0] != '\0' && sched_getscheduler(0) == SCHED_OTHER) ? 0 : 1;
    }
    struct sched_param now;
    if (sched_getscheduler(0) != SCHED_FIFO || sched_getparam(0, &now) != 0 || error[0] != '\0') {
        return 2;
    }
    return (now.sched_priority == 50) ? 0 : 3;
}

void test_real_time_is_granted_or_nothing_has_changed(void) {
    TEST_ASSERT_EQUAL_INT(0, in_child(ask_with_what_rights_there_are));
}
