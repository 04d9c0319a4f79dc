/**
 * @file monitor_page.h
 * What the screen of the monitor shows: header, supervisor, vehicle, alarms, table of messages, log, keys. From 80 x 24
 * on everything has its place; a wider screen shows more columns, a taller one more of the log.
 */
#ifndef HOST_SIM_MONITOR_PAGE_H
#define HOST_SIM_MONITOR_PAGE_H

#include <stdbool.h>
#include <stddef.h>

#include "monitor/monitor.h"
#include "monitor/monitor_view.h"

#define MONITOR_TYPED_SIZE 200u

/** What the user has chosen, and what the program does besides. */
typedef struct {
    const char *title;     /**< "monitor", "run", "vehicle" */
    const char *input;     /**< name of the log; NULL: the interfaces of the monitor */
    const char *recording; /**< name of the file that is being recorded; NULL: none */
    double speed;          /**< of a log; 0: as fast as possible */
    bool is_log;
    bool has_ended; /**< the log */
    bool is_paused;
    bool shows_help;
    bool can_type; /**< the program takes typed lines */
    bool is_typing;
    size_t scrolled; /**< entries of the log of transitions below the last one that is shown */
    char typed[MONITOR_TYPED_SIZE];
} monitor_page_t;

/** Lay the page out into a view, whose size was set by monitor_view_clear(). */
void monitor_page_draw(monitor_view_t *view, const monitor_t *monitor, const monitor_page_t *page);

/** How many entries of the log of transitions have room in a view of this height. */
int monitor_page_log_lines(const monitor_t *monitor, int height);

/** Draw the table of messages from a line on. @return the line after it */
int monitor_table_draw(monitor_view_t *view, int y, const monitor_t *monitor);

/** Draw the page of help from a line on. */
void monitor_help_draw(monitor_view_t *view, int y);

#endif
