/**
 * @file soak_rows.h
 * What disturbs a soak: random, and each of it survivable, because it stays below a limit or only warns.
 */
#ifndef HOST_SIM_SOAK_ROWS_H
#define HOST_SIM_SOAK_ROWS_H

#include <stddef.h>
#include <stdint.h>

/* When a disturbance may come. */
#define SOAK_ENGAGED (1u << 0)
#define SOAK_MANUAL (1u << 1)
#define SOAK_GATEWAY (1u << 2)
#define SOAK_SHARED (1u << 3)

typedef struct {
    const char *name;
    uint32_t flags;
    uint32_t weight;    /**< how often, beside the others */
    uint32_t lowest_ms; /**< it lasts for a random time */
    uint32_t highest_ms;
    const char *begin; /**< steps, divided by '|' */
    const char *end;
} soak_row_t;

extern const soak_row_t SOAK_ROWS[];
extern const size_t SOAK_ROW_COUNT;

#define SOAK_ROWS_MAX 64u

#endif
