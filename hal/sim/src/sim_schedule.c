/* The time of a bus's next event. */
#include "sim_internal.h"

uint64_t sim_bus_recovered_us(const sim_bus_t *bus, const sim_bus_node_state_t *node) {
    if (node->recovery_from_us == SIM_BUS_NEVER) {
        return SIM_BUS_NEVER;
    }
    return node->recovery_from_us + node->recovery_left * sim_bus_sequence_us(bus);
}

/* Earliest time at which the bus is idle and a ready node may start. At least one node is ready. */
static uint64_t next_start_us(const sim_bus_t *bus) {
    const uint64_t idle_us = bus->free_us > bus->now_us ? bus->free_us : bus->now_us;
    if ((bus->ready & ~bus->suspended) != 0) {
        return idle_us;
    }
    uint64_t start_us = SIM_BUS_NEVER;
    for (uint32_t set = bus->ready; set != 0; set &= set - 1) {
        const uint64_t until_us = bus->nodes[sim_lowest(set)].suspend_until_us;
        start_us = until_us < start_us ? until_us : start_us;
    }
    return start_us > idle_us ? start_us : idle_us;
}

/* Time of the next event of the nodes that are alone or recovering. */
static uint64_t aside_due_us(const sim_bus_t *bus) {
    uint64_t due_us = SIM_BUS_NEVER;
    for (uint32_t set = bus->alone; set != 0; set &= set - 1) {
        const uint64_t alone_us = bus->nodes[sim_lowest(set)].alone_us;
        due_us = alone_us < due_us ? alone_us : due_us;
    }
    for (uint32_t set = bus->recovering; set != 0; set &= set - 1) {
        const uint64_t end_us = sim_bus_recovered_us(bus, &bus->nodes[sim_lowest(set)]);
        due_us = end_us < due_us ? end_us : due_us;
    }
    return due_us;
}

void sim_bus_schedule(sim_bus_t *bus) {
    uint64_t due_us = SIM_BUS_NEVER;
    if (bus->busy) {
        due_us = bus->end_us;
    } else if (bus->ready != 0) {
        bus->start_us = next_start_us(bus);
        due_us = bus->start_us + 1; /* 1 us later, so that all frames sent at start_us take part in the arbitration */
    }
    if ((bus->alone | bus->recovering) != 0) {
        const uint64_t aside_us = aside_due_us(bus);
        due_us = aside_us < due_us ? aside_us : due_us;
    }
    bus->due_us = due_us;
}
