/**
 * @file evidence.h
 * What frames tell of the message that an 11-bit identifier carries: which messages they could be, how the bytes count
 * that may be alive counters, how the values change, when the identifier is silent.
 *
 * Memory is bounded: some 2 KiB for each identifier, and up to 768 KiB for each field that changes all the time. An
 * identifier that can be no message of the protocol keeps no values.
 */
#ifndef HOST_SIM_EVIDENCE_H
#define HOST_SIM_EVIDENCE_H

#include "agv/config.h"
#include "hal/can.h"
#include "survey/identify/track.h"
#include "traffic/counter_use.h"

/** A gap from which on an identifier is silent. */
#define EVIDENCE_SILENCE_US 200000u

#define EVIDENCE_SILENCES_MAX 64u

/** As the message of an identifier: none of the protocol. */
#define EVIDENCE_UNKNOWN UINT32_MAX

/** A time without frames. */
typedef struct {
    uint64_t begin_us;
    uint64_t end_us;
} silence_t;

/** Of one identifier on one side. */
typedef struct {
    uint32_t id;
    hal_can_side_t side;
    uint32_t message; /**< whose identifier it is in the configurations; EVIDENCE_UNKNOWN */
    uint64_t frames;
    uint64_t misfits;          /**< frames with a reserved bit or an invalid value of that message */
    uint32_t fits;             /**< bit n: all its frames could be those of message n (fits.h) */
    counter_use_t counters[2]; /**< data[0] and data[7] as if they were alive counters */
    track_t *tracks[FIELD_COUNT];
    silence_t silences[EVIDENCE_SILENCES_MAX]; /**< the first ones */
    size_t silence_count;
    uint64_t first_us;
    uint64_t last_us;
} evidence_id_t;

/** Of all identifiers. */
typedef struct evidence evidence_t;

/** Begin. @param configs of `count` configurations: the identifiers that are known @return NULL: out of memory */
evidence_t *evidence_new(const agv_config_t *configs, size_t count);

/** Take a frame. */
void evidence_frame(evidence_t *evidence, hal_can_side_t side, const hal_can_frame_t *frame, uint64_t t_us);

/** What is known of an 11-bit identifier. @return NULL: no data frame was heard */
const evidence_id_t *evidence_of(const evidence_t *evidence, hal_can_side_t side, uint32_t id);

/** Whether most frames of an identifier cannot be the message that the configurations say. */
bool evidence_contradicts(const evidence_id_t *heard);

/** Free it; NULL is allowed. */
void evidence_free(evidence_t *evidence);

#endif
