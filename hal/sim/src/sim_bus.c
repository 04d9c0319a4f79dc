/* Building a bus, and the driver of a node. */
#include <string.h>

#include "sim_internal.h"

#define TX_SLOTS_DEFAULT 8u

bool sim_bus_init(sim_bus_t *bus, uint32_t bitrate) {
    memset(bus, 0, sizeof *bus);
    bus->due_us = SIM_BUS_NEVER;
    if (bitrate != 125000 && bitrate != 250000 && bitrate != 500000 && bitrate != 1000000) {
        return false;
    }
    bus->bit_us = 1000000 / bitrate;
    return true;
}

sim_bus_node_t sim_bus_attach(sim_bus_t *bus, const sim_bus_node_config_t *config) {
    if (bus->node_count == SIM_BUS_NODES_MAX) {
        return SIM_BUS_NO_NODE;
    }
    sim_bus_node_state_t *node = &bus->nodes[bus->node_count];
    memset(node, 0, sizeof *node);
    if (config != NULL) {
        node->config = *config;
    }
    if (node->config.tx_slots == 0) {
        node->config.tx_slots = TX_SLOTS_DEFAULT;
    }
    if (node->config.tx_slots > SIM_BUS_TX_SLOTS_MAX || node->config.rx_slots > SIM_BUS_RX_SLOTS_MAX) {
        return SIM_BUS_NO_NODE;
    }
    node->powered = true;
    node->plugged = true;
    sim_bus_refresh(bus, bus->node_count);
    return bus->node_count++;
}

bool sim_bus_add_tap(sim_bus_t *bus, sim_bus_tap_fn *fn, void *ctx) {
    if (bus->tap_count == SIM_BUS_TAPS_MAX) {
        return false;
    }
    bus->taps[bus->tap_count++] = (sim_bus_tap_t){fn, ctx};
    return true;
}

bool sim_bus_send(sim_bus_t *bus, sim_bus_node_t number, const hal_can_frame_t *frame) {
    if (number >= bus->node_count || !sim_frame_is_classic(frame)) {
        return false;
    }
    sim_bus_node_state_t *node = &bus->nodes[number];
    if (!node->powered || node->bus_off || node->full || node->tx_count == node->config.tx_slots) {
        return false;
    }
    sim_bus_slot_t *slot = &node->tx[node->tx_count];
    slot->frame = *frame;
    slot->time_us = bus->now_us;
    for (unsigned i = (frame->flags & HAL_CAN_REMOTE) != 0 ? 0 : frame->length; i < sizeof slot->frame.data; i++) {
        slot->frame.data[i] = 0;
    }
    node->tx_key[node->tx_count] = sim_frame_key(frame);
    if (node->tx_count++ == 0) {
        sim_bus_refresh(bus, number);
        sim_bus_schedule(bus);
    }
    return true;
}

void sim_bus_purge(sim_bus_t *bus, sim_bus_node_t number) {
    if (number >= bus->node_count) {
        return;
    }
    sim_bus_node_state_t *node = &bus->nodes[number];
    const bool is_sending = (bus->sending & sim_bit(number)) != 0;
    bus->stats.purged += node->tx_count - (is_sending ? 1u : 0u);
    if (is_sending) {
        node->tx_current = 0; /* keep one slot for the frame that is being sent; it is not sent again */
        node->tx_count = 1;
        node->current_aborted = true;
    } else {
        node->tx_count = 0;
    }
    sim_bus_refresh(bus, number);
    sim_bus_schedule(bus);
}

void sim_bus_status(const sim_bus_t *bus, sim_bus_node_t number, hal_can_status_t *status) {
    *status = (hal_can_status_t){.state = HAL_CAN_ERROR_ACTIVE};
    if (number >= bus->node_count) {
        return;
    }
    const sim_bus_node_state_t *node = &bus->nodes[number];
    const unsigned oldest = node->current_aborted ? 1 : 0;
    if (node->bus_off) {
        status->state = HAL_CAN_BUS_OFF;
    } else if (sim_is_passive(node)) {
        status->state = HAL_CAN_ERROR_PASSIVE;
    }
    if (node->tx_count > oldest) {
        const uint64_t age_ms = (bus->now_us - node->tx[oldest].time_us) / 1000;
        status->tx_pending_ms = age_ms == 0 ? 1 : age_ms > UINT32_MAX ? UINT32_MAX : (uint32_t)age_ms;
    }
    status->bus_off_count = node->bus_off_count;
    status->overrun_count = node->overrun_count;
}

bool sim_bus_receive(sim_bus_t *bus, sim_bus_node_t number, hal_can_frame_t *frame, uint64_t *time_us) {
    if (number >= bus->node_count || bus->nodes[number].rx_count == 0) {
        return false;
    }
    sim_bus_node_state_t *node = &bus->nodes[number];
    const sim_bus_slot_t *slot = &node->rx[node->rx_head];
    *frame = slot->frame;
    if (time_us != NULL) {
        *time_us = slot->time_us;
    }
    node->rx_head++;
    if (node->rx_head == node->config.rx_slots) {
        node->rx_head = 0;
    }
    node->rx_count--;
    return true;
}

size_t sim_bus_waiting(const sim_bus_t *bus, sim_bus_node_t number) {
    return number < bus->node_count ? bus->nodes[number].tx_count : 0;
}

void sim_bus_stats(const sim_bus_t *bus, sim_bus_stats_t *stats) {
    *stats = bus->stats;
}
