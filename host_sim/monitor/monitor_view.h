/**
 * @file monitor_view.h
 * A screen as an array of cells, each a character and a style. It knows no terminal: monitor_screen.h puts it on one.
 */
#ifndef HOST_SIM_MONITOR_VIEW_H
#define HOST_SIM_MONITOR_VIEW_H

#include <stddef.h>
#include <stdint.h>

#define MONITOR_VIEW_WIDTH_MAX 320
#define MONITOR_VIEW_HEIGHT_MAX 120

/** How a cell looks. */
typedef enum {
    STYLE_PLAIN,
    STYLE_DIM,  /**< grey */
    STYLE_BOLD, /**< headings, keys */
    STYLE_GOOD, /**< green */
    STYLE_WARN, /**< yellow */
    STYLE_BAD,  /**< red */
    STYLE_BAR,  /**< the first and the last line, inverse */
    STYLES
} monitor_style_t;

/** A cell. */
typedef struct {
    uint32_t character; /**< Unicode */
    monitor_style_t style;
} monitor_cell_t;

/** A screen. Some 300 KiB: on the heap. */
typedef struct {
    int width;
    int height;
    monitor_cell_t cells[MONITOR_VIEW_HEIGHT_MAX][MONITOR_VIEW_WIDTH_MAX];
} monitor_view_t;

/** Make it empty, with this size or the largest possible one. */
void monitor_view_clear(monitor_view_t *view, int width, int height);

/** Put a text (UTF-8) into a line; what does not fit is cut. @return the column after it, also when it is outside */
int monitor_view_put(monitor_view_t *view, int y, int x, monitor_style_t style, const char *text);

/** The same, with a format. */
int monitor_view_print(monitor_view_t *view, int y, int x, monitor_style_t style, const char *format, ...)
    __attribute__((format(printf, 5, 6)));

/** Fill a line with blanks of a style. */
void monitor_view_fill(monitor_view_t *view, int y, monitor_style_t style);

/** A bar of @p width cells, filled to @p part of @p whole: eighths of a cell, the rest as dots. */
void monitor_view_bar(monitor_view_t *view, int y, int x, int width, monitor_style_t style, uint64_t part,
                      uint64_t whole);

#endif
