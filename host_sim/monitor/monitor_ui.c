#include "monitor/monitor_ui.h"

#include <poll.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "monitor/monitor_screen.h"

enum { DRAW_EVERY_MS = 200, DRAW_LARGE_EVERY_MS = 300, LARGE_CELLS = 4000, LOOK_EVERY_MS = 20, FILES_MAX = 4 };

bool monitor_ui_open(monitor_ui_t *ui, monitor_t *monitor, const monitor_page_t *page) {
    memset(ui, 0, sizeof *ui);
    ui->monitor = monitor;
    ui->page = *page;
    return monitor_screen_open();
}

/** Hold the picture, or let it go. */
static void toggle_pause(monitor_ui_t *ui) {
    ui->page.is_paused = !ui->page.is_paused;
    free(ui->held);
    ui->held = NULL;
    if (ui->page.is_paused) {
        ui->held = malloc(sizeof *ui->held);
        if (ui->held != NULL) {
            *ui->held = *ui->monitor;
        }
    }
}

bool monitor_ui_is_paused(const monitor_ui_t *ui) {
    return ui->page.is_paused;
}

static const monitor_t *shown_monitor(const monitor_ui_t *ui) {
    return (ui->held != NULL) ? ui->held : ui->monitor;
}

static void scroll_log(monitor_ui_t *ui, int lines) {
    const size_t length = monitor_log_length(&shown_monitor(ui)->log);
    const size_t page = (ui->log_lines > 0) ? (size_t)ui->log_lines : 1;
    const size_t most = (length > page) ? length - page : 0;
    const size_t now = ui->page.scrolled;
    if (lines < 0) {
        ui->page.scrolled = (now > (size_t)(-lines)) ? now - (size_t)(-lines) : 0;
    } else {
        ui->page.scrolled = (now + (size_t)lines < most) ? now + (size_t)lines : most;
    }
}

void monitor_ui_typed_done(monitor_ui_t *ui) {
    ui->wish.has_typed = false;
    ui->page.typed[0] = '\0';
}

static void type(monitor_ui_t *ui, int key) {
    char *typed = ui->page.typed;
    const size_t length = strlen(typed);
    if (key == MONITOR_KEY_ENTER) {
        ui->page.is_typing = false;
        ui->wish.has_typed = length > 0;
    } else if (key == MONITOR_KEY_ESCAPE) {
        ui->page.is_typing = false;
        typed[0] = '\0';
    } else if (key == MONITOR_KEY_BACKSPACE) {
        typed[(length > 0) ? length - 1 : 0] = '\0';
    } else if ((key >= ' ') && (key <= '~') && (length + 1 < sizeof ui->page.typed)) {
        typed[length] = (char)key;
        typed[length + 1] = '\0';
    }
}

static void move_log(monitor_ui_t *ui, int key) {
    const int page = (ui->log_lines > 1) ? ui->log_lines - 1 : 1;
    switch (key) {
    case MONITOR_KEY_UP:
        scroll_log(ui, 1);
        break;
    case MONITOR_KEY_DOWN:
        scroll_log(ui, -1);
        break;
    case MONITOR_KEY_PAGE_UP:
        scroll_log(ui, page);
        break;
    case MONITOR_KEY_PAGE_DOWN:
        scroll_log(ui, -page);
        break;
    case MONITOR_KEY_HOME:
        scroll_log(ui, (int)MONITOR_LOG_ENTRIES);
        break;
    case MONITOR_KEY_END:
        ui->page.scrolled = 0;
        break;
    default:
        break;
    }
}

static void obey(monitor_ui_t *ui, int key) {
    switch (key) {
    case 'q':
    case 'Q':
        ui->wish.quits = true;
        break;
    case ' ':
    case 'p':
        toggle_pause(ui);
        break;
    case 'r':
        monitor_reset(ui->monitor);
        break;
    case 'c':
        ui->wish.toggles_recording = !ui->page.is_log;
        break;
    case '+':
    case '-':
        ui->wish.faster += (key == '+') ? 1 : -1;
        break;
    case 'h':
    case '?':
        ui->page.shows_help = !ui->page.shows_help;
        break;
    case ':':
        ui->page.is_typing = ui->page.can_type;
        break;
    default:
        move_log(ui, key);
        break;
    }
}

void monitor_ui_key(monitor_ui_t *ui, int key) {
    if (ui->page.is_typing) {
        type(ui, key);
    } else if (ui->page.shows_help && (key == MONITOR_KEY_ESCAPE)) {
        ui->page.shows_help = false;
    } else {
        obey(ui, key);
    }
    ui->draw_ms = 0;
}

void monitor_ui_keys(monitor_ui_t *ui) {
    for (int key = monitor_screen_key(); key != MONITOR_KEY_NONE; key = monitor_screen_key()) {
        monitor_ui_key(ui, key);
    }
}

void monitor_ui_draw(monitor_ui_t *ui, uint64_t now_ms) {
    int width = 0;
    int height = 0;
    if (now_ms < ui->draw_ms) {
        return;
    }
    monitor_screen_size(&width, &height);
    ui->draw_ms = now_ms + (uint64_t)((width * height > LARGE_CELLS) ? DRAW_LARGE_EVERY_MS : DRAW_EVERY_MS);
    monitor_view_clear(&ui->view, width, height);
    ui->log_lines = monitor_page_log_lines(shown_monitor(ui), ui->view.height);
    monitor_page_draw(&ui->view, shown_monitor(ui), &ui->page);
    monitor_screen_show(&ui->view);
}

void monitor_ui_close(monitor_ui_t *ui) {
    monitor_screen_close();
    free(ui->held);
    ui->held = NULL;
}

bool monitor_ui_wait(const int *fds, int count, bool has_screen) {
    struct pollfd files[FILES_MAX] = {{.fd = has_screen ? STDIN_FILENO : -1, .events = POLLIN, .revents = 0}};
    for (int i = 0; i < FILES_MAX - 1; i++) {
        files[i + 1] = (struct pollfd){.fd = (i < count) ? fds[i] : -1, .events = POLLIN, .revents = 0};
    }
    const int ready = poll(files, FILES_MAX, LOOK_EVERY_MS);
    return (ready <= 0) || ((files[0].revents & (POLLHUP | POLLERR | POLLNVAL)) == 0);
}
