/**
 * @file node.h
 * The supervisor's controller: a node on a wire that is Zephyr's loopback driver.
 */
#ifndef TEST_NODE_H
#define TEST_NODE_H

#include <stdbool.h>
#include <stdint.h>

#include <zephyr/device.h>

/** The wire. Its thread calls whoever listens, also from within the functions below. */
extern const struct device *const test_wire;

/** Within a callback of the wire: whether the frame is one of the supervisor's. */
bool test_node_sent_it(void);

/** Said by who sends another frame, in the callback of its can_send(). */
void test_node_others_send(void);

/** Bus-off: it says so in an interrupt, hears nothing and takes nothing until it is asked to recover. */
void test_node_goes_bus_off(void);

/** How often it was asked to recover. */
uint32_t test_node_recoveries(void);

#endif
