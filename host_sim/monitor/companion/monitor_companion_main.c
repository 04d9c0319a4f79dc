/* The process that shows the screen. */
#include <errno.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

#include "common/interrupt.h"
#include "common/report.h"
#include "monitor/companion/monitor_companion_internal.h"
#include "monitor/inputs/monitor_can.h"
#include "monitor/monitor_ui.h"
#include "text/units.h"

enum { MESSAGES_AT_ONCE = 256, LINE_SIZE = 400 };

/** All of it. Some 1 MiB: on the heap. */
typedef struct {
    const monitor_companion_config_t *config;
    const monitor_ends_t *ends;
    monitor_t *monitor;
    monitor_can_t bus;
    monitor_record_t record;
    monitor_ui_t ui;
    char line[LINE_SIZE]; /* what the program prints, until it is a whole line */
    size_t used;
    bool has_ended; /* the program */
} companion_t;

/** A line of the program: without its time, the first word is who. */
static void list_line(companion_t *this, char *line) {
    char who[MONITOR_WHO_SIZE];
    line += strspn(line, " ");
    const size_t number = strspn(line, "0123456789.");
    if ((number > 0) && (strncmp(&line[number], " s  ", 4) == 0)) {
        line += number + 4;
        const size_t word = strcspn(line, " ");
        (void)snprintf(who, sizeof who, "%.*s", (int)((word < sizeof who) ? word : sizeof who - 1), line);
        line += word;
        line += strspn(line, " ");
        char *state = strstr(line, "  "); /* of the vehicle: it is on the screen */
        if (state != NULL) {
            *state = '\0';
        }
    } else {
        (void)snprintf(who, sizeof who, "%s", this->config->title);
    }
    if (line[0] != '\0') {
        monitor_note(this->monitor, MONITOR_QUIET, who, line);
    }
}

static void read_text(companion_t *this) {
    struct pollfd wait = {.fd = this->ends->text, .events = POLLIN, .revents = 0};
    for (int i = 0; (i < MESSAGES_AT_ONCE) && (poll(&wait, 1, 0) > 0); i++) {
        const size_t room = sizeof this->line - 1 - this->used;
        const ssize_t got = read(this->ends->text, &this->line[this->used], room);
        if (got <= 0) {
            return;
        }
        this->used += (size_t)got;
        this->line[this->used] = '\0';
        char *begin = this->line;
        for (char *end = strchr(begin, '\n'); end != NULL; end = strchr(begin, '\n')) {
            *end = '\0';
            list_line(this, begin);
            begin = end + 1;
        }
        if ((begin == this->line) && (this->used == sizeof this->line - 1)) {
            list_line(this, begin); /* too long: in parts */
            begin = &this->line[this->used];
        }
        this->used = strlen(begin);
        memmove(this->line, begin, this->used + 1);
    }
}

static void take_message(companion_t *this, const monitor_message_t *message) {
    if (message->kind == MONITOR_MESSAGE_EVENT) {
        monitor_event(this->monitor, &message->event, linux_clock_now_us(&this->bus.clock));
    } else if (message->kind == MONITOR_MESSAGE_STATE) {
        monitor_told(this->monitor, &message->state);
    }
}

static void read_messages(companion_t *this) {
    monitor_message_t message;
    for (int i = 0; i < MESSAGES_AT_ONCE; i++) {
        const ssize_t got = recv(this->ends->control, &message, sizeof message, MSG_DONTWAIT);
        if (got == (ssize_t)sizeof message) {
            take_message(this, &message);
        } else {
            this->has_ended = (got == 0) || ((got < 0) && (errno != EAGAIN) && (errno != EINTR));
            return;
        }
    }
}

static void pass_typed(companion_t *this) {
    char line[MONITOR_TYPED_SIZE + 1];
    if (this->ui.wish.has_typed) {
        const int length = snprintf(line, sizeof line, "%s\n", this->ui.page.typed);
        if (write(this->ends->typed, line, (size_t)length) != length) {
            monitor_note(this->monitor, MONITOR_WARN, "line not passed on", this->ui.page.typed);
        }
        monitor_ui_typed_done(&this->ui);
    }
}

static void end_recording(companion_t *this) {
    if (!monitor_record_end(&this->record)) {
        monitor_note(this->monitor, MONITOR_WARN, "recording failed", strerror(this->record.error));
    }
    this->ui.page.recording = NULL;
}

static void toggle_recording(companion_t *this) {
    this->ui.wish.toggles_recording = false;
    if (this->record.fd >= 0) {
        end_recording(this);
    } else if (!monitor_record_begin(&this->record, NULL)) {
        monitor_note(this->monitor, MONITOR_WARN, "record", strerror(errno));
    } else {
        this->ui.page.recording = this->record.name;
    }
}

static void go_round(companion_t *this) {
    monitor_can_pass(&this->bus, this->monitor, &this->record);
    if (!monitor_record_flush(&this->record) && (this->record.fd >= 0)) {
        end_recording(this);
    }
    read_messages(this);
    read_text(this);
    monitor_ui_keys(&this->ui);
    pass_typed(this);
    if (this->ui.wish.toggles_recording) {
        toggle_recording(this);
    }
    monitor_ui_draw(&this->ui, linux_clock_now_us(&this->bus.clock) / US_PER_MS);
}

static bool goes_on(const companion_t *this) {
    return !this->has_ended && !this->ui.wish.quits && !interrupt_pending();
}

static void go(companion_t *this) {
    const int files[] = {this->ends->text, this->ends->control};
    bool there = true;
    while (there && goes_on(this)) {
        go_round(this);
        there = monitor_ui_wait(files, 2, true);
    }
    if (this->ui.wish.quits && (getppid() == this->ends->parent)) {
        (void)kill(this->ends->parent, SIGTERM);
    }
}

static bool prepare(companion_t *this) {
    const monitor_companion_config_t *given = this->config;
    const monitor_config_t config = {
        .config = given->config,
        .interfaces =
            {[HAL_CAN_VEHICLE] = given->interfaces[HAL_CAN_VEHICLE], [HAL_CAN_AI] = given->interfaces[HAL_CAN_AI]},
        .is_gateway = given->config->topology == AGV_TOPOLOGY_GATEWAY,
        .owned = given->has_supervisor,
    };
    const monitor_page_t page = {.title = given->title, .can_type = given->can_type};
    this->monitor = monitor_new(&config);
    return (this->monitor != NULL) && monitor_can_open(&this->bus, given->interfaces) &&
           monitor_ui_open(&this->ui, this->monitor, &page);
}

/** Wait until the node runs. @return false: it never will */
static bool wait_for_show(const monitor_ends_t *ends) {
    monitor_message_t message;
    ssize_t got = -1;
    do {
        got = interrupt_wait(ends->control, INTERRUPT_READ) ? recv(ends->control, &message, sizeof message, 0) : 0;
    } while ((got < 0) && (errno == EINTR));
    return got == (ssize_t)sizeof message;
}

int monitor_companion_main(const monitor_companion_config_t *config, const monitor_ends_t *ends) {
    int status = STATUS_OK;
    interrupt_hold();
    if (!wait_for_show(ends)) {
        return status;
    }
    companion_t *this = calloc(1, sizeof *this);
    if (this == NULL) {
        return STATUS_UNUSABLE;
    }
    this->config = config;
    this->ends = ends;
    monitor_record_init(&this->record);
    if (prepare(this)) {
        go(this);
        monitor_ui_close(&this->ui);
    } else {
        status = STATUS_UNUSABLE;
    }
    status = monitor_record_close(&this->record) ? status : STATUS_UNUSABLE;
    monitor_can_close(&this->bus);
    monitor_free(this->monitor);
    free(this);
    return status;
}
