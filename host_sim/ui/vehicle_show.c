#include "ui/vehicle_show.h"

#include <inttypes.h>
#include <poll.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "scenario/parse/scenario_parse.h"
#include "text/units.h"
#include "ui/terminal.h"

enum { DRAW_EVERY_MS = 100, LINE_SIZE = 320, STATUS_SIZE = 160, ALARM_BITS = 8 };

/* The terminal: one line up, to its begin; clear to the line's end; clear all below; keep the cursor's place. */
#define UP "\033[1A\r"
#define CLEAR_LINE "\033[K"
#define CLEAR_BELOW "\033[J"
#define KEEP_CURSOR "\0337"
#define RETURN_CURSOR "\0338"

/* Bits of 363h byte 5. */
static const char *const ALARMS[ALARM_BITS] = {"REMOTE_SIGNAL_LOST", "REMOTE_POWER_LOST", "bit 2", "AI_CAN_LOST",
                                               "EPS_HARDWARE",       "EPS_CAN_BUS",       "bit 6", "S_DRIVER"};

static const char *gear_word(uint8_t gear) {
    for (const yaml_word_t *word = SCENARIO_GEARS; word->word != NULL; word++) {
        if (word->value == (int)gear) {
            return word->word;
        }
    }
    return "?";
}

static const char *vehicle_mode_word(const vehicle_view_t *view) {
    return view->autopilot ? "autopilot" : "manual";
}

static const char *eps_word(const vehicle_view_t *view) {
    return (view->eps_mode == AGV_EPS_MODE_ANGLE) ? "angle control" : "steering assist";
}

/** A number with one or two decimals. */
static void write_decimal(char text[16], int32_t value, int32_t per_one, int digits) {
    (void)snprintf(text, 16, "%s%d.%0*d", (value < 0) ? "-" : "", (int)(abs(value) / per_one), digits,
                   (int)(abs(value) % per_one));
}

static void add(char *text, size_t size, const char *separator, const char *word) {
    const size_t used = strlen(text);
    (void)snprintf(&text[used], size - used, "%s%s", (used > 0) ? separator : "", word);
}

static void write_status(const vehicle_view_t *view, char status[STATUS_SIZE]) {
    char speed[16];
    char angle[16];
    char rest[STATUS_SIZE] = "";

    write_decimal(speed, view->speed_mm_s / 10, 100, 2);
    write_decimal(angle, view->angle_ddeg, 10, 1);
    for (unsigned bit = 0; bit < ALARM_BITS; bit++) {
        if ((view->alarms & (1u << bit)) != 0) {
            add(rest, sizeof rest, ", ", ALARMS[bit]);
        }
    }
    (void)snprintf(status, STATUS_SIZE, "gear %s, %s, %s m/s, throttle %u %%, steering %s deg, alarms: %.60s",
                   gear_word(view->gear), vehicle_mode_word(view), speed, (unsigned)(view->throttle_permille / 10),
                   angle, (rest[0] != '\0') ? rest : "none");
    rest[0] = '\0';
    for (int n = 0; n < VEHICLE_NODES; n++) {
        if (!view->running[n]) {
            add(rest, sizeof rest, ", ", vehicle_node_name((vehicle_node_t)n));
        }
    }
    if (rest[0] != '\0') {
        add(status, STATUS_SIZE, ", off: ", rest);
    }
}

void vehicle_show_init(vehicle_show_t *show, const vehicle_view_t *view) {
    *show =
        (vehicle_show_t){.is_live = isatty(STDOUT_FILENO) != 0, .is_typed = isatty(STDIN_FILENO) != 0, .view = *view};
    (void)setvbuf(stdout, NULL, _IOLBF, BUFSIZ); /* through a pipe, too, each line appears at once */
}

void vehicle_show_clear(vehicle_show_t *show, bool line_typed) {
    if (show->is_drawn) {
        (void)printf("%s" UP CLEAR_BELOW, (line_typed && show->is_typed) ? UP : "");
        (void)fflush(stdout);
        show->is_drawn = false;
        show->draw_ms = 0;
    }
}

void vehicle_show_event(vehicle_show_t *show, uint64_t t_ms, const char *who, const char *format, ...) {
    char what[LINE_SIZE];
    char speed[16];
    va_list arguments;

    va_start(arguments, format);
    (void)vsnprintf(what, sizeof what, format, arguments);
    va_end(arguments);
    vehicle_show_clear(show, false);
    write_decimal(speed, show->view.speed_mm_s / 10, 100, 2);
    (void)printf("%5" PRIu64 ".%03" PRIu64 " s  %-10s  %-44s  %s %-9s %s m/s\n", t_ms / MS_PER_S, t_ms % MS_PER_S, who,
                 what, gear_word(show->view.gear), vehicle_mode_word(&show->view), speed);
}

static void show_alarms(vehicle_show_t *show, uint64_t t_ms, uint8_t before) {
    const uint8_t now = show->view.alarms;

    for (unsigned bit = 0; bit < ALARM_BITS; bit++) {
        if (((now ^ before) & (1u << bit)) != 0) {
            vehicle_show_event(show, t_ms, "vcu", "alarm %s %s", ALARMS[bit],
                               ((now & (1u << bit)) != 0) ? "raised" : "ended");
        }
    }
}

static void show_changes(vehicle_show_t *show, uint64_t t_ms, const vehicle_view_t *before) {
    const vehicle_view_t *now = &show->view;

    for (int n = 0; n < VEHICLE_NODES; n++) {
        if (now->running[n] != before->running[n]) {
            vehicle_show_event(show, t_ms, vehicle_node_name((vehicle_node_t)n), "is %s",
                               now->running[n] ? "on" : "off");
        }
    }
    if (now->autopilot != before->autopilot) {
        vehicle_show_event(show, t_ms, "vcu", "%s", vehicle_mode_word(now));
    }
    if (now->gear != before->gear) {
        vehicle_show_event(show, t_ms, "vcu", "gear %s", gear_word(now->gear));
    }
    if (now->eps_mode != before->eps_mode) {
        vehicle_show_event(show, t_ms, "eps", "%s", eps_word(now));
    }
    if ((now->speed_mm_s == 0) != (before->speed_mm_s == 0)) {
        vehicle_show_event(show, t_ms, "vehicle", "%s", (now->speed_mm_s == 0) ? "stands still" : "moves off");
    }
    show_alarms(show, t_ms, before->alarms);
}

/** Draw the status line, and leave the cursor where it was in the line below. */
static void draw(vehicle_show_t *show) {
    char status[STATUS_SIZE];

    write_status(&show->view, status);
    if (show->is_drawn) {
        (void)printf(KEEP_CURSOR UP CLEAR_LINE "%.*s" RETURN_CURSOR, terminal_columns(), status);
    } else {
        (void)printf("\r" CLEAR_LINE "%.*s\n", terminal_columns(), status);
    }
    (void)fflush(stdout);
    show->is_drawn = true;
}

/** Whether the terminal takes something now; it may have been stopped (Ctrl-S). */
static bool terminal_is_writable(void) {
    struct pollfd wait = {.fd = STDOUT_FILENO, .events = POLLOUT, .revents = 0};
    return poll(&wait, 1, 0) > 0;
}

void vehicle_show_view(vehicle_show_t *show, uint64_t t_ms, const vehicle_view_t *view) {
    const vehicle_view_t before = show->has_begun ? show->view : *view;

    show->view = *view;
    show->has_begun = true;
    show_changes(show, t_ms, &before);
    if (show->is_live && (t_ms >= show->draw_ms) && terminal_is_writable()) {
        draw(show);
        show->draw_ms = t_ms + DRAW_EVERY_MS;
    }
}

void vehicle_show_status(vehicle_show_t *show) {
    char status[STATUS_SIZE];

    write_status(&show->view, status);
    vehicle_show_clear(show, false);
    (void)printf("%s\n", status);
}
