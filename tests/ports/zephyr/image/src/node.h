/**
 * @file node.h
 * The supervisor's controller: a node on a bus made of Zephyr's loopback driver.
 */
#ifndef TEST_NODE_H
#define TEST_NODE_H

#include <stdbool.h>
#include <stdint.h>

#include <zephyr/device.h>

/** The bus. Its thread calls all listeners, also from within the functions below. */
extern const struct device *const test_wire;

/** Within a callback of the bus: whether the supervisor sent the frame. */
bool test_node_sent_it(void);

/** Other senders call this in the callback of their can_send(). */
void test_node_others_send(void);

/** Bus-off: reported by an interrupt. The node receives and accepts nothing until a recovery is requested. */
void test_node_goes_bus_off(void);

/** Number of recovery requests. */
uint32_t test_node_recoveries(void);

/** Another node floods the bus with this identifier, so that frames with a higher one stay in the controller; 0 ends it. */
void test_node_flood(uint32_t id);

/** The controller loses a received frame. */
void test_node_overrun(void);

#endif
