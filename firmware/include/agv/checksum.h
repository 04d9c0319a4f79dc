/**
 * @file checksum.h
 * Checksums: CRC-32 for what is stored or compared (INT-3, FSM-7, HW-4), a fast one for the supervisor's memory (INT-5).
 */
#ifndef AGV_CHECKSUM_H
#define AGV_CHECKSUM_H

#include <stddef.h>
#include <stdint.h>

/** Start value of agv_crc32. */
#define AGV_CRC32_START 0xFFFFFFFFu

/**
 * CRC-32 (IEEE 802.3, reflected) over bytes, in one or several calls: pass AGV_CRC32_START to the first call, pass the
 * result of each call to the next, and invert the last result. "123456789" gives CBF43926h.
 */
uint32_t agv_crc32(uint32_t crc, const void *bytes, size_t size);

/**
 * Fast checksum over memory: the inverted exclusive-or of its 32-bit words. Detects every single flipped bit.
 * @param size bytes, a multiple of 8; a rest is not checked
 */
uint32_t agv_seal(const void *words, size_t size);

#endif
