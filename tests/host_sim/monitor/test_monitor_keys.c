/* The keys, without a terminal. */
#include <stdlib.h>

#include "monitor/monitor_screen.h"
#include "monitor/monitor_ui.h"
#include "monitor_fixture.h"

static monitor_ui_t *ui;

void setUp(void) {
    agv_config_defaults(&settings);
    begin(false, false);
    ui = calloc(1, sizeof *ui);
    ui->monitor = monitor;
    ui->log_lines = 4;
}

void tearDown(void) {
    free(ui->held);
    free(ui);
    end();
}

static void press(const char *keys) {
    for (; *keys != '\0'; keys++) {
        monitor_ui_key(ui, *keys);
    }
}

void test_quit(void) {
    TEST_ASSERT_FALSE(ui->wish.quits);
    press("q");
    TEST_ASSERT_TRUE(ui->wish.quits);
}

void test_a_held_picture_stays_while_the_bus_goes_on(void) {
    frame(VEHICLE, 10, 0x168, "0800000000000000");
    press(" ");
    TEST_ASSERT_TRUE(monitor_ui_is_paused(ui));
    frame(VEHICLE, 20, 0x168, "0800000000000000");
    TEST_ASSERT_EQUAL(1, ui->held->rows[1].count);
    TEST_ASSERT_EQUAL(2, monitor->rows[1].count);
    press("p");
    TEST_ASSERT_FALSE(monitor_ui_is_paused(ui));
    TEST_ASSERT_NULL(ui->held);
}

void test_reset_of_the_gaps(void) {
    frame(VEHICLE, 10, 0x168, "0800000000000000");
    frame(VEHICLE, 20, 0x168, "0800000000000000");
    press("r");
    TEST_ASSERT_EQUAL(MONITOR_NO_GAP, monitor->rows[1].gap_min_us);
}

void test_recording_is_for_a_bus_only(void) {
    press("c");
    TEST_ASSERT_TRUE(ui->wish.toggles_recording);
    ui->wish.toggles_recording = false;
    ui->page.is_log = true;
    press("c");
    TEST_ASSERT_FALSE(ui->wish.toggles_recording);
}

void test_speed(void) {
    press("++-+");
    TEST_ASSERT_EQUAL(2, ui->wish.faster);
}

void test_help_and_back(void) {
    press("h");
    TEST_ASSERT_TRUE(ui->page.shows_help);
    monitor_ui_key(ui, MONITOR_KEY_ESCAPE);
    TEST_ASSERT_FALSE(ui->page.shows_help);
    press("??");
    TEST_ASSERT_FALSE(ui->page.shows_help);
}

void test_scrolling_ends_at_both_ends(void) {
    for (int i = 0; i < 10; i++) {
        monitor_note(monitor, MONITOR_QUIET, "test", "entry");
    }
    monitor_ui_key(ui, MONITOR_KEY_DOWN);
    TEST_ASSERT_EQUAL(0, ui->page.scrolled);
    monitor_ui_key(ui, MONITOR_KEY_UP);
    TEST_ASSERT_EQUAL(1, ui->page.scrolled);
    monitor_ui_key(ui, MONITOR_KEY_PAGE_UP);
    TEST_ASSERT_EQUAL(4, ui->page.scrolled);
    monitor_ui_key(ui, MONITOR_KEY_HOME);
    TEST_ASSERT_EQUAL(6, ui->page.scrolled); /* 10 entries, 4 are shown */
    monitor_ui_key(ui, MONITOR_KEY_END);
    TEST_ASSERT_EQUAL(0, ui->page.scrolled);
}

void test_typing_only_where_a_program_takes_it(void) {
    press(":q");
    TEST_ASSERT_TRUE(ui->wish.quits);
    ui->wish.quits = false;
    ui->page.can_type = true;
    press(":ai stoq");
    monitor_ui_key(ui, MONITOR_KEY_BACKSPACE);
    press("p");
    TEST_ASSERT_FALSE(ui->wish.has_typed);
    monitor_ui_key(ui, MONITOR_KEY_ENTER);
    TEST_ASSERT_TRUE(ui->wish.has_typed);
    TEST_ASSERT_EQUAL_STRING("ai stop", ui->page.typed);
    TEST_ASSERT_FALSE(ui->wish.quits);
    monitor_ui_typed_done(ui);
    press(":x");
    monitor_ui_key(ui, MONITOR_KEY_ESCAPE);
    TEST_ASSERT_FALSE(ui->wish.has_typed);
    TEST_ASSERT_EQUAL_STRING("", ui->page.typed);
}

void test_a_long_line_is_cut(void) {
    ui->page.can_type = true;
    press(":");
    for (int i = 0; i < 500; i++) {
        press("x");
    }
    TEST_ASSERT_EQUAL(MONITOR_TYPED_SIZE - 1, strlen(ui->page.typed));
}
