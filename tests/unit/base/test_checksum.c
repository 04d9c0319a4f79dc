/* Checksums: known answers of the standards, pieces, and every flipped bit. */
#include "agv/checksum.h"

#include "unity.h"

static uint32_t crc32_of(const void *bytes, size_t size) {
    return ~agv_crc32(AGV_CRC32_START, bytes, size);
}

/* The standard check value, and the test vectors of iSCSI and Ethernet: 32 bytes of 0 and of FFh. */
void test_crc32_gives_the_known_answers(void) {
    uint8_t ones[32];
    const uint8_t zeros[32] = {0};
    for (size_t i = 0; i < sizeof ones; i++) {
        ones[i] = 0xFF;
    }
    TEST_ASSERT_EQUAL_HEX32(0xCBF43926u, crc32_of("123456789", 9));
    TEST_ASSERT_EQUAL_HEX32(0x190A55ADu, crc32_of(zeros, sizeof zeros));
    TEST_ASSERT_EQUAL_HEX32(0xFF6CAB0Bu, crc32_of(ones, sizeof ones));
    TEST_ASSERT_EQUAL_HEX32(0x00000000u, crc32_of("", 0));
}

void test_a_checksum_of_pieces_equals_that_of_the_whole(void) {
    const char text[] = "123456789";
    for (size_t cut = 0; cut <= 9; cut++) {
        const uint32_t head32 = agv_crc32(AGV_CRC32_START, text, cut);
        TEST_ASSERT_EQUAL_HEX32(0xCBF43926u, ~agv_crc32(head32, &text[cut], 9 - cut));
    }
}

/* 12345678h ^ 0F0F0F0Fh = 1D3B5977h, inverted E2C4A688h. */
void test_the_seal_is_the_inverted_exclusive_or_of_the_words(void) {
    const uint32_t words[10] = {0x12345678u, 0x0F0F0F0Fu, 0x00000001u, 0x00000020u, 0x00000300u,
                                0x00004000u, 0x00050000u, 0x00600000u, 0x07000000u, 0x80000000u};
    TEST_ASSERT_EQUAL_HEX32(0xE2C4A688u, agv_seal(words, 8));
    TEST_ASSERT_EQUAL_HEX32(0xE2C4A6A9u, agv_seal(words, 16));
    TEST_ASSERT_EQUAL_HEX32(0xE2A1E5A9u, agv_seal(words, 32));
    TEST_ASSERT_EQUAL_HEX32(0x65A1E5A9u, agv_seal(words, 40));
}

/* Eight pairs of words are one turn of the unrolled loop: 00000001h in one place, 0 elsewhere, inverted. */
void test_the_seal_covers_each_word_of_a_turn_and_of_the_rest(void) {
    for (uint32_t size = 64; size <= 144; size += 8) {
        for (uint32_t i = 0; i < size / 4; i++) {
            uint32_t words[36] = {0};
            TEST_ASSERT_EQUAL_HEX32(0xFFFFFFFFu, agv_seal(words, size));
            words[i] = 1;
            TEST_ASSERT_EQUAL_HEX32(0xFFFFFFFEu, agv_seal(words, size));
        }
    }
}

/* Shows: INT-5 */
void test_every_flipped_bit_breaks_the_seal_and_the_checksums(void) {
    uint32_t words[10] = {0x00000000u, 0xFFFFFFFFu, 0x12345678u, 0x80000001u, 0x00000010u,
                          0x0F0F0F0Fu, 0x00000000u, 0x00000000u, 0xFFFFFFFFu, 0x76543210u};
    const uint32_t seal = agv_seal(words, sizeof words);
    const uint32_t crc32 = crc32_of(words, sizeof words);
    for (uint32_t bit = 0; bit < 10 * 32; bit++) {
        words[bit / 32] ^= 1u << (bit % 32);
        TEST_ASSERT_TRUE(agv_seal(words, sizeof words) != seal);
        TEST_ASSERT_TRUE(crc32_of(words, sizeof words) != crc32);
        words[bit / 32] ^= 1u << (bit % 32);
    }
}
