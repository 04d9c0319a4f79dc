/* How nodes send: on their cycles, and as they misbehave. */
#include <string.h>

#include "common/message_facts.h"
#include "vehicle/vehicle_internal.h"

#define EXTENDED_ID_SHIFT 18u /* an 11-bit identifier in the upper bits of a 29-bit one */

/** xorshift32 */
static uint32_t next_random(vehicle_t *vehicle) {
    uint32_t x = vehicle->random;

    x ^= x << 13;
    x ^= x >> 17;
    x ^= x << 5;
    vehicle->random = x;
    return x;
}

/** Count down what lasts for a number of frames. */
static void count_down(uint16_t *left) {
    if (*left != VEHICLE_FOREVER) {
        (*left)--;
    }
}

static void shorten(vehicle_t *vehicle, hal_can_frame_t *frame) {
    frame->length = (uint8_t)(next_random(vehicle) % AGV_DLC);
    memset(&frame->data[frame->length], 0, (size_t)AGV_DLC - frame->length);
}

static void corrupt_frame(vehicle_t *vehicle, vehicle_garbage_t kind, hal_can_frame_t *frame) {
    switch (kind) {
    case VEHICLE_GARBAGE_RANDOM:
        for (unsigned i = 0; i < AGV_DLC; i++) {
            frame->data[i] = (uint8_t)(next_random(vehicle) >> 24);
        }
        break;
    case VEHICLE_GARBAGE_LENGTH:
        shorten(vehicle, frame);
        break;
    case VEHICLE_GARBAGE_EXTENDED:
        frame->flags = HAL_CAN_EXTENDED;
        frame->id <<= EXTENDED_ID_SHIFT;
        break;
    case VEHICLE_GARBAGE_REMOTE:
        frame->flags = HAL_CAN_REMOTE;
        memset(frame->data, 0, AGV_DLC);
        break;
    default:
        break;
    }
}

static void set_bit(uint8_t bytes[AGV_DLC], unsigned bit, const uint8_t value[AGV_DLC]) {
    const uint8_t mask = (uint8_t)(1u << (bit % 8));

    bytes[bit / 8] = (uint8_t)((bytes[bit / 8] & ~mask) | (value[bit / 8] & mask));
}

vehicle_stretch_t vehicle_stretch(uint16_t count, uint16_t every) {
    return (vehicle_stretch_t){
        .left = count, .frames = count, .gap = (every > count) ? (uint16_t)(every - count) : (uint16_t)0};
}

/** One more frame. @return whether it is in the stretch, and not in a gap or after the end */
static bool pass_frame(vehicle_stretch_t *stretch) {
    if (stretch->left != 0) {
        count_down(&stretch->left);
        stretch->gap_left = (stretch->left == 0) ? stretch->gap : (uint16_t)0;
        return true;
    }
    if (stretch->gap_left != 0) {
        stretch->gap_left--;
        stretch->left = (stretch->gap_left == 0) ? stretch->frames : (uint16_t)0;
    }
    return false;
}

static bool goes_on(const vehicle_stretch_t *stretch) {
    return (stretch->left != 0) || (stretch->gap_left != 0);
}

void vehicle_patch(vehicle_message_t *message, const vehicle_action_t *action) {
    for (unsigned byte = 0; byte < AGV_DLC; byte++) {
        const uint8_t mask = (uint8_t)~action->keep[byte];
        const uint8_t held = (action->what == VEHICLE_DO_HOLD) ? mask : (uint8_t)0;
        message->held[byte] = (uint8_t)((message->held[byte] & action->keep[byte]) | held);
    }
    for (unsigned bit = 0; bit < AGV_DLC * 8; bit++) {
        if ((action->keep[bit / 8] >> (bit % 8) & 1) == 0) {
            set_bit(message->value, bit, action->value);
            message->patches[bit] = vehicle_stretch(action->count, action->every);
        }
    }
    message->patched = true;
}

void vehicle_unpatch(vehicle_message_t *message) {
    memset(message->patches, 0, sizeof message->patches);
    memset(message->held, 0, sizeof message->held);
    message->patched = false;
}

/** What is to be held is what this frame carries. */
static void take_held(vehicle_message_t *message, const uint8_t data[AGV_DLC]) {
    for (unsigned byte = 0; byte < AGV_DLC; byte++) {
        const uint8_t held = message->held[byte];
        message->value[byte] = (uint8_t)((message->value[byte] & ~held) | (data[byte] & held));
        message->held[byte] = 0;
    }
}

static void apply_patches(vehicle_message_t *message, uint8_t data[AGV_DLC]) {
    bool more = false;

    take_held(message, data);
    for (unsigned bit = 0; bit < AGV_DLC * 8; bit++) {
        vehicle_stretch_t *patch = &message->patches[bit];
        if (pass_frame(patch)) {
            set_bit(data, bit, message->value);
        }
        more = more || goes_on(patch);
    }
    message->patched = more;
}

/** Put what was carried `delay_ms` ago in the place of what would be carried now; the counter runs on. */
static void delay_data(vehicle_message_t *state, agv_message_t message, uint8_t data[AGV_DLC]) {
    vehicle_past_t *past = &state->past;
    const uint32_t wanted = state->delay_ms / agv_message_cycle_ms(message);
    const uint8_t at = message_counter_at(message);
    const uint8_t counter = (at != MESSAGE_NO_COUNTER) ? data[at] : (uint8_t)0;

    memcpy(past->data[past->next], data, AGV_DLC);
    const uint32_t back = (wanted < past->count) ? wanted : past->count;
    memcpy(data, past->data[(past->next + VEHICLE_PAST_MAX - back) % VEHICLE_PAST_MAX], AGV_DLC);
    past->next = (uint16_t)((past->next + 1) % VEHICLE_PAST_MAX);
    past->count = (past->count < VEHICLE_PAST_MAX - 1) ? (uint16_t)(past->count + 1) : past->count;
    if (at != MESSAGE_NO_COUNTER) {
        data[at] = counter;
    }
}

void vehicle_send_message(vehicle_t *vehicle, agv_message_t message, uint64_t now_ms) {
    const vehicle_row_t *row = &VEHICLE_ROWS[message];
    vehicle_message_t *state = &vehicle->messages[message];
    const vehicle_node_state_t *node = &vehicle->nodes[row->node];
    const uint32_t period_ms =
        ((state->period_ms != 0) ? state->period_ms : agv_message_cycle_ms(message)) + node->lag_ms;
    hal_can_frame_t frame = {.id = vehicle->id[message], .time_ms = (uint32_t)now_ms, .length = AGV_DLC};

    uint64_t *due_ms = &vehicle->message_ms[message];

    *due_ms += period_ms;
    if (*due_ms <= now_ms) { /* time was not called for long: no burst */
        *due_ms = now_ms + period_ms;
    }
    row->compose(vehicle, now_ms, frame.data);
    if (state->delay_ms != 0) {
        delay_data(state, message, frame.data);
    }
    if (pass_frame(&state->muted)) {
        return;
    }
    if (state->patched) {
        apply_patches(state, frame.data);
    }
    if (node->garbage != VEHICLE_GARBAGE_OFF) {
        corrupt_frame(vehicle, (vehicle_garbage_t)node->garbage, &frame);
    }
    for (unsigned i = 0; i <= node->repeat; i++) {
        vehicle->send(vehicle->send_ctx, row->node, vehicle_side_of(vehicle, row->node), &frame);
    }
}

void vehicle_recover(vehicle_t *vehicle, vehicle_node_t node) {
    vehicle_node_state_t *state = &vehicle->nodes[node];

    state->frozen = false;
    state->lag_ms = 0;
    state->repeat = 0;
    state->garbage = VEHICLE_GARBAGE_OFF;
    for (int m = 0; m < AGV_MSG_COUNT; m++) {
        vehicle_message_t *message = &vehicle->messages[m];
        if (VEHICLE_ROWS[m].node == node) {
            message->muted = vehicle_stretch(0, 0);
            vehicle_unpatch(message);
            message->period_ms = 0;
            message->delay_ms = 0;
        }
        message->ignored = message->ignored && (vehicle_receiver_of((agv_message_t)m) != node);
    }
    if (node == VEHICLE_EPS) {
        vehicle->operator.eps_stuck = false;
        vehicle->operator.eps_hunt =(vehicle_swing_t){.period_ms = 0};
    }
    if (node == VEHICLE_VCU) {
        vehicle->vcu_faults = (vehicle_vcu_faults_t){.rolls = false};
    }
}

bool vehicle_add_rogue(vehicle_t *vehicle, uint64_t now_ms, const vehicle_action_t *action) {
    for (unsigned i = 0; i < VEHICLE_ROGUES_MAX; i++) {
        vehicle_rogue_t *rogue = &vehicle->rogues[i];
        if (rogue->left == 0) {
            rogue->left = (action->count != 0) ? action->count : 1;
            rogue->period_ms = (action->ms != 0) ? action->ms : 1;
            rogue->due_ms = now_ms;
            rogue->side = action->side;
            rogue->frame = action->frame;
            return true;
        }
    }
    return false;
}

uint64_t vehicle_send_rogues(vehicle_t *vehicle, uint64_t now_ms) {
    uint64_t next = UINT64_MAX;

    for (unsigned i = 0; i < VEHICLE_ROGUES_MAX; i++) {
        vehicle_rogue_t *rogue = &vehicle->rogues[i];
        if (rogue->left == 0) {
            continue;
        }
        if (now_ms >= rogue->due_ms) {
            rogue->due_ms = now_ms + rogue->period_ms;
            rogue->frame.time_ms = (uint32_t)now_ms;
            count_down(&rogue->left);
            vehicle->send(vehicle->send_ctx, VEHICLE_ROGUE, rogue->side, &rogue->frame);
        }
        if ((rogue->left != 0) && (rogue->due_ms < next)) {
            next = rogue->due_ms;
        }
    }
    return next;
}
