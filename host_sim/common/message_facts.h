/**
 * @file message_facts.h
 * What the table of the messages (agv/message_table.def) says of each: its sender, its alive counter, its deadline.
 *
 * A message is an agv_message_t below AGV_MSG_COUNT.
 */
#ifndef HOST_SIM_MESSAGE_FACTS_H
#define HOST_SIM_MESSAGE_FACTS_H

#include <stdbool.h>
#include <stdint.h>

#include "agv/config.h"
#include "agv/protocol.h"

/** As the place of an alive counter: the message has none. */
#define MESSAGE_NO_COUNTER 0xFFu

/** Who sends a message. */
typedef enum { MESSAGE_FROM_AI, MESSAGE_FROM_VCU, MESSAGE_FROM_EPS } message_sender_t;
message_sender_t message_sender(uint32_t message);

/**
 * Whether a supervisor listens to an identifier: that of a message as configured, or in either ID set (P1). The
 * identifier of its status frame is none of them.
 */
bool message_id_is_heard(const agv_ids_t *ids, uint32_t id);

/** The index of the alive counter in data[]; MESSAGE_NO_COUNTER. */
uint8_t message_counter_at(uint32_t message);

/** The setting (AGV_SETTING_*) that limits its silence. */
uint16_t message_deadline_setting(uint32_t message);

/** Whether the alive counter of a message has to step by 1 to 3; else any change is one. */
bool message_has_to_increment(const agv_config_t *config, uint32_t message);

/** The alive counter of a message, as the supervisor follows it (SUP-2). Begin with all zero. */
typedef struct {
    uint8_t value;        /**< of the last frame */
    uint8_t steps_needed; /**< right steps until an incrementing counter counts as changed again */
    bool is_heard;
} message_beat_t;

/** Take a frame's counter. @return whether it counts as changed; true for the first frame */
bool message_beats(message_beat_t *beat, const agv_config_t *config, uint32_t message, uint8_t value);

/** What a frame with flags (HAL_CAN_*) is: "extended frame". "" without flags. */
const char *message_form(uint32_t flags);

#endif
