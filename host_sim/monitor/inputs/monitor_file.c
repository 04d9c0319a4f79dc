#include "monitor/inputs/monitor_file.h"

#include <inttypes.h>
#include <string.h>

#include "common/report.h"
#include "text/units.h"

enum { RECORDS_AT_ONCE = 4000, BACK_MS = 10 /* less is the order of two interfaces, as for replay */ };

static void note_back(monitor_file_t *file) {
    const uint64_t newest_us = file->first_us + file->next_us;
    const uint64_t stamp_us = file->next.stamp_us;
    if ((file->first_us != UINT64_MAX) && (stamp_us < newest_us) && (newest_us - stamp_us > file->back_us)) {
        file->back_us = newest_us - stamp_us;
        file->back_line = file->log.line;
    }
}

static void read_next(monitor_file_t *file) {
    const uint64_t before_us = file->next_us;
    const candump_result_t result = candump_next(&file->log, &file->next);
    file->has_next = result == CANDUMP_RECORD;
    file->failed = (result == CANDUMP_FAILED) && !file->log.is_interrupted;
    file->is_read = result == CANDUMP_END;
    if (file->has_next) {
        note_back(file);
        const uint64_t stamp_us = file->next.stamp_us;
        const uint64_t t_us = (stamp_us > file->first_us) ? stamp_us - file->first_us : 0;
        file->next_us = (t_us > before_us) ? t_us : before_us;
    }
}

bool monitor_file_open(monitor_file_t *file, const char *path, const char *ai_interface, bool skip_bad) {
    file->ai_interface = ai_interface;
    file->first_us = UINT64_MAX;
    file->next_us = 0;
    file->ai_was_heard = false;
    file->back_us = 0;
    if (!candump_open(&file->log, path, skip_bad)) {
        return false;
    }
    read_next(file);
    file->first_us = file->next.stamp_us;
    if (!file->has_next) {
        return file->failed ? false : report("%s: contains no frame", file->log.name);
    }
    if (!candump_is_from(&file->next, file->ai_interface)) {
        memcpy(file->interface, file->next.interface, file->next.interface_length);
        file->interface[file->next.interface_length] = '\0';
    }
    return true;
}

bool monitor_file_pass(monitor_file_t *file, monitor_t *monitor, uint64_t until_us) {
    int passed = 0;
    while (file->has_next && (file->next_us <= until_us) && (passed < RECORDS_AT_ONCE)) {
        const bool is_ai = candump_is_from(&file->next, file->ai_interface);
        const hal_can_side_t side = is_ai ? HAL_CAN_AI : HAL_CAN_VEHICLE;
        file->ai_was_heard = file->ai_was_heard || is_ai;
        monitor_frame(monitor, side, &file->next.frame, file->next_us);
        read_next(file);
        passed++;
    }
    if (file->has_next && (file->next_us > until_us)) {
        monitor_time(monitor, until_us);
    }
    return file->has_next;
}

void monitor_file_remark(const monitor_file_t *file) {
    if (file->back_us >= (uint64_t)BACK_MS * US_PER_MS) {
        note("%s:%" PRIu64 ": the time stamps go back by %" PRIu64 ".%03" PRIu64
             " s; the times are wrong there: cut or sort the log",
             file->log.name, file->back_line, file->back_us / US_PER_S, file->back_us % US_PER_S / US_PER_MS);
    }
    if (file->log.skipped > 0) {
        note("%s: lines skipped: %" PRIu64, file->log.name, file->log.skipped);
    }
}

void monitor_file_close(monitor_file_t *file) {
    candump_close(&file->log);
}
