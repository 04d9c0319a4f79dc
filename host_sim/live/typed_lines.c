#include "live/typed_lines.h"

#include <errno.h>
#include <poll.h>
#include <string.h>
#include <unistd.h>

#include "common/report.h"

void typed_lines_init(typed_lines_t *typed, int fd) {
    *typed = (typed_lines_t){.fd = fd};
}

/** Whether read() would not wait. From a terminal whose foreground is another program nothing is read. */
static bool is_readable(int fd) {
    struct pollfd wait = {.fd = fd, .events = POLLIN, .revents = 0};

    if (poll(&wait, 1, 0) <= 0) {
        return false;
    }
    return (isatty(fd) == 0) || (tcgetpgrp(fd) == getpgrp());
}

static void read_more(typed_lines_t *typed) {
    const size_t room = sizeof typed->bytes - typed->used;

    if (typed->ended || (room == 0) || !is_readable(typed->fd)) {
        return;
    }
    const ssize_t got = read(typed->fd, &typed->bytes[typed->used], room);
    if (got > 0) {
        typed->used += (size_t)got;
    } else {
        typed->ended = (got == 0) || ((errno != EINTR) && (errno != EAGAIN));
    }
}

/** Take the first bytes as a line. @param taken how many bytes are used up, the line's end among them */
static const char *take_line(typed_lines_t *typed, size_t length, size_t taken) {
    const bool too_long = typed->too_long;

    memcpy(typed->line, typed->bytes, length);
    typed->line[(length > 0) && (typed->line[length - 1] == '\r') ? length - 1 : length] = '\0';
    memmove(typed->bytes, &typed->bytes[taken], typed->used - taken);
    typed->used -= taken;
    typed->too_long = false;
    if (too_long) {
        (void)report("a line of standard input is longer than %u characters", TYPED_LINE_MAX);
        return "";
    }
    return typed->line;
}

const char *typed_lines_next(typed_lines_t *typed) {
    const char *end = memchr(typed->bytes, '\n', typed->used);

    if (end == NULL) {
        read_more(typed);
        end = memchr(typed->bytes, '\n', typed->used);
    }
    if (end != NULL) {
        const size_t length = (size_t)(end - typed->bytes);
        return take_line(typed, length, length + 1);
    }
    if (typed->used == sizeof typed->bytes) {
        typed->too_long = true;
        typed->used = 0;
    }
    return (typed->ended && ((typed->used > 0) || typed->too_long)) ? take_line(typed, typed->used, typed->used) : NULL;
}
