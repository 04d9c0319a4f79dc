/* The page as a file: what names and texts from outside may not do to it, and its frame. */
#include "report/report_page.h"

#include <stdlib.h>
#include <string.h>

#include "agv/recorder.h"
#include "agv/state.h"
#include "scratch.h"
#include "unity.h"

static agv_config_t config;
static report_page_t page;
static output_t *output;
static why_t *why;
static series_t *series;

void setUp(void) {
    scratch_open();
    agv_config_defaults(&config);
    page = (report_page_t){.name = "my.log", .config = &config};
    output = calloc(1, sizeof *output);
    why = why_new(&config);
    series = series_new(&config);
    TEST_ASSERT_TRUE(output_open(output, scratch_path("page.html")));
}

void tearDown(void) {
    output_discard(output);
    free(output);
    why_free(why);
    series_free(series);
}

static const char *text(void) {
    why_end(why, 1000000);
    series_end(series, 1000000);
    report_page_write(output, &page, why, series);
    TEST_ASSERT_TRUE(output_commit(output));
    return scratch_read("page.html");
}

static void has(const char *page_text, const char *part) {
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(page_text, part), part);
}

static void has_not(const char *page_text, const char *part) {
    TEST_ASSERT_NULL_MESSAGE(strstr(page_text, part), part);
}

void test_the_sentence_stands_in_the_page_without_scripts(void) {
    const char *written = text();
    has(written, "<!doctype html>");
    has(written, "<title>Nothing was supervised: the supervisor never left INIT.</title>");
    has(written, "<h1 id=\"headline\">Nothing was supervised: the supervisor never left INIT.</h1>");
    has(written, "\"name\":\"my.log\"");
    has(written, "</html>");
    has_not(written, "@TITLE@");
    has_not(written, "@JS@");
}

void test_the_page_names_no_other_address(void) {
    const char *written = text();
    has(written, "default-src 'none'");
    has_not(written, "https://");
    has_not(written, "src=\"");
    has_not(written, "@import");
}

void test_a_name_cannot_end_the_data(void) {
    page.name = "</script><script>alert(1)</script>.log";
    const char *written = text();
    has_not(written, "alert(1)</script>");
    has(written, "\\u003c/script>\\u003cscript>alert(1)");
}

void test_a_name_that_is_no_utf_8_leaves_a_page(void) {
    page.name = "log\xFF.asc";
    has(text(), "\"name\":\"log?.asc\"");
}

void test_settings_that_differ_stand_in_it(void) {
    config.steering_command_timeout_ms = 300;
    config.park = AGV_PARK_AT_STANDSTILL;
    agv_fault_set_put(&config.trips, AGV_FAULT_S_DRIVER_ALARM, false);
    const char *written = text();
    has(written, "\"name\":\"steering_command_timeout_ms\",\"value\":\"300\",\"preset\":\"125\",\"unit\":\"ms\"");
    has(written, "\"name\":\"park\",\"value\":\"at_standstill\",\"preset\":\"at_once\"");
    has(written, "\"name\":\"class_s_driver_alarm\",\"value\":\"warn\",\"preset\":\"trip\"");
    has_not(written, "gear_command_timeout_ms");
}

void test_the_frames_of_a_trip_are_decoded(void) {
    const hal_can_frame_t frame = {.id = 0x0A3, .length = 8, .data = {8}};
    const session_event_t trip = {.t_ms = 500,
                                  .recorded = {.kind = AGV_EVENT_STATE,
                                               .a = (uint8_t)AGV_STATE_ACTIVE,
                                               .b = (uint8_t)AGV_STATE_TRIPPED,
                                               .c = (uint8_t)AGV_FAULT_GEAR_STATUS_TIMEOUT}};
    why_frame(why, HAL_CAN_VEHICLE, &frame, 300000);
    series_frame(series, HAL_CAN_VEHICLE, &frame, 300000);
    why_event(why, &trip);
    series_event(series, &trip);
    has(text(), "[300000,0,false,\"0A3\",\"08 00 00 00 00 00 00 00\",\"gear_status\",\"gear P\",true]");
}

void test_a_failure_to_write_is_kept(void) {
    output_t *full = calloc(1, sizeof *full);
    TEST_ASSERT_TRUE(output_open(full, "/dev/full"));
    report_page_write(full, &page, why, series);
    (void)output_flush(full);
    TEST_ASSERT_NOT_EQUAL(0, full->error);
    output_discard(full);
    free(full);
}
