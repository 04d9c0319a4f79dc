#include "ui/progress.h"

#include <inttypes.h>
#include <stdio.h>
#include <unistd.h>

#include "text/units.h"

enum { EVERY_MS = 200, WIDTH = 30, PERCENT = 100 };

static int64_t now_ms(void) {
    return (int64_t)monotonic_ms();
}

void progress_begin(progress_t *progress, uint64_t total) {
    progress->shown = isatty(STDERR_FILENO) == 1;
    progress->total = total;
    progress->began_ms = now_ms();
    progress->next_ms = progress->began_ms;
}

void progress_show(progress_t *progress, uint64_t done, const char *unit) {
    static const char bar[] = "##############################";
    if (!progress->shown || (now_ms() < progress->next_ms)) {
        return;
    }
    const int64_t spent_ms = now_ms() - progress->began_ms;
    const int64_t left_ms = (done > 0) ? (spent_ms * (int64_t)(progress->total - done)) / (int64_t)done : 0;
    const int filled = (int)((done * (uint64_t)WIDTH) / progress->total);
    progress->next_ms = now_ms() + EVERY_MS;
    (void)fprintf(stderr, "\r[%-*.*s] %3" PRIu64 " %%  %" PRIu64 " of %" PRIu64 " %s, %" PRId64 " s left\033[K", WIDTH,
                  filled, bar, (done * PERCENT) / progress->total, done, progress->total, unit, left_ms / MS_PER_S);
}

void progress_end(progress_t *progress) {
    if (progress->shown) {
        (void)fprintf(stderr, "\r\033[K");
        progress->shown = false;
    }
}
