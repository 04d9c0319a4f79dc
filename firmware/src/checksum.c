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

uint16_t agv_crc16(uint16_t crc, const void *bytes, size_t size) {
    const uint8_t *byte = bytes;
    uint32_t sum = crc;
    for (size_t i = 0u; i < size; i++) {
        /* Both nibbles at once, without a table: x is what the polynomial 1021h folds back. */
        uint32_t x = ((sum >> 8u) ^ byte[i]) & 0xFFu;
        x ^= x >> 4u;
        sum = ((sum << 8u) ^ (x << 12u) ^ (x << 5u) ^ x) & 0xFFFFu;
    }
    return (uint16_t)sum;
}

uint32_t agv_seal(const void *words, size_t size) {
    const unsigned char *const block = words;
    uint32_t folded = UINT32_MAX;
    for (size_t at = 0u; at < size; at += sizeof folded) {
        uint32_t word;
        (void)memcpy(&word, &block[at], sizeof word);
        folded ^= word;
    }
    return folded;
}
