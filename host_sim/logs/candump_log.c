#include "logs/candump_log.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <string.h>
#include <unistd.h>

#include "common/interrupt.h"
#include "common/report.h"
#include "logs/log_foreign.h"
#include "text/text.h"

#ifdef CANDUMP_NO_OPTIONS
#define CUT_OFF "; the log is cut off in this line"
#define GZIP_CUT_OFF ""
#else
#define CUT_OFF "; the log is cut off in this line; --skip-bad-lines skips it" /* as all commands with a log have it */
#define GZIP_CUT_OFF "; --skip-bad-lines reads up to there"
#endif

bool candump_open(candump_log_t *log, const char *path, bool skip_bad) {
    bool is_stdin = strcmp(path, "-") == 0;
    log->name = report_input_name(path);
    log->line = 0;
    log->skipped = 0;
    log->skip_bad = skip_bad;
    log->at_end = false;
    log->is_cut_off = false;
    log->is_checked = false;
    log->format = CANDUMP_FORMAT_UNKNOWN;
    log->frameless = 0;
    log->newest_us = UINT64_MAX;
    log->late_line = 0;
    log->screen = (candump_screen_t){0};
    log->asc = (vector_asc_t){0};
    gunzip_init(&log->gunzip);
    log->begin = 0;
    log->end = 0;
    log->fd = is_stdin ? STDIN_FILENO : open(path, O_RDONLY | O_CLOEXEC);
    return (log->fd >= 0) ? true : report("%s: %s", path, strerror(errno));
}

void candump_close(candump_log_t *log) {
    if (log->fd > STDIN_FILENO) {
        (void)close(log->fd);
    }
    log->fd = -1;
    gunzip_end(&log->gunzip);
}

const char *candump_format_name(candump_format_t format) {
    static const char *const names[] = {[CANDUMP_FORMAT_UNKNOWN] = "unknown",
                                        [CANDUMP_FORMAT_LOG] = "candump -l",
                                        [CANDUMP_FORMAT_SCREEN] = "candump -t",
                                        [CANDUMP_FORMAT_ASC] = "Vector ASC"};
    return names[format];
}

/** A bad line. @return true: it is skipped and counted. false: that is the end; was reported. */
static bool pass_over(candump_log_t *log, const char *wrong) {
    if (log->skip_bad) {
        log->skipped++;
        return true;
    }
    return report_at(log->name, (size_t)log->line, "%s%s", wrong, log->is_cut_off ? CUT_OFF : "");
}

/** Read from the file. @return number of bytes; 0: the end; -1: an error (reported) or an interruption. */
static ssize_t read_file(void *ctx, void *bytes, size_t size) {
    candump_log_t *log = ctx;
    for (;;) {
        log->is_interrupted = !interrupt_wait(log->fd, INTERRUPT_READ);
        if (log->is_interrupted) {
            return -1;
        }
        const ssize_t count = read(log->fd, bytes, size);
        log->is_interrupted = (count == 0) && interrupt_pending(); /* Ctrl-C ended what wrote the log, too */
        if (log->is_interrupted) {
            return -1;
        }
        if (count >= 0) {
            return count;
        }
        if ((errno != EINTR) && (errno != EAGAIN)) {
            (void)report("%s: %s", log->name, strerror(errno));
            return -1;
        }
    }
}

/** Read more behind what is there. @return false: an error (reported) or an interruption. */
static bool fill(candump_log_t *log) {
    if (log->begin > 0) {
        (void)memmove(log->buffer, &log->buffer[log->begin], log->end - log->begin);
        log->end -= log->begin;
        log->begin = 0;
    }
    const char *wrong = NULL;
    const ssize_t count =
        gunzip_read(&log->gunzip, read_file, log, &log->buffer[log->end], CANDUMP_BUFFER_SIZE - log->end, &wrong);
    if ((count < 0) && log->gunzip.is_cut_off && log->skip_bad) {
        note("%s: %s; read up to there", log->name, wrong);
    } else if (count < 0) {
        return (wrong != NULL) && report("%s: %s%s", log->name, wrong, log->gunzip.is_cut_off ? GZIP_CUT_OFF : "");
    }
    const size_t more = (count > 0) ? (size_t)count : 0;
    log->at_end = more == 0;
    log->end += more;
    log->frameless += more;
    const bool is_known = log->format != CANDUMP_FORMAT_UNKNOWN;
    const uint64_t most = is_known ? CANDUMP_FRAMELESS_MAX : CANDUMP_UNKNOWN_MAX;
    if (log->frameless > most) {
        return report("%s: contains no frame in %" PRIu64 " MiB; given up", log->name, most >> 20);
    }
    return true;
}

static bool report_foreign(const candump_log_t *log, const log_foreign_t *format) {
    text_t advice = {.used = 0};
    log_foreign_advice(&advice, format, (log->fd == STDIN_FILENO) ? "FILE" : log->name);
    return report("%s: %s", log->name, advice.bytes);
}

/** Whether there are bytes that no text has, before the end of the first line. */
static bool looks_binary(const candump_log_t *log) {
    const char *feed = memchr(log->buffer, '\n', log->end);
    const size_t size = (feed != NULL) ? (size_t)(feed - log->buffer) : log->end;
    return memchr(log->buffer, '\0', size) != NULL;
}

/** Look at the first bytes. @return false: they are not of a log; was reported. */
static bool check_beginning(candump_log_t *log) {
    while ((log->end < LOG_FOREIGN_BYTES) && !log->at_end) {
        if (!fill(log)) {
            return false;
        }
    }
    log->is_checked = true;
    const log_foreign_t *format = log_foreign_binary(log->buffer, log->end);
    if (format != NULL) {
        return report_foreign(log, format);
    }
    if (!log->skip_bad && looks_binary(log)) {
        return report_at(
            log->name, 1,
            "binary data: unknown log format; readable are candump -l, candump -t a, -t A or -t z, and Vector ASC");
    }
    static const char utf8_mark[] = "\xEF\xBB\xBF";
    const bool is_marked =
        (log->end >= sizeof utf8_mark - 1) && (memcmp(log->buffer, utf8_mark, sizeof utf8_mark - 1) == 0);
    log->begin = is_marked ? sizeof utf8_mark - 1 : 0;
    return true;
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
        if ((feed == NULL) && log->at_end && (too_long || (size > 0))) {
            feed = &log->buffer[log->end]; /* a last line without a line feed: the buffer has room for one */
            *feed = '\n';
            log->end++;
            log->is_cut_off = true;
        }
        if (feed != NULL) {
            *length = too_long ? (CANDUMP_LONG_LINE_MAX + 1) : (size_t)(feed - begin);
            log->begin += (size_t)(feed - begin) + 1;
            log->line++;
            return begin;
        }
        if (log->at_end) {
            return NULL;
        }
        if ((size > CANDUMP_LONG_LINE_MAX) && !log->skip_bad) {
            *length = size; /* its end does not matter: it may have none */
            log->line++;
            return begin;
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
    size_t i = 0;
    while ((i < length) && ((line[i] == ' ') || (line[i] == '\t') || (line[i] == '\r'))) {
        i++;
    }
    return i == length;
}

/** Tell the format by the first line that is not blank. @return false: one that is not read; was reported. */
static bool detect_format(candump_log_t *log, const char *line, size_t length) {
    const log_foreign_t *foreign = log_foreign_text(line, length);
    if ((foreign != NULL) && !log->skip_bad) {
        return report_foreign(log, foreign);
    }
    const bool has_stamp = memchr(line, '(', length) != NULL;
    if (vector_asc_begins(line, length)) {
        log->format = CANDUMP_FORMAT_ASC;
    } else if (has_stamp && (memchr(line, '[', length) != NULL)) {
        log->format = CANDUMP_FORMAT_SCREEN;
    } else if (has_stamp && (memchr(line, '#', length) != NULL)) {
        log->format = CANDUMP_FORMAT_LOG;
    }
    return true;
}

static const char *parse_line(candump_log_t *log, const char *line, size_t length, candump_record_t *record) {
    const bool is_long = (log->format == CANDUMP_FORMAT_ASC) || (log->format == CANDUMP_FORMAT_SCREEN);
    if (!is_long && (length > CANDUMP_LINE_MAX)) {
        return "the line is longer than 255 characters";
    }
    if (length > CANDUMP_LONG_LINE_MAX) {
        return "the line is longer than 16383 characters";
    }
    if ((log->format == CANDUMP_FORMAT_UNKNOWN) && (line[0] != '(')) {
        return "unknown log format; supported: candump -l, candump -t a, -t A or -t z, and Vector ASC, also compressed "
               "with gzip";
    }
    switch (log->format) {
    case CANDUMP_FORMAT_SCREEN:
        return candump_screen_parse(&log->screen, line, length, record);
    case CANDUMP_FORMAT_ASC:
        return vector_asc_parse(&log->asc, line, length, record);
    default:
        return candump_parse(line, length, record);
    }
}

/**
 * Whether this is the last line of a log whose writer was stopped while it wrote the data: it has fewer than 8 bytes and no
 * line feed. As a frame of another length it could trip the supervisor.
 */
static bool may_lack_data(const candump_log_t *log, const hal_can_frame_t *frame) {
    return log->is_cut_off && (log->format == CANDUMP_FORMAT_LOG) && (frame->length < sizeof frame->data) &&
           ((frame->flags & (HAL_CAN_FD | HAL_CAN_REMOTE)) == 0);
}

/**
 * Whether a time stamp follows the one before. One that is too late is a bad line; when the next one agrees with it, the
 * clock was set, and no line after it can be skipped either.
 */
static const char *check_stamp(candump_log_t *log, uint64_t stamp_us) {
    const bool is_first = log->newest_us == UINT64_MAX;
    const bool is_newer = is_first || (stamp_us > log->newest_us);
    if (is_first || !is_newer || (stamp_us - log->newest_us <= CANDUMP_GAP_MAX_US)) {
        log->newest_us = is_newer ? stamp_us : log->newest_us;
        log->late_line = 0;
        return NULL;
    }
    const uint64_t apart_us = (stamp_us > log->late_us) ? stamp_us - log->late_us : log->late_us - stamp_us;
    if ((log->late_line != 0) && (apart_us <= CANDUMP_GAP_MAX_US)) {
        log->line = log->late_line;
        log->is_cut_off = false;
        log->skip_bad = false;
        return "the clock was set by more than 100 days: cut the log here";
    }
    log->late_us = stamp_us;
    log->late_line = log->line;
    return "the time stamp jumps by more than 100 days: if the clock was set, cut the log here";
}

static void leave_out(candump_log_t *log) {
    log->skipped++;
    note("%s:%" PRIu64 ": the last line may be cut off; it is left out", log->name, log->line);
}

/** Without its header the numbers and times of an ASC log may be others than they are taken for. */
static void remark_base(candump_log_t *log) {
    if ((log->format == CANDUMP_FORMAT_ASC) && !log->asc.has_base) {
        log->asc.has_base = true;
        note("%s:%" PRIu64 ": no line 'base hex|dec timestamps absolute|relative' before the first frame: read as "
             "hexadecimal with absolute time stamps",
             log->name, log->line);
    }
}

candump_result_t candump_next(candump_log_t *log, candump_record_t *record) {
    bool failed = !log->is_checked && !check_beginning(log);
    size_t length = 0;
    const char *line = failed ? NULL : cut_line(log, &length, &failed);
    for (; line != NULL; line = cut_line(log, &length, &failed)) {
        const bool is_blank_line = (length <= CANDUMP_LINE_MAX) && is_blank(line, length);
        const bool is_first = (log->format == CANDUMP_FORMAT_UNKNOWN) && (length <= CANDUMP_LONG_LINE_MAX);
        if (is_first && !is_blank_line && !detect_format(log, line, length)) {
            return CANDUMP_FAILED;
        }
        const char *wrong = parse_line(log, line, length, record);
        if ((wrong == NULL) && may_lack_data(log, &record->frame)) {
            leave_out(log);
            return CANDUMP_END;
        }
        wrong = (wrong == NULL) ? check_stamp(log, record->stamp_us) : wrong;
        if (wrong == NULL) {
            log->frameless = 0;
            remark_base(log);
            return CANDUMP_RECORD;
        }
        if ((wrong != LOG_NO_FRAME) && !is_blank_line && !pass_over(log, wrong)) {
            return CANDUMP_FAILED;
        }
    }
    return failed ? CANDUMP_FAILED : CANDUMP_END;
}
