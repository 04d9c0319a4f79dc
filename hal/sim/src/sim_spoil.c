/* Injected errors that destroy frames. */
#include "sim_internal.h"

void sim_bus_corrupt_all(sim_bus_t *bus, uint32_t count) {
    bus->corrupt_all = count;
}

void sim_bus_corrupt_sent(sim_bus_t *bus, sim_bus_node_t number, uint32_t count) {
    if (number < bus->node_count) {
        bus->nodes[number].corrupt_sent = count;
        bus->corrupting |= sim_bit(number);
    }
}

void sim_bus_corrupt_received(sim_bus_t *bus, sim_bus_node_t number, uint32_t count) {
    if (number < bus->node_count) {
        bus->nodes[number].corrupt_received = count;
        bus->misreading |= sim_bit(number);
    }
}

/* Use up one of the injected errors. @return false: none is left */
static bool use_one_error(uint32_t *count) {
    if (*count == 0) {
        return false;
    }
    if (*count != SIM_BUS_FOREVER) {
        (*count)--;
    }
    return true;
}

static bool spoiled_by_sender(sim_bus_t *bus) {
    bool spoiled = false;
    for (uint32_t set = bus->corrupting & bus->senders; set != 0; set &= set - 1) {
        const unsigned number = sim_lowest(set);
        if (use_one_error(&bus->nodes[number].corrupt_sent)) {
            spoiled = true;
        } else {
            bus->corrupting &= ~sim_bit(number);
        }
    }
    return spoiled;
}

/* An error-active receiver that misreads a frame destroys it for all nodes; an error-passive one only loses it. */
static bool spoiled_by_receiver(sim_bus_t *bus) {
    bool spoiled = false;
    for (uint32_t set = bus->misreading & bus->hearing; set != 0; set &= set - 1) {
        const unsigned number = sim_lowest(set);
        if (!use_one_error(&bus->nodes[number].corrupt_received)) {
            bus->misreading &= ~sim_bit(number);
            continue;
        }
        bus->misread |= sim_bit(number);
        if (sim_is_passive(&bus->nodes[number])) {
            bus->hearing &= ~sim_bit(number);
        } else {
            spoiled = true;
        }
    }
    return spoiled;
}

bool sim_bus_spoil(sim_bus_t *bus) {
    bool spoiled = use_one_error(&bus->corrupt_all);
    spoiled = spoiled_by_sender(bus) || spoiled;
    return spoiled_by_receiver(bus) || spoiled;
}
