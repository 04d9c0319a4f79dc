/* The bus of a run as the page shows it. */
#include "web_bus.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "agv/codec.h"
#include "common/json_build.h"
#include "common/message_facts.h"
#include "text/units.h"
#include "traffic/bus_load.h"
#include "traffic/signals.h"
#include "web_run.h"

enum { COMMAND_HOLDS_US = 300000, AI = 0, SUPERVISOR = 1, BYTES_TEXT = 24 };

#define UNKNOWN UINT32_MAX

void web_bus_init(web_bus_t *bus, const agv_config_t *config, uint32_t bitrate) {
    (void)memset(bus, 0, sizeof *bus);
    bus->config = *config;
    bus->bitrate = bitrate;
}

static bool is_same(const web_frame_t *a, const web_frame_t *b) {
    return (a->frame.id == b->frame.id) && (a->side == b->side) && (a->from == b->from) &&
           (a->frame.flags == b->frame.flags);
}

/** The row of a frame; NULL: there is no room for another one. */
static web_row_t *row_of(web_bus_t *bus, const web_frame_t *frame) {
    for (uint32_t i = 0u; i < bus->count; i++) {
        if (is_same(&bus->rows[i].last, frame)) {
            return &bus->rows[i];
        }
    }
    if (bus->count == (uint32_t)WEB_BUS_ROWS) {
        return NULL;
    }
    bus->count++;
    return &bus->rows[bus->count - 1u];
}

/** Frames of the last full second. */
static uint32_t rate_of(const web_row_t *row, uint32_t second) {
    if (row->second == second) {
        return row->in_last;
    }
    return (row->second + 1u == second) ? row->in_second : 0u;
}

static void count_row(web_row_t *row, const web_frame_t *frame) {
    const uint32_t second = (uint32_t)(frame->t_us / (uint64_t)US_PER_S);
    if (row->second != second) {
        row->in_last = rate_of(row, second);
        row->in_second = 0u;
        row->second = second;
    }
    row->in_second++;
    row->gap_us = (row->total > 0u) ? frame->t_us - row->last.t_us : 0u;
    row->total++;
    row->last = *frame;
}

static void count_load(web_bus_t *bus, const web_frame_t *frame) {
    const uint32_t second = (uint32_t)(frame->t_us / (uint64_t)US_PER_S);
    bus_load_t load = {0};
    if (bus->second != second) {
        bus->last_bits = (bus->second + 1u == second) ? bus->bits : 0u;
        bus->bits = 0u;
        bus->second = second;
    }
    bus_load_frame(&load, &frame->frame, frame->t_us);
    bus->bits += load.stuffed_bits;
}

void web_bus_frame(web_bus_t *bus, agv_message_t message, uint64_t t_us, hal_can_side_t side, int from,
                   const hal_can_frame_t *frame) {
    web_frame_t taken = {
        .t_us = t_us, .message = UNKNOWN, .from = (int8_t)from, .side = (uint8_t)side, .frame = *frame};
    if (message != AGV_MSG_NONE) {
        taken.message = (uint32_t)message;
    } else if (frame->id == bus->config.status_frame_id) {
        taken.message = SIGNALS_STATUS_FRAME;
    }
    bus->frame_count++;
    taken.number = bus->frame_count;
    bus->frames[bus->frame_count % (uint32_t)WEB_BUS_FRAMES] = taken;
    web_row_t *row = row_of(bus, &taken);
    if (row != NULL) {
        count_row(row, &taken);
    }
    if (side == HAL_CAN_VEHICLE) {
        count_load(bus, &taken);
    }
    const bool is_command =
        (taken.message < (uint32_t)AGV_COMMAND_COUNT) && (frame->flags == 0u) && (frame->length == AGV_DLC);
    if (is_command && ((from == (int)VEHICLE_AI) || (from == (int)SCENARIO_FROM_SUPERVISOR))) {
        bus->commands[(from == (int)VEHICLE_AI) ? AI : SUPERVISOR][taken.message] = taken;
    }
}

/** The payload of a command that holds; NULL: none. */
static const uint8_t *command(const web_bus_t *bus, int who, agv_message_t message, uint64_t now_us) {
    const web_frame_t *frame = &bus->commands[who][message];
    const bool holds = (frame->number > 0u) && (now_us < frame->t_us + (uint64_t)COMMAND_HOLDS_US);
    return holds ? frame->frame.data : NULL;
}

/** The first signal of a command as a number of its own unit; WEB_NONE: none. */
static int32_t value_of(const web_bus_t *bus, int who, agv_message_t message, uint64_t now_us) {
    const uint8_t *data = command(bus, who, message, now_us);
    signal_value_t value;
    if ((data == NULL) || !signals_read((uint32_t)message, 0u, data, &value) || !value.valid) {
        return WEB_NONE;
    }
    return (message == AGV_MSG_GEAR_COMMAND) ? (int32_t)value.raw : (int32_t)value.scaled;
}

void web_bus_view(const web_bus_t *bus, uint64_t now_us, web_view_t *view) {
    for (int who = AI; who <= SUPERVISOR; who++) {
        view->command_gear[who] = value_of(bus, who, AGV_MSG_GEAR_COMMAND, now_us);
        view->command_throttle_permille[who] = value_of(bus, who, AGV_MSG_THROTTLE_COMMAND, now_us);
        view->command_angle_ddeg[who] = value_of(bus, who, AGV_MSG_STEERING_COMMAND, now_us);
    }
    view->bus_permille = (bus->bitrate > 0u) ? (int32_t)(bus->last_bits * 1000u / bus->bitrate) : 0;
}

static const char *sender_name(int from) {
    static const char *const names[] = {"VCU", "EPS", "AI computer", "another node"};
    return (from == (int)SCENARIO_FROM_SUPERVISOR) ? "supervisor" : names[from];
}

static json_t *bytes_text(const hal_can_frame_t *frame) {
    char text[BYTES_TEXT + 1] = "";
    const size_t length = (frame->length < AGV_DLC) ? frame->length : AGV_DLC;
    for (size_t i = 0u; ((frame->flags & HAL_CAN_REMOTE) == 0u) && (i < length); i++) {
        (void)snprintf(&text[i * 3u], 4u, "%02X%s", frame->data[i], (i + 1u < length) ? " " : "");
    }
    return json_text(text);
}

/** What is special about a frame, or its signals. */
static json_t *meaning(const web_frame_t *frame) {
    static const struct {
        uint8_t flag;
        const char *text;
    } kinds[] = {
        {HAL_CAN_EXTENDED, "29-bit identifier"}, {HAL_CAN_REMOTE, "remote request"}, {HAL_CAN_FD, "FD format"}};
    char text[SIGNALS_TEXT_SIZE] = "";
    for (unsigned i = 0u; i < sizeof kinds / sizeof kinds[0]; i++) {
        if ((frame->frame.flags & kinds[i].flag) != 0u) {
            return json_text(kinds[i].text);
        }
    }
    if (frame->message == UNKNOWN) {
        return json_text("not a message of the protocol");
    }
    if (frame->frame.length != AGV_DLC) {
        return json_text("wrong length");
    }
    return json_text(signals_print(text, sizeof text, frame->message, frame->frame.data));
}

static void set_frame(json_t *object, const web_frame_t *frame) {
    char id[12];
    const char *name = signals_message_name(frame->message);
    (void)snprintf(id, sizeof id, "%03" PRIX32 "h", frame->frame.id);
    json_put(object, "id", json_text(id));
    json_put(object, "name", json_text(name));
    json_put(object, "side", json_integer(frame->side));
    json_put(object, "from", json_text(sender_name(frame->from)));
    json_put(object, "t_us", json_uint(frame->t_us));
    json_put(object, "data", bytes_text(&frame->frame));
    json_put(object, "text", meaning(frame));
}

static const char *dump(json_t *value) {
    static char *text;
    free(text);
    text = json_dumps(value, JSON_COMPACT);
    json_decref(value);
    return text;
}

/** The limit of a message's silence; 0: none. */
static uint16_t deadline_ms(const web_bus_t *bus, uint32_t message) {
    const bool has_deadline = message < (uint32_t)AGV_MSG_COUNT;
    return has_deadline ? agv_config_get(&bus->config, message_deadline_setting(message)) : 0u;
}

/*
 * An object for each row: id "363h", name, side (0 vehicle, 1 AI), from, t_us, data, text of the last frame, and total,
 * rate (frames in the last full second), gap_us, deadline_ms (of its message; 0: none).
 */
const char *web_bus(void) {
    const web_run_t *web = web_run();
    const web_bus_t *bus = &web->bus;
    const uint32_t second = web->is_there ? web->next_ms / (uint32_t)MS_PER_S : 0u;
    json_t *rows = json_array();
    for (uint32_t i = 0u; i < bus->count; i++) {
        const web_row_t *row = &bus->rows[i];
        json_t *object = json_object();
        set_frame(object, &row->last);
        json_put(object, "total", json_integer(row->total));
        json_put(object, "rate", json_integer(rate_of(row, second)));
        json_put(object, "gap_us", json_uint(row->gap_us));
        json_put(object, "deadline_ms", json_integer(deadline_ms(bus, row->last.message)));
        json_add(rows, object);
    }
    return dump(rows);
}

/* An object for each frame, the oldest first: number, and the keys of web_bus() about a frame. */
const char *web_frames(uint32_t count) {
    const web_bus_t *bus = &web_run()->bus;
    uint32_t left = (count < (uint32_t)WEB_BUS_FRAMES) ? count : (uint32_t)WEB_BUS_FRAMES;
    left = (left < bus->frame_count) ? left : bus->frame_count;
    json_t *frames = json_array();
    for (; left > 0u; left--) {
        const web_frame_t *frame = &bus->frames[(bus->frame_count + 1u - left) % (uint32_t)WEB_BUS_FRAMES];
        json_t *object = json_object();
        json_put(object, "number", json_integer(frame->number));
        set_frame(object, frame);
        json_add(frames, object);
    }
    return dump(frames);
}
