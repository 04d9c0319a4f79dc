#include "agv/checksum.h"

#include <string.h>

/* CRC-32 of four bits: a compromise between the time of a loop over bits and the memory of a table of 256. */
static const uint32_t crc_of_nibble[16] = {0x00000000u, 0x1DB71064u, 0x3B6E20C8u, 0x26D930ACu, 0x76DC4190u, 0x6B6B51F4u,
                                           0x4DB26158u, 0x5005713Cu, 0xEDB88320u, 0xF00F9344u, 0xD6D6A3E8u, 0xCB61B38Cu,
                                           0x9B64C2B0u, 0x86D3D2D4u, 0xA00AE278u, 0xBDBDF21Cu};

uint32_t agv_crc32(uint32_t crc, const void *bytes, size_t size) {
    const uint8_t *byte = bytes;
    for (size_t i = 0u; i < size; i++) {
        crc ^= byte[i];
        crc = (crc >> 4u) ^ crc_of_nibble[crc & 15u];
        crc = (crc >> 4u) ^ crc_of_nibble[crc & 15u];
    }
    return crc;
}

static uint64_t pair_at(const unsigned char *bytes) {
    uint64_t pair;
    (void)memcpy(&pair, bytes, sizeof pair);
    return pair;
}

/*
 * Bytes per turn of the loop, which is unrolled: the checksum is calculated at every call of the supervisor. Two sums keep
 * within the registers of a Cortex-M, and a host adds both with one instruction.
 */
enum { PAIR_SIZE = 8, TURN_SIZE = 8 * PAIR_SIZE };

uint32_t agv_seal(const void *words, size_t size) {
    const unsigned char *at = words;
    uint64_t even = UINT32_MAX;
    uint64_t odd = 0u;
    for (size_t left = size / (size_t)TURN_SIZE; left != 0u; left--) {
        even ^= pair_at(at) ^ pair_at(&at[16]) ^ pair_at(&at[32]) ^ pair_at(&at[48]);
        odd ^= pair_at(&at[8]) ^ pair_at(&at[24]) ^ pair_at(&at[40]) ^ pair_at(&at[56]);
        at = &at[TURN_SIZE];
    }
    for (size_t left = (size % (size_t)TURN_SIZE) / (size_t)PAIR_SIZE; left != 0u; left--) {
        even ^= pair_at(at);
        at = &at[PAIR_SIZE];
    }
    even ^= odd;
    return (uint32_t)(even ^ (even >> 32u));
}
