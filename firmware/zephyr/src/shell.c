/*
 * agv status, faults, log, dump, messages, version: commands that only read (HW-5). The shell's thread has the lowest
 * priority. It copies what it prints while no other thread can run.
 */
#include <string.h>

#include <zephyr/shell/shell.h>

#include "agv/names.h"
#include "event_text.h"
#include "events.h"
#include "hal_zephyr/zephyr_chip.h"
#include "supervise.h"

extern supervise_t agv_supervise;

static agv_supervisor_t copy;

static const agv_supervisor_t *look(void) {
    k_sched_lock();
    copy = agv_supervise.supervisor;
    k_sched_unlock();
    return &copy;
}

static const char *text(const char *name) {
    return (name != NULL) ? name : "-";
}

static const char *log_text(void) {
    static const char *const texts[] = {[ZEPHYR_HAL_LOG_NONE] = "none on this board",
                                        [ZEPHYR_HAL_LOG_READY] = "on",
                                        [ZEPHYR_HAL_LOG_FAILED] = "off: the flash cannot be used",
                                        [ZEPHYR_HAL_LOG_FOREIGN] = "off: its partition has foreign content",
                                        [ZEPHYR_HAL_LOG_FORMATTING] = "off: it is being formatted"};
    return texts[agv_supervise.hal.log];
}

static int print_status(const struct shell *shell, size_t argc, char **argv) {
    ARG_UNUSED(argc);
    ARG_UNUSED(argv);
    const agv_supervisor_t *const seen = look();
    const zephyr_chip_options_t options = zephyr_chip_options();
    shell_print(shell, "state %s, first reason %s, safety output %s, LED %d",
                text(agv_state_name(agv_supervisor_state(seen))),
                text(agv_fault_name(agv_supervisor_first_reason(seen))),
                agv_supervisor_output_closed(seen) ? "closed" : "open", agv_supervisor_led_code(seen));
    shell_print(shell, "log in flash: %s", log_text());
    if (options.brown_out_level >= 0) {
        shell_print(shell, "brown-out level of the option bytes: %d", options.brown_out_level);
    }
    if (options.ram_parity >= 0) {
        shell_print(shell, "parity of the RAM: %s", (options.ram_parity != 0) ? "checked" : "not checked");
    }
    return 0;
}

/* A failed self-test without a failed part of the port is one of the core. */
static void print_parts(const struct shell *shell) {
    char words[EVENT_TEXT_SIZE];
    const uint32_t failed = agv_supervise.hal.failed;
    event_text_parts((failed != 0u) ? failed : HAL_SELF_TEST_CORE, words, sizeof words);
    shell_print(shell, "failed in the self-test:%s", words);
}

static int print_faults(const struct shell *shell, size_t argc, char **argv) {
    ARG_UNUSED(argc);
    ARG_UNUSED(argv);
    const agv_supervisor_t *const seen = look();
    const agv_fault_set_t trips = agv_supervisor_active_trips(seen);
    uint32_t found = 0u;
    for (uint32_t fault = 0u; fault < (uint32_t)AGV_FAULT_COUNT; fault++) {
        if (agv_supervisor_has_fault(seen, (agv_fault_t)fault)) {
            shell_print(shell, "%s (%s)", text(agv_fault_name((agv_fault_t)fault)),
                        agv_fault_is_in(&trips, fault) ? "trip" : "warn");
            found++;
        }
    }
    if (agv_supervisor_has_fault(seen, AGV_FAULT_SELF_TEST_FAILED)) {
        print_parts(shell);
    }
    if (found == 0u) {
        shell_print(shell, "none");
    }
    return 0;
}

typedef void print_event_fn(const struct shell *shell, const agv_event_t *event);

/* @return the number of events that were printed */
static uint32_t print_flash(const struct shell *shell, print_event_fn *print) {
    zephyr_hal_log_cursor_t cursor = {0};
    uint32_t printed = 0u;
    size_t size = 0u;
    do {
        agv_event_t event;
        k_sched_lock();
        size = zephyr_hal_log_next(&agv_supervise.hal, &cursor, &event, sizeof event);
        k_sched_unlock();
        if ((size == sizeof event) && agv_event_is_valid(&event)) {
            print(shell, &event);
            printed++;
        }
    } while (size != 0u);
    return printed;
}

/* The events in RAM that are not in flash yet. While the log is off, flash has none of them. */
static uint32_t print_ram(const struct shell *shell, print_event_fn *print) {
    const agv_recorder_t *const recorder = agv_supervise.ports.recorder;
    const bool log_is_on = agv_supervise.hal.log == ZEPHYR_HAL_LOG_READY;
    uint32_t printed = 0u;
    k_sched_lock();
    const uint32_t next = agv_recorder_next_sequence(recorder);
    const uint32_t waiting = next - recorder->stored_sequence;
    k_sched_unlock();
    for (uint32_t i = log_is_on ? MIN(waiting, AGV_RECORDER_EVENTS) : AGV_RECORDER_EVENTS; i > 0u; i--) {
        agv_event_t event;
        k_sched_lock();
        const bool valid = agv_recorder_get(recorder, next - i, &event);
        k_sched_unlock();
        if (valid) {
            print(shell, &event);
            printed++;
        }
    }
    return printed;
}

/* The last trips, which later events do not replace, oldest first. */
static uint32_t print_trips(const struct shell *shell, print_event_fn *print) {
    uint32_t printed = 0u;
    for (uint32_t i = AGV_RECORDER_TRIPS; i > 0u; i--) {
        agv_event_t trip;
        k_sched_lock();
        const bool valid = agv_recorder_get_trip(agv_supervise.ports.recorder, i - 1u, &trip);
        k_sched_unlock();
        if (valid) {
            print(shell, &trip);
            printed++;
        }
    }
    return printed;
}

static void print_all(const struct shell *shell, print_event_fn *print) {
    const uint32_t in_flash = print_flash(shell, print);
    const uint32_t in_ram = print_ram(shell, print);
    shell_print(shell, "%u events from flash, %u from RAM; log in flash: %s", in_flash, in_ram, log_text());
    shell_print(shell, "the last trips:");
    if (print_trips(shell, print) == 0u) {
        shell_print(shell, "none");
    }
}

static void print_as_text(const struct shell *shell, const agv_event_t *event) {
    char line[EVENT_TEXT_SIZE];
    event_text(event, line, sizeof line);
    shell_print(shell, "run %u, %s", event->run, line);
}

static int print_log(const struct shell *shell, size_t argc, char **argv) {
    ARG_UNUSED(argc);
    ARG_UNUSED(argv);
    print_all(shell, print_as_text);
    return 0;
}

static uint32_t checksum(void) {
    return agv_config_checksum(agv_supervisor_config(look()));
}

/* docs/firmware.md describes this format. */
static void print_as_hex(const struct shell *shell, const agv_event_t *event) {
    static const char digits[] = "0123456789abcdef";
    static char line[(2u * sizeof *event) + 1u];
    const uint8_t *const bytes = (const uint8_t *)event;
    for (size_t i = 0u; i < sizeof *event; i++) {
        line[2u * i] = digits[bytes[i] >> 4u];
        line[(2u * i) + 1u] = digits[bytes[i] & 0x0Fu];
    }
    shell_print(shell, "agv-event %s", line);
}

static int print_dump(const struct shell *shell, size_t argc, char **argv) {
    ARG_UNUSED(argc);
    ARG_UNUSED(argv);
    shell_print(shell, "agv-version %s, configuration %08x", events_version(), checksum());
    print_all(shell, print_as_hex);
    return 0;
}

static void print_message(const struct shell *shell, const agv_supervisor_t *seen, uint32_t message, uint32_t rate) {
    const uint32_t age_ms = agv_supervisor_age_ms(seen, (agv_message_t)message);
    const uint16_t id = agv_supervise.ids.of[message];
    const char *const name = text(agv_message_name((agv_message_t)message));
    if (agv_supervise.frames[message] == 0u) {
        shell_print(shell, "%03x %s: never received", id, name);
    } else if (age_ms == UINT32_MAX) {
        shell_print(shell, "%03x %s: %u/s, no well-formed one for over 6 s, stale", id, name, rate);
    } else {
        shell_print(shell, "%03x %s: %u/s, age %u ms%s", id, name, rate, age_ms,
                    agv_supervisor_is_fresh(seen, (agv_message_t)message) ? "" : ", stale");
    }
}

/* Counted over a second: the core keeps no rates. */
static int print_messages(const struct shell *shell, size_t argc, char **argv) {
    ARG_UNUSED(argc);
    ARG_UNUSED(argv);
    uint32_t before[AGV_MSG_COUNT];
    (void)memcpy(before, agv_supervise.frames, sizeof before);
    (void)k_sleep(K_SECONDS(1));
    const agv_supervisor_t *const seen = look();
    for (uint32_t i = 0u; i < (uint32_t)AGV_MSG_COUNT; i++) {
        print_message(shell, seen, i, agv_supervise.frames[i] - before[i]);
    }
    return 0;
}

static int print_version(const struct shell *shell, size_t argc, char **argv) {
    ARG_UNUSED(argc);
    ARG_UNUSED(argv);
    shell_print(shell, "%s, configuration %08x, without: %s", events_version(), checksum(), events_lacks());
    return 0;
}

/* Erasing stalls the processor, so only with an open output. A sector at a time, so that the watchdog does not expire. */
static int __maybe_unused format_log(const struct shell *shell, size_t argc, char **argv) {
    enum { PAUSE_MS = 20 };
    ARG_UNUSED(argc);
    ARG_UNUSED(argv);
    uint32_t sector = 0u;
    bool more = true;
    while (more) {
        k_sched_lock();
        const bool allowed = !agv_supervisor_output_closed(&agv_supervise.supervisor);
        more = allowed && zephyr_hal_log_format(&agv_supervise.hal, sector);
        k_sched_unlock();
        if (!allowed) {
            shell_error(shell, "refused: the log can be erased only while the safety output is open");
            return -EPERM;
        }
        sector++;
        (void)k_sleep(K_MSEC(PAUSE_MS));
    }
    shell_print(shell, "log in flash: %s", log_text());
    return 0;
}

/* One argument, the name of the command: more are refused. */
#define READS(name, help, handler) SHELL_CMD_ARG(name, NULL, help, handler, 1, 0)

SHELL_STATIC_SUBCMD_SET_CREATE(commands, READS(status, "state, first reason, output, LED", print_status),
                               READS(faults, "active faults", print_faults),
                               READS(log, "events of the flight recorder: flash, then RAM", print_log),
                               READS(dump, "the same events in hex, for a computer", print_dump),
                               READS(messages, "messages: how often, how old, stale", print_messages),
                               READS(version, "version and configuration", print_version),
#if defined(CONFIG_AGV_SHELL_SERVICE)
                               SHELL_CMD_ARG(format, NULL, "erase the log partition, whatever it contains", format_log,
                                             1, 0),
#endif
                               SHELL_SUBCMD_SET_END);
SHELL_CMD_REGISTER(agv, &commands, "the supervisor", NULL);
