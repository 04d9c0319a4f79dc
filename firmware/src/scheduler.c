#include "agv/scheduler.h"

#include "agv/core.h"

/* First periodic frame after all were sent at once: spread, so that they do not meet again. */
static const uint8_t first_ms[AGV_COMMAND_COUNT] = {100u, 66u, 33u, 25u};

static uint32_t bit_of(uint32_t command) {
    return 1u << command;
}

static agv_slot_t *slot_of(agv_core_t *core, uint32_t command) {
    return &core->transmitter.scheduler.slots[command];
}

void agv_scheduler_restart(agv_core_t *core) {
    for (uint32_t i = 0u; i < AGV_COMMAND_COUNT; i++) {
        slot_of(core, i)->next_ms = core->now_ms + first_ms[i];
    }
    core->transmitter.scheduler.override_recent = 0u;
    core->transmitter.scheduler.override_waits = 0u;
}

void agv_scheduler_restart_slot(agv_core_t *core, uint32_t command) {
    slot_of(core, command)->next_ms = core->now_ms + agv_message_cycle_ms(command);
}

uint32_t agv_scheduler_due(agv_core_t *core, uint32_t command) {
    agv_slot_t *const slot = slot_of(core, command);
    const uint32_t late_ms = core->now_ms - slot->next_ms;
    if (late_ms > (UINT32_MAX / 2u)) {
        return 0u;
    }
    const uint32_t cycle_ms = agv_message_cycle_ms(command);
    const uint32_t slots = (late_ms / cycle_ms) + 1u;
    slot->next_ms += slots * cycle_ms;
    return slots;
}

/* Once the gap is over it stays over: differences of wrapping microseconds are only taken while it is not. */
bool agv_scheduler_override_due(agv_core_t *core, uint32_t command) {
    agv_scheduler_t *const scheduler = &core->transmitter.scheduler;
    if ((core->now_us - slot_of(core, command)->overridden_us) >= (core->config.override_gap_ms * 1000u)) {
        scheduler->override_recent &= ~bit_of(command);
    }
    return (scheduler->override_waits & ~scheduler->override_recent & bit_of(command)) != 0u;
}

bool agv_scheduler_override(agv_core_t *core, uint32_t command) {
    core->transmitter.scheduler.override_waits |= bit_of(command);
    return agv_scheduler_override_due(core, command);
}

void agv_scheduler_overridden(agv_core_t *core, uint32_t command) {
    agv_scheduler_t *const scheduler = &core->transmitter.scheduler;
    agv_slot_t *const slot = slot_of(core, command);
    slot->next_ms = core->now_ms + (agv_message_cycle_ms(command) / 2u);
    slot->overridden_us = core->now_us;
    scheduler->override_recent |= bit_of(command);
    scheduler->override_waits &= ~bit_of(command);
}
