/**
 * @file fake_parts.h
 * A simulated chip for the tests: controllers on can_fake, watchdog, reset flags, pins.
 */
#ifndef FAKE_PARTS_H
#define FAKE_PARTS_H

#include <stdbool.h>
#include <stdint.h>

#include <zephyr/drivers/can.h>

#include "hal/can.h"

enum { FAKE_FILTERS_MAX = 4, FAKE_SENT_MAX = 256 };

/** One controller: the calls of the port, and the results of the next calls. */
typedef struct {
    const struct device *device;
    bool started;
    uint32_t stops;       /**< can_stop() calls */
    int stop_error;       /**< result of the next stops; 0: it stops */
    int start_error;      /**< result of the next starts; 0: it starts */
    bool is_late;         /**< a stop does not report the frame that it discards */
    bool bus_off_at_stop; /**< the controller enters bus-off just before it is stopped */
    bool sends_at_stop;   /**< the frame leaves just before the stop */
    can_mode_t able;      /**< its reported capabilities */
    can_mode_t mode;
    struct can_timing timing;
    uint32_t filter_limit;
    uint32_t filters;
    struct can_filter filter[FAKE_FILTERS_MAX];
    can_rx_callback_t receive[FAKE_FILTERS_MAX];
    void *receive_data[FAKE_FILTERS_MAX];
    int send_error;      /**< result of the next sends; 0: accepted */
    bool sends_at_once;  /**< an accepted frame is on the bus at once */
    uint32_t in_mailbox; /**< accepted frames that are not sent yet */
    can_tx_callback_t sent_callback;
    void *sent_data;
    struct can_frame sent[FAKE_SENT_MAX]; /**< accepted frames, in order */
    uint32_t sent_count;
    enum can_state state;
    can_state_change_callback_t state_callback;
    void *state_data;
    uint32_t recoveries;
} fake_bus_t;

extern fake_bus_t fake_buses[HAL_CAN_SIDES];

/** Set everything as after a power-on; call it in every test's "before". */
void fake_parts_reset(void);

/** can_fake loses its callbacks before each test; a suite that keeps a port over several tests sets them again. */
void fake_parts_connect(void);

/** A frame arrives, in an interrupt. */
void fake_bus_frame(hal_can_side_t side, const struct can_frame *frame);

/** The frame in the mailbox was sent or discarded. */
void fake_bus_complete(hal_can_side_t side, int error);

/** The controller changes its state. @param with_interrupt true: it reports this by an interrupt */
void fake_bus_state(hal_can_side_t side, enum can_state state, bool with_interrupt);

/** Feeds so far, its longest period (ms), and whether it was started. */
extern uint32_t fake_watchdog_feeds;
extern uint32_t fake_watchdog_ms;
extern bool fake_watchdog_started;

/** The window watchdog: it counts feeds, and those that were too early or too late. */
typedef struct {
    uint32_t opens_ms;
    uint32_t expires_ms;
    uint32_t fed_ms; /**< time of the last feed, or of the start */
    uint32_t feeds;
    uint32_t outside;
} fake_window_watchdog_t;

extern fake_window_watchdog_t fake_window_watchdog;

/** Reset flags of hwinfo, until they are cleared; number of reads and of clears. */
extern uint32_t fake_reset_flags;
extern int fake_reset_error;
/** The flags that the chip has, as its driver says; 0: the driver does not say. */
extern uint32_t fake_reset_supported;
extern uint32_t fake_reset_reads;
extern uint32_t fake_reset_clears;

/** State of the pins. */
bool fake_output_is_closed(void);
bool fake_led_is_on(void);

/** The counter of the second clock: it counts fake_counter_hz in a second, up to fake_counter_top, then from 0. */
extern uint32_t fake_counter_value;
extern uint32_t fake_counter_hz;
extern uint32_t fake_counter_top;
extern int fake_counter_error;
void fake_counter_direction(bool up);

/** An input of the supervisor, and its level. */
typedef enum { FAKE_FEEDBACK = 2, FAKE_STOP = 3, FAKE_BUTTON = 4 } fake_input_t;
void fake_input_set(fake_input_t input, bool high);

#endif
