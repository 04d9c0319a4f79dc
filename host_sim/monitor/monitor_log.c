#include "monitor/monitor_log.h"

#include <stdio.h>

const monitor_entry_t *monitor_log_add(monitor_log_t *log, uint64_t t_us, monitor_level_t level, const char *who,
                                       const char *text) {
    monitor_entry_t *entry = &log->ring[log->added % MONITOR_LOG_ENTRIES];
    entry->t_us = t_us;
    entry->level = level;
    (void)snprintf(entry->who, sizeof entry->who, "%.*s", (int)MONITOR_WHO_SIZE - 1, who);
    (void)snprintf(entry->text, sizeof entry->text, "%.*s", (int)MONITOR_TEXT_SIZE - 1, text);
    log->added++;
    return entry;
}

size_t monitor_log_length(const monitor_log_t *log) {
    return (log->added < MONITOR_LOG_ENTRIES) ? (size_t)log->added : (size_t)MONITOR_LOG_ENTRIES;
}

const monitor_entry_t *monitor_log_back(const monitor_log_t *log, size_t back) {
    return (back < monitor_log_length(log)) ? &log->ring[(log->added - 1 - back) % MONITOR_LOG_ENTRIES] : NULL;
}
