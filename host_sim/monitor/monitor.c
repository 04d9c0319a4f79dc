#include "monitor/monitor.h"

#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

#include "common/report.h"
#include "monitor/monitor_internal.h"
#include "text/units.h"

void monitor_say(monitor_t *monitor, uint64_t t_us, monitor_level_t level, const char *who, const char *format, ...) {
    char text[MONITOR_TEXT_SIZE];
    va_list arguments;
    va_start(arguments, format);
    (void)vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    const monitor_entry_t *entry = monitor_log_add(&monitor->log, t_us, level, who, text);
    if (monitor->given.on_entry != NULL) {
        monitor->given.on_entry(monitor->given.ctx, entry);
    }
}

monitor_t *monitor_new(const monitor_config_t *given) {
    monitor_t *monitor = calloc(1, sizeof *monitor);
    if (monitor == NULL) {
        (void)report("out of memory");
        return NULL;
    }
    monitor->given = *given;
    monitor->config = *given->config;
    monitor->checksum = agv_config_checksum(given->config);
    monitor_rows_make(monitor);
    monitor_changes_make(monitor);
    monitor_supervisor_start(monitor);
    return monitor;
}

void monitor_free(monitor_t *monitor) {
    if (monitor != NULL) {
        monitor_shadow_free(monitor->shadow);
        free(monitor);
    }
}

/** The name of a side's interface. */
static const char *interface_of(const monitor_t *monitor, hal_can_side_t side) {
    const char *name = monitor->given.interfaces[side];
    return (name != NULL) ? name : "bus";
}

static void begin_half(monitor_t *monitor, uint64_t half_us) {
    monitor->half_us = half_us;
    monitor->counts[1] = monitor->counts[0];
    monitor->counts[0] = monitor->frames;
    for (size_t i = 0; i < monitor->other_count; i++) {
        monitor_other_t *other = &monitor->others[i];
        other->counts[1] = other->counts[0];
        other->counts[0] = other->count;
    }
    monitor_rows_half(monitor);
}

static void pass_to(monitor_t *monitor, uint64_t t_us, bool with_supervisor) {
    /* In a flood not with every frame: once a millisecond is exact enough. */
    const bool same_ms = t_us / US_PER_MS == monitor->now_us / US_PER_MS;
    monitor->now_us = t_us;
    if (same_ms) {
        return;
    }
    /* After a long pause two half seconds are enough: nothing happened in those between. */
    const uint64_t half_us = t_us - (t_us % MONITOR_HALF_US);
    if (half_us > monitor->half_us) {
        const bool more = half_us - monitor->half_us > MONITOR_HALF_US;
        begin_half(monitor, half_us);
        if (more) {
            begin_half(monitor, half_us);
        }
    }
    monitor_rows_time(monitor);
    if (with_supervisor) {
        monitor_supervisor_time(monitor);
    }
}

void monitor_time(monitor_t *monitor, uint64_t t_us) {
    if (t_us <= monitor->now_us) {
        return;
    }
    /* A silence passes by the millisecond, so that what it causes is listed in its order. A longer leap is the hole of a log. */
    const bool is_silence = t_us - monitor->now_us <= MONITOR_LEAP_MAX_US;
    const uint64_t end_us = is_silence ? t_us : monitor->now_us + MONITOR_LEAP_MAX_US;
    for (uint64_t ms = (monitor->now_us / US_PER_MS) + 1; ms * US_PER_MS < end_us; ms++) {
        pass_to(monitor, ms * US_PER_MS, is_silence);
    }
    pass_to(monitor, t_us, true);
}

/** Find the entry of an identifier, or make one. @return NULL: there is no room */
static monitor_other_t *other_of(monitor_t *monitor, hal_can_side_t side, uint32_t id, bool is_extended) {
    for (size_t i = 0; i < monitor->other_count; i++) {
        monitor_other_t *other = &monitor->others[i];
        if ((other->side == side) && (other->id == id) && (other->is_extended == is_extended)) {
            return other;
        }
    }
    if (monitor->other_count == MONITOR_OTHERS_MAX) {
        return NULL;
    }
    monitor_other_t *other = &monitor->others[monitor->other_count];
    monitor->other_count++;
    *other = (monitor_other_t){.side = side, .id = id, .is_extended = is_extended};
    return other;
}

/** Whether an identifier is that of a message in the ID set that is not in use. */
static bool is_of_other_set(const monitor_t *monitor, const monitor_other_t *other) {
    const uint32_t set = (monitor->config.id_set == AGV_ID_SET_HEADING) ? AGV_ID_SET_TABLE : AGV_ID_SET_HEADING;
    return !other->is_extended && (agv_message_from_id(other->id, set) != AGV_MSG_NONE);
}

static void take_other(monitor_t *monitor, hal_can_side_t side, const hal_can_frame_t *frame, uint64_t t_us) {
    monitor_other_t *other = other_of(monitor, side, frame->id, (frame->flags & HAL_CAN_EXTENDED) != 0);
    if (other == NULL) {
        monitor->others_uncounted++;
        return;
    }
    if (other->count == 0) {
        const bool other_set = is_of_other_set(monitor, other);
        monitor_say(monitor, t_us, other_set ? MONITOR_WARN : MONITOR_QUIET, interface_of(monitor, side),
                    "%0*" PRIX32 "h received, %s", other->is_extended ? 8 : 3, other->id,
                    other_set ? "an identifier of the other ID set (--id-set)" : "no message of the protocol");
    }
    other->count++;
    other->last_us = t_us;
}

static void take_error(monitor_t *monitor, hal_can_side_t side, uint64_t t_us) {
    monitor->errors++;
    if (monitor->errors == 1) {
        monitor_say(monitor, t_us, MONITOR_WARN, interface_of(monitor, side), "first error frame");
    }
}

/** On the AI side a gateway repeats what the vehicle reports: known, and no row of its own. */
static bool is_repeated(const monitor_t *monitor, hal_can_side_t side, uint32_t id) {
    return (side == HAL_CAN_AI) &&
           ((monitor->row_of[HAL_CAN_VEHICLE][id] != 0) || (id == monitor->config.status_frame_id));
}

static void take(monitor_t *monitor, hal_can_side_t side, const hal_can_frame_t *frame, uint64_t t_us) {
    const bool is_standard = ((frame->flags & HAL_CAN_EXTENDED) == 0) && (frame->id <= AGV_ID_MAX);
    const uint8_t index = is_standard ? monitor->row_of[side][frame->id] : 0;
    if ((frame->flags & HAL_CAN_ERROR) != 0) {
        take_error(monitor, side, t_us);
    } else if (monitor_is_status(monitor, side, frame) ||
               ((index == 0) && is_standard && is_repeated(monitor, side, frame->id))) {
        return;
    } else if (index == 0) {
        take_other(monitor, side, frame, t_us);
    } else if ((frame->flags == 0) && (frame->length == AGV_DLC)) {
        monitor_rows_take(monitor, &monitor->rows[index - 1u], frame->data, t_us);
    } else {
        monitor->rejected++;
        if (monitor->rejected == 1) {
            monitor_say(monitor, t_us, MONITOR_WARN, interface_of(monitor, side),
                        "%03" PRIX32 "h in another form than the protocol's: not counted as this message", frame->id);
        }
    }
}

void monitor_frame(monitor_t *monitor, hal_can_side_t side, const hal_can_frame_t *frame, uint64_t t_us) {
    monitor_time(monitor, t_us);
    monitor->frames++;
    take(monitor, side, frame, t_us);
    monitor_supervisor_frame(monitor, side, frame, t_us);
}

void monitor_link(monitor_t *monitor, hal_can_side_t side, bool is_down, uint64_t t_us) {
    if (monitor->is_down[side] != is_down) {
        monitor->is_down[side] = is_down;
        monitor_say(monitor, t_us, is_down ? MONITOR_BAD : MONITOR_GOOD, interface_of(monitor, side),
                    "the interface is %s", is_down ? "down" : "up again");
    }
}

void monitor_lost(monitor_t *monitor, hal_can_side_t side, uint32_t frames, uint64_t t_us) {
    if ((monitor->lost == 0) || (t_us > monitor->lost_us + (uint64_t)US_PER_S)) {
        monitor_say(monitor, t_us, MONITOR_WARN, interface_of(monitor, side),
                    "frames lost: this program is too slow, gaps may be its own");
    }
    monitor->lost += frames;
    monitor->lost_us = t_us;
    if (monitor->shadow != NULL) {
        monitor_shadow_overrun(monitor->shadow, side);
    }
}

void monitor_note(monitor_t *monitor, monitor_level_t level, const char *who, const char *text) {
    monitor_say(monitor, monitor->now_us, level, who, "%s", text);
}

void monitor_reset(monitor_t *monitor) {
    for (size_t i = 0; i < monitor->row_count; i++) {
        monitor->rows[i].gap_min_us = MONITOR_NO_GAP;
        monitor->rows[i].gap_max_us = 0;
        monitor->rows[i].has_been_late = monitor->rows[i].is_late;
    }
}

uint64_t monitor_rate(const monitor_t *monitor, uint64_t count, const uint64_t counts[2]) {
    const uint64_t since_us = (monitor->half_us > 0) ? monitor->half_us - MONITOR_HALF_US : 0;
    const uint64_t over_us = monitor->now_us - since_us;
    return (over_us < US_PER_MS) ? 0 : (((count - counts[1]) * (uint64_t)US_PER_S) + (over_us / 2)) / over_us;
}

const uint8_t *monitor_payload(const monitor_t *monitor, uint32_t message) {
    for (size_t i = 0; i < monitor->row_count; i++) {
        const monitor_row_t *row = &monitor->rows[i];
        if ((row->side == HAL_CAN_VEHICLE) && (row->message == message) && (row->count > 0)) {
            return row->data;
        }
    }
    return NULL;
}
