#include "survey/identify/compare.h"

#include <stdlib.h>

#include "agv/codec.h"
#include "text/units.h"

enum { SAMPLE_MS = 100, SAMPLES_MAX = 5000, LATE_STEPS = 5, AUTOPILOT = AGV_VCU_FLAG_AUTOPILOT };
enum { CALM_MS = 500, TOGETHER_MS = 2000, CLEARLY_MS = 5, SILENCE_PARTS = 3, EDGE_PARTS = 4 };

/** Sums over samples. */
typedef struct {
    uint64_t count;
    uint64_t equal;
    double sums[2];
    double squares[2];
    double product;
    int64_t lowest[2];
    int64_t highest[2];
} sums_t;

static void take_sample(sums_t *sums, const compare_t *compare, const int64_t values[2]) {
    for (size_t i = 0; i < 2; i++) {
        const double value = (double)values[i];
        sums->sums[i] += value;
        sums->squares[i] += value * value;
        sums->lowest[i] = ((sums->count == 0) || (values[i] < sums->lowest[i])) ? values[i] : sums->lowest[i];
        sums->highest[i] = ((sums->count == 0) || (values[i] > sums->highest[i])) ? values[i] : sums->highest[i];
    }
    sums->product += (double)values[0] * (double)values[1];
    sums->equal += (llabs(values[0] - values[1]) <= compare->tolerance) ? 1 : 0;
    sums->count++;
}

static agreement_t agreement_of(const sums_t *sums) {
    agreement_t result = {.samples = sums->count};
    if (sums->count == 0) {
        return result;
    }
    const double count = (double)sums->count;
    double spreads[2];
    for (size_t i = 0; i < 2; i++) {
        spreads[i] = sums->squares[i] - (sums->sums[i] * sums->sums[i] / count);
        result.ranges[i] = sums->highest[i] - sums->lowest[i];
    }
    result.equal = (double)sums->equal / count;
    if ((result.ranges[0] > 0) && (result.ranges[1] > 0)) {
        const double common = sums->product - (sums->sums[0] * sums->sums[1] / count);
        result.together = (common > 0.0) ? (common * common) / (spreads[0] * spreads[1]) : 0.0;
    }
    return result;
}

static uint64_t later(uint64_t a_us, uint64_t b_us) {
    return (a_us > b_us) ? a_us : b_us;
}

static uint64_t earlier(uint64_t a_us, uint64_t b_us) {
    return (a_us < b_us) ? a_us : b_us;
}

/** Compare, with the second one late by some time. */
static agreement_t compare_late(const compare_t *compare, uint64_t late_us) {
    const uint64_t begin_us = later(compare->first->changes[0].at_us, compare->second->changes[0].at_us);
    const uint64_t end_us = earlier(compare->first->until_us, compare->second->until_us);
    const uint64_t time_us = (end_us > begin_us) ? end_us - begin_us : 0;
    const uint64_t step_us = later((uint64_t)SAMPLE_MS * US_PER_MS, time_us / SAMPLES_MAX);
    size_t at[3] = {0, 0, 0};
    sums_t sums = {.count = 0};
    for (uint64_t t_us = begin_us; t_us + late_us <= end_us; t_us += step_us) {
        int64_t values[2] = {track_value(compare->first, &at[0], t_us),
                             track_value(compare->second, &at[1], t_us + late_us)};
        if ((compare->mode != NULL) && ((track_value(compare->mode, &at[2], t_us) & AUTOPILOT) == 0)) {
            continue;
        }
        for (size_t i = 0; compare->is_unsigned && (i < 2); i++) {
            values[i] = llabs(values[i]);
        }
        take_sample(&sums, compare, values);
    }
    return agreement_of(&sums);
}

agreement_t compare_values(const compare_t *compare) {
    agreement_t best = compare_late(compare, 0);
    for (uint64_t steps = 1; steps <= LATE_STEPS; steps++) {
        const agreement_t other = compare_late(compare, steps * (uint64_t)SAMPLE_MS * US_PER_MS);
        if (other.together + other.equal > best.together + best.equal) {
            best = other;
        }
    }
    return best;
}

static bool is_engaged(const compare_t *compare, uint64_t t_us) {
    size_t at = 0;
    return (compare->mode != NULL) && ((track_value(compare->mode, &at, t_us) & AUTOPILOT) != 0);
}

/** Whether a change follows a time without changes, in autopilot mode. */
static bool is_onset(const compare_t *compare, const track_t *track, size_t index) {
    const track_change_t *change = &track->changes[index];
    return (index > 0) && is_engaged(compare, change->at_us) &&
           (change->at_us - track->changes[index - 1].at_us >= (uint64_t)CALM_MS * US_PER_MS);
}

/** Whether it was engaged for some time before and after: when the mode changes, both change at their own will. */
static bool is_inside(const compare_t *compare, uint64_t t_us) {
    const uint64_t margin_us = (uint64_t)CALM_MS * US_PER_MS;
    return (t_us >= margin_us) && is_engaged(compare, t_us - margin_us) && is_engaged(compare, t_us + margin_us);
}

static bool is_up(const track_t *track, size_t index) {
    return track->changes[index].value > track->changes[index - 1].value;
}

static uint64_t apart_us(const track_change_t *a, const track_change_t *b) {
    return (a->at_us > b->at_us) ? a->at_us - b->at_us : b->at_us - a->at_us;
}

/**
 * The onset of the second one that is nearest to one of the first.
 * @param from where to search from: begin with 1, and ask in the order of time @return NULL: none within 2 s
 */
static const track_change_t *partner_of(const compare_t *compare, size_t index, size_t *from) {
    const track_change_t *change = &compare->first->changes[index];
    const track_t *second = compare->second;
    const uint64_t near_us = (uint64_t)TOGETHER_MS * US_PER_MS;
    const track_change_t *nearest = NULL;
    while ((*from < second->count) && (second->changes[*from].at_us + near_us < change->at_us)) {
        (*from)++;
    }
    for (size_t i = *from; (i < second->count) && (second->changes[i].at_us <= change->at_us + near_us); i++) {
        const track_change_t *other = &second->changes[i];
        const bool is_nearer = (nearest == NULL) || (apart_us(change, other) < apart_us(change, nearest));
        if (is_nearer && is_onset(compare, second, i) && (is_up(second, i) == is_up(compare->first, index))) {
            nearest = other;
        }
    }
    return nearest;
}

order_t compare_order(const compare_t *compare) {
    const uint64_t clearly_us = (uint64_t)CLEARLY_MS * US_PER_MS;
    order_t order = {.together = 0};
    size_t from = 1;
    for (size_t i = 1; i < compare->first->count; i++) {
        const track_change_t *change = &compare->first->changes[i];
        const track_change_t *other = is_onset(compare, compare->first, i) ? partner_of(compare, i, &from) : NULL;
        if (other != NULL) {
            const bool counts = is_inside(compare, change->at_us) && is_inside(compare, other->at_us);
            order.together++;
            order.first_leads += (counts && (other->before_us >= change->at_us + clearly_us)) ? 1 : 0;
            order.second_leads += (counts && (change->before_us >= other->at_us + clearly_us)) ? 1 : 0;
        }
    }
    return order;
}

/** How much of a time an identifier was silent without a break, at most. */
static silence_t longest_within(const evidence_id_t *heard, silence_t time) {
    silence_t longest = {0, 0};
    for (size_t i = 0; i < heard->silence_count; i++) {
        const silence_t within = {later(heard->silences[i].begin_us, time.begin_us),
                                  earlier(heard->silences[i].end_us, time.end_us)};
        if ((within.end_us > within.begin_us) &&
            (within.end_us - within.begin_us > longest.end_us - longest.begin_us)) {
            longest = heard->silences[i];
        }
    }
    return longest;
}

static bool are_near(uint64_t a_us, uint64_t b_us, uint64_t most_us) {
    return ((a_us > b_us) ? a_us - b_us : b_us - a_us) <= most_us;
}

silences_t compare_silences(const evidence_id_t *heard, const evidence_id_t *reference, const evidence_id_t *witness) {
    silences_t result = {0, 0};
    const bool is_slow = heard->silence_count == EVIDENCE_SILENCES_MAX; /* or it fails all the time */
    for (size_t i = 0; !is_slow && (i < reference->silence_count); i++) {
        const silence_t silence = reference->silences[i];
        const uint64_t us = silence.end_us - silence.begin_us;
        const silence_t bus = longest_within(witness, silence);
        const silence_t own = longest_within(heard, silence);
        if ((us < SILENCE_PARTS * (uint64_t)EVIDENCE_SILENCE_US / 2) || (bus.end_us > bus.begin_us)) {
            continue; /* too short to be seen in slow messages, or the whole bus was silent */
        }
        if ((own.end_us > own.begin_us) && are_near(own.begin_us, silence.begin_us, us / EDGE_PARTS) &&
            are_near(own.end_us, silence.end_us, us / EDGE_PARTS)) {
            result.shared++;
        } else if (own.end_us == own.begin_us) {
            result.opposed++;
        } else {
            /* silent for a part of it: says nothing */
        }
    }
    return result;
}
