#include "survey/identify/evidence.h"

#include <stdlib.h>
#include <string.h>

#include "survey/identify/fits.h"

enum { IDS = 2048, FIRST_COUNTER_AT = 0, LAST_COUNTER_AT = 7, HALF = 2 };

struct evidence {
    uint32_t messages[IDS]; /**< the message of each identifier */
    evidence_id_t *ids[HAL_CAN_SIDES][IDS];
};

evidence_t *evidence_new(const agv_config_t *configs, size_t count) {
    evidence_t *evidence = calloc(1, sizeof *evidence);
    if (evidence == NULL) {
        return NULL;
    }
    (void)memset(evidence->messages, UINT8_MAX, sizeof evidence->messages);
    for (size_t i = 0; i < count; i++) {
        agv_ids_t ids;
        agv_config_ids(&configs[i], &ids);
        for (uint32_t message = 0; message < AGV_MSG_COUNT; message++) {
            evidence->messages[ids.of[message]] = message;
        }
    }
    return evidence;
}

static void drop_tracks(evidence_id_t *heard, uint32_t kept) {
    for (uint32_t field = 0; field < FIELD_COUNT; field++) {
        if (((kept >> field) & 1) == 0) {
            track_free(heard->tracks[field]);
            heard->tracks[field] = NULL;
        }
    }
}

void evidence_free(evidence_t *evidence) {
    for (size_t i = 0; (evidence != NULL) && (i < (size_t)HAL_CAN_SIDES * IDS); i++) {
        evidence_id_t *heard = evidence->ids[i / IDS][i % IDS];
        if (heard != NULL) {
            drop_tracks(heard, 0);
            free(heard);
        }
    }
    free(evidence);
}

/** The fields that are worth a track: those of the messages that the identifier may carry. */
static uint32_t fields_of(const evidence_id_t *heard) {
    uint32_t fields = (heard->message != EVIDENCE_UNKNOWN) ? field_of_message(heard->message) : 0;
    for (uint32_t message = 0; message < AGV_MSG_COUNT; message++) {
        fields |= (((heard->fits >> message) & 1) != 0) ? field_of_message(message) : 0;
    }
    return fields;
}

static void take_fields(evidence_id_t *heard, const uint8_t data[AGV_DLC], uint64_t t_us) {
    const uint32_t fields = fields_of(heard);
    for (uint32_t field = 0; field < FIELD_COUNT; field++) {
        if (((fields >> field) & 1) != 0) {
            heard->tracks[field] =
                (heard->tracks[field] != NULL) ? heard->tracks[field] : calloc(1, sizeof *heard->tracks[field]);
            if (heard->tracks[field] != NULL) {
                track_add(heard->tracks[field], (field_t)field, data, t_us);
            }
        }
    }
}

static void take_silence(evidence_id_t *heard, uint64_t t_us) {
    if ((heard->frames > 0) && (t_us - heard->last_us >= EVIDENCE_SILENCE_US) &&
        (heard->silence_count < EVIDENCE_SILENCES_MAX)) {
        heard->silences[heard->silence_count] = (silence_t){.begin_us = heard->last_us, .end_us = t_us};
        heard->silence_count++;
    }
    heard->first_us = (heard->frames == 0) ? t_us : heard->first_us;
    heard->last_us = t_us;
}

static void take_fit(evidence_id_t *heard, const hal_can_frame_t *frame) {
    const bool is_well_formed = (frame->length == AGV_DLC) && ((frame->flags & HAL_CAN_FD) == 0);
    const uint32_t before = heard->fits;
    if (heard->message != EVIDENCE_UNKNOWN) {
        heard->misfits += (is_well_formed && !fits_protocol(heard->message, frame->data)) ? 1 : 0;
    }
    heard->fits = is_well_formed ? fits_frame(heard->fits, frame->data) : 0;
    if (heard->fits != before) {
        drop_tracks(heard, fields_of(heard));
    }
}

static evidence_id_t *find(evidence_t *evidence, hal_can_side_t side, uint32_t id) {
    evidence_id_t **slot = &evidence->ids[side][id];
    if (*slot == NULL) {
        *slot = calloc(1, sizeof **slot);
        if (*slot != NULL) {
            **slot = (evidence_id_t){.id = id, .side = side, .message = evidence->messages[id], .fits = FITS_ALL};
        }
    }
    return *slot;
}

void evidence_frame(evidence_t *evidence, hal_can_side_t side, const hal_can_frame_t *frame, uint64_t t_us) {
    const uint32_t others = HAL_CAN_ERROR | HAL_CAN_REMOTE | HAL_CAN_EXTENDED;
    if (((frame->flags & others) != 0) || (frame->id >= IDS)) {
        return;
    }
    evidence_id_t *heard = find(evidence, side, frame->id);
    if (heard == NULL) {
        return; /* out of memory: no identifier is proposed without evidence */
    }
    take_fit(heard, frame);
    take_silence(heard, t_us);
    heard->frames++;
    if (frame->length == AGV_DLC) {
        take_fields(heard, frame->data, t_us);
        counter_use_add(&heard->counters[0], frame->data[FIRST_COUNTER_AT], t_us);
        counter_use_add(&heard->counters[1], frame->data[LAST_COUNTER_AT], t_us);
    }
}

const evidence_id_t *evidence_of(const evidence_t *evidence, hal_can_side_t side, uint32_t id) {
    return (id < IDS) ? evidence->ids[side][id] : NULL;
}

bool evidence_contradicts(const evidence_id_t *heard) {
    return heard->misfits * HALF > heard->frames;
}
