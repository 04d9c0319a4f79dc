/* The shards of a campaign, read side by side: run k is in the file of shard k % n + 1. */
#include <assert.h>
#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "campaign/campaign_line.h"
#include "cli/random_options.h"
#include "common/interrupt.h"
#include "common/report.h"

enum { RUNS_BETWEEN_LOOKS = 1024 };

/** A file that is being read. */
typedef struct {
    const char *path;
    FILE *stream;
    char *line;
    size_t room;
    size_t number; /**< of the line, from 1 */
} shard_t;

/** Whether the line is what this program writes: it goes into the merged file as it is. */
static bool is_as_written(const shard_t *shard, size_t length, const json_t *object) {
    char *text = json_dumps(object, 0);
    const bool same = (text != NULL) && (strlen(text) == length - 1) && (memcmp(text, shard->line, length - 1) == 0);
    free(text);
    return same;
}

/** Read the next line as an object. @return NULL: reported; the caller drops the reference */
static json_t *read_object(shard_t *shard) {
    assert(shard->stream != NULL);
    errno = 0;
    const ssize_t length = getline(&shard->line, &shard->room, shard->stream);
    if (length < 0) {
        if (errno != 0) {
            (void)report("%s: %s", shard->path, strerror(errno));
        } else if (shard->number == 0) {
            (void)report("%s: is empty", shard->path);
        } else {
            (void)report("%s: it ends after line %zu: runs are missing", shard->path, shard->number);
        }
        return NULL;
    }
    shard->number++;
    json_error_t error;
    const bool torn = shard->line[length - 1] != '\n';
    json_t *object = json_loadb(shard->line, (size_t)length, JSON_REJECT_DUPLICATES, &error);
    if (torn || !json_is_object(object) || !is_as_written(shard, (size_t)length, object)) {
        (void)report_at(shard->path, shard->number, "not a result of a campaign%s",
                        torn ? ": the line is incomplete" : " of this program version");
        json_decref(object);
        return NULL;
    }
    return object;
}

/** The first line. @return false: reported */
static bool read_part(shard_t *shard, campaign_part_t *part) {
    json_t *object = read_object(shard);
    const bool good = (object != NULL) && campaign_line_part(shard->path, shard->number, object, part);
    json_decref(object);
    return good;
}

/** Read run @p run into a sample. */
static bool read_run(shard_t *shard, const campaign_part_t *whole, uint64_t run, campaign_sample_t *sample) {
    uint64_t number = 0;
    json_t *object = read_object(shard);
    const bool good = (object != NULL) && campaign_line_run(shard->path, shard->number, object, &number, sample);
    json_decref(object);
    if (!good) {
        return false;
    }
    if (number != run) {
        return report_at(shard->path, shard->number, "run %" PRIu64 " is expected here", run);
    }
    const campaign_row_t *only = whole->causes.only;
    if (whole->causes.newly_engaged && (campaign_engagement(CAMPAIGN_ROWS[sample->row].fault) == NULL)) {
        return report_at(shard->path, shard->number, "its fault cannot occur in a campaign with --newly-engaged");
    }
    return (only == NULL) || (only == &CAMPAIGN_ROWS[sample->row]) ||
           report_at(shard->path, shard->number, "its fault is not that of the campaign (--fault)");
}

static bool is_same(const campaign_part_t *a, const campaign_part_t *b) {
    return (a->runs == b->runs) && (a->seed == b->seed) && (a->shards == b->shards) &&
           (a->causes.only == b->causes.only) && (a->causes.newly_engaged == b->causes.newly_engaged);
}

/** Put the shards in their order. @return false: they are not of one campaign; reported */
static bool sort_shards(shard_t *shards, size_t count, campaign_part_t *whole) {
    shard_t sorted[SHARDS_MAX];
    memset(sorted, 0, sizeof sorted);
    for (size_t i = 0; i < count; i++) {
        campaign_part_t part;
        if (!read_part(&shards[i], &part)) {
            return false;
        }
        *whole = (i == 0) ? part : *whole;
        if (!is_same(&part, whole)) {
            return report_at(shards[i].path, shards[i].number, "not the same campaign as %s", shards[0].path);
        }
        if (part.shards != count) {
            return report_at(shards[i].path, shards[i].number, "it is one of %" PRIu32 " shards, but %zu were given",
                             part.shards, count);
        }
        if (sorted[part.shard - 1].path != NULL) {
            return report_at(shards[i].path, shards[i].number, "shard %" PRIu32 " is given twice", part.shard);
        }
        sorted[part.shard - 1] = shards[i];
    }
    memcpy(shards, sorted, count * sizeof *shards);
    whole->shard = 1;
    whole->shards = 1;
    return true;
}

static bool is_at_end(shard_t *shard) {
    const bool at_end = getline(&shard->line, &shard->room, shard->stream) < 0;
    return at_end || report_at(shard->path, shard->number + 1, "more runs than the campaign has");
}

static bool merge(shard_t *shards, size_t count, campaign_samples_t *samples, output_t *merged) {
    campaign_part_t whole = {0};
    campaign_sample_t sample;

    if (!sort_shards(shards, count, &whole)) {
        return false;
    }
    if (merged->is_open) {
        campaign_write_part(merged, &whole);
    }
    for (uint64_t run = 0; run < whole.runs; run++) {
        if (((run % RUNS_BETWEEN_LOOKS) == 0) && interrupt_pending()) {
            return false;
        }
        shard_t *shard = &shards[run % count];
        if (!read_run(shard, &whole, run, &sample) || !campaign_samples_add(samples, &sample)) {
            return false;
        }
        if (merged->is_open) {
            (void)output_write(merged, shard->line, strlen(shard->line));
        }
    }
    bool good = true;
    for (size_t i = 0; good && (i < count); i++) {
        good = is_at_end(&shards[i]);
    }
    return good;
}

#if defined(__GNUC__) && !defined(__clang__)
/* The analyzer of gcc 12 loses sight of streams in an array and calls them leaked; close_shard() closes them. */
#pragma GCC diagnostic ignored "-Wanalyzer-malloc-leak"
#pragma GCC diagnostic ignored "-Wanalyzer-file-leak"
#endif

static bool open_shard(shard_t *shard) {
    const int fd = open(shard->path, O_RDONLY | O_CLOEXEC);
    if (fd < 0) {
        return report("%s: %s", shard->path, strerror(errno));
    }
    shard->stream = fdopen(fd, "r");
    if (shard->stream == NULL) {
        (void)close(fd);
        return report("%s: %s", shard->path, strerror(errno));
    }
    return true;
}

static bool open_shards(shard_t *shards, char *const files[], size_t count) {
    for (size_t i = 0; i < count; i++) {
        shards[i].path = files[i];
        if (!open_shard(&shards[i])) {
            return false;
        }
    }
    return true;
}

static void close_shard(shard_t *shard) {
    if (shard->stream != NULL) {
        (void)fclose(shard->stream);
    }
    free(shard->line);
}

bool campaign_merge(char *const files[], size_t count, campaign_samples_t *samples, output_t *merged) {
    shard_t *shards = calloc(count, sizeof *shards);
    if (shards == NULL) {
        return report("out of memory");
    }
    const bool good = open_shards(shards, files, count) && merge(shards, count, samples, merged);
    for (size_t i = 0; i < count; i++) {
        close_shard(&shards[i]);
    }
    free(shards);
    return good;
}
