#include "ui/timeline.h"

#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "agv/codec.h"
#include "agv/names.h"
#include "common/crash.h"
#include "common/missing.h"
#include "text/text.h"
#include "text/units.h"
#include "traffic/signals.h"

enum { MM_PER_CM = 10, WHAT_SIZE = SIGNALS_TEXT_SIZE + 80 };

/** A line has 100 columns: before the action, the action, and with it where the vehicle has no room. */
enum { BEFORE_WHAT = 25, WHAT = 51, WHAT_ALONE = 100 - BEFORE_WHAT };

/** A speed that is outside has no room, and no vehicle has it. */
enum { CM_S_LOWEST = -9999, CM_S_HIGHEST = 99999 };

#define MODE_BITS 0xC0
#define MODE_MANUAL 0x40
#define MODE_AUTOPILOT 0x80

void timeline_init(timeline_t *timeline, const scenario_testbed_t *testbed) {
    *timeline = (timeline_t){.testbed = testbed, .mode = -1};
}

void timeline_init_run(timeline_t *timeline, const agv_config_t *config) {
    *timeline = (timeline_t){.mode = -1};
    agv_config_ids(config, &timeline->ids);
}

static agv_message_t message_of(const timeline_t *timeline, uint32_t id) {
    return (timeline->testbed != NULL) ? scenario_testbed_message(timeline->testbed, id)
                                       : (agv_message_t)agv_ids_find(&timeline->ids, id);
}

/** The time of the wire. */
static uint64_t now_us(const timeline_t *timeline) {
    scenario_testbed_view_t view;
    if (timeline->testbed == NULL) {
        return timeline->now_us;
    }
    scenario_testbed_view(timeline->testbed, &view);
    return view.now_us;
}

static char gear_letter(uint8_t gear) {
    switch (gear) {
    case AGV_GEAR_P:
        return 'P';
    case AGV_GEAR_R:
        return 'R';
    case AGV_GEAR_N:
        return 'N';
    case AGV_GEAR_D:
        return 'D';
    default:
        return (gear == 0) ? '-' : '?';
    }
}

static const char *mode_word(int mode) {
    switch (mode) {
    case MODE_MANUAL:
        return "manual";
    case MODE_AUTOPILOT:
        return "autopilot";
    default:
        return (mode < 0) ? "-" : "invalid";
    }
}

/** Print what the vehicle reports, and end the line. */
static void print_vehicle(const timeline_t *timeline) {
    const int32_t cm_s = timeline->speed_mm_s / MM_PER_CM;
    (void)printf("%c %-9s ", gear_letter(timeline->gear), mode_word(timeline->mode));
    if ((cm_s < CM_S_LOWEST) || (cm_s > CM_S_HIGHEST)) {
        (void)printf("%s m/s\n", (cm_s < 0) ? "<-99" : ">999");
    } else {
        (void)printf("%s%d.%02d m/s\n", (cm_s < 0) ? "-" : "", abs((int)cm_s) / 100, abs((int)cm_s) % 100);
    }
}

/** Print an action, and the vehicle if there is room for it; a long action is broken at blanks. */
static void print_what(const timeline_t *timeline, const char *what) {
    while (strlen(what) > WHAT_ALONE) {
        const size_t length = text_break(what, (size_t)WHAT_ALONE);
        (void)printf("%.*s\n%*s", (int)length, what, BEFORE_WHAT, "");
        what = &what[length + ((what[length] == ' ') ? 1 : 0)];
    }
    if (strlen(what) > WHAT) {
        (void)printf("%s\n", what);
    } else {
        (void)printf("%-*s  ", WHAT, what);
        print_vehicle(timeline);
    }
}

/** Print a line: time, actor, action, and what the vehicle reports. */
static void line(timeline_t *timeline, uint64_t t_us, const char *who, const char *format, ...)
    __attribute__((format(printf, 4, 5)));

static void line(timeline_t *timeline, uint64_t t_us, const char *who, const char *format, ...) {
    char what[WHAT_SIZE];
    va_list arguments;

    va_start(arguments, format);
    (void)vsnprintf(what, sizeof what, format, arguments);
    va_end(arguments);
    if (!timeline->header_done) {
        timeline->header_done = true;
        (void)printf("%11s  %-10s  %-*s  %s\n", "time", "who", WHAT, "what", "gear, mode, speed");
    }
    (void)printf("%5" PRIu64 ".%03" PRIu64 " s  %-10s  ", t_us / US_PER_S, (t_us % US_PER_S) / US_PER_MS, who);
    print_what(timeline, what);
}

void timeline_step(void *ctx, uint64_t t_ms, const scenario_step_t *step) {
    timeline_t *timeline = ctx;
    const vehicle_action_t *action = &step->vehicle;
    char more[WHAT_SIZE] = "";

    timeline->step_us = t_ms * US_PER_MS;
    timeline->step_actor = step->actor;
    timeline->step_word = step->word;
    if (step->of_vehicle && ((action->what == VEHICLE_DO_AI_DRIVE) || (action->what == VEHICLE_DO_REMOTE_DRIVE))) {
        (void)snprintf(more, sizeof more, " (gear %c, throttle %d %%, steering %d deg)", gear_letter(action->gear),
                       action->throttle_permille / 10, (int)(action->angle_ddeg / 10));
    } else if (step->of_vehicle && (action->message != AGV_MSG_NONE)) {
        (void)snprintf(more, sizeof more, " (%s)", agv_message_name(action->message));
    } else if (step->of_vehicle && (action->what == VEHICLE_DO_BUTTON)) {
        (void)snprintf(more, sizeof more, " button %u", (unsigned)action->count);
    } else {
        more[0] = '\0';
    }
    line(timeline, timeline->step_us, step->actor, "%s%s", step->word, more);
}

static void show_state(timeline_t *timeline, uint64_t t_us, const agv_event_t *event) {
    const char *reason = agv_fault_name((agv_fault_t)event->c);

    timeline->shown = 0;
    if (event->b == AGV_STATE_TRIPPED) {
        timeline->trip_us = now_us(timeline);
        timeline->wants_reaction = (reason != NULL) && (timeline->testbed != NULL);
    }
    line(timeline, t_us, "supervisor", "=> %s%s%s", agv_state_name((agv_state_t)event->b), (reason != NULL) ? ": " : "",
         (reason != NULL) ? reason : "");
}

static void show_missing(timeline_t *timeline, uint64_t t_us, const char *what, uint16_t missing) {
    char list[MISSING_TEXT_SIZE];

    line(timeline, t_us, "supervisor", "%s%s%s", what, (missing != 0) ? "; missing: " : "",
         missing_text(missing, list));
}

static void show_fault(timeline_t *timeline, uint64_t t_us, const agv_event_t *event) {
    const bool is_raised = event->c != 0;
    const bool has_parts = is_raised && (event->missing != 0);
    char parts[MISSING_TEXT_SIZE];

    line(timeline, t_us, "supervisor", "%s %s%s%s%s", agv_fault_name((agv_fault_t)event->a),
         is_raised ? "raised" : "ended", (is_raised && (event->b == AGV_CLASS_WARN)) ? " (warning)" : "",
         has_parts ? ": " : "", has_parts ? parts_text(event->missing, parts) : "");
}

static void show_crash(timeline_t *timeline, uint64_t t_us, const agv_event_t *event) {
    char text[CRASH_TEXT_SIZE];

    line(timeline, t_us, "supervisor", "run before: %s", crash_text(event, text));
}

void timeline_event(void *ctx, const session_event_t *event) {
    timeline_t *timeline = ctx;
    const uint64_t t_us = event->t_ms * US_PER_MS;
    const agv_event_t *recorded = &event->recorded;

    if (event->is_led) {
        if (event->led_code != 0) {
            line(timeline, t_us, "supervisor", "LED code %d", event->led_code);
        }
        return;
    }
    switch ((agv_event_kind_t)recorded->kind) {
    case AGV_EVENT_STATE:
        show_state(timeline, t_us, recorded);
        break;
    case AGV_EVENT_FAULT:
        show_fault(timeline, t_us, recorded);
        break;
    case AGV_EVENT_OUTPUT:
        line(timeline, t_us, "supervisor", "safety output %s", (recorded->a != 0) ? "closed" : "open");
        break;
    case AGV_EVENT_RESET:
        show_missing(timeline, t_us, (recorded->a != 0) ? "reset accepted" : "reset refused", recorded->missing);
        break;
    case AGV_EVENT_STARTUP:
        show_missing(timeline, t_us, "still in INIT", recorded->missing);
        break;
    case AGV_EVENT_CRASH:
        show_crash(timeline, t_us, recorded);
        break;
    default:
        break;
    }
}

static void show_reaction(timeline_t *timeline, uint64_t t_us) {
    const uint64_t decided_us = t_us - timeline->trip_us;
    const uint64_t caused_us = t_us - timeline->step_us;

    timeline->wants_reaction = false;
    line(timeline, t_us, "",
         "first safe frame is out %" PRIu64 ".%03" PRIu64 " ms after the decision, %" PRIu64 ".%03" PRIu64
         " ms after %s %s",
         decided_us / US_PER_MS, decided_us % US_PER_MS, caused_us / US_PER_MS, caused_us % US_PER_MS,
         (timeline->step_actor != NULL) ? timeline->step_actor : "the",
         (timeline->step_word != NULL) ? timeline->step_word : "start");
}

/** The first frame of each message that the supervisor sends in a state. */
static void show_sent(timeline_t *timeline, uint64_t t_us, const hal_can_frame_t *frame) {
    const agv_message_t message = message_of(timeline, frame->id);
    const uint8_t *d = frame->data;
    char signals[SIGNALS_TEXT_SIZE];

    if ((message == AGV_MSG_NONE) || ((timeline->shown & agv_message_bit(message)) != 0)) {
        return;
    }
    timeline->shown |= agv_message_bit(message);
    line(timeline, t_us, "supervisor", "sends %03X [%02X %02X %02X %02X %02X %02X %02X %02X] %s: %s",
         (unsigned)frame->id, d[0], d[1], d[2], d[3], d[4], d[5], d[6], d[7], agv_message_name(message),
         signals_print(signals, sizeof signals, (uint32_t)message, d));
    if (timeline->wants_reaction) {
        show_reaction(timeline, t_us);
    }
}

static void show_reported(timeline_t *timeline, uint64_t t_us, const hal_can_frame_t *frame) {
    const agv_message_t message = message_of(timeline, frame->id);
    agv_wheel_speed_t wheels;

    if ((message == AGV_MSG_GEAR_STATUS) && (frame->data[0] != timeline->gear)) {
        timeline->gear = frame->data[0];
        line(timeline, t_us, "vcu", "reports gear %c", gear_letter(timeline->gear));
    } else if ((message == AGV_MSG_VEHICLE_STATUS) && ((frame->data[6] & MODE_BITS) != timeline->mode)) {
        timeline->mode = frame->data[6] & MODE_BITS;
        line(timeline, t_us, "vcu", "reports %s", mode_word(timeline->mode));
    } else if ((message == AGV_MSG_WHEEL_SPEED) && agv_unpack_wheel_speed(&wheels, frame->data)) {
        const bool stopped = (wheels.left_mm_s == 0) && (timeline->speed_mm_s != 0);
        timeline->speed_mm_s = wheels.left_mm_s;
        if (stopped) {
            line(timeline, t_us, "vcu", "reports 0.00 m/s");
        }
    } else {
        return;
    }
}

static void show_frame(void *ctx, uint64_t t_us, hal_can_side_t side, int from, const hal_can_frame_t *frame) {
    timeline_t *timeline = ctx;

    if ((side != HAL_CAN_VEHICLE) || (frame->flags != 0) || (frame->length != AGV_DLC)) {
        return;
    }
    if (from == SCENARIO_FROM_SUPERVISOR) {
        show_sent(timeline, t_us, frame);
    } else if (from == VEHICLE_VCU) {
        show_reported(timeline, t_us, frame);
    } else {
        return;
    }
}

scenario_watch_t timeline_watch(timeline_t *timeline) {
    return (scenario_watch_t){.on_event = timeline_event, .on_frame = show_frame, .ctx = timeline};
}

void timeline_received(timeline_t *timeline, hal_can_side_t side, const hal_can_frame_t *frame, uint64_t t_us) {
    timeline->now_us = t_us;
    if ((side == HAL_CAN_VEHICLE) && (frame->flags == 0) && (frame->length == AGV_DLC)) {
        show_reported(timeline, t_us, frame);
    }
}

void timeline_sent(timeline_t *timeline, hal_can_side_t side, const hal_can_frame_t *frame, uint64_t t_us) {
    timeline->now_us = t_us;
    if (side == HAL_CAN_VEHICLE) {
        show_sent(timeline, t_us, frame);
    }
}

static bool is_seen(const agv_event_t *event, agv_message_t message) {
    return ((event->seen >> (uint32_t)message) & 1) != 0;
}

void timeline_snapshot(timeline_t *timeline, const agv_event_t *event) {
    agv_wheel_speed_t wheels;
    if (is_seen(event, AGV_MSG_GEAR_STATUS)) {
        timeline->gear = event->frames[AGV_MSG_GEAR_STATUS][0];
    }
    if (is_seen(event, AGV_MSG_VEHICLE_STATUS)) {
        timeline->mode = event->frames[AGV_MSG_VEHICLE_STATUS][6] & MODE_BITS;
    }
    if (is_seen(event, AGV_MSG_WHEEL_SPEED) && agv_unpack_wheel_speed(&wheels, event->frames[AGV_MSG_WHEEL_SPEED])) {
        timeline->speed_mm_s = wheels.left_mm_s;
    }
}
