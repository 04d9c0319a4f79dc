/*
 * Exhaustive test of all 2,048 identifiers with every length, on each side, with several payloads, in each state of
 * each variant of the configuration (testbed.h), against the rules of rules.h. A frame that is not a complete message
 * of the protocol on its own side must change only the counters (INT-2): after it, and after the next ticks, the state
 * is the same as without it, except for the override of another sender's command (TOP-1).
 *
 * usage: every_frame [PAYLOADS]     only the first PAYLOADS payloads, for slow builds
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "testbed_state.h"

enum { ID_COUNT = 0x800, PATTERNS = 6, TICKS = 8, LENGTHS = 11, KINDS = 4 };

static const uint8_t LENGTH_OF[LENGTHS] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 64};

/* Alarms and faults, modes, gears, values out of range and safe commands, in every byte. */
static const uint8_t PATTERN[PATTERNS][8] = {
    {0, 0, 0, 0, 0, 0, 0, 0},
    {0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF},
    {1, 0, 0, 1, 0, 0, 0x80, 1},
    {8, 0, 0, 0, 0x70, 0, 0, 0x55},
    {0x51, 0x46, 0x51, 0x46, 0x08, 0, 0x41, 0xAA},
    {0x28, 0x23, 0x28, 0x23, 0, 1, 0xC0, 0x10},
};
static const uint8_t KIND[KINDS] = {0, HAL_CAN_EXTENDED, HAL_CAN_REMOTE, HAL_CAN_ERROR};
static const char *const STATE_NAMES[TESTBED_STATES] = {"INIT", "STANDBY", "ACTIVE", "TRIPPED", "SAFE"};

/* The state that a malformed frame must not change. */
typedef struct {
    agv_state_t state;
    agv_fault_t first_reason;
    agv_fault_set_t active;
    bool output_closed;
    int8_t led;
    uint64_t sent;
} trace_t;

static uint64_t cases;
static uint64_t without_trace;
static uint64_t tripped;

static trace_t look(void) {
    return (trace_t){.state = agv_supervisor_state(&testbed.supervisor),
                     .first_reason = agv_supervisor_first_reason(&testbed.supervisor),
                     .active = agv_supervisor_active_faults(&testbed.supervisor),
                     .output_closed = testbed.hal.safety_output.on,
                     .led = agv_supervisor_led_code(&testbed.supervisor),
                     .sent = testbed.rules.sent};
}

static bool is_same(const trace_t *a, const trace_t *b, bool answered) {
    return (a->state == b->state) && (a->first_reason == b->first_reason) &&
           (memcmp(&a->active, &b->active, sizeof a->active) == 0) && (a->output_closed == b->output_closed) &&
           (a->led == b->led) && (answered || (a->sent == b->sent));
}

static void ticks(unsigned count) {
    for (unsigned i = 0; i < count; i++) {
        testbed_jump(1);
    }
}

static bool is_one_of(uint32_t id, const uint16_t *ids, unsigned count) {
    for (unsigned i = 0; i < count; i++) {
        if (ids[i] == id) {
            return true;
        }
    }
    return false;
}

static bool is_command(uint32_t id) {
    const uint16_t ids[] = {(uint16_t)testbed.rules.oracle.signal_id, 0x168, 0x075, 0x065};
    return is_one_of(id, ids, 4);
}

static bool is_status(uint32_t id) {
    const uint16_t ids[] = {(uint16_t)testbed.rules.oracle.vehicle_id, 0x0A3, 0x050, 0x067, 0x167, 0x267, 0x101};
    return is_one_of(id, ids, 7);
}

/* Whether a VCU may obey the frame: data frames of any length, FD too. */
static bool is_data_frame(const hal_can_frame_t *frame) {
    return (frame->flags & (HAL_CAN_EXTENDED | HAL_CAN_REMOTE | HAL_CAN_ERROR)) == 0;
}

/* Incomplete messages that have an effect: commands of any length, on the wrong side (SUP-6) or while engaged (SUP-5),
 * and the identifier of the status frame (TOP-3). */
static bool is_reported(hal_can_side_t side, const hal_can_frame_t *frame, agv_state_t state) {
    const bool gateway = testbed.rules.oracle.gateway;
    const bool engaged = (state == AGV_STATE_ACTIVE) || (state == AGV_STATE_TRIPPED);
    if (!is_data_frame(frame) || (!gateway && (side == HAL_CAN_AI))) {
        return false;
    }
    if (is_command(frame->id)) {
        return engaged || (gateway && (side == HAL_CAN_VEHICLE));
    }
    return (side == HAL_CAN_VEHICLE) && (frame->id == testbed.rules.oracle.own_status_id) && (frame->id != 0);
}

/* Whether the frame is a complete message on a side where it has an effect. A command on the wrong side is an
 * intrusion. */
static bool says_something(hal_can_side_t side, const hal_can_frame_t *frame) {
    const bool gateway = testbed.rules.oracle.gateway;
    if ((frame->flags != 0) || (frame->length != 8) || (!gateway && (side == HAL_CAN_AI))) {
        return false;
    }
    return is_command(frame->id) || ((side == HAL_CAN_VEHICLE) && is_status(frame->id));
}

static void fail(const char *what, hal_can_side_t side, const hal_can_frame_t *frame) {
    (void)fprintf(stderr, "%s: side %d, %03X, flags %X, length %u, %02X %02X %02X %02X ..\n", what, (int)side,
                  (unsigned)frame->id, frame->flags, frame->length, frame->data[0], frame->data[1], frame->data[2],
                  frame->data[3]);
    exit(1);
}

static void try_frame(const testbed_state_t *kept, const trace_t *without, hal_can_side_t side,
                      const hal_can_frame_t *frame) {
    testbed_restore(kept);
    cases++;
    testbed_frame(side, *frame, 1);
    const bool speaks = says_something(side, frame) || is_reported(side, frame, without->state);
    const bool answered = is_command(frame->id) && (side == HAL_CAN_VEHICLE) && is_data_frame(frame);
    testbed_jump(0);
    ticks(speaks || answered ? TICKS : 0);
    if (speaks) {
        tripped += ((without->state != AGV_STATE_TRIPPED) && (look().state == AGV_STATE_TRIPPED)) ? 1 : 0;
        return;
    }
    const trace_t with = look();
    if (answered) {
        testbed_restore(kept);
        ticks(TICKS + 1);
    }
    const trace_t compared = answered ? look() : *without;
    if (!is_same(&compared, &with, answered)) {
        fail("it left a trace", side, frame);
    }
    without_trace++;
}

static void try_id(const testbed_state_t *kept, const trace_t *without, uint32_t id, unsigned payloads) {
    for (unsigned i = 0; i < (unsigned)LENGTHS * payloads * HAL_CAN_SIDES; i++) {
        const uint8_t length = LENGTH_OF[i % LENGTHS];
        const uint8_t *pattern = PATTERN[(i / LENGTHS) % payloads];
        const hal_can_side_t side = (hal_can_side_t)(i / ((unsigned)LENGTHS * payloads));
        hal_can_frame_t frame = {.id = id, .length = length, .flags = (length > 9) ? HAL_CAN_FD : 0};
        memcpy(frame.data, pattern, (length < 8) ? length : 8);
        try_frame(kept, without, side, &frame);
    }
    for (unsigned kind = 1; kind < KINDS; kind++) {
        hal_can_frame_t frame = {.id = id, .length = 8, .flags = KIND[kind]};
        memcpy(frame.data, PATTERN[1], 8);
        try_frame(kept, without, HAL_CAN_VEHICLE, &frame);
    }
}

static void try_state(unsigned variant, unsigned state, unsigned payloads) {
    static testbed_state_t kept;
    const uint64_t before = cases;
    testbed_load(variant, state);
    testbed_save(&kept);
    ticks(1);
    const trace_t without = look();
    for (uint32_t id = 0; id < ID_COUNT; id++) {
        try_id(&kept, &without, id, payloads);
    }
    (void)printf("variant %u, %-8s %8llu frames\n", variant, STATE_NAMES[state], (unsigned long long)(cases - before));
}

int main(int argc, char **argv) {
    const unsigned long payloads = (argc > 1) ? strtoul(argv[1], NULL, 10) : PATTERNS;
    if ((payloads == 0) || (payloads > PATTERNS)) {
        (void)fprintf(stderr, "usage: every_frame [PAYLOADS]\n");
        return 2;
    }
    for (unsigned variant = 0; variant < TESTBED_VARIANTS; variant++) {
        for (unsigned state = 0; state < TESTBED_STATES; state++) {
            try_state(variant, state, (unsigned)payloads);
        }
    }
    (void)printf("%llu frames: all identifiers, lengths and sides; %llu of them left no trace, %llu tripped\n",
                 (unsigned long long)cases, (unsigned long long)without_trace, (unsigned long long)tripped);
    return (tripped > 0) ? 0 : 1;
}
