/**
 * @file missing.h
 * The words for bits of an event: what a reset or a start lacks (AGV_MISSING_*), and the parts that failed their test
 * (HAL_SELF_TEST_*).
 */
#ifndef HOST_SIM_MISSING_H
#define HOST_SIM_MISSING_H

#include <stdint.h>

#define MISSING_TEXT_SIZE 160u

/** The words of all bits that are set, with commas between them. @return text */
const char *missing_text(uint16_t missing, char text[MISSING_TEXT_SIZE]);

/** The bit of a word; 0: there is no such word. */
uint16_t missing_bit(const char *word);

/** @name The same for the parts of the self-test @{ */
const char *parts_text(uint16_t parts, char text[MISSING_TEXT_SIZE]);
uint16_t part_bit(const char *word);
/** @} */

#endif
