/**
 * @file criteria.h
 * What speaks for and against that an identifier carries a message.
 *
 * Cycle and plausible values are weak: other vehicles run other cycles, and many payloads are plausible. What decides is
 * that values go together with those of the message's counterpart, or content that no other message has. One thing that
 * refuses outweighs all others: an angle that stays at an end stop, a command that comes while the AI computer is silent.
 */
#ifndef HOST_SIM_CRITERIA_H
#define HOST_SIM_CRITERIA_H

#include "survey/identify/evidence.h"
#include "traffic/traffic.h"

#define CRITERIA_MAX 8u
#define CRITERIA_TEXT_SIZE 112u

/** What a criterion says. */
typedef enum {
    VERDICT_NONE,
    VERDICT_FOR,
    VERDICT_DECIDES, /**< for it, and enough to propose it if nothing refuses and no other identifier fits */
    VERDICT_AGAINST,
    VERDICT_REFUSES /**< against it: it is not proposed, whatever speaks for it */
} verdict_t;

/** A verdict in words. */
typedef struct {
    verdict_t verdict;
    char text[CRITERIA_TEXT_SIZE];
} criterion_t;

/** All that is known while identifiers are looked for. */
typedef struct {
    const traffic_t *traffic;
    const evidence_t *evidence;
    const agv_config_t *config;
    const evidence_id_t *of[AGV_MSG_COUNT]; /**< the identifier of each message that is known by now; NULL */
    uint32_t heard;                         /**< bit n: message n came with its own identifier */
    bool is_foreign; /**< most did not, or had not its values: one that did may still be another message */
} inquiry_t;

/** Whether an identifier is free to carry a message of which it has the side, the length, the bits and the counter. */
bool criteria_allow(const inquiry_t *inquiry, const traffic_id_t *entry, uint32_t message);

/** Judge one that may. @return number of verdicts, none of them VERDICT_NONE */
size_t criteria_judge(const inquiry_t *inquiry, const traffic_id_t *entry, uint32_t message,
                      criterion_t criteria[CRITERIA_MAX]);

/** The evidence of an identifier of the statistics. @return NULL: 29 bits, or out of memory */
const evidence_id_t *criteria_evidence(const inquiry_t *inquiry, const traffic_id_t *entry);

#endif
