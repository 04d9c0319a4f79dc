/* Fault injection. */
#include "sim_internal.h"

void sim_bus_set_power(sim_bus_t *bus, sim_bus_node_t number, bool on) {
    if (number >= bus->node_count || bus->nodes[number].powered == on) {
        return;
    }
    sim_bus_node_state_t *node = &bus->nodes[number];
    node->powered = on;
    node->bus_off = false;
    bus->recovering &= ~sim_bit(number);
    bus->suspended &= ~sim_bit(number);
    sim_bus_refresh(bus, number);
    node->tx_count = 0;
    node->rx_count = 0;
    node->tec = 0;
    node->rec = 0;
    node->bus_off_count = 0;
    node->overrun_count = 0;
    sim_bus_schedule(bus);
}

void sim_bus_set_stalled(sim_bus_t *bus, sim_bus_node_t number, bool stalled) {
    if (number < bus->node_count) {
        bus->nodes[number].stalled = stalled;
        sim_bus_refresh(bus, number);
        sim_bus_schedule(bus);
    }
}

void sim_bus_set_full(sim_bus_t *bus, sim_bus_node_t number, bool full) {
    if (number < bus->node_count) {
        bus->nodes[number].full = full;
    }
}

void sim_bus_set_error_counters(sim_bus_t *bus, sim_bus_node_t number, uint16_t tec, uint16_t rec) {
    if (number >= bus->node_count || !bus->nodes[number].powered) {
        return;
    }
    bus->nodes[number].tec = tec;
    bus->nodes[number].rec = rec > SIM_REC_MAX ? (uint16_t)SIM_REC_MAX : rec;
    if (tec > SIM_TEC_MAX) {
        sim_bus_enter_bus_off(bus, number);
    }
    sim_bus_refresh(bus, number);
    sim_bus_schedule(bus);
}

void sim_bus_force_bus_off(sim_bus_t *bus, sim_bus_node_t number) {
    if (number < bus->node_count) {
        sim_bus_set_error_counters(bus, number, SIM_TEC_MAX + 1, bus->nodes[number].rec);
    }
}

void sim_bus_inject_overrun(sim_bus_t *bus, sim_bus_node_t number) {
    if (number < bus->node_count) {
        bus->nodes[number].overrun_count++;
    }
}

void sim_bus_deliver(sim_bus_t *bus, sim_bus_node_t number, const hal_can_frame_t *frame) {
    if (number >= bus->node_count || !bus->nodes[number].powered || bus->nodes[number].bus_off) {
        return;
    }
    hal_can_frame_t received = *frame;
    received.time_ms = (uint32_t)(bus->now_us / 1000);
    sim_bus_arrive(&bus->nodes[number], &received, bus->now_us);
}

void sim_bus_error_counters(const sim_bus_t *bus, sim_bus_node_t number, uint16_t *tec, uint16_t *rec) {
    const bool there = number < bus->node_count;
    if (tec != NULL) {
        *tec = there ? bus->nodes[number].tec : 0;
    }
    if (rec != NULL) {
        *rec = there ? bus->nodes[number].rec : 0;
    }
}
