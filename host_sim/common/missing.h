/**
 * @file missing.h
 * The words for what a reset or a start lacks: AGV_MISSING_*.
 */
#ifndef HOST_SIM_MISSING_H
#define HOST_SIM_MISSING_H

#include <stddef.h>
#include <stdint.h>

#define MISSING_BITS 10u
#define MISSING_TEXT_SIZE 160u

/** The words of all bits that are set, with commas between them. @return text */
const char *missing_text(uint16_t missing, char text[MISSING_TEXT_SIZE]);

/** The bit of a word; 0: there is no such word. */
uint16_t missing_bit(const char *word);

#endif
