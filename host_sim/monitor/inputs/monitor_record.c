#include "monitor/inputs/monitor_record.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdio.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "common/report.h"
#include "logs/candump_line.h"
#include "text/units.h"

enum { NO_FILE = -1, MODE = 0666 };

void monitor_record_init(monitor_record_t *record) {
    memset(record, 0, sizeof *record);
    record->fd = NO_FILE;
}

static void name_by_time(char name[MONITOR_RECORD_NAME_SIZE]) {
    struct tm parts = {0};
    const time_t now = time(NULL);
    (void)localtime_r(&now, &parts);
    (void)strftime(name, MONITOR_RECORD_NAME_SIZE, "monitor-%Y%m%d-%H%M%S.log", &parts);
}

bool monitor_record_begin(monitor_record_t *record, const char *path) {
    if (path == NULL) {
        name_by_time(record->name);
    } else if (snprintf(record->name, sizeof record->name, "%s", path) >= (int)sizeof record->name) {
        errno = ENAMETOOLONG;
        return false;
    }
    record->fd = open(record->name, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, MODE);
    record->error = 0;
    record->frames = 0;
    record->left_out = 0;
    record->used = 0;
    return record->fd != NO_FILE;
}

/** A frame that is no classic data frame. @return length of the line */
static size_t write_special(char *line, size_t size, const char *interface, uint64_t stamp_us,
                            const hal_can_frame_t *frame) {
    const bool is_error = (frame->flags & HAL_CAN_ERROR) != 0;
    char id[CANDUMP_ID_SIZE];
    int used = snprintf(line, size, "(%010" PRIu64 ".%06" PRIu64 ") %s %s#", stamp_us / US_PER_S, stamp_us % US_PER_S,
                        interface, candump_id_text(id, frame->id, frame->flags));
    if (!is_error) {
        used += snprintf(&line[used], size - (size_t)used, "R%u", (unsigned)frame->length);
    }
    for (unsigned i = 0; is_error && (i < frame->length) && (i < sizeof frame->data); i++) {
        used += snprintf(&line[used], size - (size_t)used, "%02X", (unsigned)frame->data[i]);
    }
    used += snprintf(&line[used], size - (size_t)used, "\n");
    return (size_t)used;
}

void monitor_record_add(monitor_record_t *record, const char *interface, uint64_t stamp_us,
                        const hal_can_frame_t *frame) {
    if (record->fd == NO_FILE) {
        return;
    }
    if ((frame->flags & HAL_CAN_FD) != 0) {
        record->left_out++;
        return;
    }
    if (record->used + CANDUMP_WRITE_MAX > sizeof record->buffer) {
        (void)monitor_record_flush(record);
    }
    const bool is_special = (frame->flags & (HAL_CAN_ERROR | HAL_CAN_REMOTE)) != 0;
    char *line = &record->buffer[record->used];
    record->used += is_special ? write_special(line, CANDUMP_WRITE_MAX, interface, stamp_us, frame)
                               : candump_write(line, stamp_us, interface, frame);
    record->frames++;
}

bool monitor_record_flush(monitor_record_t *record) {
    size_t done = 0;
    while ((record->fd != NO_FILE) && (record->error == 0) && (done < record->used)) {
        const ssize_t count = write(record->fd, &record->buffer[done], record->used - done);
        if (count > 0) {
            done += (size_t)count;
        } else if (errno != EINTR) {
            record->error = (errno != 0) ? errno : EIO;
        }
    }
    record->used = 0;
    return record->error == 0;
}

bool monitor_record_end(monitor_record_t *record) {
    bool good = monitor_record_flush(record);
    if (record->fd != NO_FILE) {
        if ((close(record->fd) != 0) && good) {
            record->error = errno;
            good = false;
        }
        record->fd = NO_FILE;
    }
    return good;
}

bool monitor_record_close(monitor_record_t *record) {
    const uint64_t left_out = record->left_out;
    record->left_out = 0;
    if (!monitor_record_end(record)) {
        const int error = record->error;
        record->error = 0;
        return report("%s: %s", record->name, strerror(error));
    }
    if (left_out > 0) {
        note("%s: %" PRIu64 " CAN FD frames are not in it", record->name, left_out);
    }
    return true;
}
