/* The search: pieces of runs, each with a corpus of programs that showed something new. */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "common/interrupt.h"
#include "common/prng.h"
#include "hunt/hunt.h"
#include "hunt/hunt_state.h"
#include "text/units.h"
#include "text/words.h"
#include "ui/progress.h"

enum { CORPUS_MAX = 256, RANDOM_PERCENT = 35, PERCENT = 100, MS_PER_MIN = 60000 };
enum { LOOK_EVERY = 16 };

/** All of it. */
typedef struct {
    const hunt_request_t *request;
    checkpoint_t checkpoint;
    hunt_state_t state;
    hunt_play_t play;
    uint8_t seen[HUNT_FEATURE_BYTES]; /**< in this piece */
    hunt_program_t corpus[CORPUS_MAX];
    uint32_t corpus_count;
    uint64_t began_ms;
    uint64_t processor_began_ms;
    uint64_t runs; /**< from the beginning on, with those that the checkpoint does not have yet */
    uint64_t virtual_ms;
    output_t file; /**< of the checkpoint or of a scenario */
    progress_t progress;
} hunt_t;

/** How a part of it went. */
typedef enum { GOES_ON, OVER, INTERRUPTED, FAILED } went_t;

void hunt_list_hazards(void) {
    for (int kind = (int)HAZARD_NONE + 1; kind < HAZARD_KINDS; kind++) {
        const hazard_info_t *info = hazard_info((hazard_kind_t)kind);
        (void)printf("%s  %s\n    safe: %s\n", info->name, info->meaning, info->safe);
    }
}

static uint64_t spent_ms(const hunt_t *hunt) {
    return hunt->state.spent_ms + (monotonic_ms() - hunt->began_ms);
}

/** Processor time of the program. */
static uint64_t used_ms(void) {
    return (uint64_t)clock() / ((uint64_t)CLOCKS_PER_SEC / MS_PER_S);
}

static uint64_t processor_ms(const hunt_t *hunt) {
    return hunt->state.processor_ms + (used_ms() - hunt->processor_began_ms);
}

/** From now on, time counts that the checkpoint does not have. */
static void begin_counting(hunt_t *hunt) {
    hunt->began_ms = monotonic_ms();
    hunt->processor_began_ms = used_ms();
}

/** Whether a run showed what no run of the piece did before. */
static bool is_new(hunt_t *hunt) {
    bool new = false;

    for (size_t i = 0; i < HUNT_FEATURE_BYTES; i++) {
        const uint8_t more = (uint8_t)(hunt->play.features[i] & (uint8_t)~hunt->seen[i]);
        new = new || (more != 0);
        hunt->seen[i] |= more;
    }
    return new;
}

static void draw_program(hunt_t *hunt, hunt_program_t *program, uint64_t *random) {
    if ((hunt->corpus_count == 0) || (prng_draw(random, 1, PERCENT) <= RANDOM_PERCENT)) {
        hunt_program_make(program, random);
        return;
    }
    *program = hunt->corpus[prng_draw(random, 0, hunt->corpus_count - 1)];
    hunt_program_mutate(program, &hunt->corpus[prng_draw(random, 0, hunt->corpus_count - 1)], random);
}

static void add_to_corpus(hunt_t *hunt, const hunt_program_t *program, uint64_t *random) {
    if (!is_new(hunt)) {
        return;
    }
    if (hunt->corpus_count < CORPUS_MAX) {
        hunt->corpus[hunt->corpus_count] = *program;
        hunt->corpus_count++;
    } else {
        hunt->corpus[prng_draw(random, 0, CORPUS_MAX - 1)] = *program;
    }
}

/** @return false: reported */
static bool run_one(hunt_t *hunt, uint64_t run, uint64_t *random) {
    const hunt_place_t place = {.folder = hunt->request->folder,
                                .seed = hunt->request->seed,
                                .run = run,
                                .spent_ms = spent_ms(hunt),
                                .file = &hunt->file};
    hunt_program_t program;

    draw_program(hunt, &program, random);
    if (!hunt_play(&hunt->play, &program)) {
        return report("run %" PRIu64 ": its scenario is invalid", run);
    }
    hunt->runs++;
    hunt->virtual_ms += hunt->play.played_ms;
    if (hunt->play.hazard.kind == HAZARD_NONE) {
        add_to_corpus(hunt, &program, random);
        return true;
    }
    return hunt_found_take(&hunt->state.found, &hunt->play, &program, &place);
}

static void show_progress(hunt_t *hunt) {
    if (hunt->request->minutes != UINT64_MAX) {
        progress_show(&hunt->progress, spent_ms(hunt) / MS_PER_S, "seconds");
    } else {
        progress_show(&hunt->progress, hunt->runs, "runs");
    }
}

static bool is_time_over(const hunt_t *hunt) {
    return (hunt->request->minutes != UINT64_MAX) && (spent_ms(hunt) >= hunt->request->minutes * MS_PER_MIN);
}

/** A piece of the whole, by its number. It is OVER when the hunt ends before it is whole. */
static went_t run_piece(hunt_t *hunt, uint64_t piece) {
    uint64_t random = hunt->request->seed;
    const uint64_t first = piece * HUNT_PIECE_RUNS;

    random = prng_next(&random) ^ piece;
    memset(hunt->seen, 0, sizeof hunt->seen);
    hunt->corpus_count = 0;
    for (uint64_t i = 0; i < HUNT_PIECE_RUNS; i++) {
        if (first + i >= hunt->request->runs) {
            return OVER;
        }
        if (!run_one(hunt, first + i, &random)) {
            return FAILED;
        }
        show_progress(hunt);
        if ((i % LOOK_EVERY) == 0) {
            if (interrupt_pending()) {
                return INTERRUPTED;
            }
            if (is_time_over(hunt)) {
                return OVER;
            }
        }
    }
    return GOES_ON;
}

/** The piece that is next, by its number. */
static uint64_t next_piece(const hunt_t *hunt) {
    return (hunt->state.pieces * hunt->request->shards) + hunt->request->shard - 1;
}

static went_t run_all(hunt_t *hunt) {
    went_t went = GOES_ON;

    while (went == GOES_ON) {
        went = run_piece(hunt, next_piece(hunt));
        if (went == GOES_ON) {
            hunt->state.pieces++;
            hunt->state.virtual_ms = hunt->virtual_ms;
            hunt->state.spent_ms = spent_ms(hunt);
            hunt->state.processor_ms = processor_ms(hunt);
            begin_counting(hunt);
            went = hunt_state_save(&hunt->checkpoint, &hunt->state, &hunt->file) ? GOES_ON : FAILED;
        }
    }
    return went;
}

static uint64_t total_of(const hunt_request_t *request) {
    const uint64_t total =
        (request->minutes != UINT64_MAX) ? request->minutes * (MS_PER_MIN / MS_PER_S) : request->runs / request->shards;
    return (total > 0) ? total : 1;
}

/** What the checkpoint has is counted. */
static status_t conclude(const hunt_t *hunt) {
    const hunt_found_t *found = &hunt->state.found;

    (void)printf("%" PRIu64 " s of processor time\n", processor_ms(hunt) / MS_PER_S);
    (void)printf("%" PRIu64 " run%s, %" PRIu64 " simulated seconds, took %" PRIu64 " s; %" PRIu64
                 " run%s with a hazard, %" PRIu32 " distinct\n",
                 hunt->runs, words_plural(hunt->runs), hunt->virtual_ms / MS_PER_S, spent_ms(hunt) / MS_PER_S,
                 found->runs, words_plural(found->runs), found->count);
    (void)fflush(stdout); /* also when a signal that came ends the program */
    return (found->count == 0) ? STATUS_OK : STATUS_UNMET;
}

/** A checkpoint is whole pieces: the runs after the last one are done once more. */
static void note_interrupted(const hunt_t *hunt) {
    const char *plural = words_plural(hunt->runs);
    if (hunt->request->checkpoint == NULL) {
        note("interrupted after %" PRIu64 " run%s", hunt->runs, plural);
    } else if (hunt->state.pieces == 0) {
        note("interrupted after %" PRIu64 " run%s; nothing is saved yet: the checkpoint is written after each %u runs",
             hunt->runs, plural, HUNT_PIECE_RUNS);
    } else {
        note("interrupted after %" PRIu64 " run%s; the same command resumes from run %" PRIu64, hunt->runs, plural,
             next_piece(hunt) * HUNT_PIECE_RUNS);
    }
}

static status_t run_until_end(hunt_t *hunt) {
    /* Before the first run, so that none is lost. */
    if (!hunt_state_load(hunt->request, &hunt->checkpoint, &hunt->state, &hunt->file)) {
        return STATUS_UNUSABLE;
    }
    interrupt_hold();
    hunt->runs = hunt->state.pieces * HUNT_PIECE_RUNS;
    hunt->virtual_ms = hunt->state.virtual_ms;
    begin_counting(hunt);
    progress_begin(&hunt->progress, total_of(hunt->request));
    const went_t went = run_all(hunt);
    progress_end(&hunt->progress);
    if (went == FAILED) {
        return STATUS_UNUSABLE;
    }
    if (went == INTERRUPTED) {
        note_interrupted(hunt);
    }
    return conclude(hunt);
}

status_t hunt_run(const hunt_request_t *request) {
    hunt_t *hunt = calloc(1, sizeof *hunt);

    if (hunt == NULL) {
        (void)report("out of memory");
        return STATUS_UNUSABLE;
    }
    hunt->request = request;
    const status_t status = run_until_end(hunt);
    output_discard(&hunt->file);
    checkpoint_close(&hunt->checkpoint);
    free(hunt);
    interrupt_release();
    return status;
}
