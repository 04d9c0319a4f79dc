/*
 * The state of the supervisor: from its status frame; from a supervisor in this program that only listens, while no
 * status frame is heard; or from the program whose screen this is.
 */
#include <inttypes.h>

#include "agv/names.h"
#include "common/missing.h"
#include "monitor/monitor_internal.h"
#include "text/units.h"

/** For so long a status frame is waited for, unless its period is longer. */
enum { WAIT_MS = 1000, PERIODS = 3, LOW_NIBBLE = 0x0F };

/** The status frame (docs/protocol.md, 7F0h). */
enum { STATE_AT = 0, REASON_AT = 1, OUTPUT_AT = 2, CHECKSUM_AT = 4, PAGE_SHIFT = 4, BITS = 8 };

static uint64_t wait_us(const monitor_t *monitor) {
    const uint64_t periods_ms = (uint64_t)PERIODS * monitor->config.status_frame_period_ms;
    return ((periods_ms > WAIT_MS) ? periods_ms : (uint64_t)WAIT_MS) * US_PER_MS;
}

static const char *name_of(const monitor_t *monitor) {
    return (monitor->supervisor.source == MONITOR_SHADOW) ? "shadow" : "supervisor";
}

static const char *state_name(agv_state_t state) {
    const char *name = agv_state_name(state);
    return (name != NULL) ? name : "no valid state";
}

static monitor_level_t level_of(agv_state_t state) {
    if ((state == AGV_STATE_STANDBY) || (state == AGV_STATE_ACTIVE)) {
        return MONITOR_GOOD;
    }
    return (state == AGV_STATE_INIT) ? MONITOR_QUIET : MONITOR_BAD;
}

static void say_state(monitor_t *monitor, uint64_t t_us, agv_state_t from, agv_state_t to, agv_fault_t reason) {
    const char *reason_name = agv_fault_name(reason);
    monitor_say(monitor, t_us, level_of(to), name_of(monitor), "%s%s%s%s%s", (from != 0) ? state_name(from) : "",
                (from != 0) ? " -> " : "", state_name(to), (reason_name != NULL) ? ": " : "",
                (reason_name != NULL) ? reason_name : "");
}

static void say_missing(monitor_t *monitor, uint64_t t_us, monitor_level_t level, const char *what, uint16_t missing) {
    char words[MISSING_TEXT_SIZE];
    monitor_say(monitor, t_us, level, name_of(monitor), "%s%s%.100s", what, (missing != 0) ? ", missing: " : "",
                missing_text(missing, words));
}

static void say_fault(monitor_t *monitor, uint64_t t_us, agv_fault_t fault, agv_fault_class_t kind, bool is_raised) {
    const char *name = agv_fault_name(fault);
    const monitor_level_t raised = (kind == AGV_CLASS_TRIP) ? MONITOR_BAD : MONITOR_WARN;
    monitor_say(monitor, t_us, is_raised ? raised : MONITOR_GOOD, name_of(monitor), "fault %s (%s)%s",
                (name != NULL) ? name : "?", agv_class_name(kind), is_raised ? "" : " has ended");
}

/** A fault that changes too often would fill the log. */
static void say_change(monitor_t *monitor, uint64_t t_us, const session_event_t *event) {
    const agv_event_t *recorded = &event->recorded;
    const char *name = agv_fault_name((agv_fault_t)recorded->a);
    if (recorded->a >= AGV_FAULT_COUNT) {
        return;
    }
    if (!event->is_left_out) {
        say_fault(monitor, t_us, (agv_fault_t)recorded->a, (agv_fault_class_t)recorded->b, recorded->c != 0);
    } else if (!monitor->flickers[recorded->a]) {
        monitor_say(monitor, t_us, MONITOR_WARN, name_of(monitor),
                    "fault %s changes more than %u times a second: not listed", name,
                    (unsigned)AGV_RECORDER_FAULTS_PER_S);
    } else {
        /* it was said */
    }
    monitor->flickers[recorded->a] = event->is_left_out;
}

/** The faults that were raised before anything of the supervisor was shown. */
static void say_active_faults(monitor_t *monitor, uint64_t t_us) {
    for (uint32_t fault = 0; fault < AGV_FAULT_COUNT; fault++) {
        if (agv_fault_is_in(&monitor->supervisor.faults, fault)) {
            say_fault(monitor, t_us, (agv_fault_t)fault,
                      agv_config_is_trip(&monitor->config, fault) ? AGV_CLASS_TRIP : AGV_CLASS_WARN, true);
        }
    }
}

void monitor_event(monitor_t *monitor, const session_event_t *event, uint64_t t_us) {
    const agv_event_t *recorded = &event->recorded;
    if (event->is_led) {
        return; /* it follows from the faults, and is shown */
    }
    switch ((agv_event_kind_t)recorded->kind) {
    case AGV_EVENT_STATE:
        say_state(monitor, t_us, (agv_state_t)recorded->a, (agv_state_t)recorded->b, (agv_fault_t)recorded->c);
        break;
    case AGV_EVENT_FAULT:
        say_change(monitor, t_us, event);
        break;
    case AGV_EVENT_RESET:
        say_missing(monitor, t_us, (recorded->a != 0) ? MONITOR_GOOD : MONITOR_WARN,
                    (recorded->a != 0) ? "reset accepted" : "reset refused", recorded->missing);
        break;
    case AGV_EVENT_STARTUP:
        say_missing(monitor, t_us, MONITOR_WARN, "start not possible yet", recorded->missing);
        break;
    default: /* the safety output follows the state, and is shown */
        break;
    }
}

void monitor_told(monitor_t *monitor, const monitor_supervisor_t *supervisor) {
    const uint64_t heard_us = monitor->supervisor.heard_us;
    const uint64_t heard_count = monitor->supervisor.heard_count;
    monitor->supervisor = *supervisor;
    monitor->supervisor.source = MONITOR_OWNER;
    monitor->supervisor.heard_us = heard_us;
    monitor->supervisor.heard_count = heard_count;
}

/** An event of the supervisor that only listens. Before it is shown its events are not listed. */
static void on_shadow_event(void *ctx, const session_event_t *event) {
    monitor_t *monitor = ctx;
    if (monitor->supervisor.source == MONITOR_SHADOW) {
        monitor_event(monitor, event, event->t_ms * US_PER_MS);
    }
}

/** Before it is shown nothing of it is. */
static void read_shadow(monitor_t *monitor) {
    if (monitor->supervisor.source != MONITOR_SHADOW) {
        return;
    }
    const agv_supervisor_t *from = &monitor_shadow_session(monitor->shadow)->supervisor;
    monitor_supervisor_t *to = &monitor->supervisor;
    to->state = agv_supervisor_state(from);
    to->first_reason = agv_supervisor_first_reason(from);
    to->output_closed = agv_supervisor_output_closed(from);
    to->has_led = true;
    to->led_code = agv_supervisor_led_code(from);
    to->faults = agv_supervisor_active_faults(from);
    to->has_checksum = false;
}

static void start_shadow(monitor_t *monitor) {
    monitor->shadow = monitor_shadow_new(&monitor->config, on_shadow_event, monitor, monitor->now_us);
    if ((monitor->shadow == NULL) && !monitor->shadow_failed) {
        monitor->shadow_failed = true;
        monitor_say(monitor, monitor->now_us, MONITOR_WARN, "shadow", "out of memory: no supervisor listens");
    }
}

void monitor_supervisor_start(monitor_t *monitor) {
    monitor->supervisor.first_reason = AGV_FAULT_NONE;
    if (monitor->given.owned) {
        monitor->supervisor.source = MONITOR_OWNER;
        return;
    }
    if (monitor->given.shadow) {
        monitor->supervisor.source = MONITOR_SHADOW;
    }
    start_shadow(monitor);
}

bool monitor_is_status(const monitor_t *monitor, hal_can_side_t side, const hal_can_frame_t *frame) {
    return (side == HAL_CAN_VEHICLE) && (frame->flags == 0) && (frame->length == AGV_DLC) && (frame->id != 0) &&
           (frame->id == monitor->config.status_frame_id);
}

static uint32_t checksum_of(const uint8_t data[AGV_DLC]) {
    uint32_t checksum = 0;
    for (uint32_t i = AGV_DLC; i > CHECKSUM_AT; i--) {
        checksum = (checksum << BITS) | data[i - 1];
    }
    return checksum;
}

static void say_checksum(monitor_t *monitor, uint64_t t_us) {
    const monitor_supervisor_t *supervisor = &monitor->supervisor;
    if (supervisor->has_checksum && (supervisor->checksum != monitor->checksum)) {
        monitor_say(monitor, t_us, MONITOR_WARN, "supervisor",
                    "its configuration is %08" PRIX32 ", the one given here %08" PRIX32 ": deadlines may differ",
                    supervisor->checksum, monitor->checksum);
    }
}

/** The first status frame, or the first one again: from now on it is the source. */
static void begin_status(monitor_t *monitor, uint64_t t_us) {
    monitor_supervisor_t *supervisor = &monitor->supervisor;
    monitor_shadow_free(monitor->shadow);
    monitor->shadow = NULL;
    *supervisor = (monitor_supervisor_t){.source = MONITOR_STATUS_FRAME,
                                         .first_reason = AGV_FAULT_NONE,
                                         .heard_us = supervisor->heard_us,
                                         .heard_count = supervisor->heard_count};
    monitor_say(monitor, t_us, MONITOR_QUIET, "supervisor", "its status frame %03Xh is received",
                (unsigned)monitor->config.status_frame_id);
}

static void take_status(monitor_t *monitor, const uint8_t data[AGV_DLC], uint64_t t_us) {
    monitor_supervisor_t *supervisor = &monitor->supervisor;
    const agv_state_t state = (agv_state_t)data[STATE_AT];
    const agv_fault_t reason = (data[REASON_AT] < AGV_FAULT_COUNT) ? (agv_fault_t)data[REASON_AT] : AGV_FAULT_NONE;
    const bool is_page_0 = (data[OUTPUT_AT] >> PAGE_SHIFT) == 0;
    const bool is_new = is_page_0 && (!supervisor->has_checksum || (supervisor->checksum != checksum_of(data)));
    if (state != supervisor->state) {
        say_state(monitor, t_us, supervisor->state, state, agv_state_is_latched(state) ? reason : AGV_FAULT_NONE);
    }
    supervisor->state = state;
    supervisor->first_reason = reason;
    supervisor->output_closed = (data[OUTPUT_AT] & (uint8_t)LOW_NIBBLE) != 0;
    if (is_new) {
        supervisor->has_checksum = true;
        supervisor->checksum = checksum_of(data);
        say_checksum(monitor, t_us);
    }
}

void monitor_supervisor_frame(monitor_t *monitor, hal_can_side_t side, const hal_can_frame_t *frame, uint64_t t_us) {
    monitor_supervisor_t *supervisor = &monitor->supervisor;
    if (monitor_is_status(monitor, side, frame)) {
        supervisor->heard_us = t_us;
        supervisor->heard_count++;
        if (!monitor->given.owned && !monitor->given.shadow) {
            if (supervisor->source != MONITOR_STATUS_FRAME) {
                begin_status(monitor, t_us);
            }
            take_status(monitor, frame->data, t_us);
        }
    } else if (monitor->shadow != NULL) {
        monitor_shadow_frame(monitor->shadow, side, frame, t_us);
    }
}

/** No status frame comes: show the supervisor that only listens. */
static void show_shadow(monitor_t *monitor) {
    const bool was_heard = monitor->supervisor.source == MONITOR_STATUS_FRAME;
    monitor_say(monitor, monitor->now_us, was_heard ? MONITOR_BAD : MONITOR_QUIET, "supervisor",
                "no status frame%s: a supervisor in this program listens", was_heard ? " any more" : "");
    monitor->supervisor.source = MONITOR_SHADOW;
    if (monitor->shadow != NULL) {
        read_shadow(monitor);
        say_state(monitor, monitor->now_us, (agv_state_t)0, monitor->supervisor.state,
                  monitor->supervisor.first_reason);
        say_active_faults(monitor, monitor->now_us);
    }
}

void monitor_supervisor_time(monitor_t *monitor) {
    const monitor_source_t source = monitor->supervisor.source;
    if (source == MONITOR_OWNER) {
        return;
    }
    if ((source != MONITOR_SHADOW) && (monitor->now_us >= monitor->supervisor.heard_us + wait_us(monitor))) {
        show_shadow(monitor);
    }
    if ((monitor->shadow != NULL) && !monitor_shadow_time(monitor->shadow, monitor->now_us)) {
        monitor_shadow_free(monitor->shadow);
        monitor->shadow = NULL;
        monitor_say(monitor, monitor->now_us, MONITOR_WARN, "shadow", "the time jumped: it starts again");
    }
    if ((monitor->shadow == NULL) && !monitor->shadow_failed && (monitor->supervisor.source != MONITOR_STATUS_FRAME)) {
        start_shadow(monitor);
    }
    if (monitor->shadow != NULL) {
        read_shadow(monitor);
    }
}
