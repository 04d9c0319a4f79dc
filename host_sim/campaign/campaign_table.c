/* The table of a campaign: a line a fault. */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

#include "agv/names.h"
#include "campaign/campaign_result.h"
#include "common/report.h"
#include "text/units.h"
#include "text/words.h"

enum { TIME_SIZE = 24 };

/** A line that is being written. */
typedef struct {
    size_t runs;
    size_t broken;
    size_t safe_count;
    int32_t confirmed_us;
    int32_t opened_us;
} line_t;

static int compare(const void *a, const void *b) {
    const int32_t one = *(const int32_t *)a;
    const int32_t two = *(const int32_t *)b;
    return (one > two) - (one < two);
}

static void print_time(int32_t us) {
    if (us == CAMPAIGN_NO_TIME) {
        (void)printf(" %9s", "-");
    } else {
        const uint32_t amount = (us < 0) ? (uint32_t)-us : (uint32_t)us;
        char text[TIME_SIZE];
        (void)snprintf(text, sizeof text, "%s%" PRIu32 ".%03" PRIu32, (us < 0) ? "-" : "", amount / US_PER_MS,
                       amount % US_PER_MS);
        (void)printf(" %9s", text);
    }
}

static int32_t maximum(int32_t one, int32_t two) {
    return (one > two) ? one : two;
}

/** Sum up the runs of a row. @param safe gets their times to the first safe frame */
static line_t sum_up(const campaign_samples_t *samples, size_t row, int32_t *safe) {
    line_t line = {.confirmed_us = CAMPAIGN_NO_TIME, .opened_us = CAMPAIGN_NO_TIME};

    for (size_t i = 0; i < samples->count; i++) {
        const campaign_sample_t *sample = &samples->samples[i];
        if (sample->row != row) {
            continue;
        }
        line.runs++;
        line.broken += sample->broken ? 1 : 0;
        line.confirmed_us = maximum(line.confirmed_us, sample->confirmed_us);
        line.opened_us = maximum(line.opened_us, sample->opened_us);
        if (sample->safe_us != CAMPAIGN_NO_TIME) {
            safe[line.safe_count] = sample->safe_us;
            line.safe_count++;
        }
    }
    qsort(safe, line.safe_count, sizeof *safe, compare);
    return line;
}

static void print_line(size_t row, const line_t *line, const int32_t *safe) {
    (void)printf("%-26s %8zu", agv_fault_name(CAMPAIGN_ROWS[row].fault), line->runs);
    print_time((line->safe_count > 0) ? safe[0] : CAMPAIGN_NO_TIME);
    print_time((line->safe_count > 0) ? safe[line->safe_count / 2] : CAMPAIGN_NO_TIME);
    print_time((line->safe_count > 0) ? safe[line->safe_count - 1] : CAMPAIGN_NO_TIME);
    print_time(line->confirmed_us);
    print_time(line->opened_us);
    (void)printf(" %7zu\n", line->broken);
}

bool campaign_print_table(const campaign_samples_t *samples) {
    int32_t *safe = malloc((samples->count + 1) * sizeof *safe);
    size_t broken = 0;

    if (safe == NULL) {
        return report("out of memory");
    }
    (void)printf("ms after the cause:                    first safe frame           confirmed output\n"
                 "%-26s %8s %9s %9s %9s %9s %9s %7s\n",
                 "fault", "runs", "min", "median", "max", "max", "max", "broken");
    for (size_t row = 0; row < CAMPAIGN_ROW_COUNT; row++) {
        const line_t line = sum_up(samples, row, safe);
        broken += line.broken;
        if (line.runs > 0) {
            print_line(row, &line, safe);
        }
    }
    (void)printf("%zu run%s, %zu broken\n", samples->count, words_plural(samples->count), broken);
    free(safe);
    return true;
}
