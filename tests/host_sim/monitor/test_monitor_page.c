/* What the screen shows, as lines of text. */
#include <limits.h>
#include <locale.h>
#include <stdlib.h>
#include <uchar.h>

#include "monitor/monitor_page.h"
#include "monitor_fixture.h"

static monitor_view_t *view;
static monitor_page_t page;

void setUp(void) {
    TEST_ASSERT_NOT_NULL(setlocale(LC_CTYPE, "C.UTF-8"));
    agv_config_defaults(&settings);
    view = calloc(1, sizeof *view);
    page = (monitor_page_t){.title = "monitor"};
    begin(false, false);
}

void tearDown(void) {
    end();
    free(view);
}

static void draw(int width, int height) {
    monitor_view_clear(view, width, height);
    monitor_page_draw(view, monitor, &page);
}

/* A line in UTF-8 without the blanks at its end; is overwritten by the next call. */
static const char *line(int y) {
    static char text[MB_LEN_MAX * MONITOR_VIEW_WIDTH_MAX + 1];
    mbstate_t state = {0};
    size_t used = 0;
    size_t end = 0;
    for (int x = 0; (y < view->height) && (x < view->width); x++) {
        used += c32rtomb(&text[used], view->cells[y][x].character, &state);
        end = (view->cells[y][x].character != ' ') ? used : end;
    }
    text[end] = '\0';
    return text;
}

/* The first line that contains a text; -1: there is none. */
static int find(const char *text) {
    for (int y = 0; y < view->height; y++) {
        if (strstr(line(y), text) != NULL) {
            return y;
        }
    }
    return -1;
}

void test_the_empty_page(void) {
    draw(80, 24);
    TEST_ASSERT_EQUAL_STRING(" host_sim monitor  can0                                     0 frames/s  0:00:00",
                             line(0));
    TEST_ASSERT_EQUAL_STRING("supervisor  waiting for its status frame", line(1));
    TEST_ASSERT_EQUAL_STRING("vehicle     nothing received yet", line(2));
    TEST_ASSERT_EQUAL_STRING("alarms      none", line(3));
    TEST_ASSERT_EQUAL_STRING("ID   message               age deadline gap min/max cnt signals", line(5));
    TEST_ASSERT_EQUAL_STRING("43Fh turn_signal_command     - ········     -     -     never received", line(6));
    TEST_ASSERT_EQUAL(STYLE_DIM, view->cells[6][0].style);
    TEST_ASSERT_EQUAL_STRING("also seen   nothing else", line(17));
    TEST_ASSERT_EQUAL_STRING("transitions", line(18));
    TEST_ASSERT_NOT_EQUAL(-1, find("quit"));
}

void test_a_row_with_its_bar(void) {
    frame(VEHICLE, 100, 0x0A3, "0100000000000000");
    frame(VEHICLE, 125, 0x0A3, "0100000000000000");
    draw(80, 24);
    /* the deadline is 125 ms: 25 ms is a fifth of 64 eighths, 12.8 */
    TEST_ASSERT_EQUAL_STRING("0A3h gear_status          25.0 █▌······  25.0  25.0     D", line(11));
    TEST_ASSERT_EQUAL(STYLE_GOOD, view->cells[11][31].style);
    draw(100, 24);
    TEST_ASSERT_EQUAL_STRING("0A3h gear_status          25.0 █▌······   125  25.0  25.0     gear D", line(11));
    draw(160, 24);
    TEST_ASSERT_NOT_NULL(strstr(line(11), "0100000000000000 gear D"));
}

void test_a_row_near_its_deadline_and_a_late_one(void) {
    frame(VEHICLE, 100, 0x0A3, "0100000000000000");
    wait_until(200);
    draw(80, 24);
    TEST_ASSERT_EQUAL(STYLE_WARN, view->cells[11][31].style);
    TEST_ASSERT_EQUAL(STYLE_PLAIN, view->cells[11][0].style);
    wait_until(300);
    draw(80, 24);
    TEST_ASSERT_EQUAL_STRING("0A3h gear_status           200 ████████     -     -     LATE D", line(11));
    TEST_ASSERT_EQUAL(STYLE_BAD, view->cells[11][0].style);
    TEST_ASSERT_EQUAL(STYLE_BAD, view->cells[11][31].style);
}

/* Shows: SUP-3 */
void test_a_command_that_is_silent_in_manual_is_grey(void) {
    frame(VEHICLE, 100, 0x43F, "0000000000000000");
    frame(VEHICLE, 100, 0x168, "0800000000000000");
    wait_until(1000);
    frame(VEHICLE, 1010, 0x168, "0800000000000000");
    wait_until(1500);
    draw(80, 24);
    TEST_ASSERT_EQUAL_STRING("168h gear_command          910 ████████   910   910     silent P", line(7));
    TEST_ASSERT_EQUAL(STYLE_DIM, view->cells[7][0].style);
    TEST_ASSERT_EQUAL(STYLE_DIM, view->cells[7][31].style);
    TEST_ASSERT_EQUAL(STYLE_DIM, view->cells[7][48].style); /* the longest gap */
    TEST_ASSERT_EQUAL(STYLE_WARN, view->cells[6][0].style);
    TEST_ASSERT_NOT_NULL(strstr(line(6), "silent"));
}

void test_signals_and_alarms(void) {
    frame(VEHICLE, 100, 0x363, "B004000001009007"); /* 1200 m/h, remote signal lost, left turn signal, autopilot */
    frame(VEHICLE, 101, 0x065, "E02E000000000000"); /* 12000 - 9000 = 300.0 deg */
    draw(160, 30);
    TEST_ASSERT_NOT_NULL(strstr(line(10), "speed 1200 m/h  REMOTE_SIGNAL_LOST  turn_left  mode autopilot"));
    TEST_ASSERT_NOT_NULL(strstr(line(9), "angle 300.0 deg"));
    draw(80, 24);
    TEST_ASSERT_EQUAL_STRING("alarms      REMOTE_SIGNAL_LOST (LED 17)", line(3));
    TEST_ASSERT_EQUAL_STRING("vehicle     autopilot", line(2));
}

void test_the_supervisor_in_words(void) {
    frame(VEHICLE, 100, 0x7F0, "55FF010000000000");
    char data[17];
    (void)snprintf(data, sizeof data, "55%02X010000000000", (unsigned)AGV_FAULT_EPS_OVER_VOLTAGE);
    frame(VEHICLE, 200, 0x7F0, data);
    draw(80, 24);
    TEST_ASSERT_EQUAL_STRING("supervisor  TRIPPED: EPS_OVER_VOLTAGE  LED code 13  output closed", line(1));
    TEST_ASSERT_EQUAL(STYLE_BAD, view->cells[1][12].style);
    draw(120, 24);
    TEST_ASSERT_NOT_NULL(strstr(line(1), "status frame 7F0h"));
}

void test_a_gateway_has_room_on_80_by_24(void) {
    end();
    begin(true, false);
    frame(AI, 10, 0x168, "0100000000000000");
    draw(80, 24);
    TEST_ASSERT_EQUAL(0, strncmp(line(4), "bus ID   message", 16));
    TEST_ASSERT_EQUAL(0, strncmp(line(6), "ai  168h gear_command ", 22));
    TEST_ASSERT_EQUAL(0, strncmp(line(9), "veh 43Fh turn_signal_command ", 29));
    TEST_ASSERT_EQUAL(20, find("also seen"));
    TEST_ASSERT_EQUAL(2, monitor_page_log_lines(monitor, 24));
    frame(AI, 20, 0x168, "0800000000000000");
    draw(80, 24);
    TEST_ASSERT_EQUAL(21, find("168h gear: D -> P"));
    TEST_ASSERT_NOT_EQUAL(-1, find("quit"));
}

void test_the_log_and_its_scrolling(void) {
    char text[20];
    for (unsigned i = 1; i <= 20; i++) {
        (void)snprintf(text, sizeof text, "entry %u.", i);
        monitor_note(monitor, MONITOR_QUIET, "test", text);
    }
    TEST_ASSERT_EQUAL(4, monitor_page_log_lines(monitor, 24));
    draw(80, 24);
    TEST_ASSERT_EQUAL_STRING("      0.000  test       entry 17.", line(19));
    TEST_ASSERT_EQUAL_STRING("      0.000  test       entry 20.", line(22));
    page.scrolled = 10;
    draw(80, 24);
    TEST_ASSERT_EQUAL_STRING("      0.000  test       entry 10.", line(22));
    TEST_ASSERT_EQUAL_STRING("transitions 10 newer below", line(18));
    draw(80, 40);
    TEST_ASSERT_EQUAL(-1, find("entry 11."));
    TEST_ASSERT_NOT_EQUAL(-1, find("entry 1."));
}

void test_the_header_says_what_the_program_does(void) {
    page.is_paused = true;
    page.recording = "/tmp/x/monitor-1.log";
    monitor->is_down[HAL_CAN_VEHICLE] = true;
    draw(80, 24);
    TEST_ASSERT_NOT_NULL(strstr(line(0), "can0 DOWN  PAUSED  REC monitor-1.log"));
    page = (monitor_page_t){.title = "monitor", .input = "a/b/drive.log", .is_log = true, .speed = 4.0};
    draw(80, 24);
    TEST_ASSERT_NOT_NULL(strstr(line(0), " host_sim monitor  drive.log  x4 "));
    page.has_ended = true;
    draw(80, 24);
    TEST_ASSERT_NOT_NULL(strstr(line(0), " drive.log  END "));
}

void test_any_size_is_drawn(void) {
    for (int width = 0; width <= 340; width += 17) {
        for (int height = 0; height <= 130; height += 5) {
            draw(width, height);
            page.shows_help = !page.shows_help;
        }
    }
    draw(20, 5);
    TEST_ASSERT_EQUAL_STRING("too small", line(0));
}

void test_help_fits_80_by_24(void) {
    page.shows_help = true;
    draw(80, 24);
    for (int y = 0; y < 24; y++) {
        TEST_ASSERT_EQUAL_MESSAGE((uint32_t)' ', view->cells[y][79].character, line(y));
    }
    TEST_ASSERT_EQUAL(18, find("quit"));
}

void test_text_of_the_bus_cannot_leave_its_cell(void) {
    monitor_note(monitor, MONITOR_QUIET, "t\033[2Jx", "a\tb\033[31mred\x9b\xc3");
    draw(80, 24);
    TEST_ASSERT_NOT_EQUAL(-1, find("t?[2Jx"));
    TEST_ASSERT_NOT_EQUAL(-1, find("a?b?[31mred"));
}
