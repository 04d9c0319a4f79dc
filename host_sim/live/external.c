#include "live/external.h"

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
    OUTPUT_LINE_SIZE = 1024,
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

struct external {
    external_config_t config;
    pid_t pid;  /**< leads a group of its own; 0: it does not run */
    int output; /**< what it prints; -1: none */
    char line[OUTPUT_LINE_SIZE];
    size_t line_length;
    bool has_reported;
    bool output_closed;
    linux_can_t rx_sockets[HAL_CAN_SIDES];
    frames_t heard;   /**< up to the last external_listen(); the next one knows the sender */
    frames_t vehicle; /**< frames of the vehicle that are not found in `heard` yet */
    frames_t sent;    /**< by the program, not reported yet */
};

static bool add(frames_t *frames, hal_can_side_t side, const hal_can_frame_t *frame, uint64_t at_us) {
    if (frames->count == FRAMES_MAX) {
        return false;
    }
    frames->items[frames->count] = (heard_t){.side = side, .frame = *frame, .at_us = at_us};
    frames->count++;
    return true;
}

static void drop(frames_t *frames, size_t index) {
    frames->count--;
    memmove(&frames->items[index], &frames->items[index + 1], (frames->count - index) * sizeof frames->items[0]);
}

static bool is_same(const heard_t *a, const heard_t *b) {
    return (a->side == b->side) && (a->frame.id == b->frame.id) && (a->frame.flags == b->frame.flags) &&
           (a->frame.length == b->frame.length) && (memcmp(a->frame.data, b->frame.data, sizeof a->frame.data) == 0);
}

/** Whether a frame is one of the vehicle's, which then is found. */
static bool is_of_vehicle(external_t *external, const heard_t *heard) {
    for (size_t i = 0; i < external->vehicle.count; i++) {
        if (is_same(&external->vehicle.items[i], heard)) {
            drop(&external->vehicle, i);
            return true;
        }
    }
    return false;
}

static bool too_many_frames(const external_t *external) {
    return report("more than %d frames at once from '%s'", (int)FRAMES_MAX, external->config.command);
}

/** Of what was heard, keep what it has sent. @return false: reported */
static bool sort_frames(external_t *external) {
    for (size_t i = 0; i < external->heard.count; i++) {
        const heard_t *heard = &external->heard.items[i];
        if (!is_of_vehicle(external, heard) && !add(&external->sent, heard->side, &heard->frame, heard->at_us)) {
            return too_many_frames(external);
        }
    }
    external->heard.count = 0;
    return true;
}

/** Report the frames up to this time. */
static void report_frames(external_t *external, uint64_t until_us) {
    frames_t *sent = &external->sent;
    size_t count = 0;
    while ((count < sent->count) && (sent->items[count].at_us <= until_us)) {
        const heard_t *frame = &sent->items[count];
        external->config.on_sent(external->config.ctx, frame->side, &frame->frame, frame->at_us);
        count++;
    }
    sent->count -= count;
    memmove(sent->items, &sent->items[count], sent->count * sizeof sent->items[0]);
}

/** @return false: reported */
static bool report_old_frames(external_t *external) {
    const uint64_t now_us = linux_clock_now_us(external->config.clock);
    const uint64_t delay_us = external->config.delay_us;
    if (!sort_frames(external)) {
        return false;
    }
    if (now_us >= delay_us) {
        report_frames(external, now_us - delay_us);
    }
    return true;
}

/** @return false: more frames than there is room for, and a lost one could be the one that must not be; reported */
static bool receive_frames(external_t *external, hal_can_side_t side) {
    linux_can_record_t record;
    while ((external->rx_sockets[side].fd >= 0) &&
           (linux_can_read(&external->rx_sockets[side], &record) == LINUX_CAN_RECORD)) {
        const uint64_t at_us = linux_clock_of_stamp(external->config.clock, record.stamp_us);
        if (!add(&external->heard, side, &record.frame, at_us)) {
            return too_many_frames(external);
        }
    }
    return true;
}

static void report_line(external_t *external, size_t length) {
    session_event_t event;
    if (!event_line_read(external->line, length, &event)) {
        return;
    }
    external->has_reported = true;
    if (!event.is_led && (event.recorded.kind == AGV_EVENT_OUTPUT)) {
        external->output_closed = event.recorded.a != 0;
    }
    external->config.on_event(external->config.ctx, &event);
}

static void report_lines(external_t *external) {
    for (char *end = memchr(external->line, '\n', external->line_length); end != NULL;
         end = memchr(external->line, '\n', external->line_length)) {
        const size_t length = (size_t)(end - external->line);
        report_line(external, length);
        external->line_length -= length + 1;
        memmove(external->line, end + 1, external->line_length);
    }
    if (external->line_length == sizeof external->line) {
        external->line_length = 0; /* no event is that long */
    }
}

/** Read some of its output. @return false: it has ended; reported */
static bool read_output(external_t *external) {
    ssize_t got = 1;
    for (unsigned i = 0; (i < READS_AT_ONCE) && (got > 0); i++) {
        got = read(external->output, &external->line[external->line_length],
                   sizeof external->line - external->line_length);
        if (got > 0) {
            external->line_length += (size_t)got;
            report_lines(external);
        }
    }
    return (got > 0) || ((got < 0) && (errno == EAGAIN)) || report("'%s' has ended", external->config.command);
}

external_t *external_open(const external_config_t *config) {
    const linux_can_options_t options = {.receive_size = RECEIVE_SIZE};
    char error[LINUX_CAN_ERROR_SIZE];
    external_t *external = calloc(1, sizeof *external);
    if (external == NULL) {
        (void)report("out of memory");
        return NULL;
    }
    external->config = *config;
    external->output = -1;
    for (int side = 0; side < HAL_CAN_SIDES; side++) {
        external->rx_sockets[side].fd = -1;
    }
    for (int side = 0; side < HAL_CAN_SIDES; side++) {
        const char *interface = config->interfaces[side];
        if ((interface != NULL) && !linux_can_open(&external->rx_sockets[side], interface, &options, error)) {
            (void)report("%s", error);
            external_close(external);
            return NULL;
        }
    }
    return external;
}

/** In the new process. */
static _Noreturn void execute(const char *command, int output) {
    sigset_t none;
    (void)sigemptyset(&none);
    (void)sigprocmask(SIG_SETMASK, &none, NULL);
    (void)signal(SIGPIPE, SIG_DFL); /* ignored ones stay ignored: main() */
    (void)signal(SIGXFSZ, SIG_DFL);
    (void)setpgid(0, 0);
    const int nothing = open("/dev/null", O_RDONLY);
    if ((nothing >= 0) && (dup2(output, STDOUT_FILENO) >= 0) && (dup2(nothing, STDIN_FILENO) >= 0)) {
        (void)execl("/bin/sh", "sh", "-c", command, (char *)NULL);
    }
    _exit(NO_COMMAND);
}

/** Kill it, if it runs. */
static void stop(external_t *external) {
    if (external->pid > 0) {
        (void)kill(-external->pid, SIGKILL);
        (void)waitpid(external->pid, NULL, 0);
        external->pid = 0;
    }
    if (external->output >= 0) {
        (void)close(external->output);
        external->output = -1;
    }
    external->output_closed = false;
}

bool external_start(external_t *external) {
    int ends[2];
    if (pipe(ends) != 0) {
        return report("cannot create a pipe: %s", strerror(errno));
    }
    (void)fcntl(ends[0], F_SETFD, FD_CLOEXEC);
    (void)fcntl(ends[1], F_SETFD, FD_CLOEXEC);
    external->pid = fork();
    if (external->pid == 0) {
        execute(external->config.command, ends[1]);
    }
    (void)close(ends[1]);
    external->output = ends[0];
    if (external->pid < 0) {
        external->pid = 0;
        stop(external);
        return report("cannot start a process: %s", strerror(errno));
    }
    (void)setpgid(external->pid, external->pid);
    external->line_length = 0;
    external->has_reported = false;
    external->output_closed = false;
    return (fcntl(external->output, F_SETFL, O_NONBLOCK) == 0) || report("cannot read its output: %s", strerror(errno));
}

bool external_wait(external_t *external) {
    struct pollfd file = {.fd = external->output, .events = POLLIN};
    for (unsigned look = 0; (look < LOOKS_MAX) && !external->has_reported; look++) {
        if (interrupt_pending()) {
            return report("interrupted");
        }
        if ((poll(&file, 1, LOOK_EVERY_MS) > 0) && !read_output(external)) {
            return false;
        }
    }
    return external->has_reported || report("'%s' prints no events", external->config.command);
}

void external_vehicle_sent(external_t *external, hal_can_side_t side, const hal_can_frame_t *frame) {
    if (!add(&external->vehicle, side, frame, 0)) {
        drop(&external->vehicle, 0); /* the oldest one was not received */
        (void)add(&external->vehicle, side, frame, 0);
    }
}

bool external_listen(external_t *external) {
    return report_old_frames(external) && receive_frames(external, HAL_CAN_VEHICLE) &&
           receive_frames(external, HAL_CAN_AI) && read_output(external);
}

void external_finish(external_t *external) {
    report_frames(external, UINT64_MAX);
}

bool external_output_closed(const external_t *external) {
    return external->output_closed;
}

void external_close(external_t *external) {
    if (external != NULL) {
        stop(external);
        for (int side = 0; side < HAL_CAN_SIDES; side++) {
            linux_can_close(&external->rx_sockets[side]);
        }
        free(external);
    }
}
