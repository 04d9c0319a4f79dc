/* The messages: age, gaps, counter. */
#include <string.h>

#include "agv/names.h"
#include "common/message_facts.h"
#include "monitor/monitor_internal.h"
#include "text/units.h"

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
    for (uint32_t message = 0u; monitor->given.is_gateway && (message < AGV_COMMAND_COUNT); message++) {
        add_row(monitor, &ids, HAL_CAN_AI, message);
    }
    for (uint32_t message = 0u; message < (uint32_t)AGV_MSG_COUNT; message++) {
        add_row(monitor, &ids, HAL_CAN_VEHICLE, message);
    }
}

static void say(monitor_t *monitor, const monitor_row_t *row, uint64_t t_us, monitor_level_t level, const char *what,
                uint64_t ms) {
    monitor_say(monitor, t_us, level, monitor_sender(monitor, row), "%03Xh %s %s %lu ms", (unsigned)row->id,
                agv_message_name((agv_message_t)row->message), what, (unsigned long)ms);
}

static void find_late(monitor_t *monitor, monitor_row_t *row) {
    if ((row->count > 0u) && !row->is_late && (monitor->now_us > row->last_us + row->deadline_us)) {
        row->is_late = true;
        say(monitor, row, row->last_us + row->deadline_us, MONITOR_BAD, "late: no frame for",
            row->deadline_us / US_PER_MS);
    }
}

void monitor_rows_time(monitor_t *monitor) {
    for (size_t i = 0u; i < monitor->row_count; i++) {
        find_late(monitor, &monitor->rows[i]);
    }
}

void monitor_rows_half(monitor_t *monitor) {
    for (size_t i = 0u; i < monitor->row_count; i++) {
        monitor_row_t *row = &monitor->rows[i];
        row->worst_us[1] = row->worst_us[0];
        row->worst_us[0] = 0u;
        row->counts[1] = row->counts[0];
        row->counts[0] = row->count;
    }
}

static void take_gap(monitor_row_t *row, uint64_t gap_us) {
    const uint32_t gap = (gap_us < MONITOR_NO_GAP) ? (uint32_t)gap_us : MONITOR_NO_GAP - 1u;
    row->gap_min_us = (gap < row->gap_min_us) ? gap : row->gap_min_us;
    row->gap_max_us = (gap > row->gap_max_us) ? gap : row->gap_max_us;
    row->worst_us[0] = (gap > row->worst_us[0]) ? gap : row->worst_us[0];
}

static void take_counter(monitor_t *monitor, monitor_row_t *row, const uint8_t data[AGV_DLC], uint64_t t_us) {
    const uint8_t counter = data[message_counter_at(row->message)];
    if ((row->count == 0u) || (counter != row->counter)) {
        if (row->is_stuck) {
            row->is_stuck = false;
            say(monitor, row, t_us, MONITOR_GOOD, "counts again after", (t_us - row->counter_us) / US_PER_MS);
        }
        row->counter = counter;
        row->counter_us = t_us;
    } else if (!row->is_stuck && !row->is_late && (t_us > row->counter_us + row->deadline_us)) {
        row->is_stuck = true;
        say(monitor, row, t_us, MONITOR_BAD, "stuck: same counter for", row->deadline_us / US_PER_MS);
    }
}

void monitor_rows_take(monitor_t *monitor, monitor_row_t *row, const uint8_t data[AGV_DLC], uint64_t t_us) {
    const uint64_t gap_us = (t_us > row->last_us) ? t_us - row->last_us : 0u;
    find_late(monitor, row);
    if (row->count > 0u) {
        take_gap(row, gap_us);
    }
    if (row->is_late) {
        row->is_late = false;
        row->counter_us = t_us;
        say(monitor, row, t_us, MONITOR_GOOD, "back after", gap_us / US_PER_MS);
    }
    if (row->has_counter) {
        take_counter(monitor, row, data, t_us);
    }
    monitor_changes_list(monitor, row, data, t_us);
    (void)memcpy(row->data, data, sizeof row->data);
    row->last_us = t_us;
    row->count++;
}

uint64_t monitor_age_us(const monitor_t *monitor, const monitor_row_t *row) {
    if (row->count == 0u) {
        return 0u;
    }
    uint64_t age_us = (monitor->now_us > row->last_us) ? monitor->now_us - row->last_us : 0u;
    age_us = (row->worst_us[0] > age_us) ? row->worst_us[0] : age_us;
    return (row->worst_us[1] > age_us) ? row->worst_us[1] : age_us;
}

bool monitor_is_late(const monitor_t *monitor, const monitor_row_t *row) {
    return (row->count > 0u) && (monitor_age_us(monitor, row) > row->deadline_us);
}
