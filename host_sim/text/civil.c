#include "text/civil.h"

#include <stdio.h>
#include <time.h>

#include "text/units.h"

enum { YEAR_MIN = 1970, YEAR_MAX = 9999, YEAR_0 = 1900, MARCH = 3, MONTHS = 12, HOURS = 24, SIXTY = 60 };
enum { DAYS_PER_YEAR = 365, DAYS_PER_5_MONTHS = 153, DAYS_TO_1970 = 719468, LEAP = 4, CENTURY = 100, ERA = 400 };

static bool is_leap(uint32_t year) {
    return ((year % LEAP) == 0) && (((year % CENTURY) != 0) || ((year % ERA) == 0));
}

static uint32_t days_of(uint32_t year, uint32_t month) {
    static const uint8_t days[MONTHS] = {31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};
    return days[month - 1u] + (((month == 2u) && is_leap(year)) ? 1u : 0u);
}

/** Days since 1970-01-01, counted in years that begin in March. */
static uint64_t days_since_1970(uint32_t year, uint32_t month, uint32_t day) {
    const uint64_t y = (uint64_t)year - ((month < MARCH) ? 1 : 0);
    const uint64_t m = ((uint64_t)month + (uint64_t)MONTHS - (uint64_t)MARCH) % MONTHS;
    const uint64_t day_of_year = (((uint64_t)DAYS_PER_5_MONTHS * m) + 2) / 5 + day - 1;
    return (y * DAYS_PER_YEAR) + (y / LEAP) - (y / CENTURY) + (y / ERA) + day_of_year - DAYS_TO_1970;
}

bool civil_seconds(const civil_t *civil, uint64_t *seconds) {
    if ((civil->year < YEAR_MIN) || (civil->year > YEAR_MAX) || (civil->month < 1) || (civil->month > MONTHS) ||
        (civil->day < 1) || (civil->day > days_of(civil->year, civil->month)) || (civil->hour >= HOURS) ||
        (civil->minute >= SIXTY) || (civil->second > SIXTY)) {
        return false;
    }
    const uint64_t days = days_since_1970(civil->year, civil->month, civil->day);
    *seconds = (((((days * HOURS) + civil->hour) * SIXTY) + civil->minute) * SIXTY) + civil->second;
    return true;
}

const char *civil_local(char text[CIVIL_LOCAL_SIZE], uint64_t at_us) {
    const time_t seconds = (time_t)(at_us / US_PER_S);
    struct tm local;
    text[0] = '\0';
    if (localtime_r(&seconds, &local) != NULL) {
        (void)snprintf(text, CIVIL_LOCAL_SIZE, "%04d-%02d-%02d %02d:%02d:%02d.%03u", local.tm_year + YEAR_0,
                       local.tm_mon + 1, local.tm_mday, local.tm_hour, local.tm_min, local.tm_sec,
                       (unsigned)(at_us % US_PER_S / US_PER_MS));
    }
    return text;
}
