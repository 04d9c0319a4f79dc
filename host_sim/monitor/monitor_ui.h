/**
 * @file monitor_ui.h
 * The monitor on a terminal: draws the page a few times a second, and obeys the keys.
 */
#ifndef HOST_SIM_MONITOR_UI_H
#define HOST_SIM_MONITOR_UI_H

#include <stdbool.h>
#include <stdint.h>

#include "monitor/monitor.h"
#include "monitor/monitor_page.h"

/** What a key asks of the program around it. */
typedef struct {
    bool quits;
    bool toggles_recording;
    int faster;     /**< of a log: how many times twice as fast; negative: half as fast */
    bool has_typed; /**< page.typed is a whole line; clear it with monitor_ui_typed_done() */
} monitor_wish_t;

/** A monitor on a terminal. Some 300 KiB: on the heap. Members are to read; page.recording, .speed, .has_ended to set. */
typedef struct {
    monitor_t *monitor;
    monitor_t *held; /**< the monitor as it was when the picture was held; NULL: it is not */
    monitor_page_t page;
    monitor_wish_t wish;
    monitor_view_t view;
    uint64_t draw_ms; /**< when to draw next; 0: now */
    int log_lines;
} monitor_ui_t;

/** Open the screen. @return false: was reported */
bool monitor_ui_open(monitor_ui_t *ui, monitor_t *monitor, const monitor_page_t *page);

/** Take the keys that were pressed; `wish` says what they ask for. */
void monitor_ui_keys(monitor_ui_t *ui);

/** A key. Part of monitor_ui_keys(), and of use without a terminal. @param key a character or MONITOR_KEY_... */
void monitor_ui_key(monitor_ui_t *ui, int key);

/** Draw, if it is time to. */
void monitor_ui_draw(monitor_ui_t *ui, uint64_t now_ms);

/** The typed line was taken. */
void monitor_ui_typed_done(monitor_ui_t *ui);

/** Whether a log stands still. */
bool monitor_ui_is_paused(const monitor_ui_t *ui);

/** Close the screen. */
void monitor_ui_close(monitor_ui_t *ui);

/** Wait for a key, for other files, or for the next time to look. @param fds files to wait for; -1: none
 *  @return false: the terminal is gone */
bool monitor_ui_wait(const int *fds, int count, bool has_screen);

#endif
