/*
 * The supervisor as a program for a microcontroller, without an operating system: reset handler, port and main loop, around
 * the core as the preset cortex-m builds it. sweep.c runs it and disturbs its instructions.
 */
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include "agv/supervisor.h"
#include "board.h"
#include "hal/clock.h"
#include "hal/inputs.h"
#include "hal/led.h"
#include "hal/reset.h"
#include "hal/safety_output.h"
#include "hal/self_test.h"
#include "hal/store.h"
#include "hal/watchdog.h"

#define RETAINED __attribute__((section(".retained")))

struct hal {
    hal_reset_cause_t reset_cause;
};

/* RAM that a reset does not clear. */
RETAINED image_latch_t image_latch;
RETAINED agv_recorder_t image_recorder;
static agv_supervisor_t supervisor;
static struct hal hal;

static volatile uint32_t *register_at(uint32_t offset) {
    return (volatile uint32_t *)((uintptr_t)BOARD_REGISTERS + offset);
}

static uint32_t word_of(const uint8_t *bytes) {
    uint32_t word;
    (void)memcpy(&word, bytes, sizeof word);
    return word;
}

/* ---- The port ---- */

static bool receive(hal_can_side_t *side, hal_can_frame_t *frame) {
    if (*register_at(BOARD_RX_WAITING) == 0u) {
        return false;
    }
    const uint32_t low = *register_at(BOARD_RX_LOW);
    const uint32_t high = *register_at(BOARD_RX_HIGH);
    *frame = (hal_can_frame_t){
        .id = *register_at(BOARD_RX_ID), .time_ms = *register_at(BOARD_NOW_MS), .length = sizeof frame->data};
    *side = (hal_can_side_t)*register_at(BOARD_RX_SIDE);
    (void)memcpy(&frame->data[0], &low, sizeof low);
    (void)memcpy(&frame->data[4], &high, sizeof high);
    *register_at(BOARD_RX_TAKEN) = 1u;
    return true;
}

bool hal_can_send(hal_t *self, hal_can_side_t side, const hal_can_frame_t *frame) {
    (void)self;
    *register_at(BOARD_TX_SIDE) = side;
    *register_at(BOARD_TX_ID) = frame->id;
    *register_at(BOARD_TX_LENGTH) = frame->length;
    *register_at(BOARD_TX_LOW) = word_of(&frame->data[0]);
    *register_at(BOARD_TX_HIGH) = word_of(&frame->data[4]);
    *register_at(BOARD_TX_SEND) = 1u;
    return true;
}

void hal_can_purge(hal_t *self, hal_can_side_t side) {
    (void)self;
    (void)side; /* nothing ever waits */
}

void hal_can_recover(hal_t *self, hal_can_side_t side) {
    (void)self;
    (void)side;
}

void hal_can_status(hal_t *self, hal_can_side_t side, hal_can_status_t *status) {
    (void)self;
    (void)side;
    *status = (hal_can_status_t){.state = HAL_CAN_ERROR_ACTIVE};
}

bool hal_clock_second_ms(hal_t *self, uint32_t *time_ms) {
    (void)self;
    *time_ms = 0u;
    return false;
}

void hal_inputs_read(hal_t *self, hal_inputs_t *inputs) {
    (void)self;
    *inputs = (hal_inputs_t){.output_feedback = HAL_CONTACT_NONE};
}

void hal_led_set(hal_t *self, bool on) {
    (void)self;
    *register_at(BOARD_LED) = on ? 1u : 0u;
}

hal_reset_cause_t hal_reset_cause(hal_t *self) {
    return self->reset_cause;
}

void hal_safety_output_set(hal_t *self, bool closed) {
    (void)self;
    *register_at(BOARD_OUTPUT) = closed ? 1u : 0u;
}

uint32_t hal_self_test(hal_t *self) {
    (void)self;
    return 0u;
}

void hal_watchdog_feed(hal_t *self) {
    (void)self;
    *register_at(BOARD_FEED) = 1u;
}

size_t hal_store_read_latch(hal_t *self, void *record, size_t size) {
    (void)self;
    const size_t stored = image_latch.size;
    if (stored > sizeof image_latch.bytes) {
        return 0u;
    }
    (void)memcpy(record, image_latch.bytes, (stored < size) ? stored : size);
    return stored;
}

bool hal_store_write_latch(hal_t *self, const void *record, size_t size) {
    (void)self;
    if (size > sizeof image_latch.bytes) {
        return false;
    }
    (void)memcpy(image_latch.bytes, record, size);
    image_latch.size = (uint32_t)size;
    return true;
}

bool hal_store_append(hal_t *self, const void *record, size_t size) {
    (void)self;
    (void)record;
    (void)size;
    return true;
}

/* ---- The program ---- */

/* The end of a millisecond: sweep.c takes over until the next one. */
static void sleep_until_next(void) {
    __asm__ volatile("svc 0" ::: "memory");
}

static void supervise_once(const agv_ports_t *ports) {
    hal_can_side_t side;
    hal_can_frame_t frame;
    const uint32_t now_ms = *register_at(BOARD_NOW_MS);
    while (receive(&side, &frame)) {
        agv_supervisor_frame(&supervisor, ports, side, &frame);
    }
    agv_supervisor_receive_alive(&supervisor);
    agv_supervisor_tick(&supervisor, ports, now_ms);
}

int main(void) {
    const agv_ports_t ports = {.hal = &hal, .recorder = &image_recorder, .version = NULL};
    agv_config_t config;
    hal.reset_cause = (hal_reset_cause_t)*register_at(BOARD_CAUSE);
    agv_config_defaults(&config);
    config.topology = IMAGE_TOPOLOGY;
    agv_supervisor_start(&supervisor, &ports, &config, *register_at(BOARD_NOW_MS));
    for (;;) {
        sleep_until_next();
        supervise_once(&ports);
    }
}

/* ---- From the reset to main ---- */

extern uint32_t image_bss[];
extern uint32_t image_bss_end[];
extern uint32_t image_stack_top[];

static void reset(void) {
    for (uint32_t *word = image_bss; word < image_bss_end; word++) {
        *word = 0u;
    }
    (void)main();
}

/*
 * What sweep reads at the start of the flash. It plays the exceptions itself: any of them opens the output and resets, as in
 * a port (FSM-4).
 */
__attribute__((section(".vectors"))) const image_start_t image_start = {.stack = (uintptr_t)image_stack_top,
                                                                        .reset = (uintptr_t)reset,
                                                                        .latch = (uintptr_t)&image_latch,
                                                                        .log = (uintptr_t)&image_recorder.trips,
                                                                        .log_end = (uintptr_t)(&image_recorder + 1),
                                                                        .architecture = __ARM_ARCH,
                                                                        .topology = IMAGE_TOPOLOGY};
