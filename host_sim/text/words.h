/**
 * @file words.h
 * Lists of words, "a|b|c", and numbers as users write them.
 */
#ifndef HOST_SIM_WORDS_H
#define HOST_SIM_WORDS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/** The index of a word in a list. @return -1: it is not in it */
int words_find(const char *words, const char *word);

/** The word with an index, not terminated. @return its length; 0: no such index */
size_t words_at(const char *words, size_t index, const char **word);

/**
 * Read a whole decimal number: digits only, no sign, no blanks.
 * @return false: not a number, or not within @p lowest .. @p highest; not reported
 */
bool words_decimal(const char *text, uint64_t lowest, uint64_t highest, uint64_t *number);

/** Read "168h" or "0x168". @return false: neither; not reported. One above 64 bits is UINT64_MAX */
bool words_bits(const char *text, uint64_t *number);

/** Read an identifier: like words_bits(), or decimal without a leading zero, "360". */
bool words_id(const char *text, uint64_t *number);

/** Read @p length hexadecimal digits, 1 to 16 of them. @return false: other characters, or too many; not reported */
bool words_hex(const char *text, size_t length, uint64_t *number);

/** The ending of a noun behind its number: "1 run", "2 runs". */
const char *words_plural(uint64_t count);

/** Print a word on standard output, in capitals. */
void words_print_upper(const char *text);

#endif
