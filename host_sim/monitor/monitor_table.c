/* The table of messages: columns, of which a wider screen shows more. */
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "agv/names.h"
#include "monitor/monitor_page.h"
#include "text/units.h"

enum { CELL_SIZE = 32, NAMES_FROM_WIDTH = 100, MS_WITH_DECIMAL = 100, WIDE = 120, WIDER = 140 };

/** Draws one cell of the table. */
typedef void column_fn(monitor_view_t *view, int y, int x, const monitor_t *monitor, const monitor_row_t *row,
                       monitor_style_t style);

/** A column. */
typedef struct {
    const char *title;
    int width;
    bool is_right;  /* the title */
    int from_width; /* of the screen */
    bool gateway_only;
    column_fn *draw;
} column_t;

static void right(monitor_view_t *view, int y, int x, int width, monitor_style_t style, const char *text) {
    (void)monitor_view_put(view, y, x + width - (int)strlen(text), style, text);
}

/** A time in milliseconds: "9.8", "104", "12.3 s". */
static void write_ms(char text[CELL_SIZE], uint64_t us) {
    const uint64_t tenths = us / (US_PER_MS / 10);
    if (us < (uint64_t)MS_WITH_DECIMAL * US_PER_MS) {
        (void)snprintf(text, CELL_SIZE, "%" PRIu64 ".%" PRIu64, tenths / 10, tenths % 10);
    } else if (us < 10 * (uint64_t)US_PER_S) {
        (void)snprintf(text, CELL_SIZE, "%" PRIu64, us / US_PER_MS);
    } else {
        (void)snprintf(text, CELL_SIZE, "%" PRIu64 "s", us / US_PER_S);
    }
}

enum {
    SIDE_WIDTH = 3,
    ID_WIDTH = 4,
    NAME_WIDTH = 19,
    AGE_WIDTH = 5,
    BAR_WIDTH = 8,
    GAP_WIDTH = 5,
    RATE_WIDTH = 5,
    COUNT_WIDTH = 9,
    COUNTER_WIDTH = 3,
    DATA_WIDTH = 16,
    LIMIT_WIDTH = 5
};

static void draw_side(monitor_view_t *view, int y, int x, const monitor_t *monitor, const monitor_row_t *row,
                      monitor_style_t style) {
    (void)monitor;
    (void)monitor_view_put(view, y, x, style, (row->side == HAL_CAN_AI) ? "ai" : "veh");
}

static void draw_id(monitor_view_t *view, int y, int x, const monitor_t *monitor, const monitor_row_t *row,
                    monitor_style_t style) {
    (void)monitor;
    (void)monitor_view_print(view, y, x, style, "%03Xh", (unsigned)row->id);
}

static void draw_name(monitor_view_t *view, int y, int x, const monitor_t *monitor, const monitor_row_t *row,
                      monitor_style_t style) {
    (void)monitor;
    (void)monitor_view_put(view, y, x, style, agv_message_name((agv_message_t)row->message));
}

static void draw_age(monitor_view_t *view, int y, int x, const monitor_t *monitor, const monitor_row_t *row,
                     monitor_style_t style) {
    char text[CELL_SIZE] = "-";
    if (row->count > 0) {
        write_ms(text, monitor_age_us(monitor, row));
    }
    right(view, y, x, AGE_WIDTH, style, text);
}

static void draw_bar(monitor_view_t *view, int y, int x, const monitor_t *monitor, const monitor_row_t *row,
                     monitor_style_t style) {
    const uint64_t age_us = monitor_age_us(monitor, row);
    const bool is_long = (age_us * 4 > (uint64_t)row->deadline_us * 3);
    const monitor_style_t filled = (style != STYLE_PLAIN) ? style : (is_long ? STYLE_WARN : STYLE_GOOD);
    monitor_view_bar(view, y, x, BAR_WIDTH, filled, age_us, row->deadline_us);
}

static void draw_limit(monitor_view_t *view, int y, int x, const monitor_t *monitor, const monitor_row_t *row,
                       monitor_style_t style) {
    char text[CELL_SIZE];
    (void)monitor;
    (void)snprintf(text, sizeof text, "%" PRIu32, row->deadline_us / US_PER_MS);
    right(view, y, x, LIMIT_WIDTH, (style == STYLE_BAD) ? style : STYLE_DIM, text);
}

static void draw_gap_min(monitor_view_t *view, int y, int x, const monitor_t *monitor, const monitor_row_t *row,
                         monitor_style_t style) {
    char text[CELL_SIZE] = "-";
    (void)monitor;
    if (row->gap_min_us != MONITOR_NO_GAP) {
        write_ms(text, row->gap_min_us);
    }
    right(view, y, x, GAP_WIDTH, style, text);
}

static void draw_gap_max(monitor_view_t *view, int y, int x, const monitor_t *monitor, const monitor_row_t *row,
                         monitor_style_t style) {
    char text[CELL_SIZE] = "-";
    (void)monitor;
    if (row->gap_min_us != MONITOR_NO_GAP) {
        write_ms(text, row->gap_max_us);
    }
    right(view, y, x, GAP_WIDTH, row->has_been_late ? STYLE_BAD : style, text);
}

static void draw_rate(monitor_view_t *view, int y, int x, const monitor_t *monitor, const monitor_row_t *row,
                      monitor_style_t style) {
    char text[CELL_SIZE];
    (void)snprintf(text, sizeof text, "%" PRIu64, monitor_rate(monitor, row->count, row->counts));
    right(view, y, x, RATE_WIDTH, style, text);
}

static void draw_count(monitor_view_t *view, int y, int x, const monitor_t *monitor, const monitor_row_t *row,
                       monitor_style_t style) {
    char text[CELL_SIZE];
    (void)monitor;
    (void)snprintf(text, sizeof text, "%" PRIu64, row->count);
    right(view, y, x, COUNT_WIDTH, style, text);
}

static void draw_counter(monitor_view_t *view, int y, int x, const monitor_t *monitor, const monitor_row_t *row,
                         monitor_style_t style) {
    char text[CELL_SIZE] = "";
    (void)monitor;
    if (row->has_counter && (row->count > 0)) {
        (void)snprintf(text, sizeof text, "%u", (unsigned)row->counter.value);
    }
    right(view, y, x, COUNTER_WIDTH, row->is_stuck ? STYLE_BAD : style, text);
}

static void draw_data(monitor_view_t *view, int y, int x, const monitor_t *monitor, const monitor_row_t *row,
                      monitor_style_t style) {
    (void)monitor;
    for (int i = 0; (row->count > 0) && (i < (int)AGV_DLC); i++) {
        x = monitor_view_print(view, y, x, (style == STYLE_PLAIN) ? STYLE_DIM : style, "%02X", (unsigned)row->data[i]);
    }
}

/** Whether a signal is worth its place: flags and alarms while they are set; the counter has a column. */
static bool is_shown(const signal_info_t *info, const signal_value_t *value) {
    if (info->kind == SIGNAL_COUNTER) {
        return false;
    }
    return (info->kind == SIGNAL_NUMBER) || (info->kind == SIGNAL_CHOICE) || (value->raw != 0);
}

static int draw_signal(monitor_view_t *view, int y, int x, const signal_info_t *info, const signal_value_t *value,
                       monitor_style_t style) {
    char text[SIGNALS_VALUE_SIZE];
    const bool is_named = view->width >= NAMES_FROM_WIDTH;
    const bool is_bad = !value->valid || (info->kind == SIGNAL_ALARM);
    const monitor_style_t mine = is_bad ? STYLE_BAD : style;
    if ((info->kind == SIGNAL_ALARM) || ((info->kind == SIGNAL_FLAG) && (strcmp(value->word, "off") != 0))) {
        return monitor_view_put(view, y, x, mine, info->name);
    }
    signals_value_text(text, info, value);
    if (is_named || (info->kind == SIGNAL_FLAG)) {
        x = monitor_view_print(view, y, x, (style == STYLE_PLAIN) ? STYLE_DIM : style, "%s ", info->name);
    }
    return monitor_view_put(view, y, x, mine, text);
}

static void draw_signals(monitor_view_t *view, int y, int x, const monitor_t *monitor, const monitor_row_t *row,
                         monitor_style_t style) {
    (void)monitor;
    signal_value_t value;
    if (row->count == 0) {
        (void)monitor_view_put(view, y, x, style, "never received");
        return;
    }
    if (monitor_is_late(row)) {
        x = monitor_view_put(view, y, x, STYLE_BAD, "LATE ");
    } else if (row->is_stuck) {
        x = monitor_view_put(view, y, x, STYLE_BAD, "STUCK ");
    } else if (row->is_silent) {
        x = monitor_view_put(view, y, x, style, "silent ");
    } else {
        /* as it should be */
    }
    bool is_first = true;
    for (size_t i = 0; signals_read(row->message, i, row->data, &value); i++) {
        const signal_info_t *info = signals_info(row->message, i);
        if (is_shown(info, &value)) {
            x = is_first ? x : monitor_view_put(view, y, x, STYLE_PLAIN, "  ");
            x = draw_signal(view, y, x, info, &value, style);
            is_first = false;
        }
    }
}

static const column_t columns[] = {
    {"bus", SIDE_WIDTH, false, 0, true, draw_side},
    {"ID", ID_WIDTH, false, 0, false, draw_id},
    {"message", NAME_WIDTH, false, 0, false, draw_name},
    {"age", AGE_WIDTH, true, 0, false, draw_age},
    {"deadline", BAR_WIDTH, false, 0, false, draw_bar},
    {"limit", LIMIT_WIDTH, true, NAMES_FROM_WIDTH, false, draw_limit},
    {"", GAP_WIDTH, true, 0, false, draw_gap_min},
    {"gap min/max", GAP_WIDTH, true, 0, false, draw_gap_max},
    {"per s", RATE_WIDTH, true, WIDE, false, draw_rate},
    {"frames", COUNT_WIDTH, true, WIDER, false, draw_count},
    {"cnt", COUNTER_WIDTH, true, 0, false, draw_counter},
    {"data", DATA_WIDTH, false, WIDER, false, draw_data},
    {"signals", 0, false, 0, false, draw_signals},
};

static bool has_column(const monitor_view_t *view, const monitor_t *monitor, const column_t *column) {
    return (view->width >= column->from_width) && (!column->gateway_only || monitor->given.is_gateway);
}

static void draw_titles(monitor_view_t *view, int y, const monitor_t *monitor) {
    int x = 0;
    for (size_t c = 0; c < sizeof columns / sizeof columns[0]; c++) {
        const column_t *column = &columns[c];
        if (has_column(view, monitor, column)) {
            const int blank = column->is_right ? column->width - (int)strlen(column->title) : 0;
            (void)monitor_view_put(view, y, x + blank, STYLE_BOLD, column->title);
            x += column->width + 1;
        }
    }
}

/** Red: late or stuck. Grey: never heard, or silent while no deadline counts; yellow where that is a warning (43Fh). */
static monitor_style_t style_of(const monitor_row_t *row) {
    if (monitor_is_late(row) || row->is_stuck) {
        return STYLE_BAD;
    }
    if (row->is_silent && row->has_counter) {
        return STYLE_WARN;
    }
    return ((row->count == 0) || row->is_silent) ? STYLE_DIM : STYLE_PLAIN;
}

static void draw_row(monitor_view_t *view, int y, const monitor_t *monitor, const monitor_row_t *row) {
    const monitor_style_t style = style_of(row);
    int x = 0;
    for (size_t c = 0; c < sizeof columns / sizeof columns[0]; c++) {
        if (has_column(view, monitor, &columns[c])) {
            columns[c].draw(view, y, x, monitor, row, style);
            x += columns[c].width + 1;
        }
    }
}

int monitor_table_draw(monitor_view_t *view, int y, const monitor_t *monitor) {
    draw_titles(view, y, monitor);
    for (size_t i = 0; i < monitor->row_count; i++) {
        y++;
        draw_row(view, y, monitor, &monitor->rows[i]);
    }
    return y + 1;
}
