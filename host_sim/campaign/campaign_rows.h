/**
 * @file campaign_rows.h
 * What a campaign does to the vehicle and the supervisor to cause each fault, and how long the reaction may take: one
 * row a fault.
 *
 * The time that is evaluated here is coarse: the settings, and an allowance for the wire. The exact worst cases are
 * derived by scripts/tools/reaction-time.py, from what `host_sim campaign --tables` prints of this table.
 */
#ifndef HOST_SIM_CAMPAIGN_ROWS_H
#define HOST_SIM_CAMPAIGN_ROWS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "agv/config.h"
#include "agv/faults.h"
#include "agv/protocol.h"

/** As fast as the vehicle is driven. 30 %: 1.2 m/s, from which a VCU with a guard has P within confirm_timeout_ms. */
#define CAMPAIGN_THROTTLE_MAX_PCT 30u

/** When the supervisor detects a cause. */
typedef enum {
    CAMPAIGN_AT_ONCE,     /**< in the call that finds it, which is the cause */
    CAMPAIGN_TICK,        /**< by the next tick */
    CAMPAIGN_FRAME,       /**< the frame that is sent at the cause carries it */
    CAMPAIGN_FRAMES,      /**< so many frames of a message carry it (`setting`; none: one) */
    CAMPAIGN_SILENCE,     /**< a message, or the change of its counter, stays away for longer than `setting` */
    CAMPAIGN_LASTS,       /**< frames of a message have been carrying it for `setting` */
    CAMPAIGN_GAPS,        /**< so many gaps (`setting`) between frames of a message, each at most `highest` ms */
    CAMPAIGN_STALL,       /**< a frame waits for `setting` from when one is to be sent (the first of a message) */
    CAMPAIGN_UNCONFIRMED, /**< `setting` after a trip that the silence of a message causes */
    CAMPAIGN_CONTACT,     /**< a contact has read wrongly at the ticks of `setting` */
    CAMPAIGN_CLOCKS,      /**< at the end of the second whole comparison of the two clocks (HW-4) */
} campaign_kind_t;

/* What a row is like. */
#define CAMPAIGN_GATEWAY (1u << 0)    /**< on the gateway only */
#define CAMPAIGN_SHARED (1u << 1)     /**< on the shared bus only */
#define CAMPAIGN_ENGAGED (1u << 2)    /**< counts while engaged only */
#define CAMPAIGN_MANUAL (1u << 3)     /**< caused in manual only */
#define CAMPAIGN_START (1u << 4)      /**< the cause is there from the start on */
#define CAMPAIGN_LATER (1u << 5)      /**< the cause is $n ms after its steps: until then the supervisor does nothing */
#define CAMPAIGN_BY_OUTPUT (1u << 6)  /**< no frame can leave, or they leave already: what counts is the output */
#define CAMPAIGN_AS_TRIP (1u << 7)    /**< warns by default, is made a trip */
#define CAMPAIGN_LIES (1u << 8)       /**< the VCU's reports of gear and mode are wrong or missing */
#define CAMPAIGN_NO_OUTPUT (1u << 9)  /**< the safety output is never closed */
#define CAMPAIGN_NO_WIRE (1u << 10)   /**< no frame leaves for a while */
#define CAMPAIGN_AT_ONCE_P (1u << 11) /**< with park: at_once only */
#define CAMPAIGN_LATE_AI (1u << 12)   /**< the AI computer starts after INIT: no collisions with it there */
#define CAMPAIGN_AGAIN (1u << 13)     /**< engaged more than once before the cause */
#define CAMPAIGN_IN_GEAR (1u << 14) /**< with an engagement: not on the gateway, which waits with D and the throttle */
#define CAMPAIGN_FLAGS_END (1u << 15)

typedef struct {
    agv_fault_t fault;
    agv_fault_t first; /**< the first reason of the trip; it is the fault itself but for a few */
    campaign_kind_t kind;
    agv_message_t message;
    uint16_t setting; /**< AGV_SETTING_*; AGV_SETTING_COUNT: none */
    uint32_t flags;
    uint32_t lowest; /**< of $n, a random number in `steps` */
    uint32_t highest;
    const char *top;   /**< more lines at the top level of the scenario */
    const char *steps; /**< divided by '|'; "+1500 " before one: so much later; alternatives are divided by '/' */
} campaign_row_t;

/** All rows. */
extern const campaign_row_t CAMPAIGN_ROWS[];
extern const size_t CAMPAIGN_ROW_COUNT;

/** The row of a fault; NULL: a campaign cannot cause it. */
const campaign_row_t *campaign_row(agv_fault_t fault);

/** A fault that is known later when its cause comes with an engagement than under way (SUP-3, SUP-5, SUP-8). */
typedef struct {
    agv_fault_t fault;
    uint16_t
        wait; /**< AGV_SETTING_*: for so long after the engagement it is not judged; AGV_SETTING_COUNT: from then on */
    bool never_seen; /**< the cause is there from the start on, and `wait` is all the time that it takes */
} campaign_engagement_t;

/** All of them. */
extern const campaign_engagement_t CAMPAIGN_ENGAGEMENTS[];
extern const size_t CAMPAIGN_ENGAGEMENT_COUNT;

/** That of a fault; NULL: an engagement does not delay it. */
const campaign_engagement_t *campaign_engagement(agv_fault_t fault);

/** From the cause to the decision at the latest, in ms, on an idle wire. */
uint32_t campaign_decision_ms(const campaign_row_t *row, const agv_config_t *config);

/**
 * The same with a cause that comes with an engagement: from the operator's switch, or from the cause if that is later.
 */
uint32_t campaign_engaged_decision_ms(const campaign_row_t *row, const campaign_engagement_t *engagement,
                                      const agv_config_t *config);

/** What the wire may take of it, in us: some frames on the way to the supervisor, and from it. */
uint32_t campaign_wire_us(uint32_t bitrate);

#endif
