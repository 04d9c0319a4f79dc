#include "world.h"

#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "traffic.h"

/* ---- The traffic ---- */

enum { ALL_MS = 8000, FRAMES_MAX = 6 };
enum { W_ALARM, W_DEADLINE, W_HOLD, W_RELEASE, W_REFUSAL, W_RESTART };

/* Times of the script. A 363h comes in every millisecond that ends with 1. */
enum {
    ENGAGED_MS = 1001,
    DRIVES_MS = 1200,
    ALARM_MS = 2001,
    ALARM_ENDS_MS = 2101,
    SILENT_MS = 1901, /* the AI computer's 065h */
    SILENT_ENDS_MS = 2151,
    OBEYS_MS = 2610, /* too late for FSM-4: the output opens, and only a reset closes it */
    RESTART_MS = 3000,
    PRESS_MS = 4001,
    ROLLS_MS = 5000,
    HELD_MS = 5301, /* a moment of the press in which all conditions have held for long enough */
    RELEASE_MS = 5501,
    ENGAGED_AGAIN_MS = 5601,
    ALARM_AGAIN_MS = 5901
};
enum { SPEED_MM_S = 1000, SPEED_COUNTS = 3600, THROTTLE = 40, ANGLE = ANGLE_CENTRE + 100, ALARM = 0x80 };

const window_t WORLD[WORLD_WINDOWS] = {[W_ALARM] = {"trip-alarm", 0, 2, 650, false},
                                       [W_DEADLINE] = {"trip-deadline", 0, 2, 650, false},
                                       [W_HOLD] = {"reset-hold", HELD_MS, 1, 1200, false},
                                       [W_RELEASE] = {"reset-release", RELEASE_MS, 2, 1000, false},
                                       [W_REFUSAL] = {"reset-refusal", RELEASE_MS, 2, 650, false},
                                       [W_RESTART] = {"restart", RESTART_MS, 2, 900, true}};

static frame_t frames[ALL_MS][FRAMES_MAX];
static uint32_t counts[ALL_MS];
static uint32_t last_command[ALL_MS]
                            [TRAFFIC_COMMANDS]; /* 1 + index of the AI computer's last frame: ms * FRAMES_MAX + n */
static unsigned window;
static bool gateway;
static uint32_t begin_ms;

/* The windows that begin while the vehicle drives; it does not obey then. */
static bool is_driving(void) {
    return (window == W_ALARM) || (window == W_DEADLINE);
}

static void drive(traffic_message_t *traffic, bool moves) {
    traffic_wheels(traffic, moves ? SPEED_MM_S : 0, moves ? SPEED_MM_S : 0);
    traffic_put_word(traffic[M_VEHICLE].data, moves ? SPEED_COUNTS : 0);
    traffic[M_THROTTLE_STATUS].data[0] = moves ? THROTTLE : 0;
}

static void engage(traffic_message_t *traffic) {
    traffic_mode(traffic, MODE_ENGAGED);
    traffic_gear(traffic, GEAR_D);
    traffic[M_GEAR].data[0] = GEAR_D;
    traffic[M_THROTTLE].data[0] = THROTTLE;
    traffic[M_SIGNALS].data[4] = 0;
    traffic_put_word(traffic[M_STEERING].data, ANGLE);
    traffic_put_word(&traffic[M_STEERING_STATUS].data[2], ANGLE);
}

static void obey(traffic_message_t *traffic) {
    traffic_mode(traffic, MODE_MANUAL);
    traffic_gear(traffic, GEAR_P);
    drive(traffic, false);
}

static void set_alarm(traffic_message_t *traffic, bool on) {
    traffic[M_VEHICLE].data[4] = on ? ALARM : 0;
}

static void follow_common(traffic_message_t *traffic, uint32_t ms) {
    if (ms == ENGAGED_MS) {
        engage(traffic);
    } else if (ms == DRIVES_MS) {
        drive(traffic, true);
    } else if ((ms == ALARM_MS) && (window != W_DEADLINE)) {
        set_alarm(traffic, true);
    } else if (ms == ALARM_ENDS_MS) {
        set_alarm(traffic, false);
    } else if ((window == W_DEADLINE) && ((ms == SILENT_MS) || (ms == SILENT_ENDS_MS))) {
        traffic[M_STEERING].muted = ms == SILENT_MS;
    }
}

/* The vehicle obeys, and the operator presses the button for 1.5 s. */
static void follow_reset(traffic_message_t *traffic, uint32_t ms) {
    if (ms == OBEYS_MS) {
        obey(traffic);
    } else if (window == W_RESTART) {
        return;
    } else if (ms == PRESS_MS) {
        traffic_button(traffic, true);
    } else if (ms == RELEASE_MS) {
        traffic_button(traffic, false);
    } else if (window == W_REFUSAL) {
        if (ms == ROLLS_MS) {
            drive(traffic, true);
        }
    } else if (ms == ENGAGED_AGAIN_MS) {
        engage(traffic);
        drive(traffic, true);
    } else if (ms == ALARM_AGAIN_MS) {
        set_alarm(traffic, true);
    }
}

static void put(uint32_t ms, unsigned message, const hal_can_frame_t *frame, hal_can_side_t side) {
    const uint32_t n = counts[ms];
    if (n >= FRAMES_MAX) {
        abort();
    }
    frames[ms][n] = (frame_t){.side = side, .id = frame->id, .length = frame->length};
    (void)memcpy(frames[ms][n].data, frame->data, sizeof frame->data);
    if (message < TRAFFIC_COMMANDS) {
        last_command[ms][message] = 1 + (ms * (uint32_t)FRAMES_MAX) + n;
    }
    counts[ms]++;
}

void world_choose(unsigned chosen, uint32_t topology) {
    static traffic_message_t traffic[TRAFFIC_MESSAGES];
    const agv_config_t config = {.topology = (uint16_t)topology, .id_set = AGV_ID_SET_HEADING};
    window = chosen;
    gateway = topology == AGV_TOPOLOGY_GATEWAY;
    begin_ms = UINT32_MAX;
    (void)memset(counts, 0, sizeof counts);
    (void)memset(last_command, 0, sizeof last_command);
    (void)memset(traffic, 0, sizeof traffic);
    traffic_heal(traffic);
    traffic_address(traffic, &config);
    for (uint32_t ms = 1; ms < ALL_MS; ms++) {
        (void)memcpy(last_command[ms], last_command[ms - 1], sizeof last_command[ms]);
        follow_common(traffic, ms);
        if (!is_driving()) {
            follow_reset(traffic, ms);
        }
        for (unsigned i = 0; i < TRAFFIC_MESSAGES; i++) {
            if (traffic_is_due(&traffic[i], ms)) {
                const hal_can_frame_t frame = traffic_next(&traffic[i]);
                put(ms, i, &frame, traffic[i].side);
            }
        }
    }
}

void world_begin(uint32_t first_ms) {
    begin_ms = first_ms;
}

const frame_t *world_frame(uint32_t now_ms, uint32_t n) {
    return ((now_ms < ALL_MS) && (n < counts[now_ms])) ? &frames[now_ms][n] : NULL;
}

/* ---- The judge ---- */

enum {
    SILENCE_MS = 500,
    TRIP_LATE_MS = 50,
    OPEN_BY_MS = 600,
    GLITCH_MS = 2,
    ANGLE_FAR = 50,
    STANDBY = 0x33,
    ACTIVE = 0x3C
};

static const uint8_t safe_signals[7] = {0, 0, 0, 0, 0x70, 0, 0};

/* Since when safe commands are due; UINT32_MAX: they are not. */
static uint32_t due_since(uint32_t now_ms) {
    if (window == W_HOLD || window == W_RELEASE) {
        if (now_ms >= ALARM_AGAIN_MS) {
            return ALARM_AGAIN_MS;
        }
        return ((window == W_HOLD) && (now_ms < RELEASE_MS)) ? begin_ms : UINT32_MAX;
    }
    return begin_ms;
}

static bool is_due(uint32_t now_ms) {
    return (now_ms >= begin_ms) && (due_since(now_ms) != UINT32_MAX);
}

static uint32_t word_of(const uint8_t *data) {
    return (uint32_t)data[0] | ((uint32_t)data[1] << 8);
}

/* In these windows the latch is closed from the beginning. */
static bool is_latched(uint32_t now_ms) {
    return !is_driving() && is_due(now_ms) && (now_ms < ALARM_AGAIN_MS);
}

/* Whether a frame tells the vehicle anything but to stand where it is. */
static bool moves(const frame_t *frame) {
    const uint32_t raw = word_of(frame->data);
    switch (frame->id) {
    case 0x43F:
        return (frame->data[4] & 0x40u) == 0;
    case 0x168:
        return frame->data[0] != GEAR_P;
    case 0x075:
        return frame->data[0] != 0;
    case 0x065:
        return (raw < (uint32_t)(ANGLE - ANGLE_FAR)) || (raw > (uint32_t)(ANGLE + ANGLE_FAR));
    default:
        return false;
    }
}

static bool is_sent_by_ai(const frame_t *frame, uint32_t now_ms) {
    for (unsigned i = 0; i < TRAFFIC_COMMANDS; i++) {
        const uint32_t at = last_command[now_ms][i];
        if (at != 0) {
            const frame_t *const sent = &frames[(at - 1) / FRAMES_MAX][(at - 1) % FRAMES_MAX];
            if ((sent->id == frame->id) && (memcmp(sent->data, frame->data, sizeof sent->data) == 0)) {
                return true;
            }
        }
    }
    return false;
}

/* A gateway may pass on what the AI computer sends, in manual only its lights, until it trips, which it may do late. */
static bool may_pass(const bus_t *bus, const frame_t *frame, uint32_t now_ms) {
    const bool manual =
        (frame->id != 0x43Fu) && (window >= W_HOLD) && (now_ms >= OBEYS_MS) && (now_ms < ENGAGED_AGAIN_MS);
    const bool driving = !is_due(now_ms) || (!bus->latched && (now_ms < due_since(now_ms) + (uint32_t)TRIP_LATE_MS));
    return gateway && !manual && driving && is_sent_by_ai(frame, now_ms);
}

static void note_safe(bus_t *bus, uint32_t now_ms, const frame_t *frame) {
    if ((frame->id == 0x43Fu) && (memcmp(frame->data, safe_signals, sizeof safe_signals) == 0)) {
        bus->safe_ms[0] = now_ms;
    } else if ((frame->id == 0x168u) && (frame->data[0] == GEAR_P)) {
        bus->safe_ms[1] = now_ms;
        bus->latched = bus->latched || is_due(now_ms);
    } else if ((frame->id == 0x075u) && (frame->data[0] == 0)) {
        bus->safe_ms[2] = now_ms;
    } else if (frame->id == 0x7F0u) {
        bus->reason = frame->data[1];
        if (is_latched(now_ms) && ((frame->data[0] == STANDBY) || (frame->data[0] == ACTIVE))) {
            bus->harm |= HARM_UNDONE;
        }
    }
}

static void mix(bus_t *bus, const void *bytes, size_t size) {
    for (size_t i = 0; i < size; i++) {
        bus->hash = (bus->hash ^ ((const uint8_t *)bytes)[i]) * 0x100000001B3u;
    }
}

void world_sent(bus_t *bus, uint32_t now_ms, const frame_t *frame) {
    mix(bus, frame, sizeof *frame);
    if ((frame->side != HAL_CAN_VEHICLE) || (frame->length != 8)) {
        return;
    }
    if (moves(frame) && !may_pass(bus, frame, now_ms)) {
        bus->harm |= HARM_MOTION;
    }
    note_safe(bus, now_ms, frame);
}

void world_output(bus_t *bus, uint32_t now_ms, bool closed) {
    if (closed == bus->output_closed) {
        return;
    }
    mix(bus, &closed, sizeof closed);
    bus->output_closed = closed;
    if (!closed) {
        bus->opened_ms = now_ms;
        return;
    }
    /* After a trip it stays closed until the vehicle has had its time to obey: then it may have opened for a moment. */
    const bool glitch = is_driving() && (now_ms - bus->opened_ms <= GLITCH_MS);
    if (is_due(now_ms) && !glitch) {
        bus->harm |= HARM_UNDONE;
    }
}

void world_reset(bus_t *bus, uint32_t now_ms) {
    world_output(bus, now_ms, false);
    for (uint32_t i = 0; i < WORLD_KINDS; i++) {
        bus->safe_ms[i] = now_ms;
    }
}

void world_passed(bus_t *bus, uint32_t now_ms) {
    if (!is_due(now_ms)) {
        bus->latched = false;
        return;
    }
    const uint32_t since_ms = due_since(now_ms);
    for (uint32_t i = 0; i < WORLD_KINDS; i++) {
        const uint32_t from_ms = (bus->safe_ms[i] > since_ms) ? bus->safe_ms[i] : since_ms;
        if (now_ms - from_ms > SILENCE_MS) {
            bus->harm |= HARM_SILENCE;
        }
    }
    if (is_driving() && bus->output_closed && (now_ms - since_ms > OPEN_BY_MS)) {
        bus->harm |= HARM_CLOSED;
    }
}
