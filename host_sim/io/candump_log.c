#include "io/candump_log.h"

#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <unistd.h>

#include "common/interrupt.h"
#include "common/report.h"

bool candump_open(candump_log_t *log, const char *path, bool skip_bad) {
    bool is_stdin = strcmp(path, "-") == 0;
    log->name = is_stdin ? "standard input" : path;
    log->line = 0u;
    log->skipped = 0u;
    log->skip_bad = skip_bad;
    log->interrupted = false;
    log->at_end = false;
    log->begin = 0u;
    log->end = 0u;
    log->fd = is_stdin ? STDIN_FILENO : open(path, O_RDONLY | O_CLOEXEC);
    return (log->fd >= 0) ? true : report("%s: %s", path, strerror(errno));
}

void candump_close(candump_log_t *log) {
    if (log->fd > STDIN_FILENO) {
        (void)close(log->fd);
    }
    log->fd = -1;
}

bool candump_reject(candump_log_t *log, const char *wrong) {
    if (log->skip_bad) {
        log->skipped++;
        return true;
    }
    return report_at(log->name, (size_t)log->line, "%s", wrong);
}

/** Read more behind what is there. @return false: an error (reported) or an interruption. */
static bool fill(candump_log_t *log) {
    if (log->begin > 0u) {
        (void)memmove(log->buffer, &log->buffer[log->begin], log->end - log->begin);
        log->end -= log->begin;
        log->begin = 0u;
    }
    for (;;) {
        if (!interrupt_wait(log->fd, INTERRUPT_READ)) {
            log->interrupted = true;
            return false;
        }
        ssize_t count = read(log->fd, &log->buffer[log->end], CANDUMP_BUFFER_SIZE - log->end);
        if (count >= 0) {
            log->end += (size_t)count;
            log->at_end = count == 0;
            return true;
        }
        if ((errno != EINTR) && (errno != EAGAIN)) {
            return report("%s: %s", log->name, strerror(errno));
        }
    }
}

/**
 * Cut the next line out of the buffer. The beginning of one that is too long for the buffer is dropped until its end is
 * found.
 * @return NULL: end of the log, or a failure.
 */
static char *cut_line(candump_log_t *log, size_t *length, bool *failed) {
    bool too_long = false;
    for (;;) {
        char *begin = &log->buffer[log->begin];
        size_t size = log->end - log->begin;
        char *feed = memchr(begin, '\n', size);
        if ((feed == NULL) && log->at_end && (too_long || (size > 0u))) {
            feed = &log->buffer[log->end]; /* a last line without a line feed: the buffer has room for one */
            *feed = '\n';
            log->end++;
        }
        if (feed != NULL) {
            *length = too_long ? (CANDUMP_LINE_MAX + 1u) : (size_t)(feed - begin);
            log->begin += (size_t)(feed - begin) + 1u;
            log->line++;
            return begin;
        }
        if (log->at_end) {
            return NULL;
        }
        if (size == CANDUMP_BUFFER_SIZE) {
            too_long = true;
            log->begin = log->end;
        }
        if (!fill(log)) {
            *failed = true;
            return NULL;
        }
    }
}

static bool is_blank(const char *line, size_t length) {
    size_t i = 0u;
    while ((i < length) && ((line[i] == ' ') || (line[i] == '\t') || (line[i] == '\r'))) {
        i++;
    }
    return i == length;
}

candump_result_t candump_next(candump_log_t *log, candump_record_t *record) {
    bool failed = false;
    size_t length = 0u;
    const char *line = cut_line(log, &length, &failed);
    for (; line != NULL; line = cut_line(log, &length, &failed)) {
        const char *wrong = NULL;
        if (length > CANDUMP_LINE_MAX) {
            wrong = "the line is longer than 255 characters";
        } else {
            wrong = candump_parse(line, length, record);
        }
        if (wrong == NULL) {
            return CANDUMP_RECORD;
        }
        if (((length > CANDUMP_LINE_MAX) || !is_blank(line, length)) && !candump_reject(log, wrong)) {
            return CANDUMP_FAILED;
        }
    }
    return failed ? CANDUMP_FAILED : CANDUMP_END;
}
