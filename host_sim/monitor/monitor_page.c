#include "monitor/monitor_page.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "agv/faults.h"
#include "agv/names.h"
#include "text/units.h"

enum { LEAST_WIDTH = 40, LEAST_HEIGHT = 8, LABEL = 12, ALARMS_MAX = 14, CELL = 64, S_PER_MIN = 60, MIN_PER_H = 60 };

/** Lines: header, supervisor, vehicle, alarms; titles of the table; other identifiers, keys. */
enum { LINES_ABOVE_TABLE = 4, LINES_BESIDES = LINES_ABOVE_TABLE + 3 };

/** With fewer lines for the log there is no blank line above the table, and no title of the log. */
enum { ROOMY = 4 };

static bool is_roomy(const monitor_t *monitor, int height) {
    return height - (int)LINES_BESIDES - (int)monitor->row_count - 2 >= ROOMY;
}

static int label(monitor_view_t *view, int y, const char *text) {
    (void)monitor_view_put(view, y, 0, STYLE_BOLD, text);
    return LABEL;
}

/** Put a text that ends in the last column but one. */
static void put_right(monitor_view_t *view, int y, monitor_style_t style, const char *text) {
    (void)monitor_view_put(view, y, view->width - (int)strlen(text) - 1, style, text);
}

/** A time since the start: "2:05:12". */
static void write_time(char text[CELL], uint64_t us) {
    const uint64_t s = us / US_PER_S;
    const uint64_t minutes = (s / S_PER_MIN) % MIN_PER_H;
    const uint64_t hours = s / ((uint64_t)S_PER_MIN * MIN_PER_H);
    (void)snprintf(text, CELL, "%" PRIu64 ":%02" PRIu64 ":%02" PRIu64, hours, minutes, s % S_PER_MIN);
}

static int put_interfaces(monitor_view_t *view, int x, const monitor_t *monitor) {
    for (int side = 0; side < HAL_CAN_SIDES; side++) {
        const char *name = monitor->given.interfaces[side];
        if (name != NULL) {
            x = monitor_view_print(view, 0, x, STYLE_BAR, " %s%s%s ", name, (side == HAL_CAN_AI) ? " (ai)" : "",
                                   monitor->is_down[side] ? " DOWN" : "");
        }
    }
    return x;
}

/** The last part of a path. */
static const char *base_of(const char *path) {
    const char *slash = strrchr(path, '/');
    return (slash != NULL) ? slash + 1 : path;
}

static int put_modes(monitor_view_t *view, int x, const monitor_page_t *page) {
    if (page->is_paused) {
        x = monitor_view_put(view, 0, x, STYLE_BAR, " PAUSED ");
    }
    if (page->has_ended) {
        x = monitor_view_put(view, 0, x, STYLE_BAR, " END ");
    } else if (page->is_log && (page->speed > 0.0)) {
        x = monitor_view_print(view, 0, x, STYLE_BAR, " x%g ", page->speed);
    }
    if (page->recording != NULL) {
        x = monitor_view_print(view, 0, x, STYLE_BAR, " REC %.40s ", base_of(page->recording));
    }
    return x;
}

static void draw_header(monitor_view_t *view, const monitor_t *monitor, const monitor_page_t *page) {
    char time[CELL];
    char right[2 * CELL];
    monitor_view_fill(view, 0, STYLE_BAR);
    int x = monitor_view_print(view, 0, 0, STYLE_BAR, " host_sim %s ", page->title);
    x = (page->input != NULL) ? monitor_view_print(view, 0, x, STYLE_BAR, " %.24s ", base_of(page->input))
                              : put_interfaces(view, x, monitor);
    (void)put_modes(view, x, page);
    write_time(time, monitor->now_us);
    (void)snprintf(right, sizeof right, "  %" PRIu64 " frames/s  %s",
                   monitor_rate(monitor, monitor->frames, monitor->counts), time);
    put_right(view, 0, STYLE_BAR, right);
}

static monitor_style_t style_of_state(agv_state_t state) {
    if ((state == AGV_STATE_ACTIVE) || (state == AGV_STATE_STANDBY)) {
        return STYLE_GOOD;
    }
    return (state == AGV_STATE_INIT) ? STYLE_WARN : STYLE_BAD;
}

static int draw_led(monitor_view_t *view, int y, int x, const monitor_supervisor_t *supervisor) {
    if (!supervisor->has_led) {
        return x;
    }
    if (supervisor->led_code < 0) {
        return monitor_view_put(view, y, x, STYLE_BAD, "  LED fast blinking");
    }
    const bool is_dark = supervisor->led_code == 0;
    return is_dark ? monitor_view_put(view, y, x, STYLE_PLAIN, "  LED healthy")
                   : monitor_view_print(view, y, x, STYLE_BAD, "  LED code %d", (int)supervisor->led_code);
}

/** From where it is known. */
static void draw_source(monitor_view_t *view, int y, int x, const monitor_t *monitor) {
    const monitor_supervisor_t *supervisor = &monitor->supervisor;
    char text[2 * CELL] = "";
    switch (supervisor->source) {
    case MONITOR_STATUS_FRAME:
        (void)snprintf(text, sizeof text, "status frame %03Xh", (unsigned)monitor->config.status_frame_id);
        break;
    case MONITOR_SHADOW:
        (void)snprintf(text, sizeof text, "a supervisor in this program, which only listens");
        break;
    default:
        break;
    }
    if (x + (int)strlen(text) + 2 < view->width) {
        put_right(view, y, STYLE_DIM, text);
    }
}

static void draw_supervisor(monitor_view_t *view, int y, const monitor_t *monitor) {
    const monitor_supervisor_t *supervisor = &monitor->supervisor;
    const char *state = agv_state_name(supervisor->state);
    const bool is_latched = agv_state_is_latched(supervisor->state);
    const char *reason = is_latched ? agv_fault_name(supervisor->first_reason) : NULL;
    int x = label(view, y, (supervisor->source == MONITOR_SHADOW) ? "shadow" : "supervisor");
    if (supervisor->state == 0) {
        (void)monitor_view_put(view, y, x, STYLE_DIM, "waiting for its status frame");
        return;
    }
    x = monitor_view_put(view, y, x, style_of_state(supervisor->state), (state != NULL) ? state : "no valid state");
    if (reason != NULL) {
        x = monitor_view_print(view, y, x, STYLE_BAD, ": %s", reason);
        const unsigned code = agv_fault_led_code(supervisor->first_reason);
        if (!supervisor->has_led && (code > 0)) {
            x = monitor_view_print(view, y, x, STYLE_BAD, "  LED code %u", code);
        }
    }
    x = draw_led(view, y, x, supervisor);
    if (supervisor->source != MONITOR_SHADOW) { /* one that only listens never opens it */
        x = monitor_view_put(view, y, x, STYLE_PLAIN, supervisor->output_closed ? "  output closed" : "  output open");
    }
    draw_source(view, y, x, monitor);
}

/** Put one signal of a message with a label: " gear P". */
static int put_value(monitor_view_t *view, int y, int x, const monitor_t *monitor, uint32_t message, const char *name,
                     const char *before) {
    const uint8_t *data = monitor_payload(monitor, message);
    signal_value_t value;
    char text[SIGNALS_VALUE_SIZE];
    for (size_t i = 0; (data != NULL) && signals_read(message, i, data, &value); i++) {
        const signal_info_t *info = signals_info(message, i);
        if (strcmp(info->name, name) == 0) {
            signals_value_text(text, info, &value);
            x = monitor_view_put(view, y, x, STYLE_DIM, before);
            return monitor_view_put(view, y, x, value.valid ? STYLE_PLAIN : STYLE_BAD, text);
        }
    }
    return x;
}

static void draw_vehicle(monitor_view_t *view, int y, const monitor_t *monitor) {
    int x = label(view, y, "vehicle");
    const int begin = x;
    x = put_value(view, y, x, monitor, AGV_MSG_VEHICLE_STATUS, "mode", "");
    x = put_value(view, y, x, monitor, AGV_MSG_GEAR_STATUS, "gear", "  gear ");
    x = put_value(view, y, x, monitor, AGV_MSG_WHEEL_SPEED, "left", "  left wheel ");
    x = put_value(view, y, x, monitor, AGV_MSG_THROTTLE_STATUS, "throttle", "  throttle ");
    x = put_value(view, y, x, monitor, AGV_MSG_STEERING_STATUS, "angle", "  steering ");
    if (x == begin) {
        (void)monitor_view_put(view, y, x, STYLE_DIM, "nothing received yet");
    }
}

static void draw_alarms(monitor_view_t *view, int y, const monitor_t *monitor) {
    monitor_alarm_t alarms[ALARMS_MAX];
    const size_t count = monitor_alarms(monitor, alarms, ALARMS_MAX);
    int x = label(view, y, "alarms");
    if (count == 0) {
        (void)monitor_view_put(view, y, x, STYLE_DIM, "none");
    }
    for (size_t i = 0; i < count; i++) {
        const monitor_style_t style = !alarms[i].is_fresh ? STYLE_DIM : (alarms[i].is_trip ? STYLE_BAD : STYLE_WARN);
        x = monitor_view_print(view, y, x, style, "%s%s", (i > 0) ? ", " : "", agv_fault_name(alarms[i].fault));
        if (alarms[i].led_code > 0) {
            x = monitor_view_print(view, y, x, style, " (LED %u)", (unsigned)alarms[i].led_code);
        }
    }
}

static void draw_others(monitor_view_t *view, int y, const monitor_t *monitor) {
    int x = label(view, y, "also seen");
    const int begin = x;
    if (monitor->supervisor.heard_count > 0) {
        x = monitor_view_print(view, y, x, STYLE_PLAIN, "%03Xh status frame  ",
                               (unsigned)monitor->config.status_frame_id);
    }
    for (size_t i = 0; (i < monitor->other_count) && (x < view->width); i++) {
        const monitor_other_t *other = &monitor->others[i];
        const uint64_t rate = monitor_rate(monitor, other->count, other->counts);
        x = monitor_view_print(view, y, x, (rate > 0) ? STYLE_PLAIN : STYLE_DIM, "%0*" PRIX32 "h %" PRIu64 "/s  ",
                               other->is_extended ? 8 : 3, other->id, rate);
    }
    const uint64_t numbers[] = {monitor->others_uncounted, monitor->rejected, monitor->errors, monitor->lost};
    static const char *const words[] = {"frames of more", "rejected", "error frames", "lost by this program"};
    for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; i++) {
        if (numbers[i] > 0) {
            x = monitor_view_print(view, y, x, STYLE_WARN, "%" PRIu64 " %s  ", numbers[i], words[i]);
        }
    }
    if (x == begin) {
        (void)monitor_view_put(view, y, x, STYLE_DIM, "nothing else");
    }
}

static monitor_style_t style_of_level(monitor_level_t level) {
    static const monitor_style_t styles[] = {[MONITOR_QUIET] = STYLE_PLAIN,
                                             [MONITOR_GOOD] = STYLE_GOOD,
                                             [MONITOR_WARN] = STYLE_WARN,
                                             [MONITOR_BAD] = STYLE_BAD};
    return styles[level];
}

static void draw_log_title(monitor_view_t *view, int y, const monitor_page_t *page) {
    const int x = label(view, y, "transitions");
    if (page->scrolled > 0) {
        (void)monitor_view_print(view, y, x, STYLE_WARN, "%zu newer below", page->scrolled);
    }
}

static void draw_log(monitor_view_t *view, int y, const monitor_t *monitor, const monitor_page_t *page) {
    const int lines = view->height - 1 - y;
    const size_t length = monitor_log_length(&monitor->log);
    const size_t left = (length > page->scrolled) ? length - page->scrolled : 0;
    const int shown = (left < (size_t)((lines > 0) ? lines : 0)) ? (int)left : lines;
    for (int i = 0; i < shown; i++) {
        const monitor_entry_t *entry = monitor_log_back(&monitor->log, page->scrolled + (size_t)(shown - 1 - i));
        (void)monitor_view_print(view, y + i, 0, STYLE_DIM, "%7" PRIu64 ".%03" PRIu64, entry->t_us / US_PER_S,
                                 (entry->t_us % US_PER_S) / US_PER_MS);
        (void)monitor_view_put(view, y + i, LABEL + 1, STYLE_PLAIN, entry->who);
        (void)monitor_view_put(view, y + i, LABEL + LABEL, style_of_level(entry->level), entry->text);
    }
}

static int key(monitor_view_t *view, int x, const char *name, const char *does) {
    const int y = view->height - 1;
    x = monitor_view_print(view, y, x, STYLE_BAR, " %s ", name);
    return monitor_view_print(view, y, x, STYLE_PLAIN, " %s  ", does);
}

static void draw_keys(monitor_view_t *view, const monitor_page_t *page) {
    const int y = view->height - 1;
    if (page->is_typing) {
        (void)monitor_view_print(view, y, 0, STYLE_BOLD, ": %s_", page->typed);
        return;
    }
    int x = key(view, 0, "space", page->is_paused ? "go on" : "pause");
    x = key(view, x, "r", "reset gaps");
    if (page->is_log) {
        x = key(view, x, "+ -", "speed");
    } else {
        x = key(view, x, "c", (page->recording != NULL) ? "end recording" : "record");
    }
    x = page->can_type ? key(view, x, ":", "type") : x;
    x = key(view, x, "h", page->shows_help ? "back" : "help");
    (void)key(view, x, "q", "quit");
}

int monitor_page_log_lines(const monitor_t *monitor, int height) {
    const int lines = height - (int)LINES_BESIDES - (int)monitor->row_count - (is_roomy(monitor, height) ? 2 : 0);
    return (lines > 0) ? lines : 0;
}

void monitor_page_draw(monitor_view_t *view, const monitor_t *monitor, const monitor_page_t *page) {
    if ((view->width < LEAST_WIDTH) || (view->height < LEAST_HEIGHT)) {
        (void)monitor_view_put(view, 0, 0, STYLE_WARN, "too small");
        return;
    }
    int y = 1;
    draw_header(view, monitor, page);
    if (page->shows_help) {
        monitor_help_draw(view, 2);
    } else {
        draw_supervisor(view, y, monitor);
        draw_vehicle(view, y + 1, monitor);
        draw_alarms(view, y + 2, monitor);
        const bool roomy = is_roomy(monitor, view->height);
        y = monitor_table_draw(view, (int)LINES_ABOVE_TABLE + (roomy ? 1 : 0), monitor);
        draw_others(view, y, monitor);
        if (roomy) {
            y++;
            draw_log_title(view, y, page);
        }
        draw_log(view, y + 1, monitor, page);
    }
    monitor_view_fill(view, view->height - 1, STYLE_PLAIN);
    draw_keys(view, page);
}
