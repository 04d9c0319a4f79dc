#include "live/live_output.h"

#include <errno.h>
#include <inttypes.h>
#include <poll.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "common/report.h"

/* A line is shorter; a pipe that takes something takes as much without waiting; how long the last lines may take. */
enum { LINE_MAX_SIZE = 4096, CHUNK = 4096, LAST_WAIT_MS = 1000 };

bool live_output_takes(int fd, int wait_ms) {
    struct pollfd file = {.fd = fd, .events = POLLOUT, .revents = 0};
    return poll(&file, 1, wait_ms) > 0;
}

bool live_output_open(live_output_t *output, const char *path) {
    struct stat existing;
    const bool exists = stat(path, &existing) == 0;
    const bool is_missing = !exists && (errno == ENOENT);

    output->lost_lines = 0;
    output->is_file = !output_is_stdout(path) && (exists ? S_ISREG(existing.st_mode) : is_missing);
    if (output->is_file) {
        return output_open_in_place(&output->lines, path);
    }
    if (!output_is_stdout(path) && exists && S_ISFIFO(existing.st_mode)) {
        return output_open_pipe(&output->lines, path);
    }
    return output_open(&output->lines, path);
}

bool live_output_begin(live_output_t *output) {
    return !output->lines.is_open || !output->is_file || output_empty(&output->lines);
}

bool live_output_has_room(live_output_t *output) {
    if (!output->lines.is_open) {
        return false;
    }
    const bool fits = output->lines.used <= OUTPUT_BUFFER_SIZE - LINE_MAX_SIZE;
    output->lost_lines += fits ? 0 : 1;
    return fits;
}

/** Write the buffer as far as the file takes it within @p wait_ms. @return false: not all of it */
static bool pass(output_t *lines, int wait_ms) {
    size_t done = 0;
    while ((done < lines->used) && (lines->error == 0) && live_output_takes(lines->fd, wait_ms)) {
        const size_t left = lines->used - done;
        const ssize_t count = write(lines->fd, &lines->buffer[done], (left < CHUNK) ? left : CHUNK);
        if (count >= 0) {
            done += (size_t)count;
        } else if ((errno != EINTR) && (errno != EAGAIN)) {
            lines->error = errno;
        } else {
            break;
        }
    }
    lines->used -= done;
    (void)memmove(lines->buffer, &lines->buffer[done], lines->used);
    return lines->used == 0;
}

void live_output_pass(live_output_t *output) {
    if (output->lines.is_open && (output->lines.used > 0)) {
        (void)pass(&output->lines, 0);
    }
}

bool live_output_end(live_output_t *output) {
    output_t *lines = &output->lines;
    if (!lines->is_open) {
        return true;
    }
    const bool all = pass(lines, LAST_WAIT_MS);
    if (!all && (lines->error == 0)) {
        lines->used = 0;
        lines->error = ETIMEDOUT;
    }
    if (output->lost_lines > 0) {
        note("%s: %" PRIu64 " lines were lost because they were not read fast enough", lines->name, output->lost_lines);
    }
    return output_commit(lines);
}
