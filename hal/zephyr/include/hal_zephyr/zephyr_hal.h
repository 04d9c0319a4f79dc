/**
 * @file zephyr_hal.h
 * The Zephyr port: `struct hal` on Zephyr's drivers. One supervisor a chip. All objects are static memory of the program.
 *
 * Who touches what: one thread, the supervisor's, calls every function of this header and of hal/include. Interrupts (or
 * a driver's own thread) call the callbacks in zephyr_can.c, which put frames into a message queue, note that a frame has
 * left or that the controller's state has changed, and wake the thread. The kernel's timer wakes it every millisecond.
 * zephyr_hal_die() may be called from anywhere, also in a fault.
 */
#ifndef HAL_ZEPHYR_ZEPHYR_HAL_H
#define HAL_ZEPHYR_ZEPHYR_HAL_H

#include <stdbool.h>
#include <stdint.h>

#include <zephyr/device.h>
#include <zephyr/drivers/can.h>
#include <zephyr/drivers/gpio.h>
#include <zephyr/kernel.h>

#include "hal/can.h"
#include "hal/clock.h"
#include "hal/hal.h"
#include "hal/led.h"
#include "hal/reset.h"
#include "hal/safety_output.h"
#include "hal/store.h"
#include "hal/watchdog.h"

/** Memory that a reset does not clear. Uncached where there is a data cache, which a reset would empty unwritten. */
#if DT_NODE_HAS_STATUS(DT_CHOSEN(zephyr_dtcm), okay)
#define ZEPHYR_HAL_RETAINED __dtcm_noinit_section
#else
#define ZEPHYR_HAL_RETAINED __noinit
BUILD_ASSERT(!IS_ENABLED(CONFIG_DCACHE), "retained memory would lie behind the data cache: choose zephyr,dtcm");
#endif

/** Frames that wait to be sent: four commands, seven status frames that pass, the status frame, and room. */
#define ZEPHYR_HAL_QUEUE_SIZE 16u

/** What is kept through a reset, each part with its checksum. Contents are the port's. */
typedef struct {
    uint32_t latch_size;
    uint8_t latch[HAL_STORE_LATCH_SIZE_MAX];
    uint32_t latch_checksum;
    uint32_t note; /**< why the port itself made the reset: a hal_reset_cause_t */
    uint32_t note_checksum;
} zephyr_hal_retained_t;

/** A frame that waits to be sent. */
typedef struct {
    hal_can_frame_t frame;
    uint32_t taken_ms;
} zephyr_hal_waiting_t;

/** One controller. Contents are the port's. */
typedef struct {
    const struct device *device; /**< NULL: there is no such side */
    struct k_sem *wake;
    struct k_msgq received;
    char received_buffer[CONFIG_AGV_CAN_RX_QUEUE * sizeof(hal_can_frame_t)];
    struct k_spinlock lock; /**< for what follows up to `lost`, which callbacks write */
    bool in_flight;         /**< the driver has a frame */
    bool callback_gave_state;
    hal_can_state_t state;
    uint16_t bus_offs;
    uint16_t lost; /**< frames that found the queue full */
    bool running;  /**< started without an error */
    bool sent_is_purged;
    uint32_t sent_taken_ms;
    zephyr_hal_waiting_t waiting[ZEPHYR_HAL_QUEUE_SIZE]; /**< lowest identifier first */
    uint32_t waiting_count;
} zephyr_hal_side_t;

struct hal {
    zephyr_hal_side_t sides[HAL_CAN_SIDES];
    struct k_sem wake;
    struct k_timer timer;
    hal_reset_cause_t reset_cause;
    zephyr_hal_retained_t *retained;
    int watchdog_channel;
    bool log_ready;    /**< it can be read */
    bool log_is_whole; /**< and written: no sector has to be repaired first */
};

/** What the program says of its wiring. */
typedef struct {
    uint32_t bitrate;
    uint16_t sample_point_permille;
    uint32_t watchdog_ms;
    bool listen_only;                /**< the controllers acknowledge nothing, and can send nothing */
    zephyr_hal_retained_t *retained; /**< in ZEPHYR_HAL_RETAINED */
} zephyr_hal_config_t;

/**
 * Begin: output open (it is since boot), watchdog, reset cause, LED dark, store, controllers on the bus, 1 ms tick.
 * What fails does not keep the rest from beginning: a supervisor that sees less is still one that can trip.
 * @return whether all of it works; hand it on as the program's self test
 */
bool zephyr_hal_init(hal_t *hal, const zephyr_hal_config_t *config);

/** Wait until a millisecond has passed, or a frame came or left. */
void zephyr_hal_wait(hal_t *hal);

/**
 * Take the next received frame of both sides, oldest first.
 * @return false: nothing there
 */
bool zephyr_hal_receive(hal_t *hal, hal_can_side_t *side, hal_can_frame_t *frame);

/** Give the drivers what waits to be sent. Call it after each wait. */
void zephyr_hal_transmit(hal_t *hal);

/** Whether the safety output reads as open: for the self test, before anything closed it. */
bool zephyr_hal_output_is_open(void);

/**
 * The end of this run: opens the safety output, keeps the cause over the reset, resets the chip. From any context, with
 * whatever works no more.
 */
FUNC_NORETURN void zephyr_hal_die(hal_reset_cause_t cause);

#endif
