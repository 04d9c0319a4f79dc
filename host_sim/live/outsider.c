#include "live/outsider.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "common/interrupt.h"
#include "common/report.h"
#include "hal_linux/linux_can.h"
#include "io/event_line.h"

enum {
    LINE_SIZE = 1024,
    FRAMES_MAX = 8192,
    LOOK_EVERY_MS = 100,
    LOOKS_MAX = 3000, /* five minutes for its start; fewer when it prints without end, and no event */
    READS_AT_ONCE = 64,
    RECEIVE_SIZE = 4 * 1024 * 1024,
    NO_COMMAND = 127
};

/** A frame on a bus. */
typedef struct {
    hal_can_side_t side;
    hal_can_frame_t frame;
    uint64_t at_us;
} heard_t;

/** Frames in the order of their time. */
typedef struct {
    heard_t items[FRAMES_MAX];
    size_t count;
} frames_t;

struct outsider {
    outsider_config_t config;
    pid_t pid;  /**< leads a group of its own; 0: it does not run */
    int output; /**< what it prints; -1: none */
    char line[LINE_SIZE];
    size_t line_length;
    bool has_told;
    bool output_closed;
    linux_can_t ears[HAL_CAN_SIDES];
    frames_t heard;   /**< up to the last outsider_listen(): who sent it is known by the next one */
    frames_t vehicle; /**< of these the vehicle's that are not found in `heard` yet */
};

static bool add(frames_t *frames, hal_can_side_t side, const hal_can_frame_t *frame, uint64_t at_us) {
    if (frames->count == (size_t)FRAMES_MAX) {
        return false;
    }
    frames->items[frames->count] = (heard_t){.side = side, .frame = *frame, .at_us = at_us};
    frames->count++;
    return true;
}

static void drop(frames_t *frames, size_t index) {
    frames->count--;
    memmove(&frames->items[index], &frames->items[index + 1u], (frames->count - index) * sizeof frames->items[0]);
}

static bool is_same(const heard_t *a, const heard_t *b) {
    return (a->side == b->side) && (a->frame.id == b->frame.id) && (a->frame.flags == b->frame.flags) &&
           (a->frame.length == b->frame.length) && (memcmp(a->frame.data, b->frame.data, sizeof a->frame.data) == 0);
}

/** Whether a frame is one of the vehicle's, which then is found. */
static bool is_of_vehicle(outsider_t *outsider, const heard_t *heard) {
    for (size_t i = 0u; i < outsider->vehicle.count; i++) {
        if (is_same(&outsider->vehicle.items[i], heard)) {
            drop(&outsider->vehicle, i);
            return true;
        }
    }
    return false;
}

static void tell_frames(outsider_t *outsider) {
    for (size_t i = 0u; i < outsider->heard.count; i++) {
        const heard_t *heard = &outsider->heard.items[i];
        if (!is_of_vehicle(outsider, heard)) {
            outsider->config.on_sent(outsider->config.ctx, heard->side, &heard->frame, heard->at_us);
        }
    }
    outsider->heard.count = 0u;
}

/** @return false: more frames than there is room for, and a lost one could be the one that must not be; reported */
static bool hear(outsider_t *outsider, hal_can_side_t side) {
    linux_can_record_t record;
    while ((outsider->ears[side].fd >= 0) && (linux_can_read(&outsider->ears[side], &record) == LINUX_CAN_RECORD)) {
        const uint64_t at_us = linux_clock_of_stamp(outsider->config.clock, record.stamp_us);
        if (!add(&outsider->heard, side, &record.frame, at_us)) {
            return report("more than %d frames at once from '%s'", (int)FRAMES_MAX, outsider->config.command);
        }
    }
    return true;
}

static void tell_line(outsider_t *outsider, size_t length) {
    session_event_t event;
    if (!event_line_read(outsider->line, length, &event)) {
        return;
    }
    outsider->has_told = true;
    if (!event.is_led && (event.recorded.kind == (uint8_t)AGV_EVENT_OUTPUT)) {
        outsider->output_closed = event.recorded.a != 0u;
    }
    outsider->config.on_event(outsider->config.ctx, &event);
}

static void tell_lines(outsider_t *outsider) {
    for (char *end = memchr(outsider->line, '\n', outsider->line_length); end != NULL;
         end = memchr(outsider->line, '\n', outsider->line_length)) {
        const size_t length = (size_t)(end - outsider->line);
        tell_line(outsider, length);
        outsider->line_length -= length + 1u;
        memmove(outsider->line, end + 1, outsider->line_length);
    }
    if (outsider->line_length == sizeof outsider->line) {
        outsider->line_length = 0u; /* no event is that long */
    }
}

/** Read what it has printed; of much only some, as other things wait, too. @return false: it has ended; reported */
static bool read_output(outsider_t *outsider) {
    ssize_t got = 1;
    for (unsigned i = 0u; (i < READS_AT_ONCE) && (got > 0); i++) {
        got = read(outsider->output, &outsider->line[outsider->line_length],
                   sizeof outsider->line - outsider->line_length);
        if (got > 0) {
            outsider->line_length += (size_t)got;
            tell_lines(outsider);
        }
    }
    return (got > 0) || ((got < 0) && (errno == EAGAIN)) || report("'%s' has ended", outsider->config.command);
}

outsider_t *outsider_open(const outsider_config_t *config) {
    const linux_can_options_t options = {.receive_size = RECEIVE_SIZE};
    char error[LINUX_CAN_ERROR_SIZE];
    outsider_t *outsider = calloc(1u, sizeof *outsider);
    if (outsider == NULL) {
        (void)report("out of memory");
        return NULL;
    }
    outsider->config = *config;
    outsider->output = -1;
    for (int side = 0; side < (int)HAL_CAN_SIDES; side++) {
        outsider->ears[side].fd = -1;
    }
    for (int side = 0; side < (int)HAL_CAN_SIDES; side++) {
        const char *interface = config->interfaces[side];
        if ((interface != NULL) && !linux_can_open(&outsider->ears[side], interface, &options, error)) {
            (void)report("%s", error);
            outsider_close(outsider);
            return NULL;
        }
    }
    return outsider;
}

/** In the new process. */
static _Noreturn void become(const char *command, int output) {
    sigset_t none;
    (void)sigemptyset(&none);
    (void)sigprocmask(SIG_SETMASK, &none, NULL);
    (void)setpgid(0, 0);
    const int nothing = open("/dev/null", O_RDONLY);
    if ((nothing >= 0) && (dup2(output, STDOUT_FILENO) >= 0) && (dup2(nothing, STDIN_FILENO) >= 0)) {
        (void)execl("/bin/sh", "sh", "-c", command, (char *)NULL);
    }
    _exit(NO_COMMAND);
}

/** Kill it, if it runs. */
static void stop(outsider_t *outsider) {
    if (outsider->pid > 0) {
        (void)kill(-outsider->pid, SIGKILL);
        (void)waitpid(outsider->pid, NULL, 0);
        outsider->pid = 0;
    }
    if (outsider->output >= 0) {
        (void)close(outsider->output);
        outsider->output = -1;
    }
    outsider->output_closed = false;
}

bool outsider_start(outsider_t *outsider) {
    int ends[2];
    if (pipe(ends) != 0) {
        return report("cannot create a pipe: %s", strerror(errno));
    }
    (void)fcntl(ends[0], F_SETFD, FD_CLOEXEC);
    (void)fcntl(ends[1], F_SETFD, FD_CLOEXEC);
    outsider->pid = fork();
    if (outsider->pid == 0) {
        become(outsider->config.command, ends[1]);
    }
    (void)close(ends[1]);
    outsider->output = ends[0];
    if (outsider->pid < 0) {
        outsider->pid = 0;
        stop(outsider);
        return report("cannot start a process: %s", strerror(errno));
    }
    (void)setpgid(outsider->pid, outsider->pid);
    outsider->line_length = 0u;
    outsider->has_told = false;
    outsider->output_closed = false;
    return (fcntl(outsider->output, F_SETFL, O_NONBLOCK) == 0) || report("cannot read its output: %s", strerror(errno));
}

bool outsider_wait(outsider_t *outsider) {
    struct pollfd file = {.fd = outsider->output, .events = POLLIN};
    for (unsigned look = 0u; (look < LOOKS_MAX) && !outsider->has_told; look++) {
        if (interrupt_pending()) {
            return report("interrupted");
        }
        if ((poll(&file, 1u, LOOK_EVERY_MS) > 0) && !read_output(outsider)) {
            return false;
        }
    }
    return outsider->has_told || report("'%s' prints no events", outsider->config.command);
}

void outsider_vehicle_sent(outsider_t *outsider, hal_can_side_t side, const hal_can_frame_t *frame) {
    if (!add(&outsider->vehicle, side, frame, 0u)) {
        drop(&outsider->vehicle, 0u); /* of something that was not heard */
        (void)add(&outsider->vehicle, side, frame, 0u);
    }
}

bool outsider_listen(outsider_t *outsider) {
    tell_frames(outsider);
    return hear(outsider, HAL_CAN_VEHICLE) && hear(outsider, HAL_CAN_AI) && read_output(outsider);
}

bool outsider_output_closed(const outsider_t *outsider) {
    return outsider->output_closed;
}

void outsider_close(outsider_t *outsider) {
    if (outsider != NULL) {
        stop(outsider);
        for (int side = 0; side < (int)HAL_CAN_SIDES; side++) {
            linux_can_close(&outsider->ears[side]);
        }
        free(outsider);
    }
}
