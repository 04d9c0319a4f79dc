/*
 * Finds every reachable abstract state of the shipped supervisor.
 *
 * Breadth-first search: it starts from the first state of a variant of the configuration (model.h) and tries each symbol
 * of the alphabet (alphabet.h) in each state. A result that was not seen before (abstract.h, visited.h) is explored in
 * turn, until no new state is found. In every call of the supervisor all rules are checked: rules.h and oracle.h (FSM-6,
 * TOP-1, latch, safety output, first reason, starts, silence, sending), and that every sent frame passed the gate.
 *
 * A broken rule ends the search, and the symbols that lead there are printed. Because the search is breadth first, no
 * sequence of fewer symbols leads there.
 *
 * A frame, a late tick or a restart that leads to a known state is followed for some more milliseconds, so that its
 * consequences are checked, too.
 *
 * Result: no abstract state is left out, and every symbol was tried from one model of each state (from more with
 * --representatives). Limit: two models of one abstract state may differ in values outside the key, such as the phases of
 * cycles, and only the first ones were explored.
 *
 * usage: explorer [--quick] [--pairs] [--variant N] [--shard I/N] [--representatives N] [--most STATES]
 *   --quick     the short alphabet, a coarser abstraction (abstract.h)
 *   --pairs     a fault of the vehicle and a trouble of a controller may exist at the same time
 *   --shard     every N-th variant from I on
 *   --most      fail when a variant has more states
 */
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "abstract.h"
#include "alphabet.h"
#include "model.h"
#include "visited.h"

static struct {
    bool quick;
    int variant;
    unsigned representatives;
    uint32_t most;
    unsigned shard;
    unsigned shards;
} option = {.variant = -1, .shards = 1, .representatives = 1, .most = 4000000};

static struct {
    uint64_t states;
    uint64_t transitions;
    uint64_t judged; /* calls */
    uint64_t frames;
    uint64_t resets;
    uint64_t depth;
} sum;

enum { FOLLOW_MS = 8 };

/* After a symbol without a new state, run on to check its consequences, such as an answer that is still due. */
static void follow(void) {
    for (unsigned ms = 0; (ms < FOLLOW_MS) && (model_broken()[0] == '\0'); ms++) {
        model_run(1);
    }
}

/* Apply a symbol to the model; false: a rule was broken. */
static bool apply(unsigned symbol) {
    const uint64_t calls = testbed.rules.calls;
    const uint64_t frames = testbed.rules.sent;
    const uint64_t resets = testbed.rules.resets;
    alphabet_apply(symbol);
    sum.transitions++;
    sum.judged += testbed.rules.calls - calls;
    sum.frames += testbed.rules.sent - frames;
    sum.resets += testbed.rules.resets - resets;
    return model_broken()[0] == '\0';
}

static void report_broken(uint32_t state, unsigned symbol) {
    uint8_t path[PATH_MAX_SYMBOLS + 1];
    unsigned length = visited_path(state, path);
    path[length] = (uint8_t)symbol;
    length++;
    (void)printf("HARM: depth %u, %u ms: %s\n", length, (unsigned)model_now_ms(), model_broken());
    (void)printf("  after %u states, in: %s\n  by:", (unsigned)visited_states(), model_variant->name);
    for (unsigned i = 0; i < length; i++) {
        (void)printf("%s %s", (i == 0) ? "" : ",", alphabet_name(path[i]));
    }
    (void)printf("\n");
}

/* Try every symbol in a state. @return false: a rule was broken, or out of memory */
static bool explore(uint32_t index) {
    static model_saved_t here;
    here = *visited_at(index)->model;
    free(visited_at(index)->model);
    visited_at(index)->model = NULL;
    for (unsigned symbol = 0; symbol < alphabet_size(option.quick); symbol++) {
        model_restore(&here);
        if (!alphabet_enabled(symbol)) {
            continue;
        }
        const uint32_t before = visited_count();
        bool good = apply(symbol);
        if (good && !visited_reached(index, symbol, option.representatives)) {
            (void)printf("HARM: out of memory after %u states\n", (unsigned)visited_states());
            return false;
        }
        if (good && (visited_count() == before) && alphabet_leaves_no_trace(symbol)) {
            follow();
            good = model_broken()[0] == '\0';
        }
        if (!good) {
            report_broken(index, symbol);
            return false;
        }
    }
    return true;
}

static bool search(const model_variant_t *variant) {
    const clock_t began = clock();
    const uint64_t transitions = sum.transitions;
    uint32_t done = 0;
    visited_begin();
    model_root(variant);
    bool good = (model_broken()[0] == '\0') && visited_reached(VISITED_NONE, 0, 1);
    for (; good && (done < visited_count()); done++) {
        good = explore(done);
        if (good && (visited_states() > option.most)) {
            (void)printf("HARM: there are more than %u states: the search is not complete\n", (unsigned)option.most);
            good = false;
        }
    }
    const unsigned depth = visited_at(done - 1)->depth;
    sum.states += visited_states();
    sum.depth = (depth > sum.depth) ? depth : sum.depth;
    (void)printf("%-84s %8u states %9llu transitions, depth %2u, %4u s%s\n", variant->name, (unsigned)visited_states(),
                 (unsigned long long)(sum.transitions - transitions), depth,
                 (unsigned)((clock() - began) / CLOCKS_PER_SEC), good ? "" : ", NOT COMPLETE");
    (void)fflush(stdout);
    return good;
}

static unsigned number(const char *text) {
    char *end = NULL;
    const unsigned long value = strtoul(text, &end, 10);
    return ((end == text) || (*end != '\0')) ? 0 : (unsigned)value;
}

static bool take_option(const char *name, const char *value) {
    if (strcmp(name, "--variant") == 0) {
        option.variant = (int)number(value);
        return option.variant < MODEL_VARIANTS;
    }
    if (strcmp(name, "--representatives") == 0) {
        option.representatives = number(value);
        return option.representatives > 0;
    }
    if (strcmp(name, "--most") == 0) {
        option.most = number(value);
        return true;
    }
    if (strcmp(name, "--shard") == 0) {
        return (sscanf(value, "%u/%u", &option.shard, &option.shards) == 2) && (option.shard < option.shards);
    }
    return false;
}

static void read_options(int argc, char **argv) {
    bool good = true;
    for (int i = 1; good && (i < argc); i++) {
        if (strcmp(argv[i], "--quick") == 0) {
            option.quick = true;
            abstract_coarse = true;
        } else if (strcmp(argv[i], "--pairs") == 0) {
            alphabet_pairs = true;
        } else {
            good = (i + 1 < argc) && take_option(argv[i], argv[i + 1]);
            i++;
        }
    }
    if (!good) {
        (void)fprintf(stderr, "usage: explorer [--quick] [--pairs] [--variant N] [--shard I/N] [--representatives N] "
                              "[--most STATES]\n");
        exit(2);
    }
}

int main(int argc, char **argv) {
    bool good = true;
    unsigned variants = 0;
    read_options(argc, argv);
    for (unsigned i = option.shard; good && (i < MODEL_VARIANTS); i += option.shards) {
        if ((option.variant < 0) || (option.variant == (int)i)) {
            good = search(&MODEL_VARIANT[i]);
            variants++;
        }
    }
    (void)printf("%llu calls judged, %llu frames that left, %llu resets by the button, longest way %llu symbols\n",
                 (unsigned long long)sum.judged, (unsigned long long)sum.frames, (unsigned long long)sum.resets,
                 (unsigned long long)sum.depth);
    (void)printf("%u symbols, %u variants: %llu states, %llu transitions, broken rules: %u\n",
                 alphabet_size(option.quick), variants, (unsigned long long)sum.states,
                 (unsigned long long)sum.transitions, good ? 0u : 1u);
    return good ? 0 : 1;
}
