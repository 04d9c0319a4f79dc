#include "agv/checksum.h"

#include <string.h>

uint32_t agv_crc32(uint32_t crc, const void *bytes, size_t size) {
    const uint8_t *byte = bytes;
    for (size_t i = 0u; i < size; i++) {
        crc ^= byte[i];
        for (uint32_t bit = 0u; bit < 8u; bit++) {
            crc = ((crc & 1u) != 0u) ? ((crc >> 1u) ^ 0xEDB88320u) : (crc >> 1u);
        }
    }
    return crc;
}

/* Words that are folded side by side: quicker, as they do not wait for each other. */
enum { LANES = 4 };

uint32_t agv_seal(const void *words, size_t size) {
    const unsigned char *const block = words;
    const size_t in_lanes = size - (size % (LANES * sizeof(uint32_t)));
    uint32_t lanes[LANES] = {UINT32_MAX, 0u, 0u, 0u};
    for (size_t at = 0u; at < in_lanes; at += sizeof lanes) {
        uint32_t next[LANES];
        (void)memcpy(next, &block[at], sizeof next);
        for (uint32_t lane = 0u; lane < (uint32_t)LANES; lane++) {
            lanes[lane] ^= next[lane];
        }
    }
    for (size_t at = in_lanes; at < size; at += sizeof(uint32_t)) {
        uint32_t word;
        (void)memcpy(&word, &block[at], sizeof word);
        lanes[0] ^= word;
    }
    return lanes[0] ^ lanes[1] ^ lanes[2] ^ lanes[3];
}
