/**
 * @file monitor_log.h
 * The log of transitions: the last MONITOR_LOG_ENTRIES of them, each with time, actor and words.
 */
#ifndef HOST_SIM_MONITOR_LOG_H
#define HOST_SIM_MONITOR_LOG_H

#include <stddef.h>
#include <stdint.h>

#define MONITOR_LOG_ENTRIES 1000u
#define MONITOR_WHO_SIZE 16u
#define MONITOR_TEXT_SIZE 160u

/** How much an entry matters. */
typedef enum { MONITOR_QUIET, MONITOR_GOOD, MONITOR_WARN, MONITOR_BAD } monitor_level_t;

/** A transition. */
typedef struct {
    uint64_t t_us;
    monitor_level_t level;
    char who[MONITOR_WHO_SIZE];
    char text[MONITOR_TEXT_SIZE];
} monitor_entry_t;

/** Called for each entry as it comes. */
typedef void monitor_entry_fn(void *ctx, const monitor_entry_t *entry);

/** All zero: empty. */
typedef struct {
    uint64_t added; /**< entries ever */
    monitor_entry_t ring[MONITOR_LOG_ENTRIES];
} monitor_log_t;

/** Add an entry; what is too long is cut. @return the entry */
const monitor_entry_t *monitor_log_add(monitor_log_t *log, uint64_t t_us, monitor_level_t level, const char *who,
                                       const char *text);

/** An entry from the end: 0 is the newest. @return NULL: there are not that many */
const monitor_entry_t *monitor_log_back(const monitor_log_t *log, size_t back);

/** How many can be read. */
size_t monitor_log_length(const monitor_log_t *log);

#endif
