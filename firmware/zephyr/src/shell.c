/*
 * agv status, faults, log, messages, version: what is, never what is to be. The shell's thread has the lowest priority; it
 * copies the supervisor while no other thread can run, and reads the copy.
 */
#include <string.h>

#include <zephyr/shell/shell.h>

#include "agv/names.h"
#include "events.h"
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

static int print_status(const struct shell *shell, size_t argc, char **argv) {
    ARG_UNUSED(argc);
    ARG_UNUSED(argv);
    const agv_supervisor_t *const seen = look();
    shell_print(shell, "state %s, first reason %s, safety output %s, LED %d",
                text(agv_state_name(agv_supervisor_state(seen))),
                text(agv_fault_name(agv_supervisor_first_reason(seen))),
                agv_supervisor_output_closed(seen) ? "closed" : "open", agv_supervisor_led_code(seen));
    return 0;
}

static int print_faults(const struct shell *shell, size_t argc, char **argv) {
    ARG_UNUSED(argc);
    ARG_UNUSED(argv);
    const agv_supervisor_t *const seen = look();
    const agv_fault_set_t trips = agv_supervisor_active_trips(seen);
    for (uint32_t fault = 0u; fault < (uint32_t)AGV_FAULT_COUNT; fault++) {
        if (agv_supervisor_has_fault(seen, (agv_fault_t)fault)) {
            shell_print(shell, "%s (%s)", text(agv_fault_name((agv_fault_t)fault)),
                        agv_fault_is_in(&trips, fault) ? "trip" : "warn");
        }
    }
    return 0;
}

static int print_log(const struct shell *shell, size_t argc, char **argv) {
    ARG_UNUSED(argc);
    ARG_UNUSED(argv);
    const uint32_t next = agv_recorder_next_sequence(agv_supervise.ports.recorder);
    for (uint32_t i = AGV_RECORDER_EVENTS; i > 0u; i--) {
        agv_event_t event;
        k_sched_lock();
        const bool valid = agv_recorder_get(agv_supervise.ports.recorder, next - i, &event);
        k_sched_unlock();
        if (valid) {
            shell_print(shell, "%u run %u, %u ms: kind %u, %u %u %u, missing %02x, state %s, first reason %s",
                        event.sequence, event.run, event.time_ms, event.kind, event.a, event.b, event.c, event.missing,
                        text(agv_state_name((agv_state_t)event.state)),
                        text(agv_fault_name((agv_fault_t)event.first_reason)));
        }
    }
    return 0;
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
        const uint32_t age_ms = agv_supervisor_age_ms(seen, (agv_message_t)i);
        shell_print(shell, "%03x %s: %u/s, age %d ms%s", agv_supervise.ids.of[i],
                    text(agv_message_name((agv_message_t)i)), agv_supervise.frames[i] - before[i],
                    (age_ms == UINT32_MAX) ? -1 : (int)age_ms,
                    agv_supervisor_is_fresh(seen, (agv_message_t)i) ? "" : ", stale");
    }
    return 0;
}

static int print_version(const struct shell *shell, size_t argc, char **argv) {
    ARG_UNUSED(argc);
    ARG_UNUSED(argv);
    shell_print(shell, "%s, configuration %08x", events_version(), agv_config_checksum(agv_supervisor_config(look())));
    return 0;
}

SHELL_STATIC_SUBCMD_SET_CREATE(commands, SHELL_CMD(status, NULL, "state, first reason, output, LED", print_status),
                               SHELL_CMD(faults, NULL, "active faults", print_faults),
                               SHELL_CMD(log, NULL, "events of the flight recorder", print_log),
                               SHELL_CMD(messages, NULL, "messages: how often, how old, stale", print_messages),
                               SHELL_CMD(version, NULL, "version and configuration", print_version),
                               SHELL_SUBCMD_SET_END);
SHELL_CMD_REGISTER(agv, &commands, "the supervisor", NULL);
