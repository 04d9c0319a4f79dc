/* A classic CAN frame as a sequence of bits. */
#include "sim_internal.h"

#define DLC_BITS 4u
#define LENGTH_MAX 8u

/*
 * Bits that can be stuffed, 11-bit identifier: start 1, identifier 11, RTR 1, IDE 1, r0 1, DLC 4, data 8n, CRC 15
 * = 34 + 8n; 29 bits: start 1, identifier 11, SRR 1, IDE 1, identifier 18, RTR 1, r1 1, r0 1, DLC 4, data 8n, CRC 15
 * = 54 + 8n. Never stuffed: CRC delimiter 1, acknowledge slot 1 and delimiter 1, end of frame 7 = 10.
 * The first stuff bit needs five equal bits, each further one four more (the stuff bit itself is the first of the next
 * five): at most (stuffed - 1) / 4 of them, rounded down.
 */
#define STUFFED_BITS_STANDARD 34u
#define STUFFED_BITS_EXTENDED 54u
#define UNSTUFFED_BITS 10u

static uint32_t data_bytes(const hal_can_frame_t *frame) {
    return (frame->flags & HAL_CAN_REMOTE) != 0 ? 0 : frame->length;
}

uint32_t sim_bus_frame_bits(const hal_can_frame_t *frame) {
    uint32_t stuffed = (frame->flags & HAL_CAN_EXTENDED) != 0 ? STUFFED_BITS_EXTENDED : STUFFED_BITS_STANDARD;
    stuffed += 8 * data_bytes(frame);
    return stuffed + UNSTUFFED_BITS + (stuffed - 1) / 4;
}

/*
 * The bits of the arbitration field in the order in which they are sent, 0 dominant:
 * standard: identifier 11, RTR, IDE = 0 (which already beats the extended one, whose SRR and IDE are 1)
 * extended: identifier 11, SRR = 1, IDE = 1, identifier 18, RTR
 */
uint32_t sim_frame_key(const hal_can_frame_t *frame) {
    const uint32_t remote = (frame->flags & HAL_CAN_REMOTE) != 0 ? 1 : 0;
    if ((frame->flags & HAL_CAN_EXTENDED) == 0) {
        return frame->id << 21 | remote << 20;
    }
    return (frame->id >> 18) << 21 | 3u << 19 | (frame->id & 0x3FFFFu) << 1 | remote;
}

bool sim_frame_is_classic(const hal_can_frame_t *frame) {
    const uint32_t id_max = (frame->flags & HAL_CAN_EXTENDED) != 0 ? 0x1FFFFFFFu : 0x7FFu;
    return (frame->flags & ~(HAL_CAN_EXTENDED | HAL_CAN_REMOTE)) == 0 && frame->id <= id_max &&
           frame->length <= LENGTH_MAX;
}

uint32_t sim_frame_header_bits(const hal_can_frame_t *frame) {
    return (frame->flags & HAL_CAN_EXTENDED) != 0 ? 35 : 15;
}

bool sim_frame_bit(const hal_can_frame_t *frame, uint32_t index) {
    if (index < DLC_BITS) {
        return (frame->length >> (DLC_BITS - 1 - index) & 1) != 0;
    }
    const uint32_t data = index - DLC_BITS;
    return (frame->data[data / 8] >> (7 - data % 8) & 1) != 0;
}

uint32_t sim_frame_body_bits(const hal_can_frame_t *frame) {
    return DLC_BITS + 8 * data_bytes(frame);
}
