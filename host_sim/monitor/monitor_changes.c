/* Transitions of signals: words, flags and alarms that change are listed; numbers are not. */
#include <string.h>

#include "agv/faults.h"
#include "monitor/monitor_internal.h"
#include "text/units.h"

/** Changes of one message that are listed within a second: two senders that disagree would fill the log. */
enum { LISTED_PER_S = 4, BITS_PER_BYTE = 8 };

static bool is_listed(const signal_info_t *info) {
    return (info->kind == SIGNAL_CHOICE) || (info->kind == SIGNAL_FLAG) || (info->kind == SIGNAL_ALARM);
}

/** Whether a listed signal of a message differs between two payloads. */
static bool differs(uint32_t message, const uint8_t a[AGV_DLC], const uint8_t b[AGV_DLC]) {
    signal_value_t before;
    signal_value_t now;
    for (size_t i = 0; signals_read(message, i, a, &before) && signals_read(message, i, b, &now); i++) {
        if (is_listed(signals_info(message, i)) && (before.raw != now.raw)) {
            return true;
        }
    }
    return false;
}

void monitor_changes_make(monitor_t *monitor) {
    static const uint8_t zero[AGV_DLC] = {0};
    for (uint32_t message = 0; message < AGV_MSG_COUNT; message++) {
        for (uint32_t bit = 0; bit < AGV_DLC * (uint32_t)BITS_PER_BYTE; bit++) {
            uint8_t one[AGV_DLC] = {0};
            const uint32_t byte = bit / BITS_PER_BYTE;
            one[byte] = (uint8_t)(1u << (bit % BITS_PER_BYTE));
            monitor->watched[message][byte] |= differs(message, zero, one) ? one[byte] : 0;
        }
    }
}

static void list_alarm(monitor_t *monitor, const monitor_row_t *row, const signal_info_t *info, bool is_set,
                       uint64_t t_us) {
    const unsigned led_code = agv_fault_led_code(info->fault);
    if (is_set && (led_code > 0)) {
        monitor_say(monitor, t_us, MONITOR_BAD, monitor_sender(monitor, row), "alarm %s, LED code %u", info->name,
                    led_code);
    } else {
        monitor_say(monitor, t_us, is_set ? MONITOR_BAD : MONITOR_GOOD, monitor_sender(monitor, row), "alarm %s%s",
                    info->name, is_set ? "" : " has ended");
    }
}

static void list_one(monitor_t *monitor, const monitor_row_t *row, size_t index, const uint8_t data[AGV_DLC],
                     uint64_t t_us) {
    const signal_info_t *info = signals_info(row->message, index);
    signal_value_t before;
    signal_value_t now;
    char from[SIGNALS_VALUE_SIZE];
    char to[SIGNALS_VALUE_SIZE];

    if (!is_listed(info) || !signals_read(row->message, index, row->data, &before) ||
        !signals_read(row->message, index, data, &now)) {
        return;
    }
    const bool is_first = row->count == 0;
    if (info->kind == SIGNAL_ALARM) {
        if ((now.raw != 0) != (!is_first && (before.raw != 0))) {
            list_alarm(monitor, row, info, now.raw != 0, t_us);
        }
        return;
    }
    if (is_first || (before.raw == now.raw)) {
        return;
    }
    signals_value_text(from, info, &before);
    signals_value_text(to, info, &now);
    monitor_say(monitor, t_us, now.valid ? MONITOR_QUIET : MONITOR_BAD, monitor_sender(monitor, row),
                "%03Xh %s: %s -> %s", (unsigned)row->id, info->name, from, to);
}

/** Whether there is room in this second; the first one that has none is told. */
static bool may_list(monitor_t *monitor, monitor_row_t *row, uint64_t t_us) {
    if ((row->listed == 0) || (t_us > row->listed_us + (uint64_t)US_PER_S)) {
        row->listed_us = t_us;
        row->listed = 0;
    }
    row->listed = (uint8_t)((row->listed < UINT8_MAX) ? row->listed + 1 : row->listed);
    if (row->listed == LISTED_PER_S + 1) {
        monitor_say(monitor, t_us, MONITOR_WARN, monitor_sender(monitor, row),
                    "%03Xh changes more than %d times a second: not listed", (unsigned)row->id, (int)LISTED_PER_S);
    }
    return row->listed <= LISTED_PER_S;
}

void monitor_changes_list(monitor_t *monitor, monitor_row_t *row, const uint8_t data[AGV_DLC], uint64_t t_us) {
    const uint8_t *watched = monitor->watched[row->message];
    bool has_changed = row->count == 0;
    for (size_t i = 0; i < AGV_DLC; i++) {
        has_changed = has_changed || (((row->data[i] ^ data[i]) & watched[i]) != 0);
    }
    if (!has_changed || !may_list(monitor, row, t_us)) {
        return;
    }
    for (size_t i = 0; i < signals_count(row->message); i++) {
        list_one(monitor, row, i, data, t_us);
    }
}

/** Put an alarm in its place by rank, unless it is there already. @return how many there are now */
static size_t put_alarm(const monitor_t *monitor, monitor_alarm_t *alarms, size_t count, size_t room,
                        monitor_alarm_t alarm) {
    size_t place = 0;
    while ((place < count) && (alarms[place].fault < alarm.fault)) {
        place++;
    }
    if ((place == room) || ((place < count) && (alarms[place].fault == alarm.fault))) {
        return count;
    }
    const size_t kept = (count < room) ? count : room - 1;
    memmove(&alarms[place + 1], &alarms[place], (kept - place) * sizeof alarms[0]);
    alarm.led_code = agv_fault_led_code(alarm.fault);
    alarm.is_trip = agv_config_is_trip(&monitor->config, (uint32_t)alarm.fault);
    alarms[place] = alarm;
    return kept + 1;
}

static size_t put_reported(const monitor_t *monitor, monitor_alarm_t *alarms, size_t count, size_t room,
                           const monitor_row_t *row) {
    signal_value_t value;
    for (size_t i = 0; (row->count > 0) && signals_read(row->message, i, row->data, &value); i++) {
        const signal_info_t *info = signals_info(row->message, i);
        if ((info->kind == SIGNAL_ALARM) && (value.raw != 0)) {
            const monitor_alarm_t alarm = {.fault = info->fault, .is_fresh = !row->is_late && !row->is_silent};
            count = put_alarm(monitor, alarms, count, room, alarm);
        }
    }
    return count;
}

size_t monitor_alarms(const monitor_t *monitor, monitor_alarm_t *alarms, size_t room) {
    size_t count = 0;
    for (size_t i = 0; i < monitor->row_count; i++) {
        count = put_reported(monitor, alarms, count, room, &monitor->rows[i]);
    }
    for (uint32_t fault = 0; fault < AGV_FAULT_COUNT; fault++) {
        if (agv_fault_is_in(&monitor->supervisor.faults, fault)) {
            const monitor_alarm_t alarm = {.fault = (agv_fault_t)fault, .is_fresh = true};
            count = put_alarm(monitor, alarms, count, room, alarm);
        }
    }
    return count;
}
