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
