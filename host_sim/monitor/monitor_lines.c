#include "monitor/monitor_lines.h"

#include <inttypes.h>
#include <stdio.h>
#include <unistd.h>

#include "common/interrupt.h"
#include "text/units.h"

static bool has_news;

void monitor_lines_print(void *ctx, const monitor_entry_t *entry) {
    (void)ctx;
    has_news = true;
    (void)printf("%7" PRIu64 ".%03" PRIu64 " s  %-10s  %s\n", entry->t_us / US_PER_S,
                 (entry->t_us % US_PER_S) / US_PER_MS, entry->who, entry->text);
}

bool monitor_lines_flush(void) {
    if (!has_news) {
        return ferror(stdout) == 0;
    }
    has_news = false;
    return interrupt_wait(STDOUT_FILENO, INTERRUPT_WRITE) && (fflush(stdout) == 0);
}
