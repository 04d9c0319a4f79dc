/* The controllers, on can_fake: bus-off, refused sends, missing filters, and the queue. */
#include <string.h>

#include "fixture.h"

ZTEST_SUITE(port_can, NULL, NULL, fixture_before, fixture_after, NULL);

static fake_bus_t *const vehicle = &fake_buses[HAL_CAN_VEHICLE];

static bool send(uint32_t id, uint8_t first) {
    const hal_can_frame_t frame = {.id = id, .length = 8u, .data = {first}};
    return hal_can_send(&hal, HAL_CAN_VEHICLE, &frame);
}

static void arrive(hal_can_side_t side, uint32_t id, uint8_t flags) {
    const struct can_frame frame = {.id = id, .dlc = 8u, .flags = flags, .data = {1u, 2u, 3u, 4u, 5u, 6u, 7u, 8u}};
    fake_bus_frame(side, &frame);
}

ZTEST(port_can, test_the_port_starts_as_the_contract_requires) {
    zassert_true(vehicle->started && fake_buses[HAL_CAN_AI].started);
    zassert_equal(vehicle->mode, CAN_MODE_NORMAL | CAN_MODE_MANUAL_RECOVERY);
    zassert_equal(vehicle->filters, 2u, "one for 11 bits, one for 29");
    const struct can_timing *const timing = &vehicle->timing;
    const uint32_t quanta = 1u + timing->prop_seg + timing->phase_seg1 + timing->phase_seg2;
    zassert_equal(80000000u / (timing->prescaler * quanta), 500000u);
    zassert_equal((1u + timing->prop_seg + timing->phase_seg1) * 1000u / quanta, 875u);
}

/* Shows: SUP-7 */
ZTEST(port_can, test_without_a_free_filter_the_port_does_not_start) {
    fake_parts_reset();
    vehicle->filter_limit = 1u;
    zassert_false(fixture_begin());
    zassert_false(vehicle->started);
    zassert_equal(fixture_status().state, HAL_CAN_BUS_OFF, "who hears nothing takes no part");
    zassert_true(fake_buses[HAL_CAN_AI].started, "the other side begins");
}

/* Shows: SUP-7 */
ZTEST(port_can, test_a_controller_that_recovers_by_itself_is_refused) {
    fake_parts_reset();
    vehicle->able = 0u;
    zassert_false(fixture_begin());
    zassert_equal(fixture_status().state, HAL_CAN_BUS_OFF);
    hal_can_recover(&hal, HAL_CAN_VEHICLE);
    zassert_false(vehicle->started, "the recovery starts no controller that was refused");
    zassert_equal(vehicle->recoveries, 0u);
}

/* Shows: TIM-4 */
ZTEST(port_can, test_a_frame_carries_the_time_of_its_arrival) {
    hal_can_side_t side;
    hal_can_frame_t frame;
    k_msleep(5);
    const uint32_t arrived_ms = hal_clock_now_ms(&hal);
    arrive(HAL_CAN_VEHICLE, 0x363u, 0u);
    k_msleep(20);
    zassert_true(zephyr_hal_receive(&hal, &side, &frame));
    zassert_within(frame.time_ms, arrived_ms, 1u);
    zassert_true(frame.time_us < 1000u);
    zassert_equal(frame.id, 0x363u);
    zassert_equal(frame.length, 8u);
    zassert_equal(frame.data[7], 8u);
    zassert_equal(frame.flags, 0u);
    zassert_false(zephyr_hal_receive(&hal, &side, &frame));
}

/* Shows: INT-2 */
ZTEST(port_can, test_frames_that_are_rejected_are_passed_on_too) {
    static const struct can_frame sent[] = {
        {.id = 0x12345u, .dlc = 8u, .flags = CAN_FRAME_IDE},
        {.id = 0x363u, .dlc = 8u, .flags = CAN_FRAME_RTR, .data = {1u}},
        {.id = 0x363u, .dlc = 12u, .flags = CAN_FRAME_FDF, .data = {9u}},
        {.id = 0x363u, .dlc = 3u, .data = {1u, 2u, 3u, 4u}},
        {.id = 0x363u, .dlc = 9u, .data = {1u, 2u, 3u, 4u, 5u, 6u, 7u, 8u, 9u}},
        {.id = 0x363u, .dlc = 15u, .flags = CAN_FRAME_RTR},
    };
    static const hal_can_frame_t wanted[] = {
        {.id = 0x12345u, .length = 8u, .flags = HAL_CAN_EXTENDED},
        {.id = 0x363u, .length = 8u, .flags = HAL_CAN_REMOTE},
        {.id = 0x363u, .length = 24u, .flags = HAL_CAN_FD, .data = {9u}},
        {.id = 0x363u, .length = 3u, .data = {1u, 2u, 3u}},
        {.id = 0x363u, .length = 8u, .data = {1u, 2u, 3u, 4u, 5u, 6u, 7u, 8u}},
        {.id = 0x363u, .length = 8u, .flags = HAL_CAN_REMOTE},
    };
    for (size_t i = 0u; i < ARRAY_SIZE(sent); i++) {
        hal_can_side_t side;
        hal_can_frame_t frame;
        fake_bus_frame(HAL_CAN_VEHICLE, &sent[i]);
        zassert_true(zephyr_hal_receive(&hal, &side, &frame));
        zassert_equal(frame.id, wanted[i].id);
        zassert_equal(frame.length, wanted[i].length);
        zassert_equal(frame.flags, wanted[i].flags);
        zassert_mem_equal(frame.data, wanted[i].data, sizeof frame.data);
    }
}

/* Shows: TOP-2 */
ZTEST(port_can, test_frames_of_both_sides_come_in_the_order_of_their_arrival) {
    static const hal_can_side_t order[] = {HAL_CAN_AI, HAL_CAN_VEHICLE, HAL_CAN_VEHICLE, HAL_CAN_AI};
    for (size_t i = 0u; i < ARRAY_SIZE(order); i++) {
        arrive(order[i], 0x100u + i, 0u);
        k_msleep(2);
    }
    for (size_t i = 0u; i < ARRAY_SIZE(order); i++) {
        hal_can_side_t side;
        hal_can_frame_t frame;
        zassert_true(zephyr_hal_receive(&hal, &side, &frame));
        zassert_equal(frame.id, 0x100u + i);
        zassert_equal(side, order[i]);
    }
}

static hal_can_side_t first_side;

static void one_of_each_side(void) {
    arrive(first_side, 0x100u, 0u);
    k_busy_wait(1000);
    arrive((first_side == HAL_CAN_AI) ? HAL_CAN_VEHICLE : HAL_CAN_AI, 0x101u, 0u);
}

static void expect_in_order(hal_can_side_t first, uint32_t looks) {
    first_side = first;
    fixture_arrives = one_of_each_side;
    fixture_looks = looks;
    for (uint32_t next = 0x100u, calls = 0u; next < 0x102u; calls++) {
        hal_can_side_t side;
        hal_can_frame_t frame;
        zassert_true(calls < 3u, "after %u looks: a frame is missing", looks);
        if (zephyr_hal_receive(&hal, &side, &frame)) {
            zassert_equal(frame.id, next, "after %u looks: the younger one came first", looks);
            next++;
        }
    }
}

/* Shows: TOP-2 */
ZTEST(port_can, test_frames_that_arrive_while_the_port_looks_keep_their_order) {
    for (uint32_t looks = 1u; looks <= 2u; looks++) {
        expect_in_order(HAL_CAN_VEHICLE, looks);
        expect_in_order(HAL_CAN_AI, looks);
    }
}

/* Shows: SUP-7 */
ZTEST(port_can, test_a_full_queue_is_an_overrun) {
    for (uint32_t i = 0u; i < (CONFIG_AGV_CAN_RX_QUEUE + 3u); i++) {
        arrive(HAL_CAN_VEHICLE, 0x100u, 0u);
    }
    zassert_equal(fixture_status().overrun_count, 3u);
    arrive(HAL_CAN_AI, 0x101u, 0u);
    zassert_equal(fixture_status().overrun_count, 3u, "a side does not crowd out the other");
}

/* Shows: FSM-2 */
ZTEST(port_can, test_the_driver_has_one_frame_and_the_lowest_identifier_goes_next) {
    zassert_true(send(0x168u, 1u));
    zassert_true(send(0x43Fu, 2u));
    zassert_true(send(0x065u, 3u));
    zassert_true(send(0x43Fu, 4u));
    zassert_equal(vehicle->sent_count, 1u);
    static const uint8_t order[] = {1u, 3u, 2u, 4u};
    for (uint32_t i = 0u; i < ARRAY_SIZE(order); i++) {
        zassert_equal(vehicle->sent_count, i + 1u);
        zassert_equal(vehicle->in_mailbox, 1u);
        zassert_equal(vehicle->sent[i].data[0], order[i]);
        fake_bus_complete(HAL_CAN_VEHICLE, 0);
        zephyr_hal_transmit(&hal);
    }
    zassert_equal(fixture_status().tx_pending_ms, 0u);
}

ZTEST(port_can, test_a_frame_refused_by_the_driver_stays_with_the_caller) {
    vehicle->send_error = -EAGAIN;
    zassert_false(send(0x168u, 1u));
    zassert_equal(fixture_status().tx_pending_ms, 0u);
    vehicle->send_error = 0;
    zassert_true(send(0x168u, 2u));
    zassert_true(send(0x065u, 3u));
    vehicle->send_error = -EAGAIN;
    fake_bus_complete(HAL_CAN_VEHICLE, 0);
    zephyr_hal_transmit(&hal);
    zassert_equal(vehicle->sent_count, 1u, "it waits on");
    vehicle->send_error = 0;
    zephyr_hal_transmit(&hal);
    zassert_equal(vehicle->sent[1].data[0], 3u);
}

ZTEST(port_can, test_a_full_queue_accepts_nothing) {
    for (uint32_t i = 0u; i <= ZEPHYR_HAL_QUEUE_SIZE; i++) {
        zassert_true(send(0x100u + i, 0u));
    }
    zassert_false(send(0x050u, 0u));
}

ZTEST(port_can, test_only_frames_that_can_be_sent_are_accepted) {
    const hal_can_frame_t extended = {.id = 0x168u, .length = 8u, .flags = HAL_CAN_EXTENDED};
    const hal_can_frame_t long_id = {.id = 0x800u, .length = 8u};
    const hal_can_frame_t long_frame = {.id = 0x168u, .length = 9u};
    zassert_false(hal_can_send(&hal, HAL_CAN_VEHICLE, &extended));
    zassert_false(hal_can_send(&hal, HAL_CAN_VEHICLE, &long_id));
    zassert_false(hal_can_send(&hal, HAL_CAN_VEHICLE, &long_frame));
    zassert_false(hal_can_send(&hal, HAL_CAN_SIDES, &(hal_can_frame_t){.id = 1u}));
}

/* Shows: FSM-2 */
ZTEST(port_can, test_after_a_purge_at_most_the_frame_in_the_controller_is_sent) {
    (void)send(0x168u, 1u);
    (void)send(0x43Fu, 2u);
    hal_can_purge(&hal, HAL_CAN_VEHICLE);
    zassert_equal(fixture_status().tx_pending_ms, 0u);
    zassert_true(send(0x065u, 3u));
    fake_bus_complete(HAL_CAN_VEHICLE, 0);
    zephyr_hal_transmit(&hal);
    zassert_equal(vehicle->sent_count, 2u);
    zassert_equal(vehicle->sent[1].data[0], 3u);
}

enum { LONG_MS = 10 }; /* longer than a frame can take, also behind another one */

/* The status frame of the supervisor is in the controller, and another node keeps it there. */
static void jam(void) {
    zassert_true(send(0x7F0u, 1u));
    k_msleep(LONG_MS);
    zassert_equal(vehicle->in_mailbox, 1u);
}

static void expect_on_the_bus(void) {
    const hal_can_status_t status = fixture_status();
    zassert_equal(status.state, HAL_CAN_ERROR_ACTIVE);
    zassert_equal(status.bus_off_count, 0u);
    zassert_equal(status.overrun_count, 0u);
    zassert_true(vehicle->started);
}

/* Shows: FSM-2 */
ZTEST(port_can, test_a_purge_takes_back_a_frame_that_cannot_leave) {
    for (uint32_t i = 1u; i <= 5u; i++) {
        jam();
        (void)send(0x363u, 2u);
        hal_can_purge(&hal, HAL_CAN_VEHICLE);
        zassert_equal(vehicle->in_mailbox, 0u, "the driver has no frame");
        zassert_equal(vehicle->stops, i);
        zassert_equal(fixture_status().tx_pending_ms, 0u);
        expect_on_the_bus();
        zassert_true(send(0x168u, 3u));
        zassert_equal(vehicle->sent_count, 2u * i, "at once, not after the next wait");
        zassert_equal(vehicle->sent[(2u * i) - 1u].id, 0x168u);
        zassert_equal(vehicle->in_mailbox, 1u);
        fake_bus_complete(HAL_CAN_VEHICLE, 0);
    }
    expect_on_the_bus();
    zassert_equal(vehicle->filters, 2u);
    zassert_equal(vehicle->mode, CAN_MODE_NORMAL | CAN_MODE_MANUAL_RECOVERY);
    zassert_equal(fake_buses[HAL_CAN_AI].stops, 0u, "the other side is left alone");
}

ZTEST(port_can, test_a_late_report_of_a_frame_taken_back_is_ignored) {
    jam();
    vehicle->is_late = true;
    const can_tx_callback_t report = vehicle->sent_callback;
    void *const reported = vehicle->sent_data;
    hal_can_purge(&hal, HAL_CAN_VEHICLE);
    zassert_true(send(0x168u, 2u));
    report(vehicle->device, -ENETDOWN, reported);
    zassert_true(send(0x43Fu, 3u));
    zephyr_hal_transmit(&hal);
    zassert_equal(vehicle->sent_count, 2u, "the driver still has 168h");
    fake_bus_complete(HAL_CAN_VEHICLE, 0);
    zephyr_hal_transmit(&hal);
    zassert_equal(vehicle->sent_count, 3u);
    zassert_equal(vehicle->sent[2].id, 0x43Fu);
}

/* Shows: FSM-2 */
ZTEST(port_can, test_a_purge_leaves_a_frame_that_may_be_on_the_bus) {
    (void)send(0x7F0u, 1u);
    k_msleep(2);
    hal_can_purge(&hal, HAL_CAN_VEHICLE);
    zassert_equal(vehicle->stops, 0u);
    zassert_equal(vehicle->in_mailbox, 1u);
    (void)send(0x168u, 2u);
    k_msleep(LONG_MS);
    fake_bus_complete(HAL_CAN_VEHICLE, 0);
    zephyr_hal_transmit(&hal);
    hal_can_purge(&hal, HAL_CAN_VEHICLE);
    zassert_equal(vehicle->stops, 0u, "it waited in the queue, and the driver has had it for no time");
    zassert_equal(vehicle->in_mailbox, 1u);
    fake_bus_complete(HAL_CAN_VEHICLE, 0);
    k_msleep(LONG_MS);
    hal_can_purge(&hal, HAL_CAN_VEHICLE);
    zassert_equal(vehicle->stops, 0u, "all was sent");
}

/* It lost the arbitration all the time. */
/* Shows: FSM-2 */
ZTEST(port_can, test_a_purged_frame_that_turns_out_not_to_be_on_the_bus_is_taken_back) {
    (void)send(0x168u, 1u);
    k_msleep(2);
    hal_can_purge(&hal, HAL_CAN_VEHICLE);
    (void)send(0x075u, 2u);
    zephyr_hal_transmit(&hal);
    zassert_equal(vehicle->stops, 0u);
    k_msleep(LONG_MS);
    zephyr_hal_transmit(&hal);
    zassert_equal(vehicle->stops, 1u);
    zassert_equal(vehicle->in_mailbox, 1u);
    zassert_equal(vehicle->sent[vehicle->sent_count - 1u].id, 0x075u);
    expect_on_the_bus();
}

static void leaves_next(uint32_t id, uint8_t first) {
    const struct can_frame *const newest = &vehicle->sent[vehicle->sent_count - 1u];
    zassert_equal(vehicle->in_mailbox, 1u);
    zassert_equal(newest->id, id);
    zassert_equal(newest->data[0], first);
    fake_bus_complete(HAL_CAN_VEHICLE, 0);
    zephyr_hal_transmit(&hal);
}

/* Another node sends 300h without a pause. */
/* Shows: TOP-1, SUP-7 */
ZTEST(port_can, test_a_frame_that_is_kept_from_the_bus_lets_those_of_higher_priority_go_first) {
    (void)send(0x43Fu, 1u);
    (void)send(0x075u, 2u);
    (void)send(0x7F0u, 3u);
    k_msleep(20);
    zephyr_hal_transmit(&hal);
    zassert_equal(vehicle->stops, 0u, "at 125 kbit/s it may still come to its turn");
    k_msleep(5);
    zephyr_hal_transmit(&hal);
    zassert_equal(vehicle->stops, 1u);
    zassert_equal(fake_buses[HAL_CAN_AI].stops, 0u);
    zassert_within(fixture_status().tx_pending_ms, 25u, 1u, "43Fh still waits");
    leaves_next(0x075u, 2u);
    leaves_next(0x43Fu, 1u);
    leaves_next(0x7F0u, 3u);
    zassert_equal(fixture_status().tx_pending_ms, 0u);
    expect_on_the_bus();
}

/* The transmit interrupt comes between the port's decision and the stop. */
/* Shows: TOP-1 */
ZTEST(port_can, test_a_frame_that_leaves_just_before_the_stop_is_not_sent_twice) {
    (void)send(0x43Fu, 1u);
    (void)send(0x075u, 2u);
    vehicle->sends_at_stop = true;
    k_msleep(25);
    zephyr_hal_transmit(&hal);
    zassert_equal(vehicle->stops, 1u);
    leaves_next(0x075u, 2u);
    zassert_equal(vehicle->sent_count, 2u);
    zassert_equal(fixture_status().tx_pending_ms, 0u);
}

/* Shows: TOP-1 */
ZTEST(port_can, test_a_frame_of_the_highest_priority_is_left_in_the_controller) {
    (void)send(0x065u, 1u);
    (void)send(0x075u, 2u);
    k_msleep(50);
    zephyr_hal_transmit(&hal);
    zassert_equal(vehicle->stops, 0u);
    leaves_next(0x065u, 1u);
    leaves_next(0x075u, 2u);
}

/* Shows: TOP-1, TOP-2, SUP-7 */
ZTEST(port_can, test_of_older_frames_with_one_identifier_the_newest_waits_and_is_as_old_as_the_first) {
    (void)send(0x168u, 1u);
    k_msleep(5);
    (void)send(0x065u, 2u);
    (void)send(0x065u, 2u); /* together with the one before: both wait, until a later one comes */
    for (uint32_t i = 0u; i < ZEPHYR_HAL_QUEUE_SIZE; i++) {
        k_msleep(5);
        zassert_true(send(0x065u, 3u + i));
    }
    fake_bus_complete(HAL_CAN_VEHICLE, 0);
    zephyr_hal_transmit(&hal);
    zassert_within(fixture_status().tx_pending_ms, 82u, 2u);
    leaves_next(0x065u, 2u + ZEPHYR_HAL_QUEUE_SIZE);
    zassert_equal(fixture_status().tx_pending_ms, 0u);
}

/* The newer one takes over the age of the one that was taken back. */
/* Shows: TOP-1, SUP-7 */
ZTEST(port_can, test_a_frame_that_is_taken_back_does_not_replace_a_newer_one) {
    (void)send(0x43Fu, 1u);
    (void)send(0x075u, 2u);
    k_msleep(15);
    (void)send(0x43Fu, 3u);
    k_msleep(10);
    zephyr_hal_transmit(&hal);
    leaves_next(0x075u, 2u);
    zassert_within(fixture_status().tx_pending_ms, 25u, 1u);
    leaves_next(0x43Fu, 3u);
    zassert_equal(fixture_status().tx_pending_ms, 0u);
}

static void expect_bus_off(void) {
    const hal_can_status_t status = fixture_status();
    zassert_equal(status.state, HAL_CAN_BUS_OFF);
    zassert_equal(status.bus_off_count, 1u);
    zassert_equal(status.tx_pending_ms, 0u);
    zassert_false(send(0x168u, 2u));
    zassert_false(send(0x168u, 2u));
}

static void recover_by_a_start(void) {
    hal_can_recover(&hal, HAL_CAN_VEHICLE);
    const hal_can_status_t status = fixture_status();
    zassert_true(vehicle->started);
    zassert_equal(vehicle->recoveries, 0u, "a stopped controller is started");
    zassert_equal(status.state, HAL_CAN_ERROR_ACTIVE);
    zassert_equal(status.bus_off_count, 1u);
    zassert_true(send(0x168u, 3u));
    zassert_equal(vehicle->sent[vehicle->sent_count - 1u].data[0], 3u);
}

/* Shows: SUP-7 */
ZTEST(port_can, test_a_controller_that_does_not_start_again_is_bus_off) {
    jam();
    vehicle->start_error = -EIO;
    hal_can_purge(&hal, HAL_CAN_VEHICLE);
    expect_bus_off();
    hal_can_recover(&hal, HAL_CAN_VEHICLE);
    expect_bus_off();
    vehicle->start_error = 0;
    expect_bus_off();
    recover_by_a_start();
}

/* Shows: SUP-7 */
ZTEST(port_can, test_a_controller_that_does_not_stop_is_bus_off) {
    jam();
    vehicle->stop_error = -EIO;
    hal_can_purge(&hal, HAL_CAN_VEHICLE);
    expect_bus_off();
    fake_bus_state(HAL_CAN_VEHICLE, CAN_STATE_ERROR_PASSIVE, true);
    expect_bus_off();
    vehicle->stop_error = 0;
    recover_by_a_start();
}

/* Shows: SUP-7 */
ZTEST(port_can, test_a_bus_off_just_before_the_stop_waits_for_the_request) {
    jam();
    vehicle->bus_off_at_stop = true;
    hal_can_purge(&hal, HAL_CAN_VEHICLE);
    expect_bus_off();
    zassert_false(vehicle->started);
    vehicle->bus_off_at_stop = false;
    recover_by_a_start();
}

/* Shows: SUP-7 */
ZTEST(port_can, test_a_purge_in_bus_off_stops_nothing) {
    jam();
    fake_bus_state(HAL_CAN_VEHICLE, CAN_STATE_BUS_OFF, false);
    hal_can_purge(&hal, HAL_CAN_VEHICLE);
    zassert_equal(vehicle->stops, 0u);
    expect_bus_off();
}

ZTEST(port_can, test_a_controller_that_only_listens_is_not_stopped) {
    fake_parts_reset();
    zassert_true(fixture_begin_listening());
    jam();
    hal_can_purge(&hal, HAL_CAN_VEHICLE);
    zassert_equal(vehicle->stops, 0u);
    expect_on_the_bus();
}

/* Shows: SUP-7 */
ZTEST(port_can, test_the_age_of_an_unsent_frame_grows) {
    (void)send(0x168u, 1u);
    zassert_equal(fixture_status().tx_pending_ms, 1u);
    k_msleep(30);
    zassert_within(fixture_status().tx_pending_ms, 30u, 1u);
    (void)send(0x065u, 2u);
    zassert_within(fixture_status().tx_pending_ms, 30u, 1u, "the oldest counts");
    fake_bus_complete(HAL_CAN_VEHICLE, 0);
    zassert_true(fixture_status().tx_pending_ms <= 2u);
}

static void go_bus_off(void) {
    fake_bus_state(HAL_CAN_VEHICLE, CAN_STATE_BUS_OFF, true);
    if (vehicle->in_mailbox > 0u) {
        fake_bus_complete(HAL_CAN_VEHICLE, -ENETUNREACH);
    }
}

/* Shows: SUP-7 */
ZTEST(port_can, test_in_bus_off_waiting_frames_are_never_sent) {
    (void)send(0x168u, 1u);
    (void)send(0x43Fu, 2u);
    go_bus_off();
    zephyr_hal_transmit(&hal);
    const hal_can_status_t status = fixture_status();
    zassert_equal(status.state, HAL_CAN_BUS_OFF);
    zassert_equal(status.bus_off_count, 1u);
    zassert_equal(status.tx_pending_ms, 0u);
    zassert_false(send(0x065u, 3u));
    fake_bus_state(HAL_CAN_VEHICLE, CAN_STATE_ERROR_ACTIVE, false);
    zassert_equal(fixture_status().state, HAL_CAN_ERROR_ACTIVE);
    zephyr_hal_transmit(&hal);
    zassert_equal(vehicle->sent_count, 1u);
    zassert_true(send(0x065u, 4u));
    zassert_equal(vehicle->sent[1].data[0], 4u);
}

/* Shows: SUP-7 */
ZTEST(port_can, test_recovery_is_on_request_and_in_bus_off_only) {
    hal_can_recover(&hal, HAL_CAN_VEHICLE);
    zassert_equal(vehicle->recoveries, 0u);
    go_bus_off();
    zassert_equal(vehicle->recoveries, 0u);
    hal_can_recover(&hal, HAL_CAN_VEHICLE);
    zassert_equal(vehicle->recoveries, 1u);
}

/* Shows: SUP-7 */
ZTEST(port_can, test_a_bus_off_that_ends_before_the_status_is_read_is_counted) {
    fake_bus_state(HAL_CAN_VEHICLE, CAN_STATE_BUS_OFF, true);
    fake_bus_state(HAL_CAN_VEHICLE, CAN_STATE_ERROR_ACTIVE, true);
    const hal_can_status_t status = fixture_status();
    zassert_equal(status.state, HAL_CAN_ERROR_ACTIVE);
    zassert_equal(status.bus_off_count, 1u);
}

/* Shows: SUP-7 */
ZTEST(port_can, test_a_bus_off_without_an_interrupt_is_counted_once) {
    fake_bus_state(HAL_CAN_VEHICLE, CAN_STATE_BUS_OFF, false);
    zassert_equal(fixture_status().bus_off_count, 1u);
    zassert_equal(fixture_status().bus_off_count, 1u);
}

/* Shows: SUP-7 */
ZTEST(port_can, test_error_states) {
    static const struct {
        enum can_state is;
        hal_can_state_t shown;
    } cases[] = {{CAN_STATE_ERROR_WARNING, HAL_CAN_ERROR_ACTIVE},
                 {CAN_STATE_ERROR_PASSIVE, HAL_CAN_ERROR_PASSIVE},
                 {CAN_STATE_ERROR_ACTIVE, HAL_CAN_ERROR_ACTIVE},
                 {CAN_STATE_STOPPED, HAL_CAN_BUS_OFF}};
    for (size_t i = 0u; i < ARRAY_SIZE(cases); i++) {
        fake_bus_state(HAL_CAN_VEHICLE, cases[i].is, false);
        zassert_equal(fixture_status().state, cases[i].shown);
    }
}

/* Shows: TIM-4 */
ZTEST(port_can, test_the_thread_is_woken_by_a_frame_and_by_each_millisecond_once) {
    while (k_sem_take(&hal.wake, K_NO_WAIT) == 0) {
    }
    arrive(HAL_CAN_VEHICLE, 0x363u, 0u);
    zassert_equal(k_sem_take(&hal.wake, K_NO_WAIT), 0);
    k_busy_wait(20000);
    zassert_equal(k_sem_take(&hal.wake, K_MSEC(1)), 0);
    uint32_t more = 0u;
    while (k_sem_take(&hal.wake, K_NO_WAIT) == 0) {
        more++;
    }
    zassert_true(more <= 1u, "20 ms late: no burst of ticks");
}
