/* Fault confinement: sets of nodes, error counters, bus-off and recovery, unplugged nodes. */
#include "sim_internal.h"

static void put_bit(uint32_t *set, uint32_t bit, bool member) {
    *set = member ? *set | bit : *set & ~bit;
}

/* The node is off the bus: its own frame is aborted, and the frame that it was receiving is lost. */
static void leave_bus(sim_bus_t *bus, unsigned number) {
    sim_bus_node_state_t *node = &bus->nodes[number];
    bus->sending &= ~sim_bit(number);
    bus->hearing &= ~sim_bit(number);
    bus->dropped &= ~sim_bit(number);
    bus->misread &= ~sim_bit(number);
    if (node->current_aborted) {
        node->current_aborted = false;
        sim_bus_remove(node, node->tx_current);
    }
}

/* Time from one attempt of an unplugged node to send to its next attempt. */
static uint64_t alone_attempt_us(const sim_bus_t *bus, const sim_bus_node_state_t *node) {
    const hal_can_frame_t *frame = &node->tx[sim_bus_choose(node)].frame;
    const uint32_t bits =
        sim_bus_frame_bits(frame) - SIM_BITS_AFTER_ACKNOWLEDGE + SIM_BUS_ERROR_BITS + SIM_BUS_INTERFRAME_BITS;
    return (uint64_t)bits * bus->bit_us;
}

void sim_bus_refresh(sim_bus_t *bus, unsigned number) {
    sim_bus_node_state_t *node = &bus->nodes[number];
    const uint32_t bit = sim_bit(number);
    const bool works = node->powered && !node->bus_off;
    put_bit(&bus->listening, bit, works && node->plugged);
    if ((bus->listening & bit) == 0) {
        leave_bus(bus, number);
    }
    const bool wants = works && node->tx_count > 0 && !node->stalled;
    put_bit(&bus->ready, bit, wants && node->plugged);
    const bool was_alone = (bus->alone & bit) != 0;
    put_bit(&bus->alone, bit, wants && !node->plugged && !sim_is_passive(node));
    if (!was_alone && (bus->alone & bit) != 0) {
        node->alone_us = bus->now_us + alone_attempt_us(bus, node);
    }
}

void sim_bus_enter_bus_off(sim_bus_t *bus, unsigned number) {
    sim_bus_node_state_t *node = &bus->nodes[number];
    if (node->bus_off) {
        return;
    }
    node->bus_off = true;
    node->bus_off_count++;
    sim_bus_refresh(bus, number);
    if (!node->config.keep_on_bus_off) {
        node->tx_count = 0;
    }
}

void sim_bus_penalise(sim_bus_t *bus, unsigned number) {
    sim_bus_node_state_t *node = &bus->nodes[number];
    node->tec = (uint16_t)(node->tec + SIM_TEC_FAILED);
    if (node->tec > SIM_TEC_MAX) {
        sim_bus_enter_bus_off(bus, number);
    }
}

/* ---- Recovery: 128 sequences of 11 recessive bits; recovery_from_us = NEVER while the count is paused ---- */

/* Count the sequences since recovery_from_us. There are never more than recovery_left: the end of the recovery is an
 * event. */
static void count_idle_sequences(const sim_bus_t *bus, sim_bus_node_state_t *node) {
    if (node->recovery_from_us < bus->now_us) {
        node->recovery_left -= (uint32_t)((bus->now_us - node->recovery_from_us) / sim_bus_sequence_us(bus));
    }
}

/* Time at which the count continues: at once for an unplugged node, otherwise when the bus is idle. */
static uint64_t recovery_goes_on_us(const sim_bus_t *bus, const sim_bus_node_state_t *node) {
    if (!node->plugged) {
        return bus->now_us;
    }
    if (bus->busy) {
        return SIM_BUS_NEVER;
    }
    return bus->free_us > bus->now_us ? bus->free_us : bus->now_us;
}

void sim_bus_recover(sim_bus_t *bus, sim_bus_node_t number) {
    if (number >= bus->node_count || !bus->nodes[number].bus_off || (bus->recovering & sim_bit(number)) != 0) {
        return;
    }
    sim_bus_node_state_t *node = &bus->nodes[number];
    bus->recovering |= sim_bit(number);
    node->recovery_left = SIM_BUS_RECOVERY_SEQUENCES;
    node->recovery_from_us = recovery_goes_on_us(bus, node);
    sim_bus_schedule(bus);
}

void sim_bus_pause_recovery(sim_bus_t *bus) {
    for (uint32_t set = bus->recovering; set != 0; set &= set - 1) {
        sim_bus_node_state_t *node = &bus->nodes[sim_lowest(set)];
        if (node->plugged) {
            count_idle_sequences(bus, node);
            node->recovery_from_us = SIM_BUS_NEVER;
        }
    }
}

/* Delimiter, end of frame and interframe bits of a frame are 11 recessive bits: one sequence. */
void sim_bus_resume_recovery(sim_bus_t *bus) {
    for (uint32_t set = bus->recovering; set != 0; set &= set - 1) {
        sim_bus_node_state_t *node = &bus->nodes[sim_lowest(set)];
        if (node->plugged) {
            node->recovery_left--;
            node->recovery_from_us = bus->free_us;
        }
    }
}

static void end_recovery(sim_bus_t *bus, unsigned number) {
    sim_bus_node_state_t *node = &bus->nodes[number];
    bus->recovering &= ~sim_bit(number);
    node->bus_off = false;
    node->tec = 0;
    node->rec = 0;
    sim_bus_refresh(bus, number);
}

/* ---- Unplugged nodes: their frames are not acknowledged and are sent again, until the node is error passive ---- */

static void fail_alone(sim_bus_t *bus, unsigned number) {
    sim_bus_node_state_t *node = &bus->nodes[number];
    sim_bus_penalise(bus, number);
    node->alone_us = bus->now_us + alone_attempt_us(bus, node);
    sim_bus_refresh(bus, number);
}

void sim_bus_run_aside(sim_bus_t *bus) {
    for (uint32_t set = bus->alone; set != 0; set &= set - 1) {
        if (bus->nodes[sim_lowest(set)].alone_us <= bus->now_us) {
            fail_alone(bus, sim_lowest(set));
        }
    }
    for (uint32_t set = bus->recovering; set != 0; set &= set - 1) {
        if (sim_bus_recovered_us(bus, &bus->nodes[sim_lowest(set)]) <= bus->now_us) {
            end_recovery(bus, sim_lowest(set));
        }
    }
}

void sim_bus_set_plugged(sim_bus_t *bus, sim_bus_node_t number, bool plugged) {
    if (number >= bus->node_count || bus->nodes[number].plugged == plugged) {
        return;
    }
    sim_bus_node_state_t *node = &bus->nodes[number];
    if ((bus->recovering & sim_bit(number)) != 0) {
        count_idle_sequences(bus, node);
        node->plugged = plugged;
        node->recovery_from_us = recovery_goes_on_us(bus, node);
    }
    node->plugged = plugged;
    sim_bus_refresh(bus, number);
    sim_bus_schedule(bus);
}
