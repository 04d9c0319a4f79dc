/**
 * @file checksum.h
 * Checksums over bytes.
 */
#ifndef AGV_CHECKSUM_H
#define AGV_CHECKSUM_H

#include <stddef.h>
#include <stdint.h>

/** Start value of agv_crc32. */
#define AGV_CRC32_START 0xFFFFFFFFu

/**
 * CRC-32 (IEEE 802.3, reflected) of a byte sequence, in pieces: start with AGV_CRC32_START, hand the result on, and
 * invert the last one. "123456789" gives CBF43926h.
 */
uint32_t agv_crc32(uint32_t crc, const void *bytes, size_t size);

/**
 * Quick seal over memory: the exclusive-or of its 32-bit words, inverted. Any one flipped bit changes it.
 * @param size a multiple of 8
 */
uint32_t agv_seal(const void *words, size_t size);

#endif
