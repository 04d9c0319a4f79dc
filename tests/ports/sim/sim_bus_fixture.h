/* Common parts of the bus tests: a bus with four nodes that have queues, and a log of its frames. */
#ifndef SIM_BUS_FIXTURE_H
#define SIM_BUS_FIXTURE_H

#include "hal_sim/sim_bus.h"

#define FIXTURE_NODES 4u
#define FIXTURE_EVENTS 256u

/* Names of the nodes. */
#define A ((sim_bus_node_t)0)
#define B ((sim_bus_node_t)1)
#define C ((sim_bus_node_t)2)
#define D ((sim_bus_node_t)3)

typedef struct {
    uint32_t id;
    uint8_t flags;
    uint8_t length;
    uint8_t first;
    uint32_t time_ms;
    uint64_t start_us;
    uint64_t end_us;
    uint32_t senders;
    sim_bus_node_t sender;
    bool error;
} fixture_event_t;

typedef struct {
    sim_bus_t bus;
    fixture_event_t events[FIXTURE_EVENTS];
    unsigned event_count;
} fixture_t;

static inline void fixture_record(void *ctx, const sim_bus_event_t *event) {
    fixture_t *fixture = ctx;
    if (fixture->event_count < FIXTURE_EVENTS) {
        fixture->events[fixture->event_count] = (fixture_event_t){
            event->frame->id, event->frame->flags, event->frame->length, event->frame->data[0], event->frame->time_ms,
            event->start_us,  event->end_us,       event->senders,       event->sender,         event->error,
        };
    }
    fixture->event_count++;
}

static inline void fixture_init(fixture_t *fixture, uint32_t bitrate) {
    const sim_bus_node_config_t config = {.rx_slots = 8};
    fixture->event_count = 0;
    (void)sim_bus_init(&fixture->bus, bitrate);
    for (unsigned i = 0; i < FIXTURE_NODES; i++) {
        (void)sim_bus_attach(&fixture->bus, &config);
    }
    (void)sim_bus_add_tap(&fixture->bus, fixture_record, fixture);
}

static inline hal_can_frame_t frame_of(uint32_t id, uint8_t length, uint8_t first) {
    return (hal_can_frame_t){.id = id, .length = length, .data = {first}};
}

static inline bool send(fixture_t *fixture, sim_bus_node_t node, uint32_t id, uint8_t length, uint8_t first) {
    const hal_can_frame_t frame = frame_of(id, length, first);
    return sim_bus_send(&fixture->bus, node, &frame);
}

static inline hal_can_status_t status_of(const fixture_t *fixture, sim_bus_node_t node) {
    hal_can_status_t status;
    sim_bus_status(&fixture->bus, node, &status);
    return status;
}

static inline unsigned tec_of(const fixture_t *fixture, sim_bus_node_t node) {
    uint16_t tec;
    sim_bus_error_counters(&fixture->bus, node, &tec, NULL);
    return tec;
}

static inline unsigned rec_of(const fixture_t *fixture, sim_bus_node_t node) {
    uint16_t rec;
    sim_bus_error_counters(&fixture->bus, node, NULL, &rec);
    return rec;
}

static inline unsigned received_by(fixture_t *fixture, sim_bus_node_t node) {
    hal_can_frame_t frame;
    unsigned count = 0;
    while (sim_bus_receive(&fixture->bus, node, &frame, NULL)) {
        count++;
    }
    return count;
}

#endif
