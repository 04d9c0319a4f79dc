/**
 * @file zephyr_hal.h
 * The Zephyr port: `struct hal` on Zephyr's drivers. There is one supervisor on a chip. All objects are in static
 * memory of the program.
 *
 * Contexts: only the supervisor's thread calls the functions of this header and of hal/include. Interrupts (or a
 * driver's thread, or can_stop()) call the callbacks in zephyr_can.c. These put frames into a message queue, record that a frame was
 * sent or that the controller's state changed, and wake the thread. The kernel's timer wakes it every millisecond.
 * zephyr_hal_die() may be called from any context, also from a fault handler.
 */
#ifndef HAL_ZEPHYR_ZEPHYR_HAL_H
#define HAL_ZEPHYR_ZEPHYR_HAL_H

#include <stdbool.h>
#include <stdint.h>

#include <zephyr/device.h>
#include <zephyr/drivers/can.h>
#include <zephyr/drivers/gpio.h>
#include <zephyr/fs/fcb.h>
#include <zephyr/kernel.h>
#include <zephyr/linker/devicetree_regions.h>

#include "hal/can.h"
#include "hal/clock.h"
#include "hal/hal.h"
#include "hal/inputs.h"
#include "hal/led.h"
#include "hal/reset.h"
#include "hal/safety_output.h"
#include "hal/self_test.h"
#include "hal/store.h"
#include "hal/watchdog.h"

/** The node of the wiring (dts/bindings/agv,supervisor.yaml). */
#define ZEPHYR_HAL_NODE DT_COMPAT_GET_ANY_STATUS_OKAY(agv_supervisor)

/**
 * Memory that a reset does not clear. It must be uncached, because a reset discards data that is still in a data cache; and no
 * bootloader may use it, because a bootloader runs first after each reset.
 */
#if DT_NODE_HAS_PROP(ZEPHYR_HAL_NODE, retained_memory)
#define ZEPHYR_HAL_RETAINED                                                                                            \
    __attribute__((section(LINKER_DT_NODE_REGION_NAME(DT_PHANDLE(ZEPHYR_HAL_NODE, retained_memory)))))
#elif DT_NODE_HAS_STATUS(DT_CHOSEN(zephyr_dtcm), okay)
#define ZEPHYR_HAL_RETAINED __dtcm_noinit_section
#else
#define ZEPHYR_HAL_RETAINED __noinit
BUILD_ASSERT(!IS_ENABLED(CONFIG_DCACHE), "retained memory must not be cached: choose zephyr,dtcm");
BUILD_ASSERT(!IS_ENABLED(CONFIG_BOOTLOADER_MCUBOOT), "the bootloader overwrites this memory: set retained-memory");
#endif

/**
 * Frames of one side that wait to be sent: four commands, seven forwarded status frames, the supervisor's status frame,
 * and some reserve.
 */
#define ZEPHYR_HAL_QUEUE_SIZE 16u

/** How a run ended: the reason, program counter and link register; addresses are 0 where they are not known. */
typedef struct {
    uint32_t reason; /**< hal_end_t */
    uint32_t pc;
    uint32_t lr;
} zephyr_hal_end_t;

/** Data that a reset does not clear; each part has its checksum. Only the port uses the members. */
typedef struct {
    uint32_t latch_size;
    uint8_t latch[HAL_STORE_LATCH_SIZE_MAX];
    uint32_t latch_checksum;
    zephyr_hal_end_t end; /**< how the port itself ended the run */
    uint32_t end_checksum;
} zephyr_hal_retained_t;

/** A frame that waits to be sent. */
typedef struct {
    hal_can_frame_t frame;
    uint32_t taken_ms; /**< when hal_can_send() took it */
    uint32_t since_ms; /**< from when its age counts: taken_ms of the first frame that it replaced, or its own */
} zephyr_hal_waiting_t;

/** One controller. Only the port uses the members. */
typedef struct {
    const struct device *device; /**< NULL: the side does not exist */
    struct k_sem *wake;
    struct k_msgq received;
    char received_buffer[CONFIG_AGV_CAN_RX_QUEUE * sizeof(hal_can_frame_t)];
    struct k_spinlock lock; /**< protects what the callbacks write: the next members up to `lost` */
    bool in_flight;         /**< the driver has a frame */
    bool has_left;          /**< the driver sent its last frame; false: it still has it, or discarded it */
    bool newest_is_odd;     /**< changes with each frame that is taken back from the driver */
    bool is_halted;         /**< it did not start again after a frame was taken back: reported as bus-off */
    bool callback_gave_state;
    hal_can_state_t state;
    uint16_t bus_offs;
    uint16_t lost; /**< frames lost because the queue was full */
    bool running;  /**< started without an error; otherwise it stays off the bus, and is reported as bus-off */
    bool listen_only;
    bool sent_is_purged;
    zephyr_hal_waiting_t sent;                           /**< the frame that the driver has */
    uint32_t sent_given_ms;                              /**< when the driver took it */
    uint32_t driver_lost;                                /**< frames lost by the driver */
    uint32_t driver_counted;                             /**< the driver's counter, when it was last read */
    zephyr_hal_waiting_t waiting[ZEPHYR_HAL_QUEUE_SIZE]; /**< lowest identifier first */
    uint32_t waiting_count;
} zephyr_hal_side_t;

/** The log in flash. */
typedef enum {
    ZEPHYR_HAL_LOG_NONE,    /**< the board has no log partition */
    ZEPHYR_HAL_LOG_READY,   /**< can be read and written */
    ZEPHYR_HAL_LOG_FAILED,  /**< the flash cannot be used; the next write tries again */
    ZEPHYR_HAL_LOG_FOREIGN, /**< the partition has content that is not of this log: nothing is read, written or erased */
    ZEPHYR_HAL_LOG_FORMATTING
} zephyr_hal_log_t;

/** A place in the log; {0} before the oldest record. Only the port uses the member. */
typedef struct {
    struct fcb_entry place;
} zephyr_hal_log_cursor_t;

/** Where the test of the program in flash is. Only the port uses the members. */
typedef struct {
    uint32_t range;
    uint32_t done; /**< bytes of this range */
    uint32_t crc;
    uint32_t slice; /**< bytes a millisecond */
    uint32_t rounds;
} zephyr_flash_test_t;

struct hal {
    uint32_t failed; /**< HAL_SELF_TEST_* bits of the parts that have failed */
    zephyr_hal_side_t sides[HAL_CAN_SIDES];
    struct k_sem wake;
    struct k_timer timer;
    hal_reset_cause_t reset_cause;
    zephyr_hal_end_t end_before; /**< of the run before; no reason if the port did not end it */
    zephyr_hal_retained_t *retained;
    int watchdog_channel;
    zephyr_flash_test_t flash_test;
    uint64_t second_counts; /**< of the second clock, since the start */
    uint32_t second_last;   /**< what it read last */
    zephyr_hal_log_t log;
    bool log_is_whole; /**< the log can be written without the repair of a sector */
};

/** Memory that is tested at the start. */
typedef struct {
    void *start;
    size_t size;  /**< in bytes; a rest that is no whole word is not tested */
    bool is_kept; /**< its content is needed; otherwise it is 0 afterwards */
} zephyr_hal_memory_t;

/** Settings of the port. */
typedef struct {
    uint32_t bitrate; /**< in bit/s */
    uint16_t sample_point_permille;
    uint32_t watchdog_ms;
    bool listen_only;                  /**< the controllers do not acknowledge and cannot send */
    zephyr_hal_retained_t *retained;   /**< in ZEPHYR_HAL_RETAINED */
    const zephyr_hal_memory_t *memory; /**< the supervisor's RAM, for the march test */
    size_t memory_count;
} zephyr_hal_config_t;

/**
 * Start the port: self-test of registers, RAM and flash, output open (as it is since boot), watchdog, reset cause, LED dark,
 * inputs, second clock, log, controllers on the bus, 1 ms tick. After the failure of a part the other parts are started all the
 * same, because the supervisor can then still trip.
 * @return true: all parts work. hal_self_test() tells the supervisor which ones do not
 */
bool zephyr_hal_init(hal_t *hal, const zephyr_hal_config_t *config);

/** Wait until a millisecond has passed, or a frame was received or sent. */
void zephyr_hal_wait(hal_t *hal);

/**
 * Take the next received frame of both sides, oldest first.
 * @return false: no frame
 */
bool zephyr_hal_receive(hal_t *hal, hal_can_side_t *side, hal_can_frame_t *frame);

/** Pass waiting frames to the drivers. Call it after each received frame and after each tick. */
void zephyr_hal_transmit(hal_t *hal);

/** Whether the safety output reads as open. For the self-test, before the output is first closed. */
bool zephyr_hal_output_is_open(void);

/**
 * Read the next record of the log, oldest first. Another thread than the supervisor's calls it with the scheduler locked.
 * @return size of the record, of which at most @p size bytes were copied; 0 = there is none
 */
size_t zephyr_hal_log_next(hal_t *hal, zephyr_hal_log_cursor_t *cursor, void *record, size_t size);

/**
 * Make an empty log of the partition, whatever its content is. Call it with step 0, 1, ... until it returns false. Each
 * call but the last erases one sector, which may stall the processor.
 */
bool zephyr_hal_log_format(hal_t *hal, uint32_t step);

/**
 * End the run: opens the safety output, stores the end over the reset, and resets the chip. May be called from any
 * context, and does not need a working kernel.
 */
FUNC_NORETURN void zephyr_hal_die(hal_end_t reason, uint32_t pc, uint32_t lr);

#endif
