/**
 * @file monitor_screen.h
 * A view on the terminal (ncurses). There is one terminal, so there is one screen.
 */
#ifndef HOST_SIM_MONITOR_SCREEN_H
#define HOST_SIM_MONITOR_SCREEN_H

#include <stdbool.h>

#include "monitor/monitor_view.h"

/** Keys besides characters. */
enum {
    MONITOR_KEY_NONE = -1,
    MONITOR_KEY_ENTER = 0x100,
    MONITOR_KEY_ESCAPE,
    MONITOR_KEY_BACKSPACE,
    MONITOR_KEY_UP,
    MONITOR_KEY_DOWN,
    MONITOR_KEY_PAGE_UP,
    MONITOR_KEY_PAGE_DOWN,
    MONITOR_KEY_HOME,
    MONITOR_KEY_END,
    MONITOR_KEY_RESIZE,
    MONITOR_KEY_OTHER
};

/** Whether there is a terminal for a screen: standard input and output are one, and TERM names one that is not dumb. */
bool monitor_screen_possible(void);

/**
 * Open it. Standard error is kept back until monitor_screen_close(), as far as it goes to a terminal.
 * Colours are used unless NO_COLOR is set.
 * @return false: was reported
 */
bool monitor_screen_open(void);

/** Its size. */
void monitor_screen_size(int *width, int *height);

/** Show a view. Left out while the terminal takes nothing (Ctrl-S). */
void monitor_screen_show(const monitor_view_t *view);

/** The next key. @return a character, MONITOR_KEY_..., or MONITOR_KEY_NONE */
int monitor_screen_key(void);

/** Close it; print what standard error has got meanwhile. Nothing when it is not open. */
void monitor_screen_close(void);

#endif
