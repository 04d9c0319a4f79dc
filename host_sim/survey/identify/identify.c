#include "survey/identify/identify.h"

#include <stdio.h>
#include <string.h>

/** What speaks for a candidate, in the order of candidates: the higher the better. */
static int rank(const candidate_t *candidate) {
    static const int weights[] = {[VERDICT_NONE] = 0,
                                  [VERDICT_FOR] = 1,
                                  [VERDICT_DECIDES] = 10,
                                  [VERDICT_AGAINST] = -1,
                                  [VERDICT_REFUSES] = -100};
    int sum = 0;
    for (size_t i = 0; i < candidate->count; i++) {
        sum += weights[candidate->criteria[i].verdict];
    }
    return sum;
}

static bool has(const candidate_t *candidate, verdict_t verdict) {
    for (size_t i = 0; i < candidate->count; i++) {
        if (candidate->criteria[i].verdict == verdict) {
            return true;
        }
    }
    return false;
}

/** Put a candidate at its place. The last one is left out when there are too many. */
static void insert(identify_message_t *found, const candidate_t *candidate) {
    size_t at = found->count;
    while ((at > 0) && (rank(&found->candidates[at - 1]) < rank(candidate))) {
        at--;
    }
    if (at == IDENTIFY_CANDIDATES_MAX) {
        found->left_out++;
        return;
    }
    if (found->count == IDENTIFY_CANDIDATES_MAX) {
        found->left_out++;
    } else {
        found->count++;
    }
    (void)memmove(&found->candidates[at + 1], &found->candidates[at],
                  (found->count - 1 - at) * sizeof found->candidates[0]);
    found->candidates[at] = *candidate;
}

/** The candidates of a message, with what is known by now. */
static void collect(const inquiry_t *inquiry, identify_message_t *found, uint32_t message) {
    found->count = 0;
    found->left_out = 0;
    for (size_t i = 0; traffic_at(inquiry->traffic, i) != NULL; i++) {
        const traffic_id_t *entry = traffic_at(inquiry->traffic, i);
        if (criteria_allow(inquiry, entry, message)) {
            candidate_t candidate = {.id = entry->id, .heard = criteria_evidence(inquiry, entry)};
            candidate.count = criteria_judge(inquiry, entry, message, candidate.criteria);
            insert(found, &candidate);
        }
    }
}

static void collect_all(const inquiry_t *inquiry, identify_t *result) {
    for (uint32_t message = 0; message < AGV_MSG_COUNT; message++) {
        identify_message_t *found = &result->of[message];
        if (found->is_missing && !found->is_assigned) {
            collect(inquiry, found, message);
        }
    }
}

/** Whether an identifier could carry another message, too. */
static bool is_contested(const identify_t *result, uint32_t message, uint32_t id) {
    for (uint32_t other = 0; other < AGV_MSG_COUNT; other++) {
        const identify_message_t *found = &result->of[other];
        for (size_t i = 0; (other != message) && !found->is_assigned && (i < found->count); i++) {
            if ((found->candidates[i].id == id) && !has(&found->candidates[i], VERDICT_REFUSES)) {
                return true;
            }
        }
    }
    return false;
}

/** Whether the first candidate is the identifier: something decides for it, and it is the only one that fits. */
static bool is_certain(const identify_t *result, uint32_t message) {
    const identify_message_t *found = &result->of[message];
    if ((found->count == 0) || !has(&found->candidates[0], VERDICT_DECIDES) ||
        has(&found->candidates[0], VERDICT_REFUSES)) {
        return false;
    }
    if ((found->count > 1) && !has(&found->candidates[1], VERDICT_REFUSES)) {
        return false;
    }
    return !is_contested(result, message, found->candidates[0].id);
}

/** Assign one message. @return whether one was assigned */
static bool assign_once(inquiry_t *inquiry, identify_t *result) {
    for (uint32_t message = 0; message < AGV_MSG_COUNT; message++) {
        identify_message_t *found = &result->of[message];
        if (found->is_missing && !found->is_assigned && is_certain(result, message)) {
            found->is_assigned = true;
            inquiry->of[message] = found->candidates[0].heard;
            return true;
        }
    }
    return false;
}

/** A message that has got the identifier of another one, which has no other yet. @return NULL: none */
static identify_message_t *find_clash(identify_t *result, const agv_ids_t *ids) {
    for (uint32_t message = 0; message < AGV_MSG_COUNT; message++) {
        for (uint32_t other = 0; other < AGV_MSG_COUNT; other++) {
            identify_message_t *found = &result->of[other];
            if ((message != other) && !result->of[message].is_assigned && found->is_assigned &&
                (found->candidates[0].id == ids->of[message])) {
                return found;
            }
        }
    }
    return NULL;
}

/** What is at the identifier of a message: the message, nothing, or something else. */
static void look(const evidence_t *evidence, const traffic_t *traffic, uint32_t message, identify_message_t *found,
                 const evidence_id_t **heard) {
    const traffic_id_t *entry = traffic_message(traffic, message);
    *heard = NULL;
    found->is_missing = (entry == NULL) || (entry->count == 0);
    if (!found->is_missing) {
        *heard = evidence_of(evidence, entry->side, entry->id);
        found->is_contradicted = (*heard != NULL) && evidence_contradicts(*heard);
        found->contradicted_id = entry->id;
    }
    if (found->is_contradicted) {
        found->is_missing = true;
        *heard = NULL;
    }
}

static void look_at_all(inquiry_t *inquiry, identify_t *result) {
    for (uint32_t message = 0; message < AGV_MSG_COUNT; message++) {
        look(inquiry->evidence, inquiry->traffic, message, &result->of[message], &inquiry->of[message]);
        inquiry->heard |= (inquiry->of[message] != NULL) ? agv_message_bit(message) : 0;
    }
}

/** The number of messages that came with their own identifier, and of whose values nothing refuses them. */
static size_t count_credible(const inquiry_t *inquiry) {
    size_t count = 0;
    for (uint32_t message = 0; message < AGV_MSG_COUNT; message++) {
        const evidence_id_t *heard = inquiry->of[message];
        if ((heard != NULL) && (((heard->fits >> message) & 1) != 0)) {
            candidate_t own = {.id = heard->id, .heard = heard};
            own.count = criteria_judge(inquiry, traffic_message(inquiry->traffic, message), message, own.criteria);
            count += has(&own, VERDICT_REFUSES) ? 0 : 1;
        }
    }
    return count;
}

void identify(const traffic_t *traffic, const evidence_t *evidence, const agv_config_t *config, identify_t *result) {
    inquiry_t inquiry = {.traffic = traffic, .evidence = evidence, .config = config};
    agv_ids_t ids;
    agv_config_ids(config, &ids);
    (void)memset(result, 0, sizeof *result);
    look_at_all(&inquiry, result);
    inquiry.is_foreign = count_credible(&inquiry) * 2 < AGV_MSG_COUNT;
    do {
        collect_all(&inquiry, result);
    } while (assign_once(&inquiry, result)); /* the next one may go together with it */
    for (identify_message_t *clash = find_clash(result, &ids); clash != NULL; clash = find_clash(result, &ids)) {
        clash->is_assigned = false;
    }
}

size_t identify_assigned(const identify_t *result) {
    size_t count = 0;
    for (size_t i = 0; i < AGV_MSG_COUNT; i++) {
        count += result->of[i].is_assigned ? 1 : 0;
    }
    return count;
}

const char *identify_words(const candidate_t *candidate, bool is_for, char *text, size_t size) {
    text[0] = '\0';
    for (size_t i = 0; i < candidate->count; i++) {
        const verdict_t verdict = candidate->criteria[i].verdict;
        const bool speaks_for = (verdict == VERDICT_FOR) || (verdict == VERDICT_DECIDES);
        if (speaks_for == is_for) {
            const size_t used = strlen(text);
            (void)snprintf(&text[used], size - used, "%s%s", (used > 0) ? "; " : "", candidate->criteria[i].text);
        }
    }
    return text;
}
