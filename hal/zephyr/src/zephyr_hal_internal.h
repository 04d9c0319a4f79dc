/**
 * @file zephyr_hal_internal.h
 * Declarations that the source files of the port share.
 */
#ifndef HAL_ZEPHYR_ZEPHYR_HAL_INTERNAL_H
#define HAL_ZEPHYR_ZEPHYR_HAL_INTERNAL_H

#include "hal_zephyr/zephyr_chip.h"
#include "hal_zephyr/zephyr_hal.h"

/** The side, or NULL when it does not exist. */
zephyr_hal_side_t *zephyr_hal_side(hal_t *hal, hal_can_side_t side);

/** Start a controller on the bus. @return true: it works as the contract requires */
bool zephyr_can_start(zephyr_hal_side_t *side, const zephyr_hal_config_t *config);

/**
 * Put a frame in the queue, behind all frames of higher or equal priority. It takes the place, and the age, of an older frame
 * with the same identifier. @return false: no room
 */
bool zephyr_queue_put(zephyr_hal_side_t *side, const hal_can_frame_t *frame, uint32_t now_ms);

/** Put a frame back that the driver had. A newer one with its identifier stays instead, and takes over its age. */
void zephyr_queue_put_back(zephyr_hal_side_t *side, const zephyr_hal_waiting_t *taken_back);

/** Remove the first frame of the queue, which must not be empty. */
void zephyr_queue_drop_first(zephyr_hal_side_t *side);

/** As hal_can_status_t.tx_pending_ms. @param in_flight the driver has a frame */
uint32_t zephyr_queue_pending_ms(const zephyr_hal_side_t *side, bool in_flight, uint32_t now_ms);

/** Start task watchdog and hardware watchdog. @return false: one does not exist or does not start */
bool zephyr_watchdog_start(hal_t *hal, uint32_t period_ms);

/** Set up the inputs that the board has. @return false: one cannot be set up */
bool zephyr_inputs_start(void);

/** Start the second clock. @return false: the board has one that cannot be used */
bool zephyr_second_clock_start(hal_t *hal);

/** Most ranges of the program in flash, and the mark of a table that was filled. */
enum { ZEPHYR_IMAGE_RANGES = 16, ZEPHYR_IMAGE_SUM_MAGIC = 0x53564741 };

/** The program in flash, as scripts/tools/zephyr-checksum.py found it after linking. */
typedef struct {
    uint32_t magic;
    uint32_t count;
    uint32_t crc; /**< CRC-32 (IEEE) over all ranges in this order */
    struct {
        uint32_t start;
        uint32_t size;
    } ranges[ZEPHYR_IMAGE_RANGES];
} zephyr_image_sum_t;

/** Test registers, and the memory of the configuration. @return HAL_SELF_TEST_* bits of what failed */
uint32_t zephyr_self_test_start(const zephyr_hal_config_t *config);

/** Test the whole program in flash once, and begin the background test. @return HAL_SELF_TEST_FLASH, or 0 */
uint32_t zephyr_flash_test_start(hal_t *hal);

/** March test of memory that is not used yet; it is 0 afterwards. @return true: passed */
bool zephyr_march(volatile uint32_t *words, size_t count);

/** March test of memory that keeps its content. Interrupts are locked for 16 words at a time. */
bool zephyr_march_kept(volatile uint32_t *words, size_t count);

/** Set up the LED, dark. */
bool zephyr_led_start(void);

/** Open the output from any context, at the end of a run. */
void zephyr_output_open_now(void);

/** Read the cause of the reset and how the run before ended, and clear both. */
hal_reset_cause_t zephyr_reset_read(zephyr_hal_retained_t *retained, zephyr_hal_end_t *end);

/** Store how this run ends, before the reset that follows. */
void zephyr_reset_note(const zephyr_hal_end_t *end);

/** Whether the log in flash is being read: then an ECC error of the flash is a torn record. */
extern volatile bool zephyr_log_is_read;

/** Whether the program in flash is being tested: then an ECC error of the flash makes its checksum wrong. */
extern volatile bool zephyr_flash_is_tested;

/** Whether memory that outlives a reset is being tested: after a power-on it has never been written. */
extern volatile bool zephyr_ram_is_new;

/** Open the log in flash. @return false: the flash cannot be used (true without a log partition) */
bool zephyr_log_start(hal_t *hal);

#endif
