/* The messages: age, gaps, counter. */
#include <string.h>

#include "agv/names.h"
#include "common/message_facts.h"
#include "monitor/monitor_internal.h"
#include "text/units.h"

enum { MODE_AT = 6 }; /* in 363h (docs/protocol.md) */

const char *monitor_sender(const monitor_t *monitor, const monitor_row_t *row) {
    const bool is_command = row->message < AGV_COMMAND_COUNT;
    if (is_command && monitor->given.is_gateway && (row->side == HAL_CAN_VEHICLE)) {
        return "supervisor"; /* it passes them on */
    }
    static const char *const senders[] = {
        [MESSAGE_FROM_AI] = "ai", [MESSAGE_FROM_VCU] = "vcu", [MESSAGE_FROM_EPS] = "eps"};
    return senders[message_sender(row->message)];
}

static void add_row(monitor_t *monitor, const agv_ids_t *ids, hal_can_side_t side, uint32_t message) {
    monitor_row_t *row = &monitor->rows[monitor->row_count];
    monitor->row_count++;
    *row = (monitor_row_t){.side = side,
                           .message = message,
                           .id = ids->of[message],
                           .gap_min_us = MONITOR_NO_GAP,
                           .has_counter = message_counter_at(message) != MESSAGE_NO_COUNTER};
    row->deadline_us = (uint32_t)agv_config_get(&monitor->config, message_deadline_setting(message)) * US_PER_MS;
    monitor->row_of[side][row->id] = (uint8_t)monitor->row_count;
}

void monitor_rows_make(monitor_t *monitor) {
    agv_ids_t ids;
    agv_config_ids(&monitor->config, &ids);
    for (uint32_t message = 0; monitor->given.is_gateway && (message < AGV_COMMAND_COUNT); message++) {
        add_row(monitor, &ids, HAL_CAN_AI, message);
    }
    for (uint32_t message = 0; message < AGV_MSG_COUNT; message++) {
        add_row(monitor, &ids, HAL_CAN_VEHICLE, message);
    }
}

static void say(monitor_t *monitor, const monitor_row_t *row, uint64_t t_us, monitor_level_t level, const char *what,
                uint64_t ms) {
    monitor_say(monitor, t_us, level, monitor_sender(monitor, row), "%03Xh %s %s %lu ms", (unsigned)row->id,
                agv_message_name((agv_message_t)row->message), what, (unsigned long)ms);
}

static bool is_vcu(const monitor_row_t *row) {
    return (row->message == AGV_MSG_VEHICLE_STATUS) && (row->side == HAL_CAN_VEHICLE);
}

static bool is_command(const monitor_row_t *row) {
    return row->message < AGV_COMMAND_COUNT;
}

/** Whether a deadline counts now: that of a command while engaged (SUP-3), that of 43Fh by choice in manual, too (SUP-8). */
static bool counts(const monitor_t *monitor, const monitor_row_t *row) {
    const bool in_manual = row->has_counter && (monitor->config.ai_lost_in_manual != AGV_AI_LOST_WARN);
    return !is_command(row) || monitor->engagement.is_engaged || in_manual;
}

/** When a message is due. An engagement that continues none restarts the deadlines of the commands, but not that of a heartbeat. */
static uint64_t due_us(const monitor_t *monitor, const monitor_row_t *row) {
    const uint64_t began_us = monitor->engagement.began_us;
    const bool restarts = is_command(row) && !row->has_counter && (began_us > row->last_us);
    return (restarts ? began_us : row->last_us) + row->deadline_us;
}

static void begin_late(monitor_t *monitor, monitor_row_t *row) {
    const uint64_t due = due_us(monitor, row);
    const bool was_due = row->is_silent && (monitor->engaged_us > due); /* it was silent already */
    const uint64_t at_us = was_due ? monitor->engaged_us : due;
    row->is_late = true;
    row->is_silent = false;
    row->was_late[0] = true;
    row->has_been_late = true;
    if (is_vcu(row)) {
        engagement_end(&monitor->engagement, at_us);
    }
    say(monitor, row, at_us, MONITOR_BAD, "late: no frame for", (at_us - row->last_us) / US_PER_MS);
}

/** Normal in manual: an AI computer may be switched off then. The loss of its heartbeat is a warning (SUP-8). */
static void begin_silent(monitor_t *monitor, monitor_row_t *row) {
    const bool was_late = row->is_late;
    row->is_late = false;
    row->is_silent = true;
    if (!was_late) {
        say(monitor, row, due_us(monitor, row), row->has_counter ? MONITOR_WARN : MONITOR_QUIET, "silent: no frame for",
            row->deadline_us / US_PER_MS);
    }
}

/** Find whether a message is overdue. */
static void find_late(monitor_t *monitor, monitor_row_t *row) {
    if ((row->count == 0) || (monitor->now_us <= due_us(monitor, row))) {
        return;
    }
    if (!counts(monitor, row) && !row->is_silent) {
        begin_silent(monitor, row);
    } else if (counts(monitor, row) && !row->is_late) {
        begin_late(monitor, row);
    } else {
        /* as before */
    }
}

void monitor_rows_time(monitor_t *monitor) {
    for (size_t i = 0; i < monitor->row_count; i++) {
        if (is_vcu(&monitor->rows[i])) {
            find_late(monitor, &monitor->rows[i]); /* first: it ends the engagement, for which the commands are due */
        }
    }
    for (size_t i = 0; i < monitor->row_count; i++) {
        find_late(monitor, &monitor->rows[i]);
    }
}

void monitor_rows_half(monitor_t *monitor) {
    for (size_t i = 0; i < monitor->row_count; i++) {
        monitor_row_t *row = &monitor->rows[i];
        row->worst_us[1] = row->worst_us[0];
        row->worst_us[0] = 0;
        row->was_late[1] = row->was_late[0];
        row->was_late[0] = row->is_late;
        row->counts[1] = row->counts[0];
        row->counts[0] = row->count;
    }
}

static void take_gap(monitor_row_t *row, uint64_t gap_us) {
    const uint32_t gap = (gap_us < MONITOR_NO_GAP) ? (uint32_t)gap_us : MONITOR_NO_GAP - 1;
    row->gap_min_us = (gap < row->gap_min_us) ? gap : row->gap_min_us;
    row->gap_max_us = (gap > row->gap_max_us) ? gap : row->gap_max_us;
    row->worst_us[0] = (gap > row->worst_us[0]) ? gap : row->worst_us[0];
}

static void take_counter(monitor_t *monitor, monitor_row_t *row, const uint8_t data[AGV_DLC], uint64_t t_us) {
    const uint8_t counter = data[message_counter_at(row->message)];
    if (message_beats(&row->counter, &monitor->config, row->message, counter)) {
        if (row->is_stuck) {
            row->is_stuck = false;
            say(monitor, row, t_us, MONITOR_GOOD, "counter changes again after", (t_us - row->counter_us) / US_PER_MS);
        }
        row->counter_us = t_us;
    } else if (!row->is_stuck && !row->is_late && (t_us > row->counter_us + row->deadline_us)) {
        row->is_stuck = true;
        say(monitor, row, t_us, MONITOR_BAD, "stuck: counter unchanged for", row->deadline_us / US_PER_MS);
    }
}

/** Follow the mode. A VCU whose counter stands still counts as lost: it ends an engagement, and begins none. */
static void follow_engagement(monitor_t *monitor, const monitor_row_t *row, uint64_t t_us) {
    if (is_vcu(row) && row->is_stuck) {
        engagement_end(&monitor->engagement, t_us);
    } else if (is_vcu(row) && engagement_take(&monitor->engagement, &monitor->config, row->data[MODE_AT], t_us)) {
        monitor->engaged_us = monitor->engagement.is_engaged ? t_us : monitor->engaged_us;
    } else {
        /* another message */
    }
}

void monitor_rows_take(monitor_t *monitor, monitor_row_t *row, const uint8_t data[AGV_DLC], uint64_t t_us) {
    const uint64_t gap_us = (t_us > row->last_us) ? t_us - row->last_us : 0;
    find_late(monitor, row);
    if (row->count > 0) {
        take_gap(row, gap_us);
    }
    if (row->is_late || row->is_silent) {
        say(monitor, row, t_us, row->is_late ? MONITOR_GOOD : MONITOR_QUIET, "back after", gap_us / US_PER_MS);
        row->is_late = false;
        row->is_silent = false;
        row->counter_us = t_us;
    }
    if (row->has_counter) {
        take_counter(monitor, row, data, t_us);
    }
    monitor_changes_list(monitor, row, data, t_us);
    (void)memcpy(row->data, data, sizeof row->data);
    row->last_us = t_us;
    row->count++;
    follow_engagement(monitor, row, t_us);
}

uint64_t monitor_age_us(const monitor_t *monitor, const monitor_row_t *row) {
    if (row->count == 0) {
        return 0;
    }
    uint64_t age_us = (monitor->now_us > row->last_us) ? monitor->now_us - row->last_us : 0;
    age_us = (row->worst_us[0] > age_us) ? row->worst_us[0] : age_us;
    return (row->worst_us[1] > age_us) ? row->worst_us[1] : age_us;
}

bool monitor_is_late(const monitor_row_t *row) {
    return row->is_late || row->was_late[0] || row->was_late[1];
}
