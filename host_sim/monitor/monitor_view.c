#include "monitor/monitor_view.h"

#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>

enum { EIGHTHS = 8, PRINT_SIZE = 512, BYTES_MAX = 4 };

#define BLANK ((uint32_t)' ')
#define FULL_BLOCK 0x2588u /* its seven thinner ones follow it: 2589h is seven eighths, 258Fh is one */
#define TRACK 0x00B7u      /* a dot in the middle */
#define CONTINUATION_MASK 0xC0u
#define CONTINUATION 0x80u

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
static uint32_t next_character(const unsigned char **text) {
    const unsigned char *at = *text;
    const bool is_3 = (at[0] & 0xF0u) == 0xE0u;
    const bool is_2 = (at[0] & 0xE0u) == 0xC0u;
    const int more = is_3 ? 2 : (is_2 ? 1 : 0);
    uint32_t character = is_3 ? (at[0] & 0x0Fu) : (is_2 ? (at[0] & 0x1Fu) : at[0]);
    for (int i = 1; i <= more; i++) {
        if ((at[i] & CONTINUATION_MASK) != CONTINUATION) {
            *text = &at[1];
            return (uint32_t)'?';
        }
        character = (character << 6) | (at[i] & 0x3Fu);
    }
    *text = &at[1 + more];
    const bool is_shown = (more > 0) ? (character >= 0xA0u) : ((character >= BLANK) && (character < 0x7Fu));
    return is_shown ? character : (uint32_t)'?';
}

int monitor_view_put(monitor_view_t *view, int y, int x, monitor_style_t style, const char *text) {
    const unsigned char *at = (const unsigned char *)text;
    while (*at != '\0') {
        set(view, y, x, style, next_character(&at));
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
    uint64_t filled = (whole == 0u) ? 0u : ((part >= whole) ? room : (part * room) / whole);
    filled = ((filled == 0u) && (part > 0u)) ? 1u : filled;
    for (int i = 0; i < width; i++) {
        const uint64_t mine = (filled > (uint64_t)i * EIGHTHS) ? filled - ((uint64_t)i * EIGHTHS) : 0u;
        if (mine >= (uint64_t)EIGHTHS) {
            set(view, y, x + i, style, FULL_BLOCK);
        } else if (mine > 0u) {
            set(view, y, x + i, style, FULL_BLOCK + (uint32_t)((uint64_t)EIGHTHS - mine));
        } else {
            set(view, y, x + i, STYLE_DIM, TRACK);
        }
    }
}

/** @return bytes written */
static size_t encode(uint32_t character, char bytes[BYTES_MAX]) {
    if (character < 0x80u) {
        bytes[0] = (char)character;
        return 1u;
    }
    if (character < 0x800u) {
        bytes[0] = (char)(0xC0u | (character >> 6));
        bytes[1] = (char)(0x80u | (character & 0x3Fu));
        return 2u;
    }
    bytes[0] = (char)(0xE0u | (character >> 12));
    bytes[1] = (char)(0x80u | ((character >> 6) & 0x3Fu));
    bytes[2] = (char)(0x80u | (character & 0x3Fu));
    return 3u;
}

void monitor_view_text(const monitor_view_t *view, int y, char *text, size_t size) {
    size_t used = 0u;
    size_t end = 0u;
    for (int x = 0; (y < view->height) && (x < view->width) && (used + BYTES_MAX < size); x++) {
        const uint32_t character = view->cells[y][x].character;
        used += encode(character, &text[used]);
        end = (character != BLANK) ? used : end;
    }
    text[end] = '\0';
}
