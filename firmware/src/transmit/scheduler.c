#include "transmit/scheduler.h"

/* Delay of the first periodic frame after a burst: staggered, so that the four do not coincide again (FSM-2). */
static const uint8_t first_ms[AGV_COMMAND_COUNT] = {[AGV_MSG_TURN_SIGNAL_COMMAND] = 100u,
                                                    [AGV_MSG_GEAR_COMMAND] = 66u,
                                                    [AGV_MSG_THROTTLE_COMMAND] = 33u,
                                                    [AGV_MSG_STEERING_COMMAND] = 25u};

/* Longer than a frame at 125 kbit/s and its error frames. */
#define SHIFT_MS 3u

void agv_scheduler_restart(agv_scheduler_t *scheduler, uint32_t now_ms) {
    for (uint32_t i = 0u; i < AGV_COMMAND_COUNT; i++) {
        scheduler->slots[i].next_ms = now_ms + first_ms[i];
    }
    scheduler->override_recent = 0u;
    scheduler->override_waits = 0u;
}

void agv_scheduler_restart_slot(agv_scheduler_t *scheduler, uint32_t now_ms, uint32_t command) {
    scheduler->slots[command].next_ms = now_ms + agv_message_cycle_ms(command);
}

uint32_t agv_scheduler_due(agv_scheduler_t *scheduler, uint32_t now_ms, uint32_t command) {
    agv_slot_t *const slot = &scheduler->slots[command];
    const uint32_t late_ms = now_ms - slot->next_ms;
    if (late_ms > (UINT32_MAX / 2u)) {
        return 0u;
    }
    const uint32_t cycle_ms = agv_message_cycle_ms(command);
    const uint32_t slots = (late_ms / cycle_ms) + 1u;
    slot->next_ms += slots * cycle_ms;
    return slots;
}

void agv_scheduler_shift(agv_scheduler_t *scheduler, uint32_t command) {
    scheduler->slots[command].next_ms += SHIFT_MS;
}

/* The bit is cleared when the gap is over, because the microseconds wrap: later differences would be wrong. */
bool agv_scheduler_override_due(agv_scheduler_t *scheduler, uint32_t now_us, uint32_t gap_ms, uint32_t command) {
    if ((now_us - scheduler->slots[command].overridden_us) >= (gap_ms * 1000u)) {
        scheduler->override_recent &= (uint8_t)~agv_message_bit(command);
    }
    return ((uint32_t)scheduler->override_waits & ~(uint32_t)scheduler->override_recent & agv_message_bit(command)) !=
           0u;
}

bool agv_scheduler_override(agv_scheduler_t *scheduler, uint32_t now_us, uint32_t gap_ms, uint32_t command) {
    scheduler->override_waits |= (uint8_t)agv_message_bit(command);
    return agv_scheduler_override_due(scheduler, now_us, gap_ms, command);
}

void agv_scheduler_overridden(agv_scheduler_t *scheduler, const agv_timers_t *timers, uint32_t command) {
    agv_slot_t *const slot = &scheduler->slots[command];
    slot->next_ms = timers->now_ms + (agv_message_cycle_ms(command) / 2u);
    slot->overridden_us = timers->now_us;
    scheduler->override_recent |= (uint8_t)agv_message_bit(command);
    scheduler->override_waits &= (uint8_t)~agv_message_bit(command);
}

void agv_scheduler_answered(agv_scheduler_t *scheduler, uint32_t command) {
    scheduler->override_waits &= (uint8_t)~agv_message_bit(command);
}

void agv_scheduler_discard(agv_scheduler_t *scheduler) {
    scheduler->override_waits = 0u;
}
