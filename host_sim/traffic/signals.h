/**
 * @file signals.h
 * The signals that a payload carries, with name, value, unit and word, as people read them: "gear P", "angle -12.5 deg".
 * They are defined in signals.def. A frame of another length than 8 has no signals.
 */
#ifndef HOST_SIM_SIGNALS_H
#define HOST_SIM_SIGNALS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "agv/faults.h"
#include "agv/protocol.h"

/** As a message: the status frame of the supervisor (TOP-3). */
#define SIGNALS_STATUS_FRAME ((uint32_t)AGV_MSG_COUNT)

/** Messages with signals: those of the protocol, and the status frame. */
#define SIGNALS_MESSAGES (AGV_MSG_COUNT + 1)

/** The most signals of one message. */
#define SIGNALS_MAX 16u

/** Room for what signals_print() writes about any payload. */
#define SIGNALS_TEXT_SIZE 320u

/** Kinds of signals. */
typedef enum {
    SIGNAL_NUMBER,  /**< a measured or commanded value */
    SIGNAL_CHOICE,  /**< one of some words: gear, mode, state */
    SIGNAL_FLAG,    /**< one bit with two words: a light, a button */
    SIGNAL_ALARM,   /**< not 0: a fault; `fault` says which one */
    SIGNAL_COUNTER, /**< an alive counter */
    SIGNAL_HEX      /**< 32 bits that are read as 8 hexadecimal digits: a checksum */
} signal_kind_t;

/** What is the same in every frame. */
typedef struct {
    const char *name; /**< "angle"; of an alarm the name of its fault: "EPS_MOTOR_ENCODER" */
    const char *unit; /**< "deg", "%", "m/h", "mm/s", "V", or "" */
    signal_kind_t kind;
    uint8_t decimals;  /**< of the value */
    agv_fault_t fault; /**< of SIGNAL_ALARM; else AGV_FAULT_NONE */
} signal_info_t;

/** The value in one frame. */
typedef struct {
    uint32_t raw;     /**< as in the payload, without sign */
    int64_t scaled;   /**< value in `unit` times 10^decimals: -125 is -12.5 deg */
    const char *word; /**< "P", "autopilot", "on"; NULL: the value has no word */
    bool valid;       /**< false: a value that the protocol does not define */
    bool present;     /**< false: the page of this frame has another signal in its place */
} signal_value_t;

/** "gear_command", ..., "supervisor_status"; NULL for a message above SIGNALS_STATUS_FRAME. */
const char *signals_message_name(uint32_t message);

/** Number of signals of a message; 0 if there is no such message. */
size_t signals_count(uint32_t message);

/** Describe a signal. @param index 0 to signals_count() - 1 @return NULL if there is no such signal. */
const signal_info_t *signals_info(uint32_t message, size_t index);

/**
 * Read a signal from a payload. One that is not present has the value 0.
 *
 *     for (size_t i = 0; signals_read(message, i, data, &value); i++) { signals_info(message, i)->name ... }
 *
 * @return false: there is no such signal.
 */
bool signals_read(uint32_t message, size_t index, const uint8_t data[AGV_DLC], signal_value_t *value);

/** The bits of a payload that belong to signals; the others are reserved (P14). */
void signals_mask(uint32_t message, uint8_t mask[AGV_DLC]);

/** The value as a number in its unit: -12.5. */
double signals_number(const signal_info_t *info, const signal_value_t *value);

/** Room for what signals_value_text() writes. */
#define SIGNALS_VALUE_SIZE 48u

/** Write a value with its word or unit: "P", "-12.5 deg", "5 (invalid)". */
void signals_value_text(char text[SIGNALS_VALUE_SIZE], const signal_info_t *info, const signal_value_t *value);

/** Write what a raw value of a signal means: "P", "autopilot", "5 (invalid)". */
void signals_raw_text(char text[SIGNALS_VALUE_SIZE], uint32_t message, size_t index, uint32_t raw);

/**
 * Write the signals of a payload as one text: "speed 1200 m/h, mode autopilot, alive_counter 17". Alarms and flags are
 * named only while they are set.
 * @param size what does not fit is left out; SIGNALS_TEXT_SIZE is enough for all. @return text
 */
char *signals_print(char *text, size_t size, uint32_t message, const uint8_t data[AGV_DLC]);

#endif
