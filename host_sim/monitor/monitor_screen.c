#define NCURSES_WIDECHAR 1 /* NOLINT(bugprone-reserved-identifier): ncurses wants it */
#include "monitor/monitor_screen.h"

#include <curses.h>
#include <langinfo.h>
#include <locale.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "common/report.h"

enum {
    ESCAPE_MS = 25,
    GREY = 8,
    GREY_FROM_COLORS = 16,
    ESCAPE = 27,
    DELETE = 127,
    CTRL_H = 8,
    CTRL_L = 12,
    COPY = 4096
};

static struct {
    SCREEN *screen;
    bool is_utf8;
    int stderr_was; /* -1: not kept back */
    FILE *kept_back;
    attr_t attributes[STYLES];
    short pairs[STYLES];
    monitor_view_t shown; /* what the lines show; width 0: nothing yet */
} here = {.stderr_was = -1};

bool monitor_screen_possible(void) {
    const char *term = getenv("TERM");
    return (isatty(STDIN_FILENO) == 1) && (isatty(STDOUT_FILENO) == 1) && (term != NULL) && (term[0] != '\0') &&
           (strcmp(term, "dumb") != 0);
}

static void choose_attributes(void) {
    static const attr_t plain[STYLES] = {[STYLE_DIM] = A_DIM,
                                         [STYLE_BOLD] = A_BOLD,
                                         [STYLE_WARN] = A_BOLD,
                                         [STYLE_BAD] = A_BOLD | A_UNDERLINE,
                                         [STYLE_BAR] = A_REVERSE};
    static const short colors[STYLES] = {
        [STYLE_GOOD] = COLOR_GREEN, [STYLE_WARN] = COLOR_YELLOW, [STYLE_BAD] = COLOR_RED};
    const char *no_color = getenv("NO_COLOR");
    memcpy(here.attributes, plain, sizeof plain);
    memset(here.pairs, 0, sizeof here.pairs);
    if (!has_colors() || ((no_color != NULL) && (no_color[0] != '\0')) || (start_color() == ERR)) {
        return;
    }
    const bool has_default = use_default_colors() != ERR;
    for (short style = 0; style < (short)STYLES; style++) {
        const bool is_grey = (style == (short)STYLE_DIM) && (COLORS >= GREY_FROM_COLORS);
        const short color = is_grey ? (short)GREY : colors[style];
        if (color != 0) {
            (void)init_pair((short)(style + 1), color, (short)(has_default ? -1 : COLOR_BLACK));
            here.pairs[style] = (short)(style + 1);
            here.attributes[style] = A_NORMAL;
        }
    }
}

/** A message on the terminal would spoil the picture. */
static void keep_stderr_back(void) {
    if (isatty(STDERR_FILENO) == 1) {
        here.kept_back = tmpfile();
        here.stderr_was = (here.kept_back != NULL) ? dup(STDERR_FILENO) : -1;
        if (here.stderr_was >= 0) {
            (void)dup2(fileno(here.kept_back), STDERR_FILENO);
        }
    }
}

static void give_stderr_back(void) {
    char text[COPY];
    if (here.stderr_was >= 0) {
        (void)dup2(here.stderr_was, STDERR_FILENO);
        (void)close(here.stderr_was);
        here.stderr_was = -1;
        (void)fseek(here.kept_back, 0, SEEK_SET);
        for (size_t size = fread(text, 1, sizeof text, here.kept_back); size > 0;
             size = fread(text, 1, sizeof text, here.kept_back)) {
            (void)fwrite(text, 1, size, stderr);
        }
    }
    if (here.kept_back != NULL) {
        (void)fclose(here.kept_back);
        here.kept_back = NULL;
    }
}

bool monitor_screen_open(void) {
    (void)setlocale(LC_CTYPE, "");
    here.shown.width = 0;
    here.is_utf8 = strcmp(nl_langinfo(CODESET), "UTF-8") == 0;
    here.screen = newterm(NULL, stdout, stdin);
    if (here.screen == NULL) {
        return report("TERM=%.40s: this terminal is not known", getenv("TERM"));
    }
    keep_stderr_back();
    choose_attributes();
    (void)cbreak();
    (void)noecho();
    (void)nonl();
    (void)curs_set(0);
    (void)keypad(stdscr, TRUE);
    (void)nodelay(stdscr, TRUE);
    (void)set_escdelay(ESCAPE_MS);
    return true;
}

void monitor_screen_size(int *width, int *height) {
    *width = COLS;
    *height = LINES;
}

/** A terminal that shows no UTF-8 gets ASCII. */
static wchar_t shown(uint32_t character) {
    if (here.is_utf8 || (character < 0x80u)) {
        return (wchar_t)character;
    }
    return (character == 0xB7u) ? L'.' : (((character & 0xFF80u) == 0x2580u) ? L'#' : L'?');
}

static void show_line(const monitor_view_t *view, int y) {
    wchar_t text[MONITOR_VIEW_WIDTH_MAX];
    int x = 0;
    while (x < view->width) {
        const monitor_style_t style = view->cells[y][x].style;
        int length = 0;
        for (; (x + length < view->width) && (view->cells[y][x + length].style == style); length++) {
            text[length] = shown(view->cells[y][x + length].character);
        }
        (void)attr_set(here.attributes[style], here.pairs[style], NULL);
        (void)mvaddnwstr(y, x, text, length);
        x += length;
    }
}

void monitor_screen_show(const monitor_view_t *view) {
    struct pollfd terminal = {.fd = STDOUT_FILENO, .events = POLLOUT, .revents = 0};
    if (poll(&terminal, 1, 0) <= 0) {
        return;
    }
    const bool same_size = (view->width == here.shown.width) && (view->height == here.shown.height);
    const size_t size = (size_t)view->width * sizeof view->cells[0][0];
    here.shown.width = view->width;
    here.shown.height = view->height;
    for (int y = 0; y < view->height; y++) {
        if (!same_size || (memcmp(here.shown.cells[y], view->cells[y], size) != 0)) {
            memcpy(here.shown.cells[y], view->cells[y], size);
            show_line(view, y);
        }
    }
    (void)refresh();
}

static void redraw(void) {
    (void)clearok(stdscr, TRUE);
}

int monitor_screen_key(void) {
    static const struct {
        int key;
        int means;
    } keys[] = {
        {KEY_UP, MONITOR_KEY_UP},           {KEY_DOWN, MONITOR_KEY_DOWN},    {KEY_PPAGE, MONITOR_KEY_PAGE_UP},
        {KEY_NPAGE, MONITOR_KEY_PAGE_DOWN}, {KEY_HOME, MONITOR_KEY_HOME},    {KEY_END, MONITOR_KEY_END},
        {KEY_RESIZE, MONITOR_KEY_RESIZE},   {KEY_ENTER, MONITOR_KEY_ENTER},  {'\r', MONITOR_KEY_ENTER},
        {'\n', MONITOR_KEY_ENTER},          {ESCAPE, MONITOR_KEY_ESCAPE},    {KEY_BACKSPACE, MONITOR_KEY_BACKSPACE},
        {DELETE, MONITOR_KEY_BACKSPACE},    {CTRL_H, MONITOR_KEY_BACKSPACE},
    };
    const int key = getch();
    if (key == ERR) {
        return MONITOR_KEY_NONE;
    }
    if (key == KEY_RESIZE) {
        here.shown.width = 0; /* curses has made its lines anew */
    }
    if (key == CTRL_L) {
        redraw();
        return MONITOR_KEY_RESIZE;
    }
    for (size_t i = 0; i < sizeof keys / sizeof keys[0]; i++) {
        if (keys[i].key == key) {
            return keys[i].means;
        }
    }
    return ((key >= ' ') && (key < DELETE)) ? key : MONITOR_KEY_OTHER;
}

void monitor_screen_close(void) {
    if (here.screen != NULL) {
        (void)endwin();
        delscreen(here.screen);
        here.screen = NULL;
        give_stderr_back();
    }
}
