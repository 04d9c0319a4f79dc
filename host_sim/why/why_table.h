/**
 * @file why_table.h
 * What kind of thing each fault is, which message tells of it, and which setting limits it: one row a fault.
 */
#ifndef HOST_SIM_WHY_TABLE_H
#define HOST_SIM_WHY_TABLE_H

#include <stdint.h>

#include "agv/config.h"
#include "agv/faults.h"
#include "agv/protocol.h"

/** The kinds. */
typedef enum {
    WHY_SILENCE,   /**< a message, or the change of its counter, stayed away */
    WHY_STUCK,     /**< a counter did not change */
    WHY_BIT,       /**< a fault bit was set */
    WHY_SCORE,     /**< so many bad frames */
    WHY_VALUE,     /**< a value that the protocol does not have */
    WHY_BUDGET,    /**< something lasted too long */
    WHY_MODE,      /**< the reported mode */
    WHY_INTRUSION, /**< frames of another sender */
    WHY_BUS,       /**< a controller of the supervisor */
    WHY_VEHICLE,   /**< the vehicle did not do what it was told */
    WHY_HARDWARE,  /**< inputs and outputs of the supervisor */
    WHY_OWN,       /**< the supervisor itself */
    WHY_KINDS
} why_kind_t;

/** As the index of a setting: none. */
#define WHY_NO_SETTING UINT16_MAX

/** A row. */
typedef struct {
    why_kind_t kind;
    agv_message_t message; /**< AGV_MSG_NONE: none, or whichever it was */
    uint16_t setting;      /**< index, for agv_config_get(); WHY_NO_SETTING */
    const char *unit;      /**< of the limit; NULL */
    uint8_t byte;          /**< WHY_BIT, EPS supply faults: index in data[] */
    uint8_t mask;          /**< and the bits that are bad */
} why_row_t;

/** "silence". */
const char *why_kind_name(why_kind_t kind);

/** The row of a fault. */
const why_row_t *why_row(agv_fault_t fault);

/** What a fault's message is compared with: the command of a deviation, for example; AGV_MSG_NONE: nothing. */
agv_message_t why_compared_with(agv_fault_t fault);

#endif
