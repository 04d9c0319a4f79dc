#include "traffic/traffic.h"

#include <stdlib.h>
#include <string.h>

#include "agv/codec.h"
#include "common/message_facts.h"
#include "text/units.h"
#include "traffic/engagement.h"
#include "traffic/watch.h"

enum {
    IDS_11_BITS = 2048,
    IDS_29_BITS = 512,
    SLOTS_29_BITS = 1024,
    IDS_MAX = HAL_CAN_SIDES * (IDS_11_BITS + IDS_29_BITS)
};
enum { STATUS_COUNTER_AT = 3, MESSAGE_UNKNOWN = 0xFF };
enum { BITS_PER_WORD = 32, WORD_CHOICES = 256 };

/** The index of the alive counter in data[] of a message or the status frame. */
static uint8_t counter_at(uint32_t message) {
    return (message < AGV_MSG_COUNT) ? message_counter_at(message) : (uint8_t)STATUS_COUNTER_AT;
}

struct traffic {
    agv_config_t config;
    uint8_t messages[IDS_11_BITS]; /**< the message of each identifier */
    traffic_id_t *standard[HAL_CAN_SIDES][IDS_11_BITS];
    traffic_id_t *extended[HAL_CAN_SIDES][SLOTS_29_BITS];
    size_t extended_count[HAL_CAN_SIDES];
    traffic_id_t *all[IDS_MAX];
    size_t all_count;
    traffic_totals_t totals;
    engagement_t engagement;
    uint64_t engaged_since_us;  /**< not interrupted */
    const traffic_watch_t *vcu; /**< of 363h; NULL: it never came */
    uint64_t started_us;        /**< when somebody began to listen */
};

traffic_t *traffic_new(const agv_config_t *config) {
    traffic_t *traffic = calloc(1, sizeof *traffic);
    if (traffic == NULL) {
        return NULL;
    }
    agv_ids_t ids;
    agv_config_ids(config, &ids);
    traffic->config = *config;
    (void)memset(traffic->messages, MESSAGE_UNKNOWN, sizeof traffic->messages);
    if (config->status_frame_id != 0) {
        traffic->messages[config->status_frame_id] = (uint8_t)SIGNALS_STATUS_FRAME;
    }
    for (size_t i = 0; i < AGV_MSG_COUNT; i++) {
        traffic->messages[ids.of[i]] = (uint8_t)i;
    }
    return traffic;
}

static void free_id(traffic_id_t *entry) {
    free(entry->watch);
    free(entry->counter);
    free(entry->ranges);
    free(entry);
}

void traffic_free(traffic_t *traffic) {
    if (traffic != NULL) {
        for (size_t i = 0; i < traffic->all_count; i++) {
            free_id(traffic->all[i]);
        }
        free(traffic);
    }
}

/** The side on which the supervisor listens for a message. */
static hal_can_side_t side_of(const traffic_t *traffic, uint32_t message) {
    const bool is_command = message < AGV_COMMAND_COUNT;
    return (is_command && (traffic->config.topology == AGV_TOPOLOGY_GATEWAY)) ? HAL_CAN_AI : HAL_CAN_VEHICLE;
}

/** Give a new identifier what its message needs. @return false: out of memory */
static bool allocate_parts(const traffic_t *traffic, traffic_id_t *entry) {
    if (entry->message == TRAFFIC_UNKNOWN) {
        return true;
    }
    entry->ranges = calloc(SIGNALS_MAX, sizeof *entry->ranges);
    bool good = entry->ranges != NULL;
    if (counter_at(entry->message) != MESSAGE_NO_COUNTER) {
        entry->counter = calloc(1, sizeof *entry->counter);
        good = good && (entry->counter != NULL);
    }
    if ((entry->message != SIGNALS_STATUS_FRAME) && (entry->side == side_of(traffic, entry->message))) {
        entry->watch = calloc(1, sizeof *entry->watch);
        good = good && (entry->watch != NULL);
        if (good) {
            watch_init(entry->watch, &traffic->config, entry->message);
        }
    }
    return good;
}

/** Make the entry of an identifier that is heard for the first time. @return NULL: out of memory */
static traffic_id_t *add_id(traffic_t *traffic, hal_can_side_t side, const hal_can_frame_t *frame, uint64_t t_us) {
    traffic_id_t *entry = calloc(1, sizeof *entry);
    if (entry == NULL) {
        return NULL;
    }
    const bool is_extended = (frame->flags & HAL_CAN_EXTENDED) != 0;
    const uint8_t message = is_extended ? (uint8_t)MESSAGE_UNKNOWN : traffic->messages[frame->id];
    entry->side = side;
    entry->id = frame->id;
    entry->is_extended = is_extended;
    entry->message = (message == MESSAGE_UNKNOWN) ? TRAFFIC_UNKNOWN : message;
    entry->first_us = t_us;
    entry->length_min = UINT8_MAX;
    (void)memset(entry->bits_always, UINT8_MAX, sizeof entry->bits_always);
    if (!allocate_parts(traffic, entry)) {
        free_id(entry);
        return NULL;
    }
    traffic->all[traffic->all_count] = entry;
    traffic->all_count++;
    if ((entry->watch != NULL) && (entry->watch->when == TRAFFIC_ENGAGED) && traffic->engagement.is_engaged) {
        watch_start(entry->watch, traffic->engagement.began_us);
    }
    return entry;
}

/** The slot of a 29-bit identifier: its own, or a free one. */
static traffic_id_t **find_slot(traffic_t *traffic, hal_can_side_t side, uint32_t id) {
    uint32_t slot = (id ^ (id >> 10) ^ (id >> 20)) % SLOTS_29_BITS;
    while ((traffic->extended[side][slot] != NULL) && (traffic->extended[side][slot]->id != id)) {
        slot = (slot + 1) % SLOTS_29_BITS;
    }
    return &traffic->extended[side][slot];
}

/** The entry of a frame's identifier. @return NULL: there is no room for it */
static traffic_id_t *entry_of(traffic_t *traffic, hal_can_side_t side, const hal_can_frame_t *frame, uint64_t t_us) {
    const bool is_extended = (frame->flags & HAL_CAN_EXTENDED) != 0;
    if (!is_extended && (frame->id >= IDS_11_BITS)) {
        return NULL;
    }
    traffic_id_t **slot = is_extended ? find_slot(traffic, side, frame->id) : &traffic->standard[side][frame->id];
    if (*slot == NULL) {
        if (is_extended && (traffic->extended_count[side] == IDS_29_BITS)) {
            return NULL;
        }
        *slot = add_id(traffic, side, frame, t_us);
        traffic->extended_count[side] += (is_extended && (*slot != NULL)) ? 1 : 0;
    }
    return *slot;
}

static void take_range(traffic_range_t *range, const signal_value_t *value, uint64_t t_us) {
    if (!value->present) {
        return;
    }
    if (value->raw != 0) {
        range->set_at_us = (range->set == 0) ? t_us : range->set_at_us;
        range->set++;
    }
    if (value->raw < WORD_CHOICES) {
        range->words[value->raw / BITS_PER_WORD] |= 1u << (value->raw % BITS_PER_WORD);
    }
    if (!value->valid) {
        range->invalid++;
        return;
    }
    range->lowest = ((range->valid == 0) || (value->scaled < range->lowest)) ? value->scaled : range->lowest;
    range->highest = ((range->valid == 0) || (value->scaled > range->highest)) ? value->scaled : range->highest;
    range->valid++;
}

static void apply_to_engaged(traffic_t *traffic, uint64_t t_us, void (*apply)(traffic_watch_t *, uint64_t)) {
    for (uint32_t message = 0; message < AGV_COMMAND_COUNT; message++) {
        const traffic_id_t *entry = traffic_message(traffic, message);
        if ((entry != NULL) && (entry->watch->when == TRAFFIC_ENGAGED)) {
            apply(entry->watch, t_us);
        }
    }
}

static void end_engagement(traffic_t *traffic, uint64_t t_us) {
    apply_to_engaged(traffic, t_us, watch_stop);
    traffic->totals.engaged_us += t_us - traffic->engaged_since_us;
}

static uint64_t vcu_lost_us(const traffic_t *traffic) {
    const traffic_watch_t *vcu = traffic->vcu;
    return (vcu != NULL) ? vcu->since_us + ((uint64_t)vcu->deadline_ms * US_PER_MS) : 0;
}

/** A lost VCU ends an engagement, unless it is back so soon that it would be continued. */
static void lose_vcu(traffic_t *traffic, uint64_t t_us) {
    if (!traffic->engagement.is_engaged || (traffic->vcu == NULL) || !traffic->vcu->is_running) {
        return;
    }
    const uint64_t over_us = vcu_lost_us(traffic) + ((uint64_t)traffic->config.reengage_ms * US_PER_MS);
    if (t_us > over_us) {
        engagement_end(&traffic->engagement, vcu_lost_us(traffic));
        end_engagement(traffic, over_us);
    }
}

/** Follow the mode that the VCU reports. A VCU whose counter stands still begins no engagement. */
static void take_mode(traffic_t *traffic, uint8_t flags, uint64_t t_us) {
    const bool is_lost = t_us > vcu_lost_us(traffic);
    if (is_lost || !engagement_take(&traffic->engagement, &traffic->config, flags, t_us)) {
        return;
    }
    if (!traffic->engagement.is_engaged) {
        end_engagement(traffic, t_us);
        return;
    }
    const bool is_continued = traffic->engagement.is_continued;
    traffic->engaged_since_us = t_us;
    traffic->totals.engagements += is_continued ? 0 : 1;
    apply_to_engaged(traffic, traffic->engagement.began_us, is_continued ? watch_resume : watch_start);
}

/** Take a well-formed frame of a known message. */
static void take_known(traffic_t *traffic, traffic_id_t *entry, const hal_can_frame_t *frame, uint64_t t_us) {
    const uint32_t message = entry->message;
    signal_value_t value;
    for (size_t i = 0; signals_read(message, i, frame->data, &value); i++) {
        take_range(&entry->ranges[i], &value, t_us);
    }
    bool restarts = (message >= AGV_COMMAND_COUNT) || agv_value_is_valid(message, frame->data);
    if (entry->counter != NULL) {
        const uint8_t counter = frame->data[counter_at(message)];
        counter_use_add(entry->counter, counter, t_us);
        restarts = message_beats(&entry->beat, &traffic->config, message, counter);
    }
    if ((entry->watch != NULL) && restarts) {
        watch_restart(entry->watch, t_us);
    }
    if ((message == AGV_MSG_VEHICLE_STATUS) && (entry->side == HAL_CAN_VEHICLE)) {
        traffic->vcu = entry->watch;
        take_mode(traffic, frame->data[6], t_us);
    }
}

static void take_bits(traffic_id_t *entry, const hal_can_frame_t *frame) {
    for (size_t i = 0; i < AGV_DLC; i++) {
        entry->bits_ever[i] |= frame->data[i];
        entry->bits_always[i] &= frame->data[i];
    }
    entry->length_min = (frame->length < entry->length_min) ? frame->length : entry->length_min;
    entry->length_max = (frame->length > entry->length_max) ? frame->length : entry->length_max;
}

static void take_data(traffic_t *traffic, traffic_id_t *entry, const hal_can_frame_t *frame, uint64_t t_us) {
    const bool is_well_formed = (frame->length == AGV_DLC) && ((frame->flags & HAL_CAN_FD) == 0);
    if ((entry->message != TRAFFIC_UNKNOWN) && !is_well_formed) {
        entry->malformed++;
        return;
    }
    if (entry->count == 0) {
        entry->first_us = t_us;
    } else if (entry->last_us >= traffic->started_us) {
        gaps_add(&entry->gaps, entry->last_us, t_us - entry->last_us);
    } else {
        /* nobody listened all the time */
    }
    entry->count++;
    entry->last_us = t_us;
    take_bits(entry, frame);
    if (entry->message != TRAFFIC_UNKNOWN) {
        take_known(traffic, entry, frame, t_us);
    }
}

void traffic_frame(traffic_t *traffic, hal_can_side_t side, const hal_can_frame_t *frame, uint64_t t_us) {
    if ((frame->flags & HAL_CAN_ERROR) != 0) {
        traffic->totals.error++;
        return;
    }
    lose_vcu(traffic, t_us);
    traffic_id_t *entry = entry_of(traffic, side, frame, t_us);
    if ((frame->flags & HAL_CAN_REMOTE) != 0) {
        if (entry != NULL) {
            entry->malformed++;
        }
        return;
    }
    traffic->totals.data++;
    if (entry == NULL) {
        traffic->totals.uncounted++;
        return;
    }
    take_data(traffic, entry, frame, t_us);
}

void traffic_start(traffic_t *traffic, uint64_t t_us) {
    traffic->started_us = t_us;
    for (size_t i = 0; i < traffic->all_count; i++) {
        if (traffic->all[i]->watch != NULL) {
            traffic->all[i]->watch->is_running = false;
        }
    }
}

static int compare(const void *left, const void *right) {
    const traffic_id_t *a = *(const traffic_id_t *const *)left;
    const traffic_id_t *b = *(const traffic_id_t *const *)right;
    if (a->is_extended != b->is_extended) {
        return a->is_extended ? 1 : -1;
    }
    if (a->id != b->id) {
        return (a->id > b->id) ? 1 : -1;
    }
    return (int)a->side - (int)b->side;
}

void traffic_end(traffic_t *traffic, uint64_t t_us) {
    lose_vcu(traffic, t_us);
    if (traffic->engagement.is_engaged) {
        end_engagement(traffic, t_us);
        traffic->engagement.is_engaged = false;
    }
    for (size_t i = 0; i < traffic->all_count; i++) {
        if (traffic->all[i]->watch != NULL) {
            watch_stop(traffic->all[i]->watch, t_us);
        }
    }
    qsort((void *)traffic->all, traffic->all_count, sizeof traffic->all[0], compare);
    traffic->totals.end_us = t_us;
}

bool traffic_times(const traffic_t *traffic, uint32_t id, uint64_t *first_us, uint64_t *last_us) {
    bool heard = false;
    for (size_t side = 0; (id < IDS_11_BITS) && (side < HAL_CAN_SIDES); side++) {
        const traffic_id_t *entry = traffic->standard[side][id];
        if ((entry != NULL) && (entry->count > 0)) {
            *first_us = (!heard || (entry->first_us < *first_us)) ? entry->first_us : *first_us;
            *last_us = (!heard || (entry->last_us > *last_us)) ? entry->last_us : *last_us;
            heard = true;
        }
    }
    return heard;
}

bool traffic_heard(const traffic_t *traffic, uint32_t id) {
    uint64_t first_us = 0;
    uint64_t last_us = 0;
    return traffic_times(traffic, id, &first_us, &last_us);
}

const traffic_id_t *traffic_message(const traffic_t *traffic, uint32_t message) {
    if (message >= AGV_MSG_COUNT) {
        return NULL;
    }
    agv_ids_t ids;
    agv_config_ids(&traffic->config, &ids);
    return traffic->standard[side_of(traffic, message)][ids.of[message]];
}

const traffic_id_t *traffic_at(const traffic_t *traffic, size_t index) {
    return (index < traffic->all_count) ? traffic->all[index] : NULL;
}

traffic_totals_t traffic_totals(const traffic_t *traffic) {
    return traffic->totals;
}
