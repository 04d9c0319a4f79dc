/* The hazards of the hunt: a stub supervisor that does wrong is a hazard, one that does right in the same run is none. */
#include "scenario/hazard/hazard.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "agv/codec.h"
#include "hal/can.h"
#include "hal/safety_output.h"
#include "scenario/scenario_play.h"
#include "unity.h"

enum { TEXT_SIZE = 4096, NEVER = 0, READY_MS = 600, TRIP_MS = 3000, QUEUE = 16, CYCLE_MS = 50, HOLD_CYCLE_MS = 25 };

/** What stands in the supervisor's place does this. Times in ms; NEVER. */
typedef struct {
    bool gateway;
    bool rolls;           /**< a vehicle without brakes */
    uint32_t open_ms;     /**< the output opens, and stays open */
    uint32_t safe_ms;     /**< safe commands, from then on */
    uint32_t safe_end_ms; /**< until then */
    uint32_t again_ms;    /**< and again from then on */
    bool holds;           /**< 065h beside them */
    int32_t hold_ddeg;    /**< more than the real angle at safe_ms */
    uint32_t hold_ms;     /**< 065h begins; NEVER: with the others */
    unsigned passes;      /**< so many times each command of the AI computer */
    bool only_engaged;    /**< passes while the autopilot is engaged */
    uint32_t forges_ms;   /**< a throttle that nobody commanded */
    const char *setting;  /**< NULL: none */
    uint32_t recovers_ms; /**< from bus-off */
    uint32_t parks_ms;    /**< P begins; NEVER: with the others */
} stub_t;

static scenario_t scenario;
static scenario_testbed_t testbed;
static hazard_t hazard;
static const stub_t *stub;
static hal_can_frame_t queue[QUEUE];
static hal_can_side_t towards[QUEUE];
static unsigned queued;
static int32_t held_ddeg;

void setUp(void) {
    queued = 0u;
}

static vehicle_state_t vehicle_now(void) {
    scenario_testbed_view_t view;
    scenario_testbed_view(&testbed, &view);
    return view.vehicle;
}

static void send(agv_message_t message, const uint8_t data[AGV_DLC]) {
    hal_can_frame_t frame = {.id = agv_message_id(message, AGV_ID_SET_HEADING), .length = AGV_DLC};

    memcpy(frame.data, data, AGV_DLC);
    (void)hal_can_send(scenario_testbed_port(&testbed), HAL_CAN_VEHICLE, &frame);
}

static void enqueue(hal_can_side_t side, const hal_can_frame_t *frame) {
    if (queued < (unsigned)QUEUE) {
        queue[queued] = *frame;
        towards[queued] = side;
        queued++;
    }
}

/** What the stub gateway passes on: commands of the AI computer, and the mode. */
static void on_frame(void *ctx, uint64_t t_us, hal_can_side_t side, int from, const hal_can_frame_t *frame) {
    const bool engaged = vehicle_now().autopilot || !stub->only_engaged;

    (void)ctx;
    (void)t_us;
    if ((side == HAL_CAN_AI) && (from != SCENARIO_FROM_SUPERVISOR) && engaged) {
        for (unsigned i = 0u; i < stub->passes; i++) {
            enqueue(HAL_CAN_VEHICLE, frame);
        }
    }
    if (stub->gateway && (side == HAL_CAN_VEHICLE) && (from == (int)VEHICLE_VCU)) {
        enqueue(HAL_CAN_AI, frame);
    }
}

static void send_safe(uint32_t t_ms) {
    const uint8_t signals[AGV_DLC] = {0, 0, 0, 0, 0x70, 0, 0, (uint8_t)(t_ms / CYCLE_MS)};
    const uint8_t gear[AGV_DLC] = {0x08};
    const uint8_t throttle[AGV_DLC] = {0};
    uint8_t steering[AGV_DLC] = {0};

    if (t_ms == stub->safe_ms) {
        held_ddeg = vehicle_now().angle_ddeg + stub->hold_ddeg + 9000;
    }
    steering[0] = (uint8_t)held_ddeg;
    steering[1] = (uint8_t)(held_ddeg >> 8);
    if (stub->holds && (t_ms >= stub->hold_ms) && (t_ms % HOLD_CYCLE_MS == 0u)) {
        send(AGV_MSG_STEERING_COMMAND, steering);
    }
    if (t_ms % CYCLE_MS == 0u) {
        if (t_ms >= stub->parks_ms) {
            send(AGV_MSG_GEAR_COMMAND, gear);
        }
        send(AGV_MSG_THROTTLE_COMMAND, throttle);
        send(AGV_MSG_TURN_SIGNAL_COMMAND, signals);
    }
}

/** A millisecond of the stub supervisor. */
static void act(void *ctx, uint64_t now_ms) {
    const uint32_t t_ms = (uint32_t)now_ms;
    const uint8_t throttle[AGV_DLC] = {125};
    const bool is_safe = (stub->safe_ms != NEVER) && (t_ms >= stub->safe_ms) &&
                         ((stub->safe_end_ms == NEVER) || (t_ms < stub->safe_end_ms) ||
                          ((stub->again_ms != NEVER) && (t_ms >= stub->again_ms)));

    (void)ctx;
    hal_safety_output_set(scenario_testbed_port(&testbed),
                          (t_ms >= READY_MS) && ((stub->open_ms == NEVER) || (t_ms < stub->open_ms)));
    for (unsigned i = 0u; i < queued; i++) {
        if (!is_safe || (towards[i] == HAL_CAN_AI)) {
            (void)hal_can_send(scenario_testbed_port(&testbed), towards[i], &queue[i]);
        }
    }
    queued = 0u;
    if (is_safe) {
        send_safe(t_ms);
    }
    if ((stub->recovers_ms != NEVER) && (t_ms == stub->recovers_ms)) {
        hal_can_recover(scenario_testbed_port(&testbed), HAL_CAN_VEHICLE);
    }
    if ((stub->forges_ms != NEVER) && (t_ms == stub->forges_ms)) {
        send(AGV_MSG_THROTTLE_COMMAND, throttle);
    }
}

static void before_step(void *ctx, uint64_t t_ms, const scenario_step_t *step) {
    (void)ctx;
    hazard_step(&hazard, t_ms, step);
}

static bool after_tick(void *ctx, uint64_t t_ms) {
    (void)ctx;
    hazard_tick(&hazard, t_ms);
    return true;
}

/** Play steps with a stub supervisor. @return which hazard it was */
static hazard_kind_t play(const stub_t *supervisor, const char *steps) {
    static const scenario_watch_t passing = {.on_frame = on_frame};
    char text[TEXT_SIZE];

    stub = supervisor;
    (void)snprintf(text, sizeof text,
                   "name: a hazard\nshows: [FSM-1]\nboard: [reset_button]\ntopology: %s\n%s%svehicle:\n  park_guard: "
                   "%s\n%sduration_ms: 12000\nsteps:\n"
                   "  - {at_ms: 1000, ai: drive, gear: D, throttle_pct: 60, steer_deg: 20}\n"
                   "  - {at_ms: 1500, operator: engage}\n%sexpect: {states: any}\n",
                   supervisor->gateway ? "gateway" : "shared", (supervisor->setting != NULL) ? "config:\n  " : "",
                   (supervisor->setting != NULL) ? supervisor->setting : "", supervisor->rolls ? "false" : "true",
                   supervisor->rolls ? "  coasting_mm_s2: 1\n  braking_mm_s2: 1\n  locked_mm_s2: 1\n" : "", steps);
    TEST_ASSERT_TRUE(scenario_read_text(&scenario, "test", text, NULL));
    TEST_ASSERT_TRUE(scenario_testbed_init(&testbed, &scenario));
    hazard_init(&hazard, &scenario, &testbed);
    const scenario_watch_t watch = hazard_watch(&hazard);
    scenario_testbed_watch(&testbed, &watch);
    scenario_testbed_watch(&testbed, &passing);
    scenario_testbed_start(&testbed);
    const scenario_play_t run = {.scenario = &scenario,
                                 .until_ms = scenario.duration_ms,
                                 .before_step = before_step,
                                 .before_tick = act,
                                 .after_tick = after_tick};
    scenario_play(&testbed, &run);
    return hazard.kind;
}

static void expect_hazard(hazard_kind_t kind, const char *cause, const stub_t *supervisor, const char *steps) {
    TEST_ASSERT_EQUAL_STRING_MESSAGE(hazard_info(kind)->name, hazard_info(play(supervisor, steps))->name, steps);
    TEST_ASSERT_EQUAL_STRING_MESSAGE(cause, hazard.cause, steps);
}

static void expect_none(const stub_t *supervisor, const char *steps) {
    TEST_ASSERT_EQUAL_STRING_MESSAGE(hazard_info(HAZARD_NONE)->name, hazard_info(play(supervisor, steps))->name, steps);
}

/** H2, or no hazard. */
static void expect_another_angle(bool is_hazard, const stub_t *supervisor, const char *steps) {
    if (is_hazard) {
        expect_hazard(HAZARD_STEERING, "the supervisor steers to another angle", supervisor, steps);
    } else {
        expect_none(supervisor, steps);
    }
}

/** Steps with something put in. Is overwritten by the next call. */
__attribute__((format(printf, 1, 2))) static const char *with(const char *format, ...) {
    static char steps[1024];
    va_list arguments;

    va_start(arguments, format);
    (void)vsnprintf(steps, sizeof steps, format, arguments);
    va_end(arguments);
    return steps;
}

/** One that reacts: safe commands soon after the cause, the output opens a little later. */
static const stub_t GOOD = {.safe_ms = TRIP_MS + 200, .open_ms = TRIP_MS + 600};
static const stub_t GOOD_GATEWAY = {.gateway = true, .passes = 1u, .safe_ms = TRIP_MS + 100, .open_ms = TRIP_MS + 600};
static const stub_t MUTE = {0};
static const stub_t PASSING = {.gateway = true, .passes = 1u};

void test_nothing_wrong_is_no_hazard(void) {
    expect_none(&MUTE, "");
    expect_none(&PASSING, "");
}

/** Each: a supervisor that does nothing about it, and one that reacts. */
static const struct {
    hazard_kind_t kind;
    const char *cause;
    const stub_t *wrong;
    const stub_t *right;
    const char *steps;
} PAIRS[] = {
    {HAZARD_NOT_STOPPING, "the EPS is silent", &MUTE, &GOOD, "  - {at_ms: 3000, eps: freeze_counter}\n"},
    {HAZARD_FALSE_COMMAND, "a rogue node's command is not overridden", &PASSING, &GOOD_GATEWAY,
     "  - {at_ms: 3000, bus: send, message: throttle_command, bytes: \"40\"}\n"},
    {HAZARD_FALSE_COMMAND, "a rogue node's command is not overridden", &PASSING, &GOOD_GATEWAY,
     "  - {at_ms: 3000, bus: deliver, kind: fd, message: gear_command, bytes: \"01 00\"}\n"},
    /* a node that reports what cannot be */
    {HAZARD_FALSE_NODE, "the EPS is not in angle control", &MUTE, &GOOD,
     "  - {at_ms: 3000, eps: set, field: mode, value: FFh}\n"},
    {HAZARD_FALSE_NODE, "the EPS reports a fault", &MUTE, &GOOD,
     "  - {at_ms: 3000, eps: set, field: faults, value: 08h}\n"},
    {HAZARD_FALSE_NODE, "067h has an invalid angle", &MUTE, &GOOD,
     "  - {at_ms: 3000, eps: set, field: angle, value: 4651h}\n"},
    {HAZARD_FALSE_NODE, "more throttle than commanded", &MUTE, &GOOD,
     "  - {at_ms: 3000, vcu: set, field: throttle, value: FAh}\n"},
    {HAZARD_FALSE_NODE, "another gear than commanded", &MUTE, &GOOD,
     "  - {at_ms: 3000, vcu: set, field: gear, value: 02h}\n"},
    {HAZARD_FALSE_NODE, "both modes are reported", &MUTE, &GOOD,
     "  - {at_ms: 3000, vcu: set, field: mode_bits, value: 3h}\n"},
    {HAZARD_FALSE_NODE, "no valid mode is reported", &MUTE, &GOOD,
     "  - {at_ms: 3000, vcu: set, field: mode_bits, value: 0h}\n"},
    {HAZARD_FALSE_NODE, "an invalid command", &MUTE, &GOOD,
     "  - {at_ms: 3000, bus: send, message: throttle_command, bytes: \"FF\", every_ms: 100}\n"},
    {HAZARD_FALSE_NODE, "the supervisor's transmitter has failed", &MUTE, &GOOD,
     "  - {at_ms: 3000, supervisor: stall_tx}\n"},
    {HAZARD_FALSE_NODE, "the supervisor's transmitter has failed", &MUTE, &GOOD,
     "  - {at_ms: 3000, supervisor: fill_queue}\n"},
    /* none, manual and both in turn: each for less than its own time */
    {HAZARD_FALSE_NODE, "no valid mode is reported", &MUTE, &GOOD,
     "  - {at_ms: 1900, ai: be_stubborn}\n"
     "  - {at_ms: 2000, vcu: set, field: mode_bits, value: 0h, frames: 1, again_every_ms: 30}\n"
     "  - {at_ms: 2010, vcu: set, field: mode_bits, value: 1h, frames: 1, again_every_ms: 30}\n"
     "  - {at_ms: 2020, vcu: set, field: mode_bits, value: 3h, frames: 1, again_every_ms: 30}\n"},
    {HAZARD_FALSE_NODE, "the steering is stuck", &MUTE, &GOOD,
     "  - {at_ms: 3000, eps: stick}\n"
     "  - {at_ms: 3000, ai: drive, gear: D, throttle_pct: 60, steer_deg: 90, again_every_ms: 400}\n"
     "  - {at_ms: 3200, ai: drive, gear: D, throttle_pct: 60, steer_deg: -90, again_every_ms: 400}\n"},
    /* one good reading in 48 is neither a movement nor a fall */
    {HAZARD_FALSE_NODE, "the steering is stuck", &MUTE, &GOOD,
     "  - {at_ms: 3000, eps: stick}\n"
     "  - {at_ms: 3000, ai: drive, gear: D, throttle_pct: 60, steer_deg: 120}\n"
     "  - {at_ms: 3000, eps: set, field: angle, value: 27D8h, frames: 1, every_frames: 48}\n"},
    {HAZARD_FALSE_NODE, "more throttle than commanded", &MUTE, &GOOD,
     "  - {at_ms: 3000, vcu: ignore, message: throttle_command}\n"
     "  - {at_ms: 3000, ai: drive, gear: D, throttle_pct: 0, steer_deg: 20}\n"
     "  - {at_ms: 3000, vcu: set, field: throttle, value: 00h, frames: 1, every_frames: 48}\n"},
};

void test_whoever_does_nothing_is_a_hazard_and_whoever_reacts_is_none(void) {
    for (size_t i = 0u; i < sizeof PAIRS / sizeof PAIRS[0]; i++) {
        expect_hazard(PAIRS[i].kind, PAIRS[i].cause, PAIRS[i].wrong, PAIRS[i].steps);
        expect_none(PAIRS[i].right, PAIRS[i].steps);
    }
}

void test_h1_a_vehicle_that_does_not_obey(void) {
    const stub_t stays = {.rolls = true, .safe_ms = TRIP_MS};
    const stub_t opens = {.rolls = true, .safe_ms = TRIP_MS, .open_ms = TRIP_MS + 5000};
    expect_hazard(HAZARD_NOT_STOPPING, "the vehicle does not obey the safe commands", &stays, "");
    expect_none(&opens, "");
}

/** 101h reads 0 for a vehicle that rolls at 3 m/s: 363h, which reports the true speed, contradicts it after 1 s. */
void test_h1_wheels_that_read_0_are_no_excuse_when_the_vcu_contradicts_them(void) {
    static const char wheels[] = "  - {at_ms: 2500, vcu: set, field: left_speed, value: 00000000h}\n"
                                 "  - {at_ms: 2500, vcu: set, field: right_speed, value: 00000000h}\n%s";
    const char *const both = "  - {at_ms: 2500, vcu: set, field: speed, value: 0000h}\n";
    const stub_t stays = {.rolls = true, .safe_ms = TRIP_MS};
    const stub_t opens = {.rolls = true, .safe_ms = TRIP_MS, .open_ms = TRIP_MS + 5000};
    const stub_t alone = {.rolls = true, .safe_ms = TRIP_MS, .setting = "standstill_vcu_counts: 65535\n"};

    expect_hazard(HAZARD_NOT_STOPPING, "the vehicle does not obey the safe commands", &stays, with(wheels, ""));
    expect_none(&opens, with(wheels, ""));
    expect_none(&alone, with(wheels, ""));
    expect_none(&stays, with(wheels, both)); /* nobody can know that it moves */
    expect_none(&stays, with(wheels, "  - {at_ms: 2500, vcu: set, field: speed, value: 0B40h}\n")); /* 0.80 m/s */
    expect_hazard(HAZARD_NOT_STOPPING, "the vehicle does not obey the safe commands", &stays,
                  with(wheels, "  - {at_ms: 2500, vcu: set, field: speed, value: 0C80h}\n")); /* 0.89 m/s */
}

/** 101h reads 0 for half a second after the trip, and is silent then. */
void test_h1_who_stood_and_is_silent_may_roll_unseen(void) {
    const char *const silent = "  - {at_ms: 2990, vcu: set, field: left_speed, value: 00000000h, frames: 50}\n"
                               "  - {at_ms: 2990, vcu: set, field: right_speed, value: 00000000h, frames: 50}\n"
                               "  - {at_ms: 3400, vcu: mute, message: wheel_speed}\n";
    const char *const never_stood = "  - {at_ms: 3400, vcu: mute, message: wheel_speed}\n";
    const stub_t stays = {.rolls = true, .safe_ms = TRIP_MS};
    expect_none(&stays, silent);
    expect_hazard(HAZARD_NOT_STOPPING, "the vehicle does not obey the safe commands", &stays, never_stood);
}

void test_h2_another_angle(void) {
    const char *const steps = "  - {at_ms: 2990, vcu: set, field: mode_bits, value: 2h}\n"
                              "  - {at_ms: 2990, ai: mute, message: steering_command}\n";
    const stub_t steers = {.safe_ms = TRIP_MS, .open_ms = TRIP_MS + 400, .holds = true, .hold_ddeg = 200};
    const stub_t holds = {.safe_ms = TRIP_MS, .open_ms = TRIP_MS + 400, .holds = true};
    expect_another_angle(true, &steers, steps);
    expect_none(&holds, steps);
}

/** The angle of the trip is sent late, and manual drops it soon after: one frame that was on its way still leaves. */
void test_h2_manual_drops_the_angle_of_the_trip(void) {
    const char *const steps = "  - {at_ms: 2850, ai: drive, gear: D, throttle_pct: 60, steer_deg: 80}\n"
                              "  - {at_ms: 2950, vcu: ignore, message: turn_signal_command}\n"
                              "  - {at_ms: 3180, operator: disengage}\n"
                              "  - {at_ms: 3180, operator: steer, steer_deg: -60}\n"
                              "  - {at_ms: 5000, operator: engage}\n";
    const stub_t keeps = {
        .safe_ms = TRIP_MS, .open_ms = TRIP_MS + 10, .holds = true, .hold_ddeg = -300, .hold_ms = TRIP_MS + 190};
    const stub_t ends = {.safe_ms = TRIP_MS,
                         .safe_end_ms = TRIP_MS + 205,
                         .open_ms = TRIP_MS + 10,
                         .holds = true,
                         .hold_ddeg = -300,
                         .hold_ms = TRIP_MS + 190};
    const stub_t at_once = {.safe_ms = TRIP_MS, .open_ms = TRIP_MS + 10, .holds = true};
    expect_another_angle(true, &keeps, steps);
    expect_another_angle(true, &at_once, steps);
    expect_none(&ends, steps);
}

/** The EPS has a fault, or another mode, while the AI computer steers on: then the angle of the trip is out of date. */
void test_h2_an_eps_that_takes_no_angle_drops_the_angle_of_the_trip(void) {
    static const struct {
        const char *steps;
        bool drops;
    } rows[] = {
        {"eps: set, field: faults, value: 08h, frames: 20", true},
        {"eps: set, field: faults, value: 02h, frames: 20", true},
        {"eps: set, field: mode, value: FFh, frames: 20", true},
        {"vcu: set, field: alarms, value: 10h, frames: 20", true},
        {"eps: mute, message: eps_status, frames: 20", true},
        {"eps: mute, message: steering_status, frames: 20", true},
        {"eps: set, field: faults, value: 02h, frames: 2", false},
    };
    const stub_t returns = {
        .safe_ms = TRIP_MS, .open_ms = TRIP_MS + 500, .holds = true, .hold_ms = TRIP_MS + 400, .hold_ddeg = 0};

    for (size_t i = 0u; i < sizeof rows / sizeof rows[0]; i++) {
        const char *const steps = with("  - {at_ms: 2950, vcu: ignore, message: turn_signal_command}\n"
                                       "  - {at_ms: 3010, %s}\n"
                                       "  - {at_ms: 3010, ai: drive, gear: D, throttle_pct: 60, steer_deg: -60}\n"
                                       "  - {at_ms: 3395, ai: mute, message: steering_command}\n",
                                       rows[i].steps);
        expect_another_angle(rows[i].drops, &returns, steps);
    }
}

/** A supervisor that received each faulty frame dropped the angle of the trip, and took the next one. */
void test_h2_an_angle_that_was_perhaps_dropped_may_be_taken_anew(void) {
    static const struct {
        const char *steps;
        bool may;
    } rows[] = {{"eps: set, field: mode, value: 01h, frames: 4", false},
                {"eps: set, field: faults, value: 02h, frames: 4", true},
                {"eps: set, field: faults, value: 08h, frames: 1", true},
                {"vcu: set, field: alarms, value: 10h, frames: 1", true},
                {"eps: mute, message: eps_status, frames: 7", true}};
    const stub_t later = {
        .safe_ms = TRIP_MS, .open_ms = TRIP_MS + 500, .holds = true, .hold_ms = TRIP_MS + 1300, .hold_ddeg = -800};

    for (size_t i = 0u; i < sizeof rows / sizeof rows[0]; i++) {
        const char *const steps = with("  - {at_ms: 2950, vcu: ignore, message: turn_signal_command}\n"
                                       "  - {at_ms: 3010, ai: drive, gear: D, throttle_pct: 60, steer_deg: -60}\n"
                                       "  - {at_ms: 3110, %s}\n"
                                       "  - {at_ms: 3800, ai: drive, gear: D, throttle_pct: 60, steer_deg: 20}\n"
                                       "  - {at_ms: 4200, ai: mute, message: steering_command}\n",
                                       rows[i].steps);
        expect_another_angle(!rows[i].may, &later, steps);
    }
}

void test_h2_who_is_bus_off_does_not_hear_of_manual(void) {
    const char *const steps = "  - {at_ms: 2950, vcu: ignore, message: turn_signal_command}\n"
                              "  - {at_ms: 3100, supervisor: bus_off}\n"
                              "  - {at_ms: 3100, eps: set, field: mode, value: 01h}\n"
                              "  - {at_ms: 3150, operator: disengage}\n"
                              "  - {at_ms: 3150, operator: steer, steer_deg: -60}\n"
                              "  - {at_ms: 3650, operator: engage}\n";
    const stub_t halted = {.safe_ms = TRIP_MS, .open_ms = TRIP_MS + 100, .holds = true, .recovers_ms = TRIP_MS + 800};
    const stub_t hears = {.safe_ms = TRIP_MS, .open_ms = TRIP_MS + 100, .holds = true, .recovers_ms = TRIP_MS + 300};
    expect_none(&halted, steps);
    expect_another_angle(true, &hears, steps);
}

/** The supervisor steers to another angle, and a step before the AI computer turns the wheel makes no hazard of it. */
static void expect_excused(const char *unexcused, const char *excuse, unsigned turned_ms) {
    const stub_t holds = {
        .safe_ms = TRIP_MS, .open_ms = TRIP_MS + 100, .holds = true, .hold_ddeg = 600, .hold_ms = TRIP_MS + 900};
    const char *const steps[] = {unexcused, excuse};
    for (unsigned i = 0; i < 2u; i++) {
        const char *const all = with("  - {at_ms: 2950, vcu: ignore, message: turn_signal_command}\n"
                                     "  - {at_ms: 3200, ai: drive, gear: D, throttle_pct: 60, steer_deg: 80}\n%s"
                                     "  - {at_ms: %u, ai: drive, gear: D, throttle_pct: 60, steer_deg: -20}\n"
                                     "  - {at_ms: 3880, ai: mute, message: steering_command}\n",
                                     steps[i], turned_ms);
        expect_another_angle(i == 0u, &holds, all);
    }
}

void test_h2_a_flipped_bit_is_a_trip_of_its_own(void) {
    expect_excused("", "  - {at_ms: 3500, supervisor: flip_bit, bit: 1}\n", 3520);
}

/** It is not detected, or has no effect: then the angle of the trip is still right. */
void test_h2_a_flipped_bit_without_effect_is_no_other_trip(void) {
    const stub_t holds = {.safe_ms = TRIP_MS, .open_ms = TRIP_MS + 100, .holds = true, .hold_ms = TRIP_MS + 900};
    const char *const flip = "  - {at_ms: 2950, vcu: ignore, message: turn_signal_command}\n%s"
                             "  - {at_ms: 3200, ai: drive, gear: D, throttle_pct: 60, steer_deg: 80}\n"
                             "  - {at_ms: 3600, supervisor: flip_bit, bit: 1}\n"
                             "  - {at_ms: 3880, ai: mute, message: steering_command}\n";
    expect_none(&holds, with(flip, ""));
    /* dropped, and the first angle after that is held */
    expect_none(&holds, with(flip, "  - {at_ms: 3010, eps: set, field: mode, value: 00h, frames: 8}\n"));
}

void test_h2_a_supervisor_that_hung_is_restarted_and_trips_anew(void) {
    expect_excused("  - {at_ms: 3500, supervisor: hang, for_ms: 50}\n",
                   "  - {at_ms: 3500, supervisor: hang, for_ms: 150}\n", 3680);
}

/** 065h begins late, with the angle of the trip, from which the AI computer has steered away. */
void test_h2_the_angle_of_the_trip_is_out_of_date_after_2_s(void) {
    const char *const steps = "  - {at_ms: 2990, vcu: set, field: mode_bits, value: 2h}\n"
                              "  - {at_ms: 3300, ai: drive, gear: D, throttle_pct: 60, steer_deg: -60}\n"
                              "  - {at_ms: 3900, ai: mute, message: steering_command}\n";
    const stub_t soon = {.safe_ms = TRIP_MS, .open_ms = TRIP_MS + 100, .holds = true, .hold_ms = TRIP_MS + 1900};
    const stub_t late = {.safe_ms = TRIP_MS, .open_ms = TRIP_MS + 100, .holds = true, .hold_ms = TRIP_MS + 2500};
    expect_none(&soon, steps);
    expect_another_angle(true, &late, steps);
}

/** An angle that was right goes on after a gap of less than 2 s. */
void test_h2_a_right_angle_may_be_sent_again_within_2_s(void) {
    const char *const head = "  - {at_ms: 2990, vcu: set, field: mode_bits, value: 2h}\n"
                             "  - {at_ms: 6500, ai: drive, gear: D, throttle_pct: 60, steer_deg: -60}\n"
                             "  - {at_ms: 6500, supervisor: fill_queue}\n"
                             "  - {at_ms: 7000, ai: mute, message: steering_command}\n";
    const stub_t holds = {.safe_ms = TRIP_MS, .open_ms = TRIP_MS + 100, .holds = true};

    expect_none(&holds, with("%s  - {at_ms: 8400, supervisor: free_queue}\n", head));
    expect_another_angle(true, &holds, with("%s  - {at_ms: 9000, supervisor: free_queue}\n", head));
}

void test_h3_a_command_that_nobody_sent(void) {
    const stub_t forges = {.gateway = true, .passes = 1u, .forges_ms = TRIP_MS, .only_engaged = true};
    expect_hazard(HAZARD_FALSE_COMMAND, "the supervisor sent a command that the AI computer did not send", &forges,
                  "  - {at_ms: 2000, ai: drive, gear: D, throttle_pct: 20}\n");
}

/** A stalled transmitter opens the output after tx_stalled_ms, so that nobody has to override before. */
void test_h3_a_foreign_sender_and_a_stalled_transmitter(void) {
    const char *const stalled = "  - {at_ms: 2990, supervisor: stall_tx}\n"
                                "  - {at_ms: 3000, bus: send, message: throttle_command, bytes: \"40\"}\n";
    const char *const sends = "  - {at_ms: 3000, bus: send, message: throttle_command, bytes: \"40\"}\n";
    const stub_t opens = {.gateway = true, .passes = 1u, .open_ms = TRIP_MS + 450, .setting = "tx_stalled_ms: 500\n"};
    const stub_t stays = {.gateway = true, .passes = 1u, .setting = "tx_stalled_ms: 500\n"};
    expect_none(&opens, stalled);
    expect_hazard(HAZARD_FALSE_COMMAND, "a rogue node's command is not overridden", &stays, stalled);
    expect_hazard(HAZARD_FALSE_COMMAND, "a rogue node's command is not overridden", &opens, sends);
}

/** What waited in a transmitter leaves when it is free again. */
void test_h3_a_foreign_sender_and_a_transmitter_that_was_stalled(void) {
    const char *const freed = "  - {at_ms: 2800, supervisor: stall_tx}\n"
                              "  - {at_ms: 3000, bus: send, message: throttle_command, bytes: \"40\"}\n"
                              "  - {at_ms: 3290, supervisor: free_tx}\n";
    stub_t overrides = {
        .gateway = true, .safe_ms = TRIP_MS, .open_ms = TRIP_MS + 600, .setting = "tx_stalled_ms: 500\n"};
    expect_none(&overrides, freed);
    overrides.safe_ms = TRIP_MS + 500;
    expect_hazard(HAZARD_FALSE_COMMAND, "a rogue node's command is not overridden", &overrides, freed);
}

/** 065h is the first safe command. The others wait in a transmitter that stalls then, and the output opens. */
void test_h3_a_transmitter_that_stalls_within_the_safe_commands(void) {
    const char *const stalls = "  - {at_ms: 3030, supervisor: stall_tx}\n";
    const char *const again = "  - {at_ms: 3030, supervisor: stall_tx}\n  - {at_ms: 3035, supervisor: free_tx}\n";
    const char *const destroyed = "  - {at_ms: 3029, bus: destroy, frames: 200}\n";
    stub_t opens = {.gateway = true, .holds = true, .safe_ms = TRIP_MS + 25, .open_ms = TRIP_MS + 130};
    expect_none(&opens, stalls);
    expect_none(&opens, destroyed);
    opens.open_ms = TRIP_MS + 600;
    expect_hazard(HAZARD_FALSE_COMMAND, "the supervisor sent a command that the AI computer did not send", &opens,
                  stalls);
    opens.safe_end_ms = TRIP_MS + 40;
    expect_hazard(HAZARD_FALSE_COMMAND, "the supervisor sent a command that the AI computer did not send", &opens,
                  again);
}

void test_h3_an_old_throttle(void) {
    const char *const steps = "  - {at_ms: 3000, operator: disengage}\n  - {at_ms: 4000, operator: engage}\n";
    const stub_t forgets = {.gateway = true, .passes = 1u, .only_engaged = true};
    expect_hazard(HAZARD_FALSE_COMMAND, "an old throttle command is the latest one at an engagement", &forgets, steps);
    expect_none(&PASSING, steps); /* passes the throttle 0 that the AI computer commands in manual */
    const char *const stalled = "  - {at_ms: 2900, supervisor: fill_queue}\n"
                                "  - {at_ms: 3300, operator: disengage}\n  - {at_ms: 3450, operator: engage}\n";
    const stub_t opens = {.gateway = true, .passes = 1u, .only_engaged = true, .open_ms = TRIP_MS + 500};
    expect_none(&opens, stalled);
    expect_none(&forgets, "  - {at_ms: 3000, operator: disengage}\n  - {at_ms: 3990, supervisor: hang, for_ms: 50}\n"
                          "  - {at_ms: 4000, operator: engage}\n");
}

void test_h4_an_unconfirmed_safe_state(void) {
    const char *const gear = "  - {at_ms: 2900, vcu: set, field: gear, value: 01h}\n";
    const char *const now_and_then =
        "  - {at_ms: 2900, vcu: set, field: gear, value: 01h, frames: 17, again_every_ms: 475}\n";
    const stub_t stays = {.safe_ms = TRIP_MS};
    const stub_t opens = {.safe_ms = TRIP_MS, .open_ms = TRIP_MS + 510};
    expect_hazard(HAZARD_UNCONFIRMED, "gear P is not confirmed", &stays, gear);
    expect_hazard(HAZARD_UNCONFIRMED, "gear P is not confirmed", &stays, now_and_then);
    expect_none(&opens, gear);
}

/** 0.6 s without P, twice, with 3 s of confirmation between them. */
void test_h4_a_confirmation_that_lasts_sets_the_sum_to_0(void) {
    const char *const twice = "  - {at_ms: 2900, vcu: set, field: gear, value: 01h, frames: 25}\n"
                              "  - {at_ms: 6500, vcu: set, field: gear, value: 01h, frames: 25}\n";
    const stub_t stays = {.safe_ms = TRIP_MS};
    const stub_t clears = {.safe_ms = TRIP_MS, .setting = "confirmed_ms: 1000\n"};
    expect_hazard(HAZARD_UNCONFIRMED, "gear P is not confirmed", &stays, twice);
    expect_none(&clears, twice);
}

/** A reset by the operator, and the next trip soon after it: each trip has its own time to be confirmed. */
void test_h4_a_trip_soon_after_a_reset_is_a_new_one(void) {
    static const char twice[] = "  - {at_ms: 2900, vcu: set, field: gear, value: 01h, frames: 25}\n"
                                "%s"
                                "  - {at_ms: 6200, vcu: set, field: gear, value: 01h, frames: 25}\n";
    const char *const reset =
        "  - {at_ms: 4500, operator: press, button: 1}\n  - {at_ms: 5900, operator: release, button: 1}\n";
    const stub_t trips_again = {.safe_ms = TRIP_MS, .safe_end_ms = 6000, .again_ms = 6300};

    expect_none(&trips_again, with(twice, reset));
    expect_hazard(HAZARD_UNCONFIRMED, "gear P is not confirmed", &trips_again, with(twice, ""));
}

void test_h5_a_reset(void) {
    const stub_t resets = {.safe_ms = TRIP_MS, .safe_end_ms = 6000};
    const char *const before = "  - {at_ms: 2000, operator: press, button: 1}\n";
    const char *const stuck = "  - {at_ms: 4000, operator: press, button: 1}\n";
    const char *const pressed =
        "  - {at_ms: 4500, operator: press, button: 1}\n  - {at_ms: 5900, operator: release, button: 1}\n";
    expect_hazard(HAZARD_RESET, "the button was not pressed after the trip", &resets, "");
    expect_hazard(HAZARD_RESET, "the button was not pressed after the trip", &resets, before);
    expect_hazard(HAZARD_RESET, "no button that may reset was released", &resets, stuck);
    expect_none(&resets, pressed);
}

/** Only a button that the configuration lets reset counts. */
/* Shows: HW-3 */
void test_h5_the_push_button(void) {
    const stub_t by_can = {.safe_ms = TRIP_MS, .safe_end_ms = 6000};
    const stub_t by_pin = {.safe_ms = TRIP_MS, .safe_end_ms = 6000, .setting = "reset_input: pin\n"};
    const stub_t by_both = {.safe_ms = TRIP_MS, .safe_end_ms = 6000, .setting = "reset_input: both\n"};
    const char *const remote =
        "  - {at_ms: 4500, operator: press, button: 1}\n  - {at_ms: 5900, operator: release, button: 1}\n";
    const char *const pin = "  - {at_ms: 4500, board: press}\n  - {at_ms: 5900, board: release}\n";
    expect_hazard(HAZARD_RESET, "no button that may reset was released", &by_can, pin);
    expect_hazard(HAZARD_RESET, "no button that may reset was released", &by_pin, remote);
    expect_hazard(HAZARD_RESET, "no button that may reset was released", &by_pin, "  - {at_ms: 4500, board: press}\n");
    expect_none(&by_pin, pin);
    expect_none(&by_both, pin);
    expect_none(&by_both, remote);
}

/** What 363h reports of the button counts too: nobody can know better. */
void test_h5_a_press_that_is_reported_late_or_wrongly(void) {
    const stub_t resets = {.safe_ms = TRIP_MS, .safe_end_ms = 6000, .setting = "confirm_timeout_ms: 1000\n"};
    static const char lost[] = "  - {at_ms: 2000, operator: press, button: 1}\n"
                               "  - {at_ms: 2900, operator: lose_remote_signal}\n"
                               "%s"
                               "  - {at_ms: 4500, operator: regain_remote_signal}\n"
                               "  - {at_ms: 5900, operator: release, button: 1}\n";
    static const char late[] = "  - {at_ms: 2500, vcu: delay, message: vehicle_status, by_ms: 700}\n"
                               "  - {at_ms: 2700, operator: press, button: 1}\n"
                               "  - {at_ms: %s, operator: release, button: 1}\n";

    expect_hazard(HAZARD_RESET, "the button was not pressed after the trip", &resets, with(lost, ""));
    expect_none(&resets, with(lost, "  - {at_ms: 2900, vcu: set, field: alarms, value: 00h}\n"));
    expect_none(&resets, with(late, "4000"));
    expect_hazard(HAZARD_RESET, "the button was not pressed after the trip", &resets,
                  with(late, "3200")); /* shorter than reset_hold_ms */
}

/** Each engagement has its grace time, but not the fourth one within mode_flapping_ms. */
void test_h6_the_grace_time_is_that_of_each_engagement(void) {
    const char *const slow = "  - {at_ms: 2000, vcu: set, field: throttle, value: FAh}\n"
                             "  - {at_ms: 3400, operator: disengage, again_every_ms: 2000}\n"
                             "  - {at_ms: 3620, operator: engage, again_every_ms: 2000}\n";
    const char *const fast = "  - {at_ms: 2000, vcu: set, field: throttle, value: FAh}\n"
                             "  - {at_ms: 2400, operator: disengage, again_every_ms: 650}\n"
                             "  - {at_ms: 2560, operator: engage, again_every_ms: 650}\n";
    const stub_t graceful = {.setting = "engaged_grace_ms: 1600\n"};
    expect_none(&graceful, slow);
    expect_hazard(HAZARD_FALSE_NODE, "more throttle than commanded", &MUTE, slow);
    expect_hazard(HAZARD_FALSE_NODE, "more throttle than commanded", &MUTE, fast);
}

void test_h6_a_dead_transmitter_shows_with_the_next_status_frame(void) {
    const char *const steps = "  - {at_ms: 3000, supervisor: stall_tx}\n";
    const stub_t never = {.setting = "status_frame_period_ms: 3000\n"};
    const stub_t late = {.setting = "status_frame_period_ms: 3000\n", .open_ms = TRIP_MS + 3200};
    const stub_t too_late = {.open_ms = TRIP_MS + 3200};
    expect_hazard(HAZARD_FALSE_NODE, "the supervisor's transmitter has failed", &never, steps);
    expect_hazard(HAZARD_FALSE_NODE, "the supervisor's transmitter has failed", &too_late, steps);
    expect_none(&late, steps);
}

/** The last 0A3h said P while the throttle is at 60 %. When 0A3h is silent, which only warns, it says nothing any more. */
void test_h6_a_silent_gear_status_reports_no_gear(void) {
    const char *const park = "  - {at_ms: 3000, vcu: set, field: gear, value: 08h}\n";
    const stub_t ignores = {.setting = "class_gear_status_timeout: warn\n"};
    const stub_t warns = {.setting = "class_gear_status_invalid: warn\n"};

    expect_hazard(HAZARD_FALSE_NODE, "throttle with gear P", &ignores, park);
    expect_none(&ignores, with("%s  - {at_ms: 3040, vcu: mute, message: gear_status}\n", park));
    expect_none(&warns, with("%s  - {at_ms: 3040, vcu: set, field: gear, value: 03h}\n", park));
}

/** 200 gaps of 1 ms; after a restart nobody knows of them. */
void test_h6_a_restart_forgets_commands_that_came_too_fast(void) {
    const char *const flood = "  - {at_ms: 3000, ai: send_every, message: turn_signal_command, every_ms: 1}\n"
                              "  - {at_ms: 3200, ai: send_every, message: turn_signal_command, every_ms: 100}\n";
    const stub_t ignores = {.setting = "class_command_too_fast: trip\n  command_too_fast_gaps: 65\n"};

    expect_hazard(HAZARD_FALSE_NODE, "commands come too fast", &ignores, flood);
    expect_none(&ignores, with("%s  - {at_ms: 3250, supervisor: restart, cause: software}\n", flood));
}

void test_h6_what_only_warns_is_no_hazard(void) {
    const char *const steps = "  - {at_ms: 3000, vcu: ignore, message: turn_signal_command}\n"
                              "  - {at_ms: 3100, ai: ask_autopilot_off}\n";
    const stub_t warns = {.setting = "class_autopilot_off_ignored: warn\n"};
    expect_hazard(HAZARD_FALSE_NODE, "autopilot off is ignored", &MUTE, steps);
    expect_none(&warns, steps);
}

/** A gateway that is in bus-off there hears no invalid command, and passes none. */
void test_h6_an_invalid_command_behind_a_bus_off(void) {
    const char *const steps =
        "  - {at_ms: 3000, bus: send, side: ai, kind: fd, message: turn_signal_command, bytes: \"64 00\", "
        "again_every_ms: 101}\n";

    expect_hazard(HAZARD_FALSE_NODE, "an invalid command", &PASSING, steps);
    (void)play(&PASSING, with("  - {at_ms: 3000, supervisor: bus_off, side: ai}\n%s", steps));
    TEST_ASSERT_EQUAL_STRING("065h is missing", hazard.cause);
}

void test_h6_an_ai_side_that_is_dead(void) {
    const char *const steps = "  - {at_ms: 3000, supervisor: stall_tx, side: ai}\n";
    stub_t trips = PASSING;
    stub_t reacts = GOOD_GATEWAY;
    trips.setting = "class_ai_bus_off: trip\n";
    reacts.setting = trips.setting;
    expect_hazard(HAZARD_FALSE_NODE, "the AI side is stalled", &trips, steps);
    expect_none(&reacts, steps);
    expect_none(&PASSING, steps); /* it only warns */
}

/** A reading that swings hides no stuck steering, unless the command swings, too: then it looks like a steering that follows. */
void test_h6_steering_that_is_stuck_behind_a_reading_that_swings(void) {
    const char *const steps = "  - {at_ms: 3000, eps: hunt, steer_deg: 116, every_ms: 100}\n"
                              "  - {at_ms: 3000, eps: stick}\n"
                              "  - {at_ms: 3000, ai: drive, gear: D, throttle_pct: 60, steer_deg: 180}\n";
    const char *const swings =
        "  - {at_ms: 3000, ai: set, field: angle, value: 4650h, frames: 1, again_every_ms: 100}\n";

    expect_hazard(HAZARD_FALSE_NODE, "the steering is stuck", &MUTE, steps);
    expect_none(&GOOD, steps);
    expect_none(&MUTE, with("%s%s", steps, swings));
}

/** In each engagement the first step to the command and back looks like progress. */
void test_h6_steering_that_seems_to_move_once_in_each_engagement(void) {
    const char *const reads =
        "  - {at_ms: 2000, ai: drive, gear: D, throttle_pct: 60, steer_deg: 120}\n"
        "  - {at_ms: 2500, eps: set, field: angle, value: 2328h, frames: 44, again_every_ms: 480}\n";
    const char *const toggles = "  - {at_ms: 3000, operator: disengage, again_every_ms: 1506}\n"
                                "  - {at_ms: 3133, operator: engage, again_every_ms: 1506}\n";

    expect_hazard(HAZARD_FALSE_NODE, "the steering is stuck", &MUTE, reads);
    expect_none(&MUTE, with("%s%s", reads, toggles));
}

/** Who reports manual in most frames, and both modes in the others, is in manual. */
void test_h6_manual_with_short_both_is_manual(void) {
    const char *const steps = "  - {at_ms: 2000, vcu: set, field: mode_bits, value: 3h, again_every_ms: 101}\n"
                              "  - {at_ms: 2000, eps: set, field: mode, value: 00h}\n"
                              "  - {at_ms: 2021, vcu: set, field: mode_bits, value: 1h, again_every_ms: 101}\n";
    expect_none(&MUTE, steps);
}

/** A VCU that comes down slowly obeys the AI computer, which asks for 100 % now and then. */
void test_h6_a_throttle_that_was_commanded_to_rise_again_is_no_hazard(void) {
    const char *const slow =
        "  - {at_ms: 2000, vcu: ramp_throttle, pct_s: 27}\n"
        "  - {at_ms: 3000, ai: set, field: throttle, value: FAh, frames: 1, again_every_ms: 600}\n";
    const char *const stays =
        "  - {at_ms: 2000, vcu: set, field: throttle, value: FAh}\n"
        "  - {at_ms: 3000, ai: set, field: throttle, value: FAh, frames: 1, again_every_ms: 600}\n";
    expect_none(&MUTE, slow);
    expect_hazard(HAZARD_FALSE_NODE, "more throttle than commanded", &MUTE, stays);
}

/** The AI computer commands 82 % every 100 ms, a rogue node 0 every 30 ms. The VCU obeys both, slowly: the falls add up. */
void test_h6_a_throttle_with_two_senders_is_no_hazard(void) {
    const char *const slow =
        "  - {at_ms: 2000, vcu: ramp_throttle, pct_s: 40}\n"
        "  - {at_ms: 2000, ai: drive, gear: D, throttle_pct: 82}\n"
        "  - {at_ms: 3500, bus: send, side: vehicle, message: throttle_command, bytes: \"01 00 00 00 00 00 00 00\", "
        "every_ms: 30}\n";
    expect_none(&MUTE, slow);
}

/** The stub commands P at once; the vehicle needs a second to stop. */
void test_h8_park_in_motion(void) {
    const char *const brakes = "  - {at_ms: 2500, ai: drive, gear: D, throttle_pct: 0}\n"
                               "  - {at_ms: 2500, operator: disengage}\n";
    const char *const asks = "  - {at_ms: 3000, ai: drive, gear: P, throttle_pct: 0}\n";
    const stub_t at_once = {.safe_ms = TRIP_MS};
    const stub_t early = {.safe_ms = TRIP_MS, .setting = "park: at_standstill\n"};
    const stub_t late = {.safe_ms = TRIP_MS + 6000, .setting = "park: at_standstill\n"};
    const stub_t passes = {.gateway = true, .passes = 1u, .setting = "park: at_standstill\n"};
    expect_none(&at_once, "");
    expect_hazard(HAZARD_PARK, "P comes in motion", &early, "");
    expect_none(&late, brakes);
    expect_hazard(HAZARD_PARK, "P comes in motion", &passes, asks);
    expect_none(&PASSING, asks);
}

/** P after park_timeout_ms: from the trip on, which a stalled transmitter or a hang may hide; a flipped bit is no other trip. */
void test_h8_the_time_counts_from_the_trip(void) {
    const char *const config = "park: at_standstill\n  park_timeout_ms: 500\n  watchdog_period_ms: 600\n";
    const char *const full = "  - {at_ms: 2000, supervisor: fill_queue}\n"
                             "  - {at_ms: 2990, supervisor: free_queue}\n";
    const stub_t parks = {.safe_ms = TRIP_MS, .parks_ms = TRIP_MS + 50, .setting = config};
    const stub_t waits = {
        .rolls = true, .safe_ms = TRIP_MS, .open_ms = TRIP_MS + 5000, .parks_ms = TRIP_MS + 550, .setting = config};
    expect_hazard(HAZARD_PARK, "P comes in motion", &parks, "");
    expect_none(&parks, full);
    expect_none(&parks, "  - {at_ms: 2500, supervisor: hang, for_ms: 490}\n");
    expect_none(&waits, "  - {at_ms: 3300, supervisor: flip_bit, bit: 1}\n");
}

void test_h7_a_flood(void) {
    const stub_t floods = {.gateway = true, .passes = 3u};
    expect_hazard(HAZARD_FLOOD, "the vehicle's bus is flooded through the gateway", &floods, "");
}
