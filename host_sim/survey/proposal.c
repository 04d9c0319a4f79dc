#include "survey/proposal.h"

#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "agv/names.h"
#include "text/units.h"
#include "text/words.h"

enum { MEDIAN_PERMILLE = 500, CYCLES = 3, PERMILLE = 1000, OUTAGES_MAX = 10, ROUND_MS = 5, STATUS_ID_LOWEST = 0x7F1 };

__attribute__((format(printf, 3, 4))) static void reason(proposal_t *proposal, uint32_t setting, const char *format,
                                                         ...) {
    va_list arguments;
    va_start(arguments, format);
    (void)vsnprintf(proposal->reasons[setting], PROPOSAL_REASON_SIZE, format, arguments);
    va_end(arguments);
}

__attribute__((format(printf, 2, 3))) static void add_note(proposal_t *proposal, const char *format, ...) {
    if (proposal->note_count < PROPOSAL_NOTES_MAX) {
        va_list arguments;
        va_start(arguments, format);
        (void)vsnprintf(proposal->notes[proposal->note_count], PROPOSAL_REASON_SIZE, format, arguments);
        va_end(arguments);
        proposal->note_count++;
    }
}

/** What a sender does as a rule. */
typedef struct {
    uint64_t cycle_us;
    uint64_t usual_us; /**< the longest gap that is usual */
    uint64_t need_us;  /**< the deadline that it needs */
} habit_t;

static habit_t habit_of(const gaps_t *gaps) {
    const uint64_t rare = gaps->count / PERMILLE;
    habit_t habit = {.cycle_us = gaps_quantile_us(gaps, MEDIAN_PERMILLE)};
    habit.usual_us = gaps_without_longest_us(gaps, (rare > OUTAGES_MAX) ? rare : (uint64_t)OUTAGES_MAX);
    habit.need_us = habit.cycle_us * CYCLES;
    if ((habit.usual_us <= habit.cycle_us * CYCLES) && ((habit.usual_us * 3) / 2 > habit.need_us)) {
        habit.need_us = (habit.usual_us * 3) / 2;
    }
    return habit;
}

/** The gaps that were late at the proposed deadline: no setting hides them. If most are late, it is no outage. */
static void note_late(proposal_t *proposal, const traffic_id_t *entry, const char *name) {
    const traffic_watch_t *watch = entry->watch;
    const uint64_t deadline_us = (uint64_t)agv_config_get(&proposal->config, watch->setting) * US_PER_MS;
    if ((watch->gaps.count > 0) && (watch->gaps.longest_us > deadline_us)) {
        const uint64_t longer = gaps_longer_than(&watch->gaps, deadline_us);
        const uint64_t late = (longer > 0) ? longer : 1;
        const bool is_slow = gaps_quantile_us(&watch->gaps, MEDIAN_PERMILLE) > deadline_us;
        add_note(proposal, "%03Xh %s: %" PRIu64 " gap%s of up to %.1f ms, the longest at %.3f s; %s %s%s", entry->id,
                 name, late, words_plural(late), ms_of_us(watch->gaps.longest_us), s_of_us(watch->gaps.longest_at_us),
                 is_slow ? "a sender that is too slow for" : "an outage, not a slow sender:",
                 agv_setting_info(watch->setting)->name, is_slow ? "" : " stays");
    }
}

static void propose_deadline(proposal_t *proposal, const traffic_id_t *entry) {
    const traffic_watch_t *watch = entry->watch;
    const agv_setting_info_t *info = agv_setting_info(watch->setting);
    const char *name = signals_message_name(entry->message);
    (void)agv_config_set(&proposal->config, watch->setting, info->preset);
    if ((watch->when == TRAFFIC_ENGAGED) && (watch->gaps.count == 0)) {
        return;
    }
    if (watch->gaps.count < PROPOSAL_GAPS_MIN) {
        add_note(proposal, "%03Xh %s: %" PRIu64 " gap%s%s, too few to evaluate its deadline", entry->id, name,
                 watch->gaps.count, words_plural(watch->gaps.count),
                 (watch->when == TRAFFIC_ENGAGED) ? " while engaged" : "");
    } else {
        proposal->judged++;
        const habit_t habit = habit_of(&watch->gaps);
        const uint64_t step_us = (uint64_t)ROUND_MS * US_PER_MS;
        const uint64_t need_ms = ((habit.need_us + step_us - 1) / step_us) * ROUND_MS;
        const uint64_t value = (need_ms > info->highest) ? info->highest : need_ms;
        if (value > info->preset) {
            (void)agv_config_set(&proposal->config, watch->setting, (uint16_t)value);
            reason(proposal, watch->setting,
                   "%03Xh %s: median gap %.1f ms, usual longest gap %.1f ms: needs %" PRIu64 " ms", entry->id, name,
                   ms_of_us(habit.cycle_us), ms_of_us(habit.usual_us), need_ms);
        }
        if (need_ms > info->highest) {
            add_note(proposal, "%03Xh %s needs %" PRIu64 " ms, and %s may be %u ms at most: the sender must be faster",
                     entry->id, name, need_ms, info->name, info->highest);
        }
    }
    note_late(proposal, entry, name);
}

static void propose_counter(proposal_t *proposal, const traffic_id_t *entry, uint32_t setting) {
    const counter_use_t *use = entry->counter;
    const char *name = signals_message_name(entry->message);
    (void)agv_config_set(&proposal->config, setting, AGV_COUNTER_ANY);
    switch (counter_use_kind(use)) {
    case COUNTER_INCREMENTS:
        if (use->steps >= PROPOSAL_STEPS_MIN) {
            (void)agv_config_set(&proposal->config, setting, AGV_COUNTER_INCREMENTS);
            reason(proposal, setting,
                   "%03Xh %s: all %" PRIu64 " steps of its counter were by 1 to 3 (stricter than any)", entry->id, name,
                   use->steps);
        }
        break;
    case COUNTER_ANY:
        add_note(proposal,
                 "%03Xh %s: %" PRIu64 " of %" PRIu64
                 " steps of its counter %s not by 1 to 3, the first at %.3f s: %s stays any",
                 entry->id, name, use->other_steps, use->steps + use->other_steps,
                 (use->other_steps == 1) ? "was" : "were", s_of_us(use->other_at_us),
                 agv_setting_info((uint16_t)setting)->name);
        break;
    case COUNTER_STUCK:
        add_note(proposal, "%03Xh %s: its alive counter never changes, so it is no heartbeat; its sender must count",
                 entry->id, name);
        break;
    default:
        break;
    }
}

/** Alarms and invalid values: they trip or warn by their class, which is not changed. */
static void note_values(proposal_t *proposal, const traffic_id_t *entry) {
    for (size_t i = 0; i < signals_count(entry->message); i++) {
        const signal_info_t *info = signals_info(entry->message, i);
        const traffic_range_t *range = &entry->ranges[i];
        if ((info->kind == SIGNAL_ALARM) && (range->set > 0)) {
            add_note(
                proposal, "%s was set in %" PRIu64 " frame%s, first at %.3f s: its class stays %s", info->name,
                range->set, words_plural(range->set), s_of_us(range->set_at_us),
                agv_class_name(agv_config_is_trip(&proposal->config, info->fault) ? AGV_CLASS_TRIP : AGV_CLASS_WARN));
        } else if (range->invalid > 0) {
            add_note(proposal, "%03Xh %s: %" PRIu64 " frame%s with an invalid %s; no setting allows that", entry->id,
                     signals_message_name(entry->message), range->invalid, words_plural(range->invalid), info->name);
        }
    }
    if (entry->malformed > 0) {
        add_note(proposal, "%03Xh %s: %" PRIu64 " frame%s of another length or kind; they count as missing", entry->id,
                 signals_message_name(entry->message), entry->malformed, words_plural(entry->malformed));
    }
}

/** An identifier with its reason: "169h has the gear of 0A3h; ...". */
static void propose_found(proposal_t *proposal, uint32_t setting, const candidate_t *candidate) {
    char words[PROPOSAL_REASON_SIZE];
    (void)agv_config_set(&proposal->config, setting, (uint16_t)candidate->id);
    reason(proposal, setting, "%03Xh %.400s: check it with the vehicle's maker", candidate->id,
           identify_words(candidate, true, words, sizeof words));
}

/** Why a message is not there. */
static const char *absence_of(const identify_message_t *found, char text[PROPOSAL_REASON_SIZE]) {
    if (!found->is_contradicted) {
        return "was not received";
    }
    (void)snprintf(text, PROPOSAL_REASON_SIZE, "is not what %03Xh carries (most of its frames do not fit)",
                   found->contradicted_id);
    return text;
}

static void propose_identifier(proposal_t *proposal, uint32_t message, const identify_message_t *found) {
    const uint32_t setting = (uint32_t)AGV_SETTING_ID + message;
    const char *name = signals_message_name(message);
    if (found->is_assigned) {
        propose_found(proposal, setting, &found->candidates[0]);
        return;
    }
    char absence[PROPOSAL_REASON_SIZE];
    char candidates[IDENTIFY_CANDIDATES_MAX * 8] = "";
    for (size_t i = 0; i < found->count; i++) {
        (void)snprintf(&candidates[strlen(candidates)], 8, "%s%03Xh", (i > 0) ? ", " : "", found->candidates[i].id);
    }
    if (found->count > 0) {
        add_note(proposal, "%s %.80s; candidates: %s%s. Look it up in the vehicle's document, and set %s", name,
                 absence_of(found, absence), candidates, (found->left_out > 0) ? " and more" : "",
                 agv_setting_info((uint16_t)setting)->name);
    } else {
        add_note(proposal,
                 "%s %.80s, and no identifier here could be it. Look it up in the vehicle's document, and set %s", name,
                 absence_of(found, absence), agv_setting_info((uint16_t)setting)->name);
    }
}

/** The status frame needs an identifier that nobody else uses. */
static void propose_status_id(proposal_t *proposal, const traffic_t *traffic) {
    const uint16_t id = proposal->config.status_frame_id;
    uint64_t first_us = 0;
    uint64_t last_us = 0;
    if ((id == 0) || !traffic_times(traffic, id, &first_us, &last_us)) {
        return;
    }
    const uint8_t message = (uint8_t)SIGNALS_STATUS_FRAME;
    for (size_t i = 0; traffic_at(traffic, i) != NULL; i++) {
        const traffic_id_t *entry = traffic_at(traffic, i);
        if ((entry->message == message) && (entry->ranges[0].invalid == 0) && (entry->count > 0)) {
            add_note(proposal,
                     "%03Xh carries status frames of a supervisor: was a supervisor on the bus during the recording?",
                     id);
            return;
        }
    }
    for (uint32_t free_id = STATUS_ID_LOWEST; free_id <= AGV_ID_MAX; free_id++) {
        if (!traffic_heard(traffic, free_id)) {
            proposal->config.status_frame_id = (uint16_t)free_id;
            reason(proposal, AGV_SETTING_status_frame_id, "%03Xh is in use by another sender", id);
            return;
        }
    }
}

static void propose_message(proposal_t *proposal, const traffic_t *traffic, uint32_t message) {
    static const struct {
        uint32_t message;
        uint32_t setting;
    } counters[] = {{AGV_MSG_VEHICLE_STATUS, AGV_SETTING_vcu_counter},
                    {AGV_MSG_STEERING_STATUS, AGV_SETTING_eps_counter},
                    {AGV_MSG_TURN_SIGNAL_COMMAND, AGV_SETTING_ai_counter}};
    const traffic_id_t *entry = traffic_message(traffic, message);
    if ((entry == NULL) || (entry->count == 0)) {
        return;
    }
    propose_deadline(proposal, entry);
    for (size_t i = 0; i < sizeof counters / sizeof counters[0]; i++) {
        if (counters[i].message == message) {
            propose_counter(proposal, entry, counters[i].setting);
        }
    }
    note_values(proposal, entry);
}

/** The reason of a setting that the user chose: it stays. */
static void keep_given(proposal_t *proposal) {
    for (uint16_t i = 0; i < AGV_SETTING_COUNT; i++) {
        if ((proposal->reasons[i][0] == '\0') &&
            (agv_config_get(&proposal->config, i) != agv_setting_info(i)->preset) &&
            (i != (uint16_t)AGV_SETTING_shadow)) {
            reason(proposal, i, "as given to this survey");
        }
    }
}

void proposal_make(proposal_t *proposal, const traffic_t *traffic, const agv_config_t *config, const identify_t *found,
                   const char *id_set_reason) {
    (void)memset(proposal, 0, sizeof *proposal);
    proposal->config = *config;
    proposal->config.shadow = AGV_SHADOW_OFF;
    if (id_set_reason != NULL) {
        reason(proposal, AGV_SETTING_id_set, "%s", id_set_reason);
    }
    for (uint32_t message = 0; message < AGV_MSG_COUNT; message++) {
        const identify_message_t *missing = &found->of[message];
        if (missing->is_missing) {
            propose_identifier(proposal, message, missing);
        }
        if (!missing->is_contradicted || missing->is_assigned) {
            propose_message(proposal, traffic, message);
        }
    }
    if (traffic_totals(traffic).engagements == 0) {
        add_note(proposal, "autopilot was never engaged: the deadlines of the commands are not judged");
    }
    propose_status_id(proposal, traffic);
    keep_given(proposal);
}

void proposal_note(proposal_t *proposal, const char *text) {
    add_note(proposal, "%s", text);
}
