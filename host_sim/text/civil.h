/**
 * @file civil.h
 * Dates as people write them, as seconds since 1970.
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

#endif
