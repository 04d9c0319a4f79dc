#include "text/words.h"

#include "unity.h"

void test_a_word_is_found_as_a_whole(void) {
    TEST_ASSERT_EQUAL_INT(0, words_find("shared|gateway", "shared"));
    TEST_ASSERT_EQUAL_INT(1, words_find("shared|gateway", "gateway"));
    TEST_ASSERT_EQUAL_INT(-1, words_find("shared|gateway", "gate"));
    TEST_ASSERT_EQUAL_INT(-1, words_find("shared|gateway", "gateways"));
    TEST_ASSERT_EQUAL_INT(-1, words_find("shared|gateway", "shared|gateway"));
    TEST_ASSERT_EQUAL_INT(-1, words_find("shared|gateway", ""));
}

void test_the_word_with_an_index(void) {
    const char *word = NULL;
    TEST_ASSERT_EQUAL_UINT(1, words_at("a|bb|ccc", 0, &word));
    TEST_ASSERT_EQUAL_STRING("a|bb|ccc", word);
    TEST_ASSERT_EQUAL_UINT(3, words_at("a|bb|ccc", 2, &word));
    TEST_ASSERT_EQUAL_STRING("ccc", word);
    TEST_ASSERT_EQUAL_UINT(0, words_at("a|bb|ccc", 3, &word));
}

void test_a_decimal_number_of_64_bits(void) {
    uint64_t number = 0;
    TEST_ASSERT_TRUE(words_decimal("18446744073709551615", 0, UINT64_MAX, &number));
    TEST_ASSERT_EQUAL_UINT64(UINT64_MAX, number);
    TEST_ASSERT_FALSE(words_decimal("18446744073709551616", 0, UINT64_MAX, &number));
    TEST_ASSERT_FALSE(words_decimal("184467440737095516150", 0, UINT64_MAX, &number));
    TEST_ASSERT_FALSE(words_decimal("", 0, UINT64_MAX, &number));
    TEST_ASSERT_FALSE(words_decimal("1 ", 0, UINT64_MAX, &number));
    TEST_ASSERT_TRUE(words_decimal("007", 7, 7, &number));
    TEST_ASSERT_EQUAL_UINT64(7, number);
    TEST_ASSERT_FALSE(words_decimal("6", 7, 9, &number));
    TEST_ASSERT_FALSE(words_decimal("10", 7, 9, &number));
}

void test_hexadecimal_digits_in_either_case(void) {
    uint64_t number = 0;
    TEST_ASSERT_TRUE(words_hex("3fA", 3, &number));
    TEST_ASSERT_EQUAL_HEX64(0x3FA, number);
    TEST_ASSERT_TRUE(words_hex("12345678", 4, &number));
    TEST_ASSERT_EQUAL_HEX64(0x1234, number);
    TEST_ASSERT_TRUE(words_hex("FFFFFFFFFFFFFFFF", 16, &number));
    TEST_ASSERT_EQUAL_HEX64(UINT64_MAX, number);
    TEST_ASSERT_FALSE(words_hex("10000000000000000", 17, &number));
    TEST_ASSERT_FALSE(words_hex("1G", 2, &number));
    TEST_ASSERT_FALSE(words_hex("1", 0, &number));
}

void test_an_identifier_in_any_notation(void) {
    static const char *const same[] = {"0x168", "168h", "360"};
    static const char *const bad[] = {"",      "h",    "0x", "x168",  "0168", "00",  "0x168h",
                                      "168hh", "16Gh", "-1", "168 h", "1e2",  "168H"};
    uint64_t number = 0;
    for (size_t i = 0; i < sizeof same / sizeof same[0]; i++) {
        TEST_ASSERT_TRUE_MESSAGE(words_id(same[i], &number), same[i]);
        TEST_ASSERT_EQUAL_UINT64_MESSAGE(0x168, number, same[i]);
    }
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        TEST_ASSERT_FALSE_MESSAGE(words_id(bad[i], &number), bad[i]);
    }
    TEST_ASSERT_TRUE(words_id("0", &number));
    TEST_ASSERT_EQUAL_UINT64(0, number);
    TEST_ASSERT_TRUE(words_id("10000000000000000h", &number));
    TEST_ASSERT_EQUAL_UINT64(UINT64_MAX, number);
    TEST_ASSERT_TRUE(words_id("18446744073709551616", &number));
    TEST_ASSERT_EQUAL_UINT64(UINT64_MAX, number);
}

void test_the_ending_of_a_noun(void) {
    TEST_ASSERT_EQUAL_STRING("s", words_plural(0));
    TEST_ASSERT_EQUAL_STRING("", words_plural(1));
    TEST_ASSERT_EQUAL_STRING("s", words_plural(2));
}
