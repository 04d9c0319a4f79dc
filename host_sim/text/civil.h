/**
 * @file civil.h
 * Dates and times of day as people write them.
 */
#ifndef HOST_SIM_CIVIL_H
#define HOST_SIM_CIVIL_H

#include <stdbool.h>
#include <stdint.h>

/** A date and a time of day, UTC. */
typedef struct {
    uint32_t year;  /**< 1970 to 9999 */
    uint32_t month; /**< 1 to 12 */
    uint32_t day;   /**< 1 to 31 */
    uint32_t hour;
    uint32_t minute;
    uint32_t second; /**< up to 60: a leap second is the second after */
} civil_t;

/** @param[out] seconds since 1970-01-01 00:00:00 @return false: there is no such date or time of day */
bool civil_seconds(const civil_t *civil, uint64_t *seconds);

/** Size of a local time in print, and length of the date at its beginning. */
enum { CIVIL_LOCAL_SIZE = 40, CIVIL_DATE_LENGTH = 10 };

/** Microseconds since 1970 as local date and time of day: "2026-11-20 10:33:06.209"; "": there is none. @return text */
const char *civil_local(char text[CIVIL_LOCAL_SIZE], uint64_t at_us);

#endif
