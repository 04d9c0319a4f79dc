/* The commands of the shell: what they print, and that they take no arguments (HW-5). */
#include <string.h>

#include <zephyr/shell/shell.h>
#include <zephyr/shell/shell_dummy.h>
#include <zephyr/ztest.h>

#include "fake_parts.h"
#include "supervise.h"
#include "vehicle.h"

static ZEPHYR_HAL_RETAINED agv_recorder_t recorder;
static ZEPHYR_HAL_RETAINED zephyr_hal_retained_t retained;
supervise_t agv_supervise;

static void supervise(void) {
    supervise_start(&agv_supervise, &recorder, &retained);
    for (;;) {
        supervise_once(&agv_supervise);
    }
}

K_THREAD_DEFINE(supervisor, 2048, supervise, NULL, NULL, NULL, K_PRIO_COOP(2), 0, SYS_FOREVER_MS);

static void *setup(void) {
    fake_parts_reset();
    fake_buses[HAL_CAN_VEHICLE].sends_at_once = true;
    vehicle = (vehicle_t){.park = true, .ai_is_silent = true};
    k_thread_start(supervisor);
    vehicle_run(5000u); /* STANDBY at standstill: events are copied to flash */
    return NULL;
}

static void before(void *unused) {
    ARG_UNUSED(unused);
    fake_parts_connect();
    vehicle_run(2u);
}

ZTEST_SUITE(shell_commands, NULL, setup, before, NULL, NULL);

/* @return what the command printed */
static const char *type(const char *command, int expected) {
    size_t size = 0u;
    const struct shell *const shell = shell_backend_dummy_get_ptr();
    shell_backend_dummy_clear_output(shell);
    const int status = shell_execute_cmd(shell, command);
    zassert_equal(status, expected, "%s: %d", command, status);
    return shell_backend_dummy_get_output(shell, &size);
}

static void assert_has(const char *printed, const char *text) {
    zassert_not_null(strstr(printed, text), "no \"%s\" in: %s", text, printed);
}

/* Shows: HW-5 */
ZTEST(shell_commands, test_arguments_are_refused) {
    static const char *const commands[] = {"agv status x",   "agv faults x",  "agv log x",  "agv dump x",
                                           "agv messages x", "agv version x", "agv format", "agv nothing"};
    for (size_t i = 0u; i < ARRAY_SIZE(commands); i++) {
        const struct shell *const shell = shell_backend_dummy_get_ptr();
        zassert_true(shell_execute_cmd(shell, commands[i]) != 0, "%s", commands[i]);
    }
}

ZTEST(shell_commands, test_state_and_log) {
    const char *const printed = type("agv status", 0);
    assert_has(printed, "state STANDBY, first reason -, safety output closed");
    assert_has(printed, "log in flash: on");
}

ZTEST(shell_commands, test_without_a_fault_it_says_none) {
    assert_has(type("agv faults", 0), "none");
}

/* Shows: HW-4, HW-6 */
ZTEST(shell_commands, test_the_version_says_what_the_board_lacks) {
    const char *const printed = type("agv version", 0);
    assert_has(printed, "test+");
    assert_has(printed, ", configuration ");
    assert_has(printed,
               "without: stack guard, brown-out, memory errors, second clock, output feedback, emergency stop, "
               "reset button");
}

/* Shows: INT-3 */
ZTEST(shell_commands, test_the_log_is_that_of_the_flash_in_the_words_of_the_console) {
    const char *const printed = type("agv log", 0);
    assert_has(printed, "run 0, ");
    assert_has(printed, " ms: => STANDBY");
    assert_has(printed, " ms: safety output closed");
    zassert_is_null(strstr(printed, "0 events from flash"), "%s", printed);
    assert_has(printed, "the last trips:");
    assert_has(strstr(printed, "the last trips:"), "none");
}

/* Shows: INT-3 */
ZTEST(shell_commands, test_with_the_log_off_all_events_come_from_ram) {
    agv_supervise.hal.log = ZEPHYR_HAL_LOG_FOREIGN;
    const char *const printed = type("agv log", 0);
    agv_supervise.hal.log = ZEPHYR_HAL_LOG_READY;
    assert_has(printed, "\n0 events from flash");
    assert_has(printed, " ms: => STANDBY");
}

/* Shows: INT-3 */
ZTEST(shell_commands, test_the_dump_has_the_bytes_of_each_event) {
    const char *line = type("agv dump", 0);
    assert_has(line, "agv-version test+");
    assert_has(line, ", configuration ");
    line = strstr(line, "agv-event ");
    zassert_not_null(line);
    line += strlen("agv-event ");
    zassert_equal(strspn(line, "0123456789abcdef"), 224u);
    zassert_mem_equal(line, "00000000", 8u, "the first event has number 0");
    zassert_mem_equal(&line[16], "01", 2u, "it is a change of the state");
}

/* The last test, because no frame comes during the second that the command takes: the supervisor trips. */
ZTEST(shell_commands, test_without_frames_a_message_has_no_age) {
    assert_has(type("agv messages", 0), "43f turn_signal_command: never received");
}

/* Shows: INT-3 */
ZTEST(shell_commands, test_without_frames_the_trip_is_kept) {
    const char *const trips = strstr(type("agv log", 0), "the last trips:");
    zassert_not_null(trips);
    assert_has(trips, "=> TRIPPED");
}
