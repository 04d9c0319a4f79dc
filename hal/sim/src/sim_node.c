/* A node: its mailboxes, its receive queue, its receive error counter. */
#include "sim_internal.h"

void sim_bus_remove(sim_bus_node_state_t *node, unsigned slot) {
    node->tx_count--;
    for (unsigned i = slot; i < node->tx_count; i++) {
        node->tx[i] = node->tx[i + 1];
        node->tx_key[i] = node->tx_key[i + 1];
    }
}

void sim_bus_arrive(sim_bus_node_state_t *node, const hal_can_frame_t *frame, uint64_t time_us) {
    if (node->config.rx_slots != 0) {
        if (node->rx_count == node->config.rx_slots) {
            node->overrun_count++;
            return;
        }
        unsigned tail = (unsigned)node->rx_head + node->rx_count;
        if (tail >= node->config.rx_slots) {
            tail -= node->config.rx_slots;
        }
        node->rx[tail] = (sim_bus_slot_t){*frame, time_us};
        node->rx_count++;
    }
    if (node->config.on_receive != NULL) {
        node->config.on_receive(node->config.ctx, frame);
    }
}

void sim_bus_misread(sim_bus_node_state_t *node, unsigned amount) {
    const unsigned rec = node->rec + amount;
    node->rec = (uint16_t)(rec > SIM_REC_MAX ? SIM_REC_MAX : rec);
}
