/*
 * FSM-6 by brute force: 200,000 random steps in each topology, with healthy periods so that every state is reached. The
 * oracle checks every sent frame. This test checks every step out of the latch.
 */
#include <stdio.h>

#include "agv/names.h"
#include "fixture.h"
#include "unity.h"
#include "walk.h"

enum { STEPS = 200000 };

static fixture_t f;
static uint32_t random_state;

/* Statistics. */
static uint32_t steps_in[5]; /* INIT, STANDBY, ACTIVE, TRIPPED, SAFE */
static uint32_t resets;
static uint32_t restarts;
static uint32_t malformed;

/* Reported button 1 and mode. */
static bool down;
static uint32_t pressed_ms;  /* last rising edge */
static uint32_t released_ms; /* last falling edge */
static uint32_t held_ms;     /* of the press that ended then */
static uint32_t unwell_ms;   /* last report of another mode than manual */

void setUp(void) {
    fixture_init(&f);
    f.long_run = true;
}

static uint32_t draw(uint32_t below) {
    random_state = random_state * 1664525u + 1013904223u;
    return (random_state >> 8) % below;
}

static bool one_in(uint32_t times) {
    return draw(times) == 0;
}

/* ---- Random frames ---- */

static uint32_t any_id(void) {
    static const uint32_t IDS[] = {0x43F, 0x168, 0x075, 0x065, 0x363, 0x0A3, 0x050,
                                   0x067, 0x167, 0x267, 0x101, 0x201, 0x203};
    return one_in(20) ? draw(0x800) : IDS[draw(sizeof IDS / sizeof IDS[0])];
}

static uint8_t any_byte(void) {
    static const uint8_t LIKELY[] = {0, 1, 2, 4, 8, 0x40, 0x80, 0x70, 0xFF, 0x23, 0x28};
    return one_in(2) ? LIKELY[draw(sizeof LIKELY)] : (uint8_t)draw(256);
}

static hal_can_frame_t any_frame(void) {
    hal_can_frame_t frame = {.id = any_id(), .length = 8};
    if (one_in(5)) {
        frame.length = (uint8_t)draw(9);
    }
    if (one_in(10)) {
        frame.flags = (uint8_t)draw(16);
    }
    for (unsigned i = 0; i < frame.length; i++) {
        frame.data[i] = any_byte();
    }
    malformed += (frame.flags != 0 || frame.length != 8) ? 1 : 0;
    return frame;
}

/* Record the button and the mode of a frame that the supervisor accepts. */
static void note_button(hal_can_side_t side, const hal_can_frame_t *frame) {
    const bool is_status = side == HAL_CAN_VEHICLE && frame->id == 0x363 && frame->flags == 0 && frame->length == 8;
    if (!is_status) {
        return;
    }
    const bool is_down = (frame->data[6] & BUTTON_1) != 0;
    if (is_down && !down) {
        pressed_ms = f.now_ms;
    }
    if (!is_down && down) {
        released_ms = f.now_ms;
        held_ms = f.now_ms - pressed_ms;
    }
    down = is_down;
    if ((frame->data[6] & MODE_BOTH) != MODE_MANUAL) {
        unwell_ms = f.now_ms;
    }
}

static bool note_traffic(fixture_t *fixture, agv_message_t message, hal_can_frame_t *frame) {
    note_button(fixture->traffic[message].side, frame);
    return true;
}

static void hand_over_random_frames(void) {
    for (uint32_t i = draw(6); i > 0; i--) {
        const hal_can_side_t side = one_in(2) ? HAL_CAN_AI : HAL_CAN_VEHICLE;
        const hal_can_frame_t frame = any_frame();
        note_button(side, &frame);
        fixture_raw(&f, side, frame);
    }
}

/* ---- Random vehicle ---- */

static void heal(void) {
    fixture_vehicle_confirms(&f);
    fixture_angle(&f, ANGLE_CENTRE);
    walk_alarm(&f, ALARM_NONE);
    f.traffic[AGV_MSG_EPS_STATUS].data[7] = 0;
    f.traffic[AGV_MSG_EPS_STATUS].data[3] = 1;
    for (unsigned i = 0; i < AGV_MSG_COUNT; i++) {
        f.traffic[i].muted = false;
        f.traffic[i].frozen = false;
    }
    sim_hal_set_can_state(&f.hal, HAL_CAN_VEHICLE, HAL_CAN_ERROR_ACTIVE);
    sim_hal_set_full(&f.hal, HAL_CAN_VEHICLE, false);
    sim_hal_set_full(&f.hal, HAL_CAN_AI, false);
    sim_hal_set_tx_pending_ms(&f.hal, HAL_CAN_VEHICLE, 0);
}

static void hurt_a_message(void) {
    switch (draw(5)) {
    case 0:
        f.traffic[draw(AGV_MSG_COUNT)].muted = true;
        break;
    case 1:
        f.traffic[draw(AGV_MSG_COUNT)].frozen = true;
        break;
    case 2:
        walk_alarm(&f, any_byte());
        break;
    case 3:
        f.traffic[AGV_MSG_EPS_STATUS].data[7] = any_byte();
        break;
    default:
        f.traffic[AGV_MSG_EPS_STATUS].data[3] = any_byte();
        break;
    }
}

static void hurt_the_vehicle(void) {
    static const uint8_t MODES[] = {MODE_MANUAL, MODE_ENGAGED, MODE_NEITHER, MODE_BOTH};
    switch (draw(6)) {
    case 0:
        fixture_mode(&f, MODES[draw(4)]);
        break;
    case 1:
        fixture_gear(&f, any_byte());
        break;
    case 2:
        fixture_wheels(&f, (int32_t)draw(2000) - 1000, (int32_t)draw(200) - 100);
        break;
    case 3:
        fixture_angle(&f, (uint16_t)draw(19000));
        break;
    case 4:
        fixture_throttle(&f, any_byte());
        break;
    default:
        fixture_speed(&f, (uint16_t)draw(4000));
        break;
    }
}

static void hurt_a_bus(void) {
    switch (draw(3)) {
    case 0:
        sim_hal_set_can_state(&f.hal, HAL_CAN_VEHICLE, (hal_can_state_t)draw(3));
        break;
    case 1:
        sim_hal_set_full(&f.hal, one_in(2) ? HAL_CAN_AI : HAL_CAN_VEHICLE, one_in(2));
        break;
    default:
        sim_hal_add_overrun(&f.hal, HAL_CAN_VEHICLE);
        break;
    }
}

static void hurt(void) {
    static void (*const WAYS[])(void) = {hurt_a_message, hurt_a_message, hurt_the_vehicle, hurt_the_vehicle,
                                         hurt_a_bus};
    WAYS[draw(5)]();
}

static void drive_the_vehicle(void) {
    fixture_mode(&f, MODE_ENGAGED);
    fixture_gear(&f, GEAR_D);
    fixture_drive(&f, 900);
}

/* ---- Steps ---- */

static unsigned index_of(agv_state_t state) {
    static const agv_state_t STATES[] = {AGV_STATE_INIT, AGV_STATE_STANDBY, AGV_STATE_ACTIVE, AGV_STATE_TRIPPED,
                                         AGV_STATE_SAFE};
    unsigned i = 0;
    while (i < 5 && STATES[i] != state) {
        i++;
    }
    TEST_ASSERT_TRUE_MESSAGE(i < 5, "no state");
    return i;
}

static bool is_latched(agv_state_t state) {
    return state == AGV_STATE_TRIPPED || state == AGV_STATE_SAFE;
}

static bool may_be_closed(agv_state_t state) {
    static const agv_fault_t OPENING[] = {AGV_FAULT_BUS_OFF, AGV_FAULT_TX_STALLED, AGV_FAULT_SAFE_STATE_UNCONFIRMED,
                                          AGV_FAULT_VEHICLE_NOT_STOPPING, AGV_FAULT_MOVING_WHILE_SAFE};
    bool closable = state != AGV_STATE_INIT;
    for (unsigned i = 0; i < sizeof OPENING / sizeof OPENING[0]; i++) {
        closable = closable && !fixture_has(&f, OPENING[i]);
    }
    return closable;
}

/* No trip cause is active in ACTIVE. The output is not closed while it must be open. */
static void judge_moment(agv_state_t state) {
    const agv_fault_set_t trips = agv_supervisor_active_trips(&f.supervisor);
    if (state == AGV_STATE_ACTIVE) {
        TEST_ASSERT_EQUAL_STRING(
            "", agv_fault_first(&trips) == AGV_FAULT_NONE ? "" : agv_fault_name((agv_fault_t)agv_fault_first(&trips)));
    }
    TEST_ASSERT_TRUE(may_be_closed(state) || !f.hal.safety_output.on);
}

/* The latch may only end in STANDBY, and only in a step that releases the button after 1 s to 5 s, with manual reported
 * for the whole last second. */
static void judge_step(agv_state_t before, uint32_t before_ms) {
    const agv_state_t after = agv_supervisor_state(&f.supervisor);
    steps_in[index_of(after)]++;
    judge_moment(after);
    if (is_latched(before) && !is_latched(after)) {
        TEST_ASSERT_EQUAL_HEX8(AGV_STATE_STANDBY, after);
        TEST_ASSERT_TRUE(f.now_ms - released_ms <= f.now_ms - before_ms);
        TEST_ASSERT_TRUE(held_ms >= 1000 && held_ms <= 5000);
        TEST_ASSERT_TRUE(f.now_ms - unwell_ms >= 1000);
        resets++;
    }
    if (!is_latched(before) && is_latched(after)) {
        TEST_ASSERT_NOT_EQUAL(AGV_FAULT_NONE, agv_supervisor_first_reason(&f.supervisor));
    }
    TEST_ASSERT_FALSE(before != AGV_STATE_INIT && after == AGV_STATE_INIT);
    TEST_ASSERT_EQUAL_UINT32(
        0, agv_supervisor_counters(&f.supervisor)->gate_refused); /* no module passes such a frame to the gate */
}

static void restart(void) {
    const hal_reset_cause_t cause = one_in(2) ? HAL_RESET_POWER_ON : (hal_reset_cause_t)draw(HAL_RESET_UNKNOWN + 1u);
    fixture_restart(&f, cause);
    restarts++;
    TEST_ASSERT_EQUAL_HEX8(cause == HAL_RESET_POWER_ON ? AGV_STATE_INIT : AGV_STATE_TRIPPED,
                           agv_supervisor_state(&f.supervisor));
    unwell_ms = f.now_ms;
}

/* Periods: a healthy vehicle, an engaged one, a faulty one, or random input. */
static void step(uint32_t stretch) {
    const agv_state_t before = agv_supervisor_state(&f.supervisor);
    const uint32_t before_ms = f.now_ms;
    if (stretch >= 5) {
        hand_over_random_frames();
    }
    if (stretch >= 4 && one_in(40)) {
        hurt();
    }
    if (one_in(50)) {
        fixture_jump(&f, 1 + draw(20));
    } else {
        fixture_run(&f, 1);
    }
    judge_step(before, before_ms);
}

/* In the last 1.5 s of the period the button is pressed, and released 30 ms before its end. */
static bool presses_at_last(uint32_t stretch) {
    return stretch == 1 || stretch == 2;
}

enum { PRESS_MS = 1500, RELEASE_MS = 30 };

static void follow_press(uint32_t stretch, uint32_t left) {
    if (presses_at_last(stretch) && (left == PRESS_MS || left == RELEASE_MS)) {
        fixture_button(&f, left == PRESS_MS);
    }
}

static void begin_stretch(uint32_t stretch) {
    if (stretch <= 4) {
        heal();
    }
    if (stretch == 3) {
        drive_the_vehicle();
    }
    fixture_button(&f, !presses_at_last(stretch) && one_in(4));
    if (one_in(12)) {
        restart();
    }
}

static void run_randomly(uint16_t topology, uint32_t seed) {
    random_state = seed;
    f.config.topology = topology;
    f.config.gateway_in_manual = (uint16_t)(topology == AGV_TOPOLOGY_GATEWAY ? draw(2) : 0); /* else refused */
    f.config.park = (uint16_t)draw(2);
    f.edit = note_traffic;
    fixture_start(&f);
    f.hal.config.watchdog_ms = SIM_HAL_WATCHDOG_OFF;
    unwell_ms = f.now_ms;
    uint32_t stretch = 0;
    uint32_t left = 0;
    for (uint32_t i = 0; i < STEPS; i++) {
        if (left == 0) {
            stretch = stretch == 2 ? 3 : draw(8); /* a reset, then the vehicle is engaged */
            left = 400 + draw(2500) + (presses_at_last(stretch) ? 1500 : 0);
            begin_stretch(stretch);
        }
        left--;
        follow_press(stretch, left);
        step(stretch);
    }
}

static void expect_everything_was_seen(const char *topology) {
    (void)printf("FSM-6, %s: %u frames judged, %u passed in STANDBY and ACTIVE, %u malformed received, %u resets, "
                 "%u restarts; steps in INIT %u, STANDBY %u, ACTIVE %u, TRIPPED %u, SAFE %u\n",
                 topology, (unsigned)f.oracle.judged, (unsigned)f.oracle.others, (unsigned)malformed, (unsigned)resets,
                 (unsigned)restarts, (unsigned)steps_in[0], (unsigned)steps_in[1], (unsigned)steps_in[2],
                 (unsigned)steps_in[3], (unsigned)steps_in[4]);
    TEST_ASSERT_EQUAL_STRING("", oracle_verdict(&f.oracle));
    for (unsigned i = 0; i < 5; i++) {
        TEST_ASSERT_TRUE_MESSAGE(steps_in[i] >= 500, "a state was hardly seen");
        steps_in[i] = 0;
    }
    TEST_ASSERT_TRUE(f.oracle.judged >= 10000);
    TEST_ASSERT_TRUE(malformed >= 10000);
    TEST_ASSERT_TRUE(resets >= 3);
    TEST_ASSERT_TRUE(restarts >= 3);
    malformed = 0;
    resets = 0;
    restarts = 0;
}

/* Shows: FSM-6, FSM-3, FSM-4, FSM-7, FSM-11, INT-2 */
void test_random_input_on_the_shared_bus(void) {
    run_randomly(AGV_TOPOLOGY_SHARED, 20261121);
    expect_everything_was_seen("shared bus");
}

/* Shows: FSM-6, FSM-3, FSM-4, FSM-7, FSM-11, INT-2, TOP-2 */
void test_random_input_in_the_gateway(void) {
    run_randomly(AGV_TOPOLOGY_GATEWAY, 1121);
    expect_everything_was_seen("gateway");
}
