/**
 * @file sim_hal.h
 * The simulated port: `struct hal` for one supervisor, which implements hal/include.
 *
 * It has two modes:
 * - On a bus: sim_hal_init(), then sim_hal_attach() for each side. The time is that of the bus; the program takes received
 *   frames with sim_hal_receive().
 * - Direct: sim_hal_init_direct(). Sent frames are passed to a callback within the call; the program sets the clock and
 *   the state of the controllers, and passes received frames to the supervisor itself. For replay, exploration and
 *   fuzzing.
 *
 * The program owns the struct. Copy it by assignment to take a snapshot (it points to bus and store). Members marked
 * "read" may be read at any time; change them through functions only.
 */
#ifndef HAL_SIM_SIM_HAL_H
#define HAL_SIM_SIM_HAL_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

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
#include "hal_forward/hal_ops.h"
#include "hal_sim/sim_board.h"
#include "hal_sim/sim_bus.h"
#include "hal_sim/sim_store.h"

#define SIM_HAL_WATCHDOG_DEFAULT_MS 100u
#define SIM_HAL_WATCHDOG_OFF UINT32_MAX

/** The operations of hal/include, one each. */
typedef enum {
    SIM_HAL_OP_CAN_SEND,
    SIM_HAL_OP_CAN_PURGE,
    SIM_HAL_OP_CAN_RECOVER,
    SIM_HAL_OP_CAN_STATUS,
    SIM_HAL_OP_CLOCK_NOW,
    SIM_HAL_OP_LED_SET,
    SIM_HAL_OP_RESET_CAUSE,
    SIM_HAL_OP_SAFETY_OUTPUT_SET,
    SIM_HAL_OP_STORE_READ_LATCH,
    SIM_HAL_OP_STORE_WRITE_LATCH,
    SIM_HAL_OP_STORE_APPEND,
    SIM_HAL_OP_STORE_READ_RECORD,
    SIM_HAL_OP_WATCHDOG_FEED,
    SIM_HAL_OP_INPUTS_READ,
    SIM_HAL_OP_CLOCK_SECOND,
    SIM_HAL_OP_SELF_TEST,
    SIM_HAL_OP_COUNT
} sim_hal_op_t;

#define SIM_HAL_OP_ALL ((1u << SIM_HAL_OP_COUNT) - 1u)

/** Direct mode: called for every sent frame, not for refused ones. */
typedef void sim_hal_sink_fn(void *ctx, hal_can_side_t side, const hal_can_frame_t *frame);

/** All zero: clock from 0, watchdog after 100 ms, power-on, no store. */
typedef struct {
    uint32_t clock_start_ms; /**< the clock at bus time 0 (direct mode: until it is set); any value */
    uint16_t clock_phase_us; /**< 0..999: microseconds of the first millisecond that have passed at bus time 0 */
    uint32_t watchdog_ms;    /**< period; 0 = SIM_HAL_WATCHDOG_DEFAULT_MS; or SIM_HAL_WATCHDOG_OFF */
    hal_reset_cause_t reset_cause;
    sim_store_t *store; /**< NULL: nothing is ever stored, writes fail */
} sim_hal_config_t;

/** An output pin. */
typedef struct {
    bool on;             /**< LED lit; safety output closed */
    uint32_t changes;    /**< times that it changed */
    uint32_t changed_ms; /**< clock at the last change */
} sim_hal_pin_t;

/** One CAN controller. */
typedef struct {
    bool exists;               /**< read */
    uint32_t sent;             /**< read: accepted frames */
    uint32_t refused;          /**< read: hal_can_send() calls that returned false */
    uint32_t received;         /**< read: frames returned by sim_hal_receive() */
    uint32_t purges;           /**< read: hal_can_purge() calls */
    uint32_t recover_requests; /**< read: hal_can_recover() calls in bus-off */
    hal_can_status_t status;   /**< direct mode: the status to report; bus mode: the last reported one */
    bool full;                 /**< sim_hal_set_full() */
    bool swallows;             /**< sim_hal_set_swallowing() */
    sim_bus_t *bus;
    sim_bus_node_t node;
} sim_hal_can_t;

/** The simulated microcontroller. The program owns it and reads the members marked *read*. */
struct hal {
    const hal_ops_t *ops;             /**< first: hal_ops.h */
    sim_hal_can_t can[HAL_CAN_SIDES]; /**< read */
    sim_hal_pin_t led;                /**< read */
    sim_hal_pin_t safety_output;      /**< read */
    sim_board_t board;                /**< set by the program at any time; kept over a reset */
    bool contact_closed;              /**< read: the contact of the safety output, as it is */
    bool held;         /**< read: in reset (watchdog or sim_hal_hold()); nothing works until sim_hal_reset() */
    uint32_t feeds;    /**< read: hal_watchdog_feed() calls */
    uint32_t bites;    /**< read: resets by the watchdog since sim_hal_init() */
    uint32_t resets;   /**< read: sim_hal_reset() calls */
    uint32_t calls;    /**< read: operations of hal/include called so far */
    uint32_t failures; /**< read: how many of them were made to fail */
    uint32_t op_calls[SIM_HAL_OP_COUNT]; /**< read: calls of each */
    sim_hal_op_t last_failed;            /**< read: operation made to fail last (when failures > 0) */
    uint32_t fail_first;
    uint32_t fail_count;
    uint32_t fail_ops;
    uint32_t fed_ms;
    uint32_t direct_now_ms;
    uint32_t last_now_ms;
    uint32_t last_second_ms;
    hal_inputs_t last_inputs;
    uint64_t second_us; /* the second clock when it was read last */
    uint32_t second_read_ms;
    bool direct;
    sim_hal_config_t config;
    sim_hal_sink_fn *sink;
    void *sink_ctx;
};

/** @name Building @{ */

/** Make a port on a bus. No controller exists until sim_hal_attach(). @param config NULL = all zero; is copied. */
void sim_hal_init(hal_t *hal, const sim_hal_config_t *config);

/**
 * Attach a side to a bus as a new node. Both sides' buses must be kept at one time (sim_bus_run_all_until()). A callback
 * on_receive is the receive interrupt: it takes the frame with sim_hal_receive(), which stamps it with this clock.
 * @param config of the node; NULL = 8 mailboxes by ID, a receive queue of SIM_BUS_RX_SLOTS_MAX
 * @return false: the side has a bus already, the bus is full, or the configuration is out of range.
 */
bool sim_hal_attach(hal_t *hal, hal_can_side_t side, sim_bus_t *bus, const sim_bus_node_config_t *config);

/**
 * Make a port without a bus.
 * @param sides how many controllers exist: 1 = the vehicle side, 2 = the AI side too
 * @param sink gets every frame that is sent; NULL = they are only counted
 */
void sim_hal_init_direct(hal_t *hal, const sim_hal_config_t *config, unsigned sides, sim_hal_sink_fn *sink, void *ctx);
/** @} */

/** @name Running @{ */

/**
 * Take the next received frame of a side; the program passes it to the supervisor.
 * @param frame time_ms = this supervisor's clock at its reception, rounded down
 * @return false: no frame, no such side, direct mode, or held in reset.
 */
bool sim_hal_receive(hal_t *hal, hal_can_side_t side, hal_can_frame_t *frame);

/**
 * Run the watchdog; call this every tick, after the supervisor's step. If the last feed is more than its period ago, it
 * resets the MCU: the safety output opens (at the time when the period was over), the LED goes dark, the controllers lose
 * power, and no operation has an effect until sim_hal_reset().
 * @return true while the port is held in reset.
 */
bool sim_hal_poll(hal_t *hal);

/**
 * Hold the MCU in reset, as without supply, until sim_hal_reset(): the safety output is open, the LED dark, the controllers
 * without power, and no operation has an effect.
 */
void sim_hal_hold(hal_t *hal);

/**
 * Reset the MCU: outputs as at boot (open, dark), controllers with empty queues and zero counters, watchdog just fed. The
 * log is kept, and so is the latch (except for HAL_RESET_POWER_ON, see sim_store_t). The program then starts a new
 * supervisor.
 */
void sim_hal_reset(hal_t *hal, hal_reset_cause_t cause);

/** The clock, for the program's own use: the call is not counted and never fails. */
uint32_t sim_hal_now_ms(const hal_t *hal);

/** The clock at a bus time; direct mode: as sim_hal_now_ms(). */
uint32_t sim_hal_clock_at(const hal_t *hal, uint64_t bus_us);
/** @} */

/** @name Fault injection @{ */

/**
 * Make calls of hal/include fail: those with the numbers @p first .. @p first + @p count - 1 (the first call after
 * sim_hal_init() is number 1; hal->calls is the number of the last one), as far as their operation is in @p ops.
 * A failing operation has no effect and reports:
 * send, write_latch, append: false; read_latch, read_record: 0; reset_cause: HAL_RESET_UNKNOWN; status: what it
 * reported last; both clocks and the inputs: what they read last; self_test: 0; purge, recover, led, safety output, feed: nothing happens.
 * @param first 0 = nothing fails (default)
 * @param count UINT32_MAX = all from first on
 * @param ops bits 1 << sim_hal_op_t; SIM_HAL_OP_ALL
 */
void sim_hal_fail_at(hal_t *hal, uint32_t first, uint32_t count, uint32_t ops);
/** @} */

/** @name Direct mode: state set by the program @{ */

/** Set the clock. Never call it with an earlier time; the wrap from UINT32_MAX to 0 is not earlier. */
void sim_hal_set_now_ms(hal_t *hal, uint32_t now_ms);

/**
 * Set a controller's error state. Entering HAL_CAN_BUS_OFF counts bus_off_count up and sets tx_pending_ms to 0; while
 * in it hal_can_send() returns false. hal_can_recover() only counts recover_requests.
 */
void sim_hal_set_can_state(hal_t *hal, hal_can_side_t side, hal_can_state_t state);

/** Count one overrun. Works on a bus, too. */
void sim_hal_add_overrun(hal_t *hal, hal_can_side_t side);

/** Set the reported waiting time of frames (0 = none); hal_can_purge() sets it to 0. */
void sim_hal_set_tx_pending_ms(hal_t *hal, hal_can_side_t side, uint32_t tx_pending_ms);

/** While set, hal_can_send() returns false (queue full). Works on a bus, too. */
void sim_hal_set_full(hal_t *hal, hal_can_side_t side, bool full);

/**
 * While set, accepted frames are never sent, and the status does not show it: a dead transmitter behind the controller.
 * Works on a bus, too.
 */
void sim_hal_set_swallowing(hal_t *hal, hal_can_side_t side, bool swallows);
/** @} */

#endif
