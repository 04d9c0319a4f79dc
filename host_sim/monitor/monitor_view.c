#include "monitor/monitor_view.h"

#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>

#include "text/text.h"

enum { EIGHTHS = 8, PRINT_SIZE = 512 };

#define BLANK ((uint32_t)' ')
#define FULL_BLOCK 0x2588u /* its seven thinner ones follow it: 2589h is seven eighths, 258Fh is one */
#define TRACK 0x00B7u      /* a dot in the middle */

static int clamp(int value, int highest) {
    return (value < 0) ? 0 : ((value > highest) ? highest : value);
}

void monitor_view_clear(monitor_view_t *view, int width, int height) {
    view->width = clamp(width, MONITOR_VIEW_WIDTH_MAX);
    view->height = clamp(height, MONITOR_VIEW_HEIGHT_MAX);
    for (int y = 0; y < view->height; y++) {
        monitor_view_fill(view, y, STYLE_PLAIN);
    }
}

static void set(monitor_view_t *view, int y, int x, monitor_style_t style, uint32_t character) {
    if ((y >= 0) && (y < view->height) && (x >= 0) && (x < view->width)) {
        view->cells[y][x] = (monitor_cell_t){.character = character, .style = style};
    }
}

void monitor_view_fill(monitor_view_t *view, int y, monitor_style_t style) {
    for (int x = 0; x < view->width; x++) {
        set(view, y, x, style, BLANK);
    }
}

/** The next character of a text; what is no UTF-8 or cannot be shown is a question mark. */
static uint32_t next_character(const char **text) {
    uint32_t character = 0;
    const size_t length = text_character(*text, &character);
    *text += (length > 0) ? length : 1;
    const bool is_ascii = (character >= BLANK) && (character < 0x7Fu);
    const bool is_other = (character >= 0xA0u) && (character <= 0xFFFFu);
    return ((length > 0) && (is_ascii || is_other)) ? character : (uint32_t)'?';
}

int monitor_view_put(monitor_view_t *view, int y, int x, monitor_style_t style, const char *text) {
    while (*text != '\0') {
        set(view, y, x, style, next_character(&text));
        x++;
    }
    return x;
}

int monitor_view_print(monitor_view_t *view, int y, int x, monitor_style_t style, const char *format, ...) {
    char text[PRINT_SIZE];
    va_list arguments;
    va_start(arguments, format);
    (void)vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    return monitor_view_put(view, y, x, style, text);
}

void monitor_view_bar(monitor_view_t *view, int y, int x, int width, monitor_style_t style, uint64_t part,
                      uint64_t whole) {
    const uint64_t room = (uint64_t)width * EIGHTHS;
    uint64_t filled = (whole == 0) ? 0 : ((part >= whole) ? room : (part * room) / whole);
    filled = ((filled == 0) && (part > 0)) ? 1 : filled;
    for (int i = 0; i < width; i++) {
        const uint64_t mine = (filled > (uint64_t)i * EIGHTHS) ? filled - ((uint64_t)i * EIGHTHS) : 0;
        if (mine >= EIGHTHS) {
            set(view, y, x + i, style, FULL_BLOCK);
        } else if (mine > 0) {
            set(view, y, x + i, style, FULL_BLOCK + (uint32_t)((uint64_t)EIGHTHS - mine));
        } else {
            set(view, y, x + i, STYLE_DIM, TRACK);
        }
    }
}
