/* The bus line: arbitration, collisions, the end of a frame, and the order of events. */
#include "sim_internal.h"

/* The nodes that may start now: those whose suspend time is over. */
static uint32_t nodes_that_may_start(sim_bus_t *bus) {
    for (uint32_t set = bus->suspended; set != 0; set &= set - 1) {
        const unsigned number = sim_lowest(set);
        if (bus->nodes[number].suspend_until_us <= bus->now_us) {
            bus->suspended &= ~sim_bit(number);
        }
    }
    return bus->ready & ~bus->suspended;
}

/* The winners of the arbitration: all nodes with the lowest key. */
static uint32_t arbitrate(sim_bus_t *bus) {
    uint32_t lowest_key = UINT32_MAX;
    uint32_t winners = 0;
    for (uint32_t set = nodes_that_may_start(bus); set != 0; set &= set - 1) {
        const unsigned number = sim_lowest(set);
        sim_bus_node_state_t *node = &bus->nodes[number];
        const unsigned slot = sim_bus_choose(node);
        node->tx_current = (uint8_t)slot;
        if (node->tx_key[slot] < lowest_key) {
            lowest_key = node->tx_key[slot];
            winners = 0;
        }
        if (node->tx_key[slot] == lowest_key) {
            winners |= sim_bit(number);
        }
    }
    return winners;
}

static const hal_can_frame_t *current_frame(const sim_bus_t *bus, unsigned number) {
    const sim_bus_node_state_t *node = &bus->nodes[number];
    return &node->tx[node->tx_current].frame;
}

/* The nodes of a set whose bit @p index of the body is recessive. */
static uint32_t recessive_at(const sim_bus_t *bus, uint32_t set, uint32_t index) {
    uint32_t recessive = 0;
    for (; set != 0; set &= set - 1) {
        const unsigned number = sim_lowest(set);
        if (sim_frame_bit(current_frame(bus, number), index)) {
            recessive |= sim_bit(number);
        }
    }
    return recessive;
}

static bool is_any_error_active(const sim_bus_t *bus, uint32_t set) {
    for (; set != 0; set &= set - 1) {
        if (!sim_is_passive(&bus->nodes[sim_lowest(set)])) {
            return true;
        }
    }
    return false;
}

/*
 * Several nodes send the same arbitration field. Equal frames merge. At the first bit that differs, the nodes that send
 * it recessive detect a bit error. If one of them is error active, its error flag destroys the frame for all nodes. If
 * all are error passive, they stop sending (dropped) and the others continue.
 * @return bits up to and including the error; 0 = the frame of the remaining senders is sent
 */
static uint32_t resolve_collision(sim_bus_t *bus) {
    for (uint32_t index = 0; (bus->senders & (bus->senders - 1)) != 0; index++) {
        const hal_can_frame_t *frame = current_frame(bus, sim_lowest(bus->senders));
        if (index == sim_frame_body_bits(frame)) {
            break; /* all bits are equal, so the CRC is, too */
        }
        const uint32_t recessive = recessive_at(bus, bus->senders, index);
        if (recessive == 0 || recessive == bus->senders) {
            continue;
        }
        if (is_any_error_active(bus, recessive)) {
            const uint32_t bits = sim_frame_header_bits(frame) + index + 1;
            return bits + (bits - 1) / 4;
        }
        bus->dropped |= recessive;
        bus->senders &= ~recessive;
    }
    return 0;
}

/* Determine the outcome of the winners' frame, and its length in bits. */
static uint32_t determine_outcome(sim_bus_t *bus) {
    const uint32_t collision_bits = resolve_collision(bus);
    bus->frame = *current_frame(bus, sim_lowest(bus->senders));
    bus->sending = bus->senders;
    bus->hearing = bus->listening & ~(bus->senders | bus->dropped);
    bus->outcome = SIM_BUS_DESTROYED;
    if (collision_bits != 0) {
        return collision_bits + SIM_BUS_ERROR_BITS;
    }
    const uint32_t bits = sim_bus_frame_bits(&bus->frame);
    if (sim_bus_spoil(bus)) {
        return bits + SIM_BUS_ERROR_BITS;
    }
    if (bus->hearing == 0) {
        bus->outcome = SIM_BUS_NOT_ACKNOWLEDGED;
        return bits - SIM_BITS_AFTER_ACKNOWLEDGE + SIM_BUS_ERROR_BITS;
    }
    bus->outcome = SIM_BUS_ARRIVES;
    return bits;
}

static void begin(sim_bus_t *bus) {
    bus->now_us = bus->start_us;
    if (bus->recovering != 0) {
        sim_bus_pause_recovery(bus);
    }
    bus->dropped = 0;
    bus->misread = 0;
    bus->senders = arbitrate(bus);
    bus->end_us = bus->start_us + (uint64_t)determine_outcome(bus) * bus->bit_us;
    bus->busy = true;
}

static void notify_taps(const sim_bus_t *bus) {
    const sim_bus_event_t event = {
        .frame = &bus->frame,
        .start_us = bus->start_us,
        .end_us = bus->end_us,
        .senders = bus->senders,
        .sender = (sim_bus_node_t)sim_lowest(bus->senders),
        .error = bus->outcome != SIM_BUS_ARRIVES,
    };
    for (unsigned i = 0; i < bus->tap_count; i++) {
        bus->taps[i].fn(bus->taps[i].ctx, &event);
    }
}

/* An error-passive node that has sent must wait SIM_BUS_SUSPEND_BITS longer than the others. */
static void suspend_sender(sim_bus_t *bus, unsigned number) {
    sim_bus_node_state_t *node = &bus->nodes[number];
    if (sim_is_passive(node)) {
        node->suspend_until_us = bus->free_us + (uint64_t)SIM_BUS_SUSPEND_BITS * bus->bit_us;
        bus->suspended |= sim_bit(number);
    }
}

static void sent(sim_bus_t *bus, unsigned number) {
    sim_bus_node_state_t *node = &bus->nodes[number];
    sim_bus_remove(node, node->tx_current);
    node->current_aborted = false;
    if (node->tx_count == 0) {
        bus->ready &= ~sim_bit(number);
    }
    suspend_sender(bus, number);
    if (node->tec > 0) {
        node->tec--;
    }
}

static void complete_frame(sim_bus_t *bus, uint32_t senders, uint32_t hearing) {
    for (uint32_t set = senders; set != 0; set &= set - 1) {
        sent(bus, sim_lowest(set));
    }
    for (uint32_t set = hearing; set != 0; set &= set - 1) {
        sim_bus_node_state_t *node = &bus->nodes[sim_lowest(set)];
        if (node->rec > SIM_PASSIVE_ABOVE) {
            node->rec = SIM_PASSIVE_ABOVE;
        } else if (node->rec > 0) {
            node->rec--;
        }
        /* An earlier callback may have switched the node off. */
        if ((bus->listening & set & (0 - set)) != 0) {
            sim_bus_arrive(node, &bus->frame, bus->now_us);
        }
    }
}

static void fail_frame(sim_bus_t *bus, uint32_t senders, uint32_t hearing) {
    for (uint32_t set = senders; set != 0; set &= set - 1) {
        const unsigned number = sim_lowest(set);
        sim_bus_node_state_t *node = &bus->nodes[number];
        if (node->current_aborted) {
            sim_bus_remove(node, node->tx_current);
            node->current_aborted = false;
            sim_bus_refresh(bus, number);
        }
        /* ISO 11898-1: an error-passive node does not count a missing acknowledge. */
        if (bus->outcome == SIM_BUS_DESTROYED || !sim_is_passive(node)) {
            sim_bus_penalise(bus, number);
        }
        suspend_sender(bus, number);
    }
    for (uint32_t set = hearing; set != 0; set &= set - 1) {
        sim_bus_misread(&bus->nodes[sim_lowest(set)], 1);
    }
}

/* Count the errors of nodes that misread the frame or dropped out of a collision. */
static void count_errors_of_receivers(sim_bus_t *bus, uint32_t hearing) {
    for (uint32_t set = bus->misread; set != 0; set &= set - 1) {
        const unsigned number = sim_lowest(set);
        sim_bus_misread(&bus->nodes[number], (hearing & sim_bit(number)) != 0 ? 8 : 1);
    }
    for (uint32_t set = bus->dropped & bus->listening; set != 0; set &= set - 1) {
        sim_bus_penalise(bus, sim_lowest(set));
        suspend_sender(bus, sim_lowest(set));
    }
}

static void finish(sim_bus_t *bus) {
    const uint32_t senders = bus->sending;
    const uint32_t hearing = bus->hearing;
    bus->now_us = bus->end_us;
    bus->free_us = bus->end_us + (uint64_t)SIM_BUS_INTERFRAME_BITS * bus->bit_us;
    bus->frame.time_ms = (uint32_t)(bus->now_us / 1000);
    if (senders == 0) {
        bus->outcome = SIM_BUS_DESTROYED; /* its sender was switched off or unplugged */
    } else if (hearing == 0 && bus->outcome == SIM_BUS_ARRIVES) {
        bus->outcome = SIM_BUS_NOT_ACKNOWLEDGED; /* the last receiver was switched off or unplugged */
    }
    bus->busy = false;
    bus->sending = 0;
    bus->hearing = 0;
    bus->stats.busy_us += bus->free_us - bus->start_us;
    notify_taps(bus);
    if (bus->recovering != 0) {
        sim_bus_resume_recovery(bus);
    }
    if ((bus->misread | bus->dropped) != 0) {
        count_errors_of_receivers(bus, hearing);
    }
    if (bus->outcome == SIM_BUS_ARRIVES) {
        bus->stats.frames++;
        complete_frame(bus, senders, hearing);
    } else {
        bus->stats.errors++;
        fail_frame(bus, senders, hearing);
    }
}

/* Process the next event: a frame begins or ends, or an event of a node that is alone or recovering. */
static void step(sim_bus_t *bus) {
    const uint64_t due_us = bus->due_us;
    if (bus->busy) {
        if (bus->end_us == due_us) {
            finish(bus);
        }
    } else if (bus->ready != 0 && bus->start_us < due_us) {
        begin(bus);
    }
    if ((bus->alone | bus->recovering) != 0) {
        bus->now_us = due_us;
        sim_bus_run_aside(bus);
    }
    sim_bus_schedule(bus);
}

void sim_bus_process(sim_bus_t *bus, uint64_t until_us) {
    while (bus->due_us <= until_us) {
        step(bus);
    }
    if (until_us > bus->now_us) {
        bus->now_us = until_us;
    }
}

static uint64_t earliest_due_us(sim_bus_t *const buses[], size_t count) {
    uint64_t due_us = SIM_BUS_NEVER;
    for (size_t i = 0; i < count; i++) {
        due_us = buses[i]->due_us < due_us ? buses[i]->due_us : due_us;
    }
    return due_us;
}

/* Idle buses advance first: the start of a frame calls no callback, so no callback can send on a bus whose time is
 * behind. */
static void run_all_to(sim_bus_t *const buses[], size_t count, uint64_t time_us) {
    for (size_t i = 0; i < count; i++) {
        if (!buses[i]->busy) {
            sim_bus_run_until(buses[i], time_us);
        } else if (time_us > buses[i]->now_us) {
            buses[i]->now_us = time_us;
        }
    }
    for (size_t i = 0; i < count; i++) {
        sim_bus_run_until(buses[i], time_us);
    }
}

void sim_bus_run_all_until(sim_bus_t *const buses[], size_t count, uint64_t until_us) {
    uint64_t due_us = earliest_due_us(buses, count);
    while (due_us <= until_us) {
        run_all_to(buses, count, due_us);
        due_us = earliest_due_us(buses, count);
    }
    for (size_t i = 0; i < count; i++) {
        sim_bus_run_until(buses[i], until_us);
    }
}
