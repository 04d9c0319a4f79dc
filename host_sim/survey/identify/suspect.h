/**
 * @file suspect.h
 * For the criteria alone: an identifier that may carry a message.
 */
#ifndef HOST_SIM_SUSPECT_H
#define HOST_SIM_SUSPECT_H

#include "survey/identify/criteria.h"

/** An identifier, and the message that it may carry. */
typedef struct {
    const inquiry_t *inquiry;
    const traffic_id_t *entry;
    const evidence_id_t *heard;
    uint32_t message;
    const evidence_id_t *partner; /**< what goes together with it as its counterpart; NULL: none, or several */
} suspect_t;

/** Say it in words. @return verdict */
__attribute__((format(printf, 3, 4))) verdict_t say(criterion_t *criterion, verdict_t verdict, const char *format, ...);

/** Values of its own: what they are, and whether such a message has them. */
verdict_t criteria_values(const suspect_t *suspect, criterion_t *criterion);

/** The mode of the EPS follows the mode of the vehicle. @param mode NULL: unknown */
verdict_t criteria_eps_mode(const suspect_t *suspect, const track_t *mode, criterion_t *criterion);

#endif
