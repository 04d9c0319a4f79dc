/* hal/can.h: the controllers. The driver gets one frame at a time; other frames wait in the port's queue, which can be
 * purged. A frame that the driver cannot send is taken back by a stop of the controller. */
#include "zephyr_hal_internal.h"

#include <string.h>

/* A frame that the driver has had for longer is kept from the bus. At 125 kbit/s it takes 1.1 ms with 8 bytes and all stuff
 * bits, and waits at most 1.3 ms for the frame of another node that is on the bus already. */
enum { FRAME_TURN_MS = 3 };

/* A frame that waits for longer keeps back frames of higher priority: the driver takes one at a time. At 125 kbit/s, with all
 * messages due at once, the lowest priority waits for 20 ms. A stop may lose a frame that is being received. */
enum { FRAME_PATIENCE_MS = 21 };

enum { US_PER_MS = 1000 };

BUILD_ASSERT(sizeof(((hal_can_frame_t *)0)->data) <= CAN_MAX_DLEN,
             "the data of a hal_can_frame_t must fit in a Zephyr frame");

static void stamp(hal_can_frame_t *frame) {
    const uint64_t now_us = k_ticks_to_us_floor64((uint64_t)k_uptime_ticks());
    frame->time_ms = (uint32_t)(now_us / US_PER_MS);
    frame->time_us = (uint16_t)(now_us % US_PER_MS);
}

/* A classic frame may have a DLC of 9 to 15, and carries 8 bytes then (ISO 11898-1). */
static uint8_t length_of(const struct can_frame *frame) {
    const bool is_fd = (frame->flags & CAN_FRAME_FDF) != 0u;
    return is_fd ? can_dlc_to_bytes(frame->dlc) : (uint8_t)MIN(frame->dlc, CAN_MAX_DLC);
}

static void convert(hal_can_frame_t *to, const struct can_frame *from) {
    *to = (hal_can_frame_t){.id = from->id, .length = length_of(from)};
    to->flags |= ((from->flags & CAN_FRAME_IDE) != 0u) ? HAL_CAN_EXTENDED : 0u;
    to->flags |= ((from->flags & CAN_FRAME_RTR) != 0u) ? HAL_CAN_REMOTE : 0u;
    to->flags |= ((from->flags & CAN_FRAME_FDF) != 0u) ? HAL_CAN_FD : 0u;
    if ((to->flags & HAL_CAN_REMOTE) == 0u) {
        (void)memcpy(to->data, from->data, MIN(to->length, sizeof to->data));
    }
}

/* Runs in the receive interrupt. The frame is stamped here, so that a backlog does not look fresh. */
static void on_frame(const struct device *device, struct can_frame *frame, void *user_data) {
    zephyr_hal_side_t *const side = user_data;
    hal_can_frame_t received;
    ARG_UNUSED(device);
    convert(&received, frame);
    stamp(&received);
    if (k_msgq_put(&side->received, &received, K_NO_WAIT) != 0) {
        const k_spinlock_key_t key = k_spin_lock(&side->lock);
        side->lost++;
        k_spin_unlock(&side->lock, key);
    }
    k_sem_give(side->wake);
}

static void sent(zephyr_hal_side_t *side, bool is_odd, bool has_left) {
    const k_spinlock_key_t key = k_spin_lock(&side->lock);
    if (side->newest_is_odd == is_odd) {
        side->in_flight = false;
        side->has_left = has_left;
    }
    k_spin_unlock(&side->lock, key);
    k_sem_give(side->wake);
}

/* These two run in the transmit interrupt, when the driver has sent the frame, or discarded it in bus-off or at a stop.
 * They alternate when a frame is taken back: a driver that reports it late does not report the next frame as sent. */
static void on_even_sent(const struct device *device, int error, void *user_data) {
    ARG_UNUSED(device);
    sent(user_data, false, error == 0);
}

static void on_odd_sent(const struct device *device, int error, void *user_data) {
    ARG_UNUSED(device);
    sent(user_data, true, error == 0);
}

static hal_can_state_t state_of(enum can_state state) {
    switch (state) {
    case CAN_STATE_ERROR_ACTIVE:
    case CAN_STATE_ERROR_WARNING:
        return HAL_CAN_ERROR_ACTIVE;
    case CAN_STATE_ERROR_PASSIVE:
        return HAL_CAN_ERROR_PASSIVE;
    default:
        return HAL_CAN_BUS_OFF; /* a stopped controller takes no part in the bus either */
    }
}

/* The caller holds the lock. */
static void enter(zephyr_hal_side_t *side, hal_can_state_t state) {
    if ((state == HAL_CAN_BUS_OFF) && (side->state != HAL_CAN_BUS_OFF)) {
        side->bus_offs++;
    }
    side->state = state;
}

/* Runs in the controller's interrupt, so that a bus-off that ends before the next hal_can_status() is counted, too. Only
 * the port stops the controller, and only for a moment; look() notices one that stays stopped. */
static void on_state(const struct device *device, enum can_state state, struct can_bus_err_cnt errors,
                     void *user_data) {
    zephyr_hal_side_t *const side = user_data;
    ARG_UNUSED(device);
    ARG_UNUSED(errors);
    const k_spinlock_key_t key = k_spin_lock(&side->lock);
    if ((state != CAN_STATE_STOPPED) && !side->is_halted) {
        side->callback_gave_state = true;
        enter(side, state_of(state));
    }
    k_spin_unlock(&side->lock, key);
    k_sem_give(side->wake);
}

/* Read the controller's state. A state that on_state() reported in the meantime is newer and is kept. */
static void look(zephyr_hal_side_t *side) {
    enum can_state state = CAN_STATE_STOPPED;
    k_spinlock_key_t key = k_spin_lock(&side->lock);
    side->callback_gave_state = false;
    k_spin_unlock(&side->lock, key);
    const bool known = !side->is_halted && (can_get_state(side->device, &state, NULL) == 0);
    key = k_spin_lock(&side->lock);
    if (!side->callback_gave_state) {
        enter(side, known ? state_of(state) : HAL_CAN_BUS_OFF);
    }
    k_spin_unlock(&side->lock, key);
}

/* Filters for all frames with 11-bit and 29-bit identifiers, because the supervisor counts the frames that it
 * rejects. */
static bool listen(zephyr_hal_side_t *side) {
    static const struct can_filter all[] = {{.flags = 0u}, {.flags = CAN_FILTER_IDE}};
    bool works = true;
    for (size_t i = 0u; i < ARRAY_SIZE(all); i++) {
        works = (can_add_rx_filter(side->device, on_frame, side, &all[i]) >= 0) && works;
    }
    return works;
}

static bool set_mode(const struct device *device, bool listen_only) {
    can_mode_t able = 0u;
    can_mode_t mode = listen_only ? CAN_MODE_LISTENONLY : CAN_MODE_NORMAL;
    if (can_get_capabilities(device, &able) != 0) {
        return false;
    }
    mode |= able & CAN_MODE_MANUAL_RECOVERY;
    const bool recovers_on_request =
        ((able & CAN_MODE_MANUAL_RECOVERY) != 0u) || IS_ENABLED(CONFIG_AGV_CAN_WITHOUT_BUS_OFF);
    return recovers_on_request && (can_set_mode(device, mode) == 0);
}

static bool set_timing(const struct device *device, const zephyr_hal_config_t *config) {
    struct can_timing timing;
    const int off_permille = can_calc_timing(device, &timing, config->bitrate, config->sample_point_permille);
    return (off_permille >= 0) && (off_permille <= CONFIG_AGV_CAN_SAMPLE_POINT_TOLERANCE) &&
           (can_set_timing(device, &timing) == 0);
}

bool zephyr_can_start(zephyr_hal_side_t *side, const zephyr_hal_config_t *config) {
    if (!device_is_ready(side->device)) {
        side->state = HAL_CAN_BUS_OFF;
        return false;
    }
    side->listen_only = config->listen_only || IS_ENABLED(CONFIG_AGV_CAN_LISTEN_ONLY);
    can_set_state_change_callback(side->device, on_state, side);
    const bool works = set_mode(side->device, side->listen_only) && set_timing(side->device, config) && listen(side) &&
                       (can_start(side->device) == 0);
    look(side);
    return works;
}

static bool take(zephyr_hal_side_t *side, hal_can_frame_t *frame) {
    return (side->device != NULL) && (k_msgq_peek(&side->received, frame) == 0);
}

static bool is_older(const hal_can_frame_t *a, const hal_can_frame_t *b) {
    const int32_t ms = (int32_t)(a->time_ms - b->time_ms);
    return (ms < 0) || ((ms == 0) && (a->time_us < b->time_us));
}

/* A frame of the vehicle that arrived after the first look may be older than the one of the AI side. */
bool zephyr_hal_receive(hal_t *hal, hal_can_side_t *side, hal_can_frame_t *frame) {
    hal_can_frame_t of_ai;
    bool vehicle = take(&hal->sides[HAL_CAN_VEHICLE], frame);
    const bool ai = take(&hal->sides[HAL_CAN_AI], &of_ai);
    if (ai && !vehicle) {
        vehicle = take(&hal->sides[HAL_CAN_VEHICLE], frame);
    }
    *side = (ai && (!vehicle || is_older(&of_ai, frame))) ? HAL_CAN_AI : HAL_CAN_VEHICLE;
    return (vehicle || ai) && (k_msgq_get(&hal->sides[*side].received, frame, K_NO_WAIT) == 0);
}

/* Set before can_send(), because the driver's interrupt may come before can_send() returns. */
static void set_in_flight(zephyr_hal_side_t *side, bool in_flight) {
    const k_spinlock_key_t key = k_spin_lock(&side->lock);
    side->in_flight = in_flight;
    side->has_left = false;
    k_spin_unlock(&side->lock, key);
}

static bool is_in_flight(zephyr_hal_side_t *side) {
    const k_spinlock_key_t key = k_spin_lock(&side->lock);
    const bool in_flight = side->in_flight;
    k_spin_unlock(&side->lock, key);
    return in_flight;
}

static bool give(zephyr_hal_side_t *side, const zephyr_hal_waiting_t *frame, uint32_t now_ms) {
    struct can_frame given = {.id = frame->frame.id, .dlc = can_bytes_to_dlc(frame->frame.length)};
    (void)memcpy(given.data, frame->frame.data, MIN(frame->frame.length, sizeof frame->frame.data));
    set_in_flight(side, true);
    side->sent_is_purged = false;
    side->sent = *frame;
    side->sent_given_ms = now_ms;
    const can_tx_callback_t on_sent = side->newest_is_odd ? on_odd_sent : on_even_sent;
    const bool taken = can_send(side->device, &given, K_NO_WAIT, on_sent, side) == 0;
    if (!taken) {
        set_in_flight(side, false);
    }
    return taken;
}

static bool can_be_sent(const hal_can_frame_t *frame) {
    return (frame->flags == 0u) && (frame->length <= sizeof frame->data) && (frame->id <= CAN_STD_ID_MASK);
}

bool hal_can_send(hal_t *hal, hal_can_side_t side, const hal_can_frame_t *frame) {
    zephyr_hal_side_t *const sender = zephyr_hal_side(hal, side);
    if ((sender == NULL) || (sender->state == HAL_CAN_BUS_OFF) || !can_be_sent(frame)) {
        return false;
    }
    const uint32_t now_ms = hal_clock_now_ms(hal);
    if (!is_in_flight(sender) && (sender->waiting_count == 0u)) {
        return give(sender, &(zephyr_hal_waiting_t){.frame = *frame, .taken_ms = now_ms, .since_ms = now_ms}, now_ms);
    }
    return zephyr_queue_put(sender, frame, now_ms);
}

BUILD_ASSERT(IS_ENABLED(CONFIG_CAN_STATS) || IS_ENABLED(CONFIG_CAN_FAKE),
             "the driver's overruns must be counted: CONFIG_STATS and CONFIG_CAN_STATS");

static uint32_t driver_counter(const zephyr_hal_side_t *side) {
#if defined(CONFIG_CAN_FAKE)
    ARG_UNUSED(side);
    return 0u;
#else
    return can_stats_get_rx_overruns(side->device);
#endif
}

static void count_overruns(zephyr_hal_side_t *side) {
    const uint32_t counter = driver_counter(side);
    side->driver_lost += counter - side->driver_counted;
    side->driver_counted = counter;
}

/* A start keeps filters, mode and timing, but sets the driver's counters to 0. */
static void start_again(zephyr_hal_side_t *side) {
    count_overruns(side);
    const bool works = can_start(side->device) == 0;
    side->driver_counted = driver_counter(side);
    const k_spinlock_key_t key = k_spin_lock(&side->lock);
    side->is_halted = !works;
    if (!works) {
        enter(side, HAL_CAN_BUS_OFF);
    }
    k_spin_unlock(&side->lock, key);
}

/* Zephyr's only way is a stop. Its result does not matter: a controller that has not stopped does not start again either. A
 * start may set the error counters to 0; from 250 kbit/s on the stops are far enough apart for a bus-off, which takes 32
 * failed frames. Returns false when the frame left before the stop. */
static bool take_back(zephyr_hal_side_t *side) {
    (void)can_stop(side->device);
    const k_spinlock_key_t key = k_spin_lock(&side->lock);
    side->in_flight = false;
    side->newest_is_odd = !side->newest_is_odd;
    side->is_halted = side->state == HAL_CAN_BUS_OFF; /* reported during the stop: it waits for hal_can_recover() */
    const bool is_off = side->is_halted;
    const bool has_left = side->has_left;
    k_spin_unlock(&side->lock, key);
    if (!is_off) {
        start_again(side);
    }
    return !has_left;
}

/* Not in bus-off, because a start would end it, nor while the controller only listens. */
static bool is_kept_from_the_bus(zephyr_hal_side_t *side, uint32_t now_ms, uint32_t patience_ms) {
    const bool overdue = is_in_flight(side) && ((now_ms - side->sent_given_ms) > patience_ms);
    if (!overdue || side->listen_only) {
        return false;
    }
    look(side);
    return side->state != HAL_CAN_BUS_OFF;
}

/* A frame that was purged while it could be on the bus is taken back when it turns out that it is not. */
static void withdraw_purged(zephyr_hal_side_t *side, uint32_t now_ms) {
    if (is_kept_from_the_bus(side, now_ms, FRAME_TURN_MS)) {
        (void)take_back(side);
    }
}

void hal_can_purge(hal_t *hal, hal_can_side_t side) {
    zephyr_hal_side_t *const purged = zephyr_hal_side(hal, side);
    if (purged != NULL) {
        purged->waiting_count = 0u;
        purged->sent_is_purged = true;
        withdraw_purged(purged, hal_clock_now_ms(hal));
    }
}

/* A frame that is kept from the bus lets those of higher priority go first. */
static void make_way(zephyr_hal_side_t *side, uint32_t now_ms) {
    const bool in_the_way = (side->waiting_count > 0u) && (side->waiting[0].frame.id < side->sent.frame.id);
    if (in_the_way && is_kept_from_the_bus(side, now_ms, FRAME_PATIENCE_MS) && take_back(side)) {
        zephyr_queue_put_back(side, &side->sent);
    }
}

static void transmit(zephyr_hal_side_t *side, uint32_t now_ms) {
    if (side->sent_is_purged) {
        withdraw_purged(side, now_ms);
    } else {
        make_way(side, now_ms);
    }
    if (side->state == HAL_CAN_BUS_OFF) {
        side->waiting_count = 0u;
    } else if (!is_in_flight(side) && (side->waiting_count > 0u) && give(side, &side->waiting[0], now_ms)) {
        zephyr_queue_drop_first(side);
    } else {
        /* the driver is busy or refused the frame, or no frame waits */
    }
}

void zephyr_hal_transmit(hal_t *hal) {
    for (uint32_t i = 0u; i < (uint32_t)HAL_CAN_SIDES; i++) {
        if (hal->sides[i].device != NULL) {
            transmit(&hal->sides[i], hal_clock_now_ms(hal));
        }
    }
}

/* The driver of bxCAN would send what its mailboxes hold after the recovery. A stop takes it back. */
enum { STOP_FOR_RECOVERY = DT_HAS_COMPAT_STATUS_OKAY(st_stm32_bxcan) };

/* After a failure the supervisor requests it again. */
static void recover(zephyr_hal_side_t *side) {
    if (side->is_halted || ((int)STOP_FOR_RECOVERY != 0)) {
        (void)can_stop(side->device);
        start_again(side);
    } else {
#if defined(CONFIG_CAN_MANUAL_RECOVERY_MODE)
        (void)can_recover(side->device, K_NO_WAIT);
#endif
    }
}

void hal_can_recover(hal_t *hal, hal_can_side_t side) {
    zephyr_hal_side_t *const off = zephyr_hal_side(hal, side);
    if ((off != NULL) && off->running && (off->state == HAL_CAN_BUS_OFF)) {
        recover(off);
    }
}

void hal_can_status(hal_t *hal, hal_can_side_t side, hal_can_status_t *status) {
    zephyr_hal_side_t *const asked = zephyr_hal_side(hal, side);
    *status = (hal_can_status_t){.state = HAL_CAN_ERROR_ACTIVE};
    if (asked != NULL) {
        look(asked);
        status->tx_pending_ms = zephyr_queue_pending_ms(asked, is_in_flight(asked), hal_clock_now_ms(hal));
        status->state = asked->state;
        status->bus_off_count = asked->bus_offs;
        count_overruns(asked);
        status->overrun_count = (uint16_t)(asked->lost + asked->driver_lost);
    }
}
