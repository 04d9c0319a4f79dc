#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "survey/survey_result.h"
#include "text/text.h"
#include "text/units.h"
#include "text/words.h"

enum { MEDIAN = 500, P999 = 999, BITS_PER_WORD = 32, WORD_CHOICES = 256, LINE_SIZE = 160, UNKNOWN_SHOWN_MAX = 40 };

#define LEAST_LATE_MS (-0.01) /* what two decimals show */

static void print_head(const survey_result_t *result) {
    const observation_t *observation = &result->observation;
    const uint64_t ms = shown_ms(observation->first_us, observation->last_us);
    const double seconds = (double)ms / (double)MS_PER_S;
    char interfaces[OBSERVATION_NAMES_SIZE];
    text_t text;
    if (observation_goes_back(observation, &text)) {
        (void)printf("NOT RELIABLE: %s\n", text.bytes);
    }
    observation_interfaces(observation, interfaces);
    (void)printf("%s: %.3f s on %s, %" PRIu64 " frame%s", text_one_line(&text, result->source.name), seconds,
                 interfaces, observation->frames, words_plural(observation->frames));
    if (seconds > 0.0) {
        (void)printf(" (%.0f/s)", (double)observation->frames / seconds);
    }
    (void)printf("%s%s\n", (result->source.format[0] != '\0') ? ", " : "", result->source.format);
    if ((observation->interface_count > 1) && (result->config.topology == AGV_TOPOLOGY_SHARED)) {
        (void)printf(
            "         all interfaces count as one bus; --ai-if NAME makes one of them the AI side of a gateway\n");
    }
    const traffic_totals_t totals = traffic_totals(result->traffic);
    text_clear(&text);
    text_add_count(&text, "lines skipped", result->source.skipped_lines);
    text_add_count(&text, "frames lost", observation->lost);
    text_add_count(&text, "time stamps that went backwards", observation->backward_stamps);
    text_add_count(&text, "error frames", totals.error);
    if (text.used > 0) {
        (void)printf("%s      %s\n", (result->source.format[0] != '\0') ? "log" : "bus", text.bytes);
    }
    (void)printf("engaged  %.3f s in %" PRIu64 " engagement%s\n", s_of_us(totals.engaged_us), totals.engagements,
                 words_plural(totals.engagements));
}

static void print_load(const survey_result_t *result) {
    static const char *const sides[HAL_CAN_SIDES] = {"", " of the AI side"};
    const uint64_t us = observation_us(&result->observation);
    const uint32_t bit_rate = (uint32_t)result->request->bit_rate;
    for (size_t side = 0; side < HAL_CAN_SIDES; side++) {
        const bus_load_t *load = &result->observation.loads[side];
        if (load->bits > 0) {
            (void)printf("load%s     %.1f to %.1f %% of %" PRIu32 " bit/s (no stuff bits, to the most possible)",
                         sides[side], bus_load_percent(load->bits, us, bit_rate),
                         bus_load_percent(load->stuffed_bits, us, bit_rate), bit_rate);
            if (us >= US_PER_S) {
                (void)printf(", busiest second %.1f %%", bus_load_percent(bus_load_busiest(load), US_PER_S, bit_rate));
            }
            (void)putchar('\n');
        }
    }
}

static void print_id_sets(const survey_result_t *result) {
    static const char *const names[2][3] = {{"heading", "43Fh", "363h"}, {"table", "201h", "203h"}};
    const size_t own = (result->config.id_set == AGV_ID_SET_TABLE) ? 1 : 0;
    const size_t other = 1 - own;
    uint64_t counts[2][2];
    observation_set_counts(&result->observation, AGV_ID_SET_HEADING, counts[0]);
    observation_set_counts(&result->observation, AGV_ID_SET_TABLE, counts[1]);
    (void)printf("ID set   %s (frames: %s %" PRIu64 ", %s %" PRIu64 "; of %s: %s %" PRIu64 ", %s %" PRIu64 ")\n",
                 names[own][0], names[own][1], counts[own][0], names[own][2], counts[own][1], names[other][0],
                 names[other][1], counts[other][0], names[other][2], counts[other][1]);
}

/** Deadline and margin of a message; nothing of one without. */
static void print_deadline(const traffic_watch_t *watch) {
    if (watch == NULL) {
        return;
    }
    (void)printf(" %8" PRIu32 "%s", watch->deadline_ms, (watch->when == TRAFFIC_ENGAGED) ? "*" : " ");
    if (watch->gaps.count > 0) {
        const double left_ms = (double)watch->deadline_ms - ms_of_us(watch->gaps.longest_us);
        const bool rounds_to_zero = (left_ms < 0.0) && (left_ms > LEAST_LATE_MS);
        (void)printf(" %9.2f%s", rounds_to_zero ? LEAST_LATE_MS : left_ms, (watch->late > 0) ? "  LATE" : "");
    } else {
        (void)printf(" %9s", "-");
    }
}

static void print_message(const traffic_id_t *entry) {
    char id[16];
    (void)snprintf(id, sizeof id, entry->is_extended ? "%08Xh" : "%03Xh", entry->id);
    (void)printf("%-5s%s %-19s %9" PRIu64, id, (entry->side == HAL_CAN_AI) ? "a" : " ",
                 signals_message_name(entry->message), entry->count);
    const gaps_t *gaps = &entry->gaps;
    if (gaps->count > 0) {
        (void)printf(" %8.2f %8.2f %8.2f %9.2f", ms_of_us(gaps->shortest_us), ms_of_us(gaps_quantile_us(gaps, MEDIAN)),
                     ms_of_us(gaps_quantile_us(gaps, P999)), ms_of_us(gaps->longest_us));
        print_deadline(entry->watch);
    }
    (void)putchar('\n');
}

static void print_messages(const survey_result_t *result) {
    (void)printf("\n%-6s %-19s %9s %8s %8s %8s %9s %8s %10s\n", "gaps", "in ms", "count", "min", "median", "p99.9",
                 "max", "deadline", "margin");
    for (size_t i = 0; traffic_at(result->traffic, i) != NULL; i++) {
        const traffic_id_t *entry = traffic_at(result->traffic, i);
        if (entry->message != TRAFFIC_UNKNOWN) {
            print_message(entry);
        }
    }
    for (uint32_t message = 0; message < AGV_MSG_COUNT; message++) {
        const traffic_id_t *entry = traffic_message(result->traffic, message);
        if ((entry == NULL) || (entry->count == 0)) {
            agv_ids_t ids;
            agv_config_ids(&result->config, &ids);
            (void)printf("%03Xh   %-19s         -  not received\n", ids.of[message], signals_message_name(message));
        }
    }
    (void)printf("* this deadline counts only while engaged. The margin of a heartbeat is that of the longest time\n"
                 "  between two changes of its counter.\n");
}

static void print_counters(const survey_result_t *result) {
    (void)printf("\nalive counters\n");
    for (size_t i = 0; traffic_at(result->traffic, i) != NULL; i++) {
        const traffic_id_t *entry = traffic_at(result->traffic, i);
        if ((entry->counter != NULL) && (entry->count > 0)) {
            const counter_use_t *use = entry->counter;
            (void)printf("  %03Xh  %-10s  steps by 1 to 3: %" PRIu64 ", by more: %" PRIu64 ", repeated: %" PRIu64
                         ", longest without a change %.1f ms\n",
                         entry->id, counter_use_word(counter_use_kind(use)), use->steps, use->other_steps, use->repeats,
                         ms_of_us(use->longest_us));
        }
    }
}

/** The words of a choice that were seen: "P, D". */
static void words_seen(char *text, size_t size, uint32_t message, size_t index, const traffic_range_t *range) {
    text[0] = '\0';
    for (uint32_t raw = 0; raw < WORD_CHOICES; raw++) {
        if (((range->words[raw / BITS_PER_WORD] >> (raw % BITS_PER_WORD)) & 1) != 0) {
            char word[SIGNALS_VALUE_SIZE];
            const size_t used = strlen(text);
            signals_raw_text(word, message, index, raw);
            (void)snprintf(&text[used], size - used, "%s%s", (used > 0) ? ", " : "", word);
        }
    }
}

static void print_range(const traffic_id_t *entry, size_t index) {
    const signal_info_t *info = signals_info(entry->message, index);
    const traffic_range_t *range = &entry->ranges[index];
    char text[LINE_SIZE] = "";
    if ((info->kind == SIGNAL_CHOICE) || (info->kind == SIGNAL_FLAG)) {
        words_seen(text, sizeof text, entry->message, index, range);
    } else if (info->kind == SIGNAL_HEX) {
        (void)snprintf(text, sizeof text, "%08" PRIX64 "%s", (uint64_t)range->lowest,
                       (range->lowest == range->highest) ? "" : " and others");
    } else if (range->valid > 0) {
        const signal_value_t lowest = {.scaled = range->lowest};
        const signal_value_t highest = {.scaled = range->highest};
        int used = 0;
        if (range->lowest != range->highest) {
            used = snprintf(text, sizeof text, "%.*f to ", info->decimals, signals_number(info, &lowest));
        }
        (void)snprintf(&text[used], sizeof text - (size_t)used, "%.*f%s%s", info->decimals,
                       signals_number(info, &highest), (info->unit[0] != '\0') ? " " : "", info->unit);
    }
    (void)printf("  %03Xh  %-15s %s", entry->id, info->name, text);
    if (range->invalid > 0) {
        (void)printf("  invalid: %" PRIu64, range->invalid);
    }
    (void)putchar('\n');
}

static void print_values(const survey_result_t *result) {
    (void)printf("\nvalues\n");
    for (size_t i = 0; traffic_at(result->traffic, i) != NULL; i++) {
        const traffic_id_t *entry = traffic_at(result->traffic, i);
        for (size_t signal = 0;
             (entry->count > 0) && (entry->ranges != NULL) && (signal < signals_count(entry->message)); signal++) {
            const signal_kind_t kind = signals_info(entry->message, signal)->kind;
            const bool is_seen = entry->ranges[signal].valid + entry->ranges[signal].invalid > 0;
            if (is_seen && (kind != SIGNAL_ALARM) && (kind != SIGNAL_COUNTER)) {
                print_range(entry, signal);
            }
        }
    }
}

static void print_alarms(const survey_result_t *result) {
    bool any = false;
    (void)printf("\nalarm bits that were set\n");
    for (size_t i = 0; traffic_at(result->traffic, i) != NULL; i++) {
        const traffic_id_t *entry = traffic_at(result->traffic, i);
        for (size_t signal = 0; (entry->ranges != NULL) && (signal < signals_count(entry->message)); signal++) {
            const signal_info_t *info = signals_info(entry->message, signal);
            const traffic_range_t *range = &entry->ranges[signal];
            if ((info->kind == SIGNAL_ALARM) && (range->set > 0)) {
                (void)printf("  %03Xh  %-26s %" PRIu64 " frame%s, first at %.3f s\n", entry->id, info->name, range->set,
                             words_plural(range->set), s_of_us(range->set_at_us));
                any = true;
            }
        }
    }
    if (!any) {
        (void)printf("  none\n");
    }
}

static void print_unknown(const survey_result_t *result) {
    const double seconds = s_of_us(observation_us(&result->observation));
    uint32_t count = 0;
    (void)printf("\nidentifiers that the protocol does not know\n");
    for (size_t i = 0; traffic_at(result->traffic, i) != NULL; i++) {
        const traffic_id_t *entry = traffic_at(result->traffic, i);
        if (entry->message != TRAFFIC_UNKNOWN) {
            continue;
        }
        count++;
        if (count <= UNKNOWN_SHOWN_MAX) {
            (void)printf(entry->is_extended ? "  %08Xh" : "  %03Xh", entry->id);
            const unsigned shortest = (entry->count > 0) ? entry->length_min : 0;
            (void)printf("%s %9" PRIu64 " frame%s, %.1f/s, ", (entry->side == HAL_CAN_AI) ? " AI side" : "",
                         entry->count, words_plural(entry->count),
                         (seconds > 0.0) ? (double)entry->count / seconds : 0.0);
            if (shortest != entry->length_max) {
                (void)printf("%u to ", shortest);
            }
            (void)printf("%u byte%s, median gap %.2f ms\n", entry->length_max, words_plural(entry->length_max),
                         ms_of_us(gaps_quantile_us(&entry->gaps, MEDIAN)));
        }
    }
    if (count == 0) {
        (void)printf("  none\n");
    } else if (count > UNKNOWN_SHOWN_MAX) {
        (void)printf("  and %" PRIu32 " more: --json lists all of them\n", count - (uint32_t)UNKNOWN_SHOWN_MAX);
    } else {
        /* all are shown */
    }
    const traffic_totals_t totals = traffic_totals(result->traffic);
    if (totals.uncounted > 0) {
        (void)printf("  %" PRIu64 " frames of further 29-bit identifiers\n", totals.uncounted);
    }
}

/** One candidate: what speaks for it and what against it. */
static void print_candidate(const candidate_t *candidate) {
    char id[8];
    (void)snprintf(id, sizeof id, "%03Xh", candidate->id);
    for (unsigned side = 0; side < 2; side++) {
        const bool is_for = side == 0;
        for (size_t i = 0; i < candidate->count; i++) {
            const verdict_t verdict = candidate->criteria[i].verdict;
            if (((verdict == VERDICT_FOR) || (verdict == VERDICT_DECIDES)) == is_for) {
                (void)printf("    %-5s %-7s  %s\n", id, is_for ? "for" : "against", candidate->criteria[i].text);
                id[0] = '\0';
            }
        }
    }
}

static void print_candidates_of(uint32_t message, const identify_message_t *found) {
    (void)printf("  %s: %s\n", agv_setting_info((uint16_t)(AGV_SETTING_ID + message))->name,
                 (found->count > 0) ? "candidates" : "no candidate");
    for (size_t i = 0; i < found->count; i++) {
        print_candidate(&found->candidates[i]);
    }
    if (found->left_out > 0) {
        (void)printf("    and %zu more with weaker evidence\n", found->left_out);
    }
}

/** What may carry the messages that were not received and got no identifier. */
static void print_candidates(const survey_result_t *result) {
    bool any = false;
    for (uint32_t message = 0; message < AGV_MSG_COUNT; message++) {
        const identify_message_t *found = &result->found.of[message];
        if (found->is_missing && !found->is_assigned) {
            if (!any) {
                (void)printf("\nmessages that were not received, and the identifiers that may carry them\n");
            }
            print_candidates_of(message, found);
            any = true;
        }
    }
    if (any) {
        (void)printf(
            "  Their senders may have been off. Otherwise look up the identifiers in the vehicle's document,\n"
            "  write them to a file, for example \"id_gear_status: 0x123\", and survey again with --config FILE.\n");
    }
}

void survey_print(const survey_result_t *result, const char *yaml) {
    print_head(result);
    print_load(result);
    print_id_sets(result);
    print_messages(result);
    print_counters(result);
    print_values(result);
    print_alarms(result);
    print_unknown(result);
    print_candidates(result);
    if (result->is_unread) {
        (void)printf("\nThe messages with other identifiers are not evaluated yet: survey again with --config and the "
                     "file below.\n");
    }
    (void)printf("\n%s", yaml);
}
