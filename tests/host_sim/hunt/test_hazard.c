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
    bool coasts;          /**< a vehicle that becomes slower by 60 mm/s each second */
    uint32_t open_ms;     /**< the output opens, and stays open */
    uint32_t safe_ms;     /**< safe commands, from then on */
    uint32_t safe_end_ms; /**< until then */
    uint32_t again_ms;    /**< and again from then on */
    bool holds;           /**< 065h beside them */
    int32_t hold_ddeg;    /**< more than the real angle at safe_ms */
    uint32_t hold_ms;     /**< 065h begins; NEVER: with the others */
    unsigned passes;      /**< so many times each command of the AI computer */
    bool passes_on;       /**< also beside safe commands */
    bool only_engaged;    /**< passes while the autopilot is engaged */
    uint32_t forges_ms;   /**< a throttle that nobody commanded */
    int32_t forges_ddeg;  /**< not a throttle but this angle; 0: a throttle */
    int32_t steers_ddeg;  /**< 065h is passed with this angle; 0: as it is */
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
    queued = 0;
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
    if (queued < QUEUE) {
        queue[queued] = *frame;
        towards[queued] = side;
        queued++;
    }
}

/** A stub with a slew limit that stays at one angle. */
static void steer_as_the_stub(hal_can_frame_t *frame) {
    const uint32_t raw = (uint32_t)(stub->steers_ddeg + 9000);
    if ((stub->steers_ddeg != 0) && (frame->id == 0x065u)) {
        frame->data[0] = (uint8_t)raw;
        frame->data[1] = (uint8_t)(raw >> 8);
    }
}

/** What the stub gateway passes on: commands of the AI computer, and the mode. */
static void on_frame(void *ctx, uint64_t t_us, hal_can_side_t side, int from, const hal_can_frame_t *frame) {
    const bool engaged = vehicle_now().autopilot || !stub->only_engaged;

    (void)ctx;
    (void)t_us;
    if ((side == HAL_CAN_AI) && (from != SCENARIO_FROM_SUPERVISOR) && engaged) {
        for (unsigned i = 0; i < stub->passes; i++) {
            enqueue(HAL_CAN_VEHICLE, frame);
            steer_as_the_stub(&queue[queued - 1]);
        }
    }
    if (stub->gateway && (side == HAL_CAN_VEHICLE) && (from == VEHICLE_VCU)) {
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
    if (stub->holds && (t_ms >= stub->hold_ms) && (t_ms % HOLD_CYCLE_MS == 0)) {
        send(AGV_MSG_STEERING_COMMAND, steering);
    }
    if (t_ms % CYCLE_MS == 0) {
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
    for (unsigned i = 0; i < queued; i++) {
        if (!is_safe || stub->passes_on || (towards[i] == HAL_CAN_AI)) {
            (void)hal_can_send(scenario_testbed_port(&testbed), towards[i], &queue[i]);
        }
    }
    queued = 0;
    if (is_safe) {
        send_safe(t_ms);
    }
    if ((stub->recovers_ms != NEVER) && (t_ms == stub->recovers_ms)) {
        hal_can_recover(scenario_testbed_port(&testbed), HAL_CAN_VEHICLE);
    }
    if ((stub->forges_ms != NEVER) && (t_ms == stub->forges_ms)) {
        const uint32_t raw = (uint32_t)(stub->forges_ddeg + 9000);
        const uint8_t steering[AGV_DLC] = {(uint8_t)raw, (uint8_t)(raw >> 8)};
        if (stub->forges_ddeg != 0) {
            send(AGV_MSG_STEERING_COMMAND, steering);
        } else {
            send(AGV_MSG_THROTTLE_COMMAND, throttle);
        }
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
                   (supervisor->setting != NULL) ? supervisor->setting : "",
                   (supervisor->rolls || supervisor->coasts) ? "false" : "true",
                   supervisor->rolls    ? "  coasting_mm_s2: 1\n  braking_mm_s2: 1\n  locked_mm_s2: 1\n"
                   : supervisor->coasts ? "  coasting_mm_s2: 60\n  braking_mm_s2: 60\n  locked_mm_s2: 60\n"
                                        : "",
                   steps);
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
static const stub_t GOOD_GATEWAY = {.gateway = true, .passes = 1, .safe_ms = TRIP_MS + 100, .open_ms = TRIP_MS + 600};
static const stub_t MUTE = {0};
static const stub_t PASSING = {.gateway = true, .passes = 1};

static const stub_t ROLLS = {.rolls = true, .safe_ms = TRIP_MS};
static const stub_t PARKED = {.safe_ms = TRIP_MS};
static const stub_t PARKED_AND_OPENS = {.safe_ms = TRIP_MS, .open_ms = TRIP_MS + 5000};
static const stub_t ROLLS_AND_OPENS = {.rolls = true, .safe_ms = TRIP_MS, .open_ms = TRIP_MS + 5000};
static const stub_t STAYS = {.safe_ms = TRIP_MS};
static const stub_t FORGETS = {.gateway = true, .passes = 1, .only_engaged = true};
static const stub_t RESETS = {.safe_ms = TRIP_MS, .safe_end_ms = 6000};
static const stub_t RESETS_BY_PIN = {.safe_ms = TRIP_MS, .safe_end_ms = 6000, .setting = "reset_input: pin\n"};
static const stub_t RESETS_BY_BOTH = {.safe_ms = TRIP_MS, .safe_end_ms = 6000, .setting = "reset_input: both\n"};
static const stub_t RESETS_LATER = {.safe_ms = TRIP_MS, .safe_end_ms = 6000, .setting = "confirm_timeout_ms: 1000\n"};
static const stub_t TRIPS_AGAIN = {.safe_ms = TRIP_MS, .safe_end_ms = 6000, .again_ms = 6300};
static const stub_t OPENS_LATE = {
    .gateway = true, .passes = 1, .open_ms = TRIP_MS + 450, .setting = "tx_stalled_ms: 500\n"};
static const stub_t LATE_GEAR = {.setting = "gear_command_timeout_ms: 2000\n"};
static const stub_t HANGS_AND_OPENS = {
    .gateway = true, .passes = 1, .open_ms = TRIP_MS + 600, .setting = "watchdog_period_ms: 600\n"};
static const stub_t HANGS_AND_OPENS_LATE = {
    .gateway = true, .passes = 1, .open_ms = TRIP_MS + 800, .setting = "watchdog_period_ms: 600\n"};
static const stub_t STEERS_LATE = {
    .safe_ms = TRIP_MS, .open_ms = TRIP_MS + 10, .holds = true, .hold_ddeg = -300, .hold_ms = TRIP_MS + 190};
static const stub_t STEERS_ONCE = {.safe_ms = TRIP_MS,
                                   .safe_end_ms = TRIP_MS + 205,
                                   .open_ms = TRIP_MS + 10,
                                   .holds = true,
                                   .hold_ddeg = -300,
                                   .hold_ms = TRIP_MS + 190};
static const stub_t HOLDS_AN_OLD_ANGLE = {.safe_ms = TRIP_MS + 200,
                                          .open_ms = TRIP_MS + 700,
                                          .holds = true,
                                          .hold_ddeg = 150,
                                          .setting = "tx_stalled_ms: 500\n"};
static const stub_t IGNORES_PARK = {.setting = "class_gear_status_timeout: warn\n"};
static const stub_t IGNORES_FLOOD = {.setting = "class_command_too_fast: trip\n  command_too_fast_gaps: 65\n"};
static const stub_t OVERRIDES_SOON = {
    .gateway = true, .holds = true, .safe_ms = TRIP_MS + 25, .open_ms = TRIP_MS + 130};

#define SOON_PARKS "park: at_standstill\n  park_timeout_ms: 500\n  watchdog_period_ms: 600\n"
static const stub_t PARKS_LATER = {.rolls = true,
                                   .safe_ms = TRIP_MS,
                                   .open_ms = TRIP_MS + 1300,
                                   .parks_ms = TRIP_MS + 1200,
                                   .setting = "park: at_standstill\n"};
static const stub_t PARKS = {.safe_ms = TRIP_MS, .parks_ms = TRIP_MS + 50, .setting = SOON_PARKS};

#define TURNS                                                                                                          \
    "  - {at_ms: 2600, ai: drive, gear: D, throttle_pct: 60, steer_deg: -60}\n"                                        \
    "  - {at_ms: 3190, ai: mute, message: steering_command}\n"
/* 60 degrees are measured after the first invalid angles, and -60 when the next ones begin */
#define BAD_ANGLES_TWICE                                                                                               \
    "  - {at_ms: 2990, vcu: set, field: mode_bits, value: 2h}\n"                                                       \
    "  - {at_ms: 3400, ai: drive, gear: D, throttle_pct: 60, steer_deg: 60}\n"                                         \
    "  - {at_ms: 3600, eps: set, field: angle, value: 4651h, frames: 4}\n"                                             \
    "  - {at_ms: 3900, ai: drive, gear: D, throttle_pct: 60, steer_deg: -60}\n"                                        \
    "  - {at_ms: 4390, ai: mute, message: steering_command}\n"                                                         \
    "  - {at_ms: 4400, eps: set, field: angle, value: 4651h, frames: 8}\n"
#define NOT_OBEYED "the vehicle does not obey the safe commands"
#define ANOTHER_ANGLE "the supervisor steers to another angle"
#define NOT_SENT "the supervisor sent a command that the AI computer did not send"
#define NOT_OVERRIDDEN "a rogue node's command is not overridden"
#define NOT_PRESSED "the button was not pressed after the trip"
#define NOT_RELEASED "no button that may reset was released"

#define WHEELS_SILENT "  - {at_ms: 3400, vcu: mute, message: wheel_speed}\n"
#define WHEELS_0                                                                                                       \
    "  - {at_ms: 2500, vcu: set, field: left_speed, value: 00000000h}\n"                                               \
    "  - {at_ms: 2500, vcu: set, field: right_speed, value: 00000000h}\n"
#define ROGUE_THROTTLE "  - {at_ms: 3000, bus: send, message: throttle_command, bytes: \"40\"}\n"
#define MANUAL_SOON                                                                                                    \
    "  - {at_ms: 2850, ai: drive, gear: D, throttle_pct: 60, steer_deg: 80}\n"                                         \
    "  - {at_ms: 2950, vcu: ignore, message: turn_signal_command}\n"                                                   \
    "  - {at_ms: 3180, operator: disengage}\n"                                                                         \
    "  - {at_ms: 3180, operator: steer, steer_deg: -60}\n"                                                             \
    "  - {at_ms: 5000, operator: engage}\n"
#define STALLS "  - {at_ms: 3030, supervisor: stall_tx}\n"
#define NOT_IN_PARK "  - {at_ms: 2900, vcu: set, field: gear, value: 01h, frames: 25}\n"
#define NOT_IN_PARK_LATER "  - {at_ms: 6200, vcu: set, field: gear, value: 01h, frames: 25}\n"
#define PRESS_1 "  - {at_ms: 4500, operator: press, button: 1}\n  - {at_ms: 5900, operator: release, button: 1}\n"
#define PRESS_PIN "  - {at_ms: 4500, board: press}\n  - {at_ms: 5900, board: release}\n"
#define PRESS_LOST "  - {at_ms: 2000, operator: press, button: 1}\n  - {at_ms: 2900, operator: lose_remote_signal}\n"
#define PRESS_REGAINED                                                                                                 \
    "  - {at_ms: 4500, operator: regain_remote_signal}\n  - {at_ms: 5900, operator: release, button: 1}\n"
#define PRESS_LATE                                                                                                     \
    "  - {at_ms: 2500, vcu: delay, message: vehicle_status, by_ms: 700}\n"                                             \
    "  - {at_ms: 2700, operator: press, button: 1}\n"
#define TX_DEAD "  - {at_ms: 3000, supervisor: stall_tx}\n"
#define FALSE_PARK "  - {at_ms: 3000, vcu: set, field: gear, value: 08h}\n"
#define NO_GEAR "  - {at_ms: 2000, ai: mute, message: gear_command}\n"
#define FLOOD                                                                                                          \
    "  - {at_ms: 3000, ai: send_every, message: turn_signal_command, every_ms: 1}\n"                                   \
    "  - {at_ms: 3200, ai: send_every, message: turn_signal_command, every_ms: 100}\n"
#define AI_SIDE_STALLED "  - {at_ms: 3000, supervisor: stall_tx, side: ai}\n"
#define STUCK_AND_SWINGS                                                                                               \
    "  - {at_ms: 3000, eps: hunt, steer_deg: 116, every_ms: 100}\n"                                                    \
    "  - {at_ms: 3000, eps: stick}\n"                                                                                  \
    "  - {at_ms: 3000, ai: drive, gear: D, throttle_pct: 60, steer_deg: 180}\n"
#define MOVES_ONCE                                                                                                     \
    "  - {at_ms: 2000, ai: drive, gear: D, throttle_pct: 60, steer_deg: 120}\n"                                        \
    "  - {at_ms: 2500, eps: set, field: angle, value: 2328h, frames: 44, again_every_ms: 480}\n"
#define FULL_THROTTLE "  - {at_ms: 2000, vcu: set, field: throttle, value: FAh}\n"
#define AI_RISES "  - {at_ms: 3000, ai: set, field: throttle, value: FAh, frames: 1, again_every_ms: 600}\n"
#define NO_ENGAGEMENT                                                                                                  \
    "  - {at_ms: 2122, vcu: set, field: mode_bits, value: 3h, again_every_ms: 192, again_until_ms: 4738}\n"            \
    "  - {at_ms: 2132, vcu: set, field: mode_bits, value: 1h, again_every_ms: 192, again_until_ms: 4738}\n"            \
    "  - {at_ms: 3000, eps: set, field: mode, value: FFh}\n"                                                           \
    "  - {at_ms: 4739, vcu: unset, message: vehicle_status}\n"                                                         \
    "  - {at_ms: 7800, eps: unset, message: eps_status}\n"
#define BAD_IN_GRACE                                                                                                   \
    "  - {at_ms: 1500, eps: set, field: mode, value: FFh}\n"                                                           \
    "  - {at_ms: 1990, eps: unset, message: eps_status}\n"                                                             \
    "  - {at_ms: 2000, eps: send_every, message: eps_status, every_ms: 60}\n"                                          \
    "  - {at_ms: 2000, eps: set, field: mode, value: FFh, frames: 3, again_every_ms: 480}\n"
#define GEAR_LIES "  - {at_ms: 1857, vcu: set, field: gear, value: 02h, frames: 19, again_every_ms: 550}\n"
#define GLITCHES(frames)                                                                                               \
    "  - {at_ms: 2000, operator: press, button: 1}\n"                                                                  \
    "  - {at_ms: 4000, vcu: set_bytes, message: vehicle_status, bytes: \".. .. .. .. .. .. 40 ..\", frames: " frames   \
    "}\n"                                                                                                              \
    "  - {at_ms: 5500, vcu: set_bytes, message: vehicle_status, bytes: \".. .. .. .. .. .. 40 ..\", frames: 1}\n"
#define JERKS                                                                                                          \
    "  - {at_ms: 1900, ai: stop}\n"                                                                                    \
    "  - {at_ms: 3900, vcu: roll, speed_mm_s: 3000, again_every_ms: 1800}\n"
#define AI_PARKS "  - {at_ms: 3000, ai: drive, gear: P, throttle_pct: 0}\n"

/** Each: a supervisor that does nothing about it, and one that reacts; NULL: none. */
static const struct {
    hazard_kind_t kind;
    const char *cause;
    const stub_t *wrong;
    const stub_t *right;
    const char *steps;
} PAIRS[] = {
    {HAZARD_NONE, NULL, NULL, &MUTE, ""},
    {HAZARD_NONE, NULL, NULL, &PASSING, ""},
    {HAZARD_NOT_STOPPING, NOT_OBEYED, &ROLLS, &ROLLS_AND_OPENS, ""},
    /* 101h reads 0 for a vehicle that rolls at 3 m/s: 363h, with the true speed, contradicts it after 1 s */
    {HAZARD_NOT_STOPPING, NOT_OBEYED, &ROLLS, &ROLLS_AND_OPENS, WHEELS_0},
    {HAZARD_NONE, NULL, NULL,
     &(const stub_t){.rolls = true, .safe_ms = TRIP_MS, .setting = "standstill_vcu_counts: 65535\n"}, WHEELS_0},
    /* 0 of both: nobody can know that it moves; 0.80 m/s does not contradict, 0.89 m/s does */
    {HAZARD_NONE, NULL, NULL, &ROLLS, WHEELS_0 "  - {at_ms: 2500, vcu: set, field: speed, value: 0000h}\n"},
    {HAZARD_NONE, NULL, NULL, &ROLLS, WHEELS_0 "  - {at_ms: 2500, vcu: set, field: speed, value: 0B40h}\n"},
    {HAZARD_NOT_STOPPING, NOT_OBEYED, &ROLLS, NULL,
     WHEELS_0 "  - {at_ms: 2500, vcu: set, field: speed, value: 0C80h}\n"},
    /* who stood for half a second, and is silent, may roll unseen */
    {HAZARD_NOT_STOPPING, NOT_OBEYED, &ROLLS, NULL, WHEELS_SILENT},
    {HAZARD_NONE, NULL, NULL, &ROLLS,
     "  - {at_ms: 2990, vcu: set, field: left_speed, value: 00000000h, frames: 50}\n"
     "  - {at_ms: 2990, vcu: set, field: right_speed, value: 00000000h, frames: 50}\n" WHEELS_SILENT},
    /* it rolls for a second of each 1.8 s; the stops in between are shorter than hold_standstill_ms */
    {HAZARD_NOT_STOPPING, NOT_OBEYED, &PARKED, &PARKED_AND_OPENS,
     JERKS "  - {at_ms: 4900, vcu: hold, again_every_ms: 1800}\n"},
    {HAZARD_NONE, NULL, NULL, &(const stub_t){.safe_ms = TRIP_MS, .setting = "hold_standstill_ms: 500\n"},
     JERKS "  - {at_ms: 4900, vcu: hold, again_every_ms: 1800}\n"},
    /* one that becomes slower has to stop in time, too; one 101h in six that reads 0 is no standstill */
    {HAZARD_NOT_STOPPING, NOT_OBEYED, &(const stub_t){.coasts = true, .safe_ms = TRIP_MS},
     &(const stub_t){.coasts = true, .safe_ms = TRIP_MS, .open_ms = TRIP_MS + 5000}, ""},
    {HAZARD_NOT_STOPPING, NOT_OBEYED, &ROLLS, &ROLLS_AND_OPENS,
     "  - {at_ms: 2990, vcu: set, field: left_speed, value: 00000000h, frames: 9, every_frames: 55}\n"
     "  - {at_ms: 2990, vcu: set, field: right_speed, value: 00000000h, frames: 9, every_frames: 55}\n"},
    /* the same, and then 101h comes every 200 ms: it shows the motion for a part of the time */
    {HAZARD_NOT_STOPPING, NOT_OBEYED, &ROLLS, NULL,
     "  - {at_ms: 2990, vcu: set, field: left_speed, value: 00000000h, frames: 50}\n"
     "  - {at_ms: 2990, vcu: set, field: right_speed, value: 00000000h, frames: 50}\n"
     "  - {at_ms: 3500, vcu: send_every, message: wheel_speed, every_ms: 200}\n"},
    {HAZARD_FALSE_COMMAND, "the supervisor commands motion",
     &(const stub_t){.safe_ms = TRIP_MS, .forges_ms = TRIP_MS + 1000}, &STAYS, ""},
    {HAZARD_FALSE_COMMAND, "the supervisor commands motion",
     &(const stub_t){.gateway = true, .passes = 1, .passes_on = true, .safe_ms = TRIP_MS},
     &(const stub_t){.gateway = true, .passes = 1, .safe_ms = TRIP_MS}, ""},
    {HAZARD_STEERING, ANOTHER_ANGLE,
     &(const stub_t){.safe_ms = TRIP_MS, .open_ms = TRIP_MS + 400, .holds = true, .hold_ddeg = 200},
     &(const stub_t){.safe_ms = TRIP_MS, .open_ms = TRIP_MS + 400, .holds = true},
     "  - {at_ms: 2990, vcu: set, field: mode_bits, value: 2h}\n"
     "  - {at_ms: 2990, ai: mute, message: steering_command}\n"},
    /* a transmitter that took nothing for some time: the trip, and its angle, may be so old */
    {HAZARD_STEERING, ANOTHER_ANGLE, &HOLDS_AN_OLD_ANGLE, NULL, TURNS},
    {HAZARD_NONE, NULL, NULL, &HOLDS_AN_OLD_ANGLE,
     "  - {at_ms: 2500, supervisor: fill_queue}\n" TURNS "  - {at_ms: 3195, supervisor: free_queue}\n"},
    /* who took an angle between two times without one still has it until the second one has lasted for some frames */
    {HAZARD_STEERING, ANOTHER_ANGLE,
     &(const stub_t){
         .safe_ms = TRIP_MS, .open_ms = TRIP_MS + 400, .holds = true, .hold_ddeg = 400, .hold_ms = TRIP_MS + 1460},
     &(const stub_t){.safe_ms = TRIP_MS,
                     .safe_end_ms = TRIP_MS + 1430,
                     .open_ms = TRIP_MS + 400,
                     .holds = true,
                     .hold_ddeg = 400,
                     .hold_ms = TRIP_MS + 1410},
     BAD_ANGLES_TWICE},
    /* manual drops the angle of the trip soon after it was sent late: one frame that was on its way still leaves */
    {HAZARD_STEERING, ANOTHER_ANGLE, &STEERS_LATE, &STEERS_ONCE, MANUAL_SOON},
    {HAZARD_STEERING, ANOTHER_ANGLE, &(const stub_t){.safe_ms = TRIP_MS, .open_ms = TRIP_MS + 10, .holds = true}, NULL,
     MANUAL_SOON},
    /* who is bus-off does not hear of manual */
    {HAZARD_STEERING, ANOTHER_ANGLE,
     &(const stub_t){.safe_ms = TRIP_MS, .open_ms = TRIP_MS + 100, .holds = true, .recovers_ms = TRIP_MS + 300},
     &(const stub_t){.safe_ms = TRIP_MS, .open_ms = TRIP_MS + 100, .holds = true, .recovers_ms = TRIP_MS + 800},
     "  - {at_ms: 2950, vcu: ignore, message: turn_signal_command}\n"
     "  - {at_ms: 3100, supervisor: bus_off}\n"
     "  - {at_ms: 3100, eps: set, field: mode, value: 01h}\n"
     "  - {at_ms: 3150, operator: disengage}\n"
     "  - {at_ms: 3150, operator: steer, steer_deg: -60}\n"
     "  - {at_ms: 3650, operator: engage}\n"},
    /* the angle of the trip, from which the AI computer has steered away, is out of date after 2 s */
    {HAZARD_STEERING, ANOTHER_ANGLE,
     &(const stub_t){.safe_ms = TRIP_MS, .open_ms = TRIP_MS + 100, .holds = true, .hold_ms = TRIP_MS + 2500},
     &(const stub_t){.safe_ms = TRIP_MS, .open_ms = TRIP_MS + 100, .holds = true, .hold_ms = TRIP_MS + 1900},
     "  - {at_ms: 2990, vcu: set, field: mode_bits, value: 2h}\n"
     "  - {at_ms: 3300, ai: drive, gear: D, throttle_pct: 60, steer_deg: -60}\n"
     "  - {at_ms: 3900, ai: mute, message: steering_command}\n"},
    {HAZARD_FALSE_COMMAND, NOT_SENT,
     &(const stub_t){.gateway = true, .passes = 1, .forges_ms = TRIP_MS, .only_engaged = true}, NULL,
     "  - {at_ms: 2000, ai: drive, gear: D, throttle_pct: 20}\n"},
    {HAZARD_FALSE_COMMAND, NOT_OVERRIDDEN, &PASSING, &GOOD_GATEWAY, ROGUE_THROTTLE},
    {HAZARD_FALSE_COMMAND, NOT_OVERRIDDEN, &PASSING, &GOOD_GATEWAY,
     "  - {at_ms: 3000, bus: deliver, kind: fd, message: gear_command, bytes: \"01 00\"}\n"},
    /* a stalled transmitter opens the output after tx_stalled_ms, so that nobody has to override before */
    {HAZARD_FALSE_COMMAND, NOT_OVERRIDDEN,
     &(const stub_t){.gateway = true, .passes = 1, .setting = "tx_stalled_ms: 500\n"}, &OPENS_LATE,
     "  - {at_ms: 2990, supervisor: stall_tx}\n" ROGUE_THROTTLE},
    {HAZARD_FALSE_COMMAND, NOT_OVERRIDDEN, &OPENS_LATE, NULL, ROGUE_THROTTLE},
    /* a supervisor that hangs with a full queue opens the output when its watchdog ends that */
    {HAZARD_FALSE_COMMAND, NOT_OVERRIDDEN, &HANGS_AND_OPENS_LATE, &HANGS_AND_OPENS,
     "  - {at_ms: 2990, supervisor: fill_queue}\n" ROGUE_THROTTLE},
    /* what waited in a transmitter leaves when it is free again */
    {HAZARD_FALSE_COMMAND, NOT_OVERRIDDEN,
     &(const stub_t){
         .gateway = true, .safe_ms = TRIP_MS + 500, .open_ms = TRIP_MS + 600, .setting = "tx_stalled_ms: 500\n"},
     &(const stub_t){.gateway = true, .safe_ms = TRIP_MS, .open_ms = TRIP_MS + 600, .setting = "tx_stalled_ms: 500\n"},
     "  - {at_ms: 2800, supervisor: stall_tx}\n" ROGUE_THROTTLE "  - {at_ms: 3290, supervisor: free_tx}\n"},
    /* 065h is the first safe command; the others wait in a transmitter that stalls then, and the output opens */
    {HAZARD_FALSE_COMMAND, NOT_SENT,
     &(const stub_t){.gateway = true, .holds = true, .safe_ms = TRIP_MS + 25, .open_ms = TRIP_MS + 600},
     &OVERRIDES_SOON, STALLS},
    {HAZARD_NONE, NULL, NULL, &OVERRIDES_SOON, "  - {at_ms: 3029, bus: destroy, frames: 200}\n"},
    {HAZARD_FALSE_COMMAND, NOT_SENT,
     &(const stub_t){.gateway = true,
                     .holds = true,
                     .safe_ms = TRIP_MS + 25,
                     .safe_end_ms = TRIP_MS + 40,
                     .open_ms = TRIP_MS + 600},
     NULL, STALLS "  - {at_ms: 3035, supervisor: free_tx}\n"},
    /* PASSING passes the throttle 0 that the AI computer commands in manual */
    {HAZARD_FALSE_COMMAND, "an old throttle command is the latest one at an engagement", &FORGETS, &PASSING,
     "  - {at_ms: 3000, operator: disengage}\n  - {at_ms: 4000, operator: engage}\n"},
    {HAZARD_NONE, NULL, NULL,
     &(const stub_t){.gateway = true, .passes = 1, .only_engaged = true, .open_ms = TRIP_MS + 500},
     "  - {at_ms: 2900, supervisor: fill_queue}\n"
     "  - {at_ms: 3300, operator: disengage}\n  - {at_ms: 3450, operator: engage}\n"},
    {HAZARD_NONE, NULL, NULL, &FORGETS,
     "  - {at_ms: 3000, operator: disengage}\n  - {at_ms: 3990, supervisor: hang, for_ms: 50}\n"
     "  - {at_ms: 4000, operator: engage}\n"},
    {HAZARD_UNCONFIRMED, "gear P is not commanded", &(const stub_t){.safe_ms = TRIP_MS, .parks_ms = TRIP_MS + 400},
     &(const stub_t){.safe_ms = TRIP_MS, .parks_ms = TRIP_MS + 200}, ""},
    {HAZARD_UNCONFIRMED, "the autopilot is not confirmed as off", &STAYS,
     &(const stub_t){.safe_ms = TRIP_MS, .open_ms = TRIP_MS + 700}, "  - {at_ms: 3200, vcu: freeze_counter}\n"},
    {HAZARD_UNCONFIRMED, "gear P is not confirmed", &STAYS,
     &(const stub_t){.safe_ms = TRIP_MS, .open_ms = TRIP_MS + 510},
     "  - {at_ms: 2900, vcu: set, field: gear, value: 01h}\n"},
    {HAZARD_UNCONFIRMED, "gear P is not confirmed", &STAYS, NULL,
     "  - {at_ms: 2900, vcu: set, field: gear, value: 01h, frames: 17, again_every_ms: 475}\n"},
    /* 0.6 s without P, twice: a confirmation of 3 s between them, or a reset and the next trip, sets the sum to 0 */
    {HAZARD_UNCONFIRMED, "gear P is not confirmed", &STAYS,
     &(const stub_t){.safe_ms = TRIP_MS, .setting = "confirmed_ms: 1000\n"},
     NOT_IN_PARK "  - {at_ms: 6500, vcu: set, field: gear, value: 01h, frames: 25}\n"},
    {HAZARD_UNCONFIRMED, "gear P is not confirmed", &TRIPS_AGAIN, NULL, NOT_IN_PARK NOT_IN_PARK_LATER},
    {HAZARD_NONE, NULL, NULL, &TRIPS_AGAIN, NOT_IN_PARK PRESS_1 NOT_IN_PARK_LATER},
    {HAZARD_RESET, NOT_PRESSED, &RESETS, NULL, ""},
    {HAZARD_RESET, NOT_PRESSED, &RESETS, NULL, "  - {at_ms: 2000, operator: press, button: 1}\n"},
    {HAZARD_RESET, NOT_RELEASED, &RESETS, NULL, "  - {at_ms: 4000, operator: press, button: 1}\n"},
    {HAZARD_RESET, NOT_RELEASED, &RESETS, NULL, /* a tap */
     "  - {at_ms: 4000, operator: press, button: 1}\n  - {at_ms: 4050, operator: release, button: 1}\n"},
    {HAZARD_RESET, NOT_RELEASED, &RESETS, &RESETS_BY_PIN, PRESS_PIN},
    {HAZARD_RESET, NOT_RELEASED, &RESETS_BY_PIN, &RESETS_BY_BOTH, PRESS_1},
    {HAZARD_RESET, NOT_RELEASED, &RESETS_BY_PIN, NULL, "  - {at_ms: 4500, board: press}\n"},
    {HAZARD_NONE, NULL, NULL, &RESETS, PRESS_1},
    {HAZARD_NONE, NULL, NULL, &RESETS_BY_BOTH, PRESS_PIN},
    {HAZARD_NOT_STOPPING, "the EPS is silent", &MUTE, &GOOD, "  - {at_ms: 3000, eps: freeze_counter}\n"},
    /* each engagement begins the deadline of a command anew, but not the fourth one within 5 s */
    {HAZARD_NOT_STOPPING, "168h is missing", &LATE_GEAR, NULL, NO_GEAR},
    {HAZARD_NOT_STOPPING, "168h is missing", &LATE_GEAR, NULL,
     NO_GEAR "  - {at_ms: 2500, operator: disengage, again_every_ms: 1200}\n"
             "  - {at_ms: 2700, operator: engage, again_every_ms: 1200}\n"},
    {HAZARD_NONE, NULL, NULL, &LATE_GEAR,
     NO_GEAR "  - {at_ms: 2500, operator: disengage, again_every_ms: 2000}\n"
             "  - {at_ms: 2700, operator: engage, again_every_ms: 2000}\n"},
    /* what 363h reports of the button counts too: nobody can know better */
    {HAZARD_RESET, NOT_PRESSED, &RESETS_LATER, NULL, PRESS_LOST PRESS_REGAINED},
    {HAZARD_NONE, NULL, NULL, &RESETS_LATER,
     PRESS_LOST "  - {at_ms: 2900, vcu: set, field: alarms, value: 00h}\n" PRESS_REGAINED},
    {HAZARD_NONE, NULL, NULL, &RESETS_LATER, PRESS_LATE "  - {at_ms: 4000, operator: release, button: 1}\n"},
    {HAZARD_RESET, NOT_PRESSED, &RESETS_LATER, NULL, /* shorter than reset_hold_ms */
     PRESS_LATE "  - {at_ms: 3200, operator: release, button: 1}\n"},
    /* a button that is held since before the trip, and missing in a single 363h, was not pressed after it */
    {HAZARD_RESET, NOT_PRESSED, &RESETS_LATER, NULL, GLITCHES("1")},
    {HAZARD_NONE, NULL, NULL, &RESETS_LATER, GLITCHES("3")},
    /* a slew limit leaves angles between the steering and the command */
    {HAZARD_FALSE_COMMAND, NOT_SENT,
     &(const stub_t){.gateway = true,
                     .passes = 1,
                     .only_engaged = true,
                     .forges_ms = TRIP_MS,
                     .forges_ddeg = 600,
                     .setting = "steering_slew_ddeg_s: 100\n"},
     &(const stub_t){.gateway = true,
                     .passes = 1,
                     .only_engaged = true,
                     .forges_ms = TRIP_MS,
                     .forges_ddeg = 160,
                     .setting = "steering_slew_ddeg_s: 100\n"},
     ""},
    /* a slew limit that goes on from before the hand-over, although the operator steered until the EPS followed */
    {HAZARD_FALSE_COMMAND, NOT_SENT,
     &(const stub_t){.gateway = true,
                     .passes = 1,
                     .only_engaged = true,
                     .steers_ddeg = 20,
                     .setting = "steering_slew_ddeg_s: 100\n"},
     &(const stub_t){.gateway = true, .passes = 1, .only_engaged = true, .setting = "steering_slew_ddeg_s: 100\n"},
     "  - {at_ms: 1600, operator: disengage}\n"
     "  - {at_ms: 1700, ai: drive, gear: D, throttle_pct: 60, steer_deg: 60}\n"
     "  - {at_ms: 1700, ai: be_stubborn}\n"
     "  - {at_ms: 2000, operator: engage}\n"
     "  - {at_ms: 2005, operator: steer, steer_deg: 60}\n"},
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
    /* each engagement has its grace time, but not the fourth one within mode_flapping_ms */
    {HAZARD_FALSE_NODE, "more throttle than commanded", &MUTE, &(const stub_t){.setting = "engaged_grace_ms: 1600\n"},
     FULL_THROTTLE "  - {at_ms: 3400, operator: disengage, again_every_ms: 2000}\n"
                   "  - {at_ms: 3620, operator: engage, again_every_ms: 2000}\n"},
    {HAZARD_FALSE_NODE, "more throttle than commanded", &MUTE, NULL,
     FULL_THROTTLE "  - {at_ms: 2400, operator: disengage, again_every_ms: 650}\n"
                   "  - {at_ms: 2560, operator: engage, again_every_ms: 650}\n"},
    /* each begins its budgets anew */
    {HAZARD_FALSE_NODE, "another gear than commanded", &MUTE, NULL, GEAR_LIES},
    {HAZARD_NONE, NULL, NULL, &MUTE,
     GEAR_LIES "  - {at_ms: 2102, operator: disengage, again_every_ms: 1901}\n"
               "  - {at_ms: 2289, operator: engage, again_every_ms: 1901}\n"},
    /* 363h with both mode bits begin no engagement */
    {HAZARD_FALSE_NODE, "the EPS is not in angle control", &MUTE,
     &(const stub_t){.setting = "engaged_grace_ms: 2000\n"}, NO_ENGAGEMENT},
    /* bad frames in the grace time count for nothing afterwards, when three of eight are bad */
    {HAZARD_FALSE_NODE, "the EPS is not in angle control", &(const stub_t){.setting = "engaged_grace_ms: 50\n"}, &MUTE,
     BAD_IN_GRACE},
    /* a dead transmitter shows with the next status frame */
    {HAZARD_FALSE_NODE, "the supervisor's transmitter has failed",
     &(const stub_t){.setting = "status_frame_period_ms: 3000\n"},
     &(const stub_t){.setting = "status_frame_period_ms: 3000\n", .open_ms = TRIP_MS + 3200}, TX_DEAD},
    {HAZARD_FALSE_NODE, "the supervisor's transmitter has failed", &(const stub_t){.open_ms = TRIP_MS + 3200}, NULL,
     TX_DEAD},
    /* 0A3h says P while the throttle is at 60 %; when it is silent, which only warns, it says nothing any more */
    {HAZARD_FALSE_NODE, "throttle with gear P", &IGNORES_PARK, NULL, FALSE_PARK},
    {HAZARD_NONE, NULL, NULL, &IGNORES_PARK, FALSE_PARK "  - {at_ms: 3040, vcu: mute, message: gear_status}\n"},
    {HAZARD_NONE, NULL, NULL, &(const stub_t){.setting = "class_gear_status_invalid: warn\n"},
     FALSE_PARK "  - {at_ms: 3040, vcu: set, field: gear, value: 03h}\n"},
    {HAZARD_NONE, NULL, NULL, &(const stub_t){.setting = "throttle_idle_counts: 25\n"},
     FALSE_PARK "  - {at_ms: 3000, vcu: set, field: throttle, value: 14h}\n"},
    /* two of three 0A3h have no gear: the others show D, and R is commanded */
    {HAZARD_FALSE_NODE, "another gear than commanded", &(const stub_t){.setting = "class_gear_status_invalid: warn\n"},
     NULL,
     "  - {at_ms: 2000, vcu: ignore, message: gear_command}\n"
     "  - {at_ms: 2000, vcu: set, field: gear, value: 03h, frames: 2, every_frames: 3}\n"
     "  - {at_ms: 2100, ai: set, field: gear, value: 02h}\n"},
    /* R is commanded, 0A3h shows D; every second 050h shows idle, which says nothing about the gear */
    {HAZARD_FALSE_NODE, "another gear than commanded", &MUTE, &GOOD,
     "  - {at_ms: 2900, vcu: ignore, message: gear_command}\n"
     "  - {at_ms: 3000, ai: set, field: gear, value: 02h}\n"
     "  - {at_ms: 3000, vcu: set, field: throttle, value: 00h, frames: 1, every_frames: 2}\n"},
    /* 200 gaps of 1 ms; after a restart nobody knows of them */
    {HAZARD_FALSE_NODE, "commands come too fast", &IGNORES_FLOOD, NULL, FLOOD},
    {HAZARD_NONE, NULL, NULL, &IGNORES_FLOOD, FLOOD "  - {at_ms: 3250, supervisor: restart, cause: software}\n"},
    {HAZARD_FALSE_NODE, "autopilot off is ignored", &MUTE,
     &(const stub_t){.setting = "class_autopilot_off_ignored: warn\n"},
     "  - {at_ms: 3000, vcu: ignore, message: turn_signal_command}\n"
     "  - {at_ms: 3100, ai: ask_autopilot_off}\n"},
    {HAZARD_FALSE_NODE, "the AI side is stalled",
     &(const stub_t){.gateway = true, .passes = 1, .setting = "class_ai_bus_off: trip\n"},
     &(const stub_t){.gateway = true,
                     .passes = 1,
                     .safe_ms = TRIP_MS + 100,
                     .open_ms = TRIP_MS + 600,
                     .setting = "class_ai_bus_off: trip\n"},
     AI_SIDE_STALLED},
    {HAZARD_NONE, NULL, NULL, &PASSING, AI_SIDE_STALLED}, /* it only warns */
    /* a reading that swings hides no stuck steering, unless the command swings, too: it looks like one that follows */
    {HAZARD_FALSE_NODE, "the steering is stuck", &MUTE, &GOOD, STUCK_AND_SWINGS},
    {HAZARD_NONE, NULL, NULL, &MUTE,
     STUCK_AND_SWINGS "  - {at_ms: 3000, ai: set, field: angle, value: 4650h, frames: 1, again_every_ms: 100}\n"},
    /* in each engagement the first step to the command and back looks like progress */
    {HAZARD_FALSE_NODE, "the steering is stuck", &MUTE, NULL, MOVES_ONCE},
    {HAZARD_NONE, NULL, NULL, &MUTE,
     MOVES_ONCE "  - {at_ms: 3000, operator: disengage, again_every_ms: 1506}\n"
                "  - {at_ms: 3133, operator: engage, again_every_ms: 1506}\n"},
    /* who reports manual in most frames, and both modes in the others, is in manual */
    {HAZARD_NONE, NULL, NULL, &MUTE,
     "  - {at_ms: 2000, vcu: set, field: mode_bits, value: 3h, again_every_ms: 101}\n"
     "  - {at_ms: 2000, eps: set, field: mode, value: 00h}\n"
     "  - {at_ms: 2021, vcu: set, field: mode_bits, value: 1h, again_every_ms: 101}\n"},
    /* a VCU that comes down slowly obeys the AI computer, which asks for 100 % now and then */
    {HAZARD_NONE, NULL, NULL, &MUTE, "  - {at_ms: 2000, vcu: ramp_throttle, pct_s: 27}\n" AI_RISES},
    {HAZARD_FALSE_NODE, "more throttle than commanded", &MUTE, NULL, FULL_THROTTLE AI_RISES},
    /* AI computer 82 % every 100 ms, rogue node 0 every 30 ms: the VCU obeys both, slowly, and the falls add up */
    {HAZARD_NONE, NULL, NULL, &MUTE,
     "  - {at_ms: 2000, vcu: ramp_throttle, pct_s: 40}\n"
     "  - {at_ms: 2000, ai: drive, gear: D, throttle_pct: 82}\n"
     "  - {at_ms: 3500, bus: send, side: vehicle, message: throttle_command, bytes: \"01 00 00 00 00 00 00 00\", "
     "every_ms: 30}\n"},
    {HAZARD_FLOOD, "the vehicle's bus is flooded through the gateway", &(const stub_t){.gateway = true, .passes = 3},
     NULL, ""},
    /* the stub commands P at once; the vehicle needs a second to stop */
    {HAZARD_PARK, "P comes in motion", &(const stub_t){.safe_ms = TRIP_MS, .setting = "park: at_standstill\n"}, &STAYS,
     ""},
    {HAZARD_NONE, NULL, NULL, &(const stub_t){.safe_ms = TRIP_MS + 6000, .setting = "park: at_standstill\n"},
     "  - {at_ms: 2500, ai: drive, gear: D, throttle_pct: 0}\n  - {at_ms: 2500, operator: disengage}\n"},
    {HAZARD_PARK, "P comes in motion",
     &(const stub_t){.gateway = true, .passes = 1, .setting = "park: at_standstill\n"}, &PASSING, AI_PARKS},
    /* 363h contradicts a 101h of 0 for 1.7 s, of which 101h is silent for 0.1 s or for 1.1 s */
    {HAZARD_PARK, "P comes in motion", &PARKS_LATER, NULL,
     WHEELS_0 "  - {at_ms: 2900, vcu: mute, message: wheel_speed}\n"
              "  - {at_ms: 3000, vcu: unmute, message: wheel_speed}\n"},
    {HAZARD_NONE, NULL, NULL, &PARKS_LATER,
     WHEELS_0 "  - {at_ms: 2900, vcu: mute, message: wheel_speed}\n"
              "  - {at_ms: 4000, vcu: unmute, message: wheel_speed}\n"},
    /* park_timeout_ms counts from the trip, which a stalled transmitter or a hang may hide; a flipped bit is no trip */
    {HAZARD_PARK, "P comes in motion", &PARKS, NULL, ""},
    {HAZARD_NONE, NULL, NULL, &PARKS,
     "  - {at_ms: 2000, supervisor: fill_queue}\n  - {at_ms: 2990, supervisor: free_queue}\n"},
    {HAZARD_NONE, NULL, NULL, &PARKS, "  - {at_ms: 2500, supervisor: hang, for_ms: 490}\n"},
    {HAZARD_NONE, NULL, NULL,
     &(const stub_t){.rolls = true,
                     .safe_ms = TRIP_MS,
                     .open_ms = TRIP_MS + 5000,
                     .parks_ms = TRIP_MS + 550,
                     .setting = SOON_PARKS},
     "  - {at_ms: 3300, supervisor: flip_bit, bit: 1}\n"},
};

/* Shows: HW-3 */
void test_whoever_does_nothing_is_a_hazard_and_whoever_reacts_is_none(void) {
    for (size_t i = 0; i < sizeof PAIRS / sizeof PAIRS[0]; i++) {
        if (PAIRS[i].wrong != NULL) {
            expect_hazard(PAIRS[i].kind, PAIRS[i].cause, PAIRS[i].wrong, PAIRS[i].steps);
        }
        if (PAIRS[i].right != NULL) {
            expect_none(PAIRS[i].right, PAIRS[i].steps);
        }
    }
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
        {"eps: set, field: angle, value: FFFFh, frames: 20", true},
        {"eps: set, field: faults, value: 02h, frames: 2", false},
        {"eps: set, field: angle, value: FFFFh, frames: 4", false},
    };
    const stub_t returns = {
        .safe_ms = TRIP_MS, .open_ms = TRIP_MS + 500, .holds = true, .hold_ms = TRIP_MS + 400, .hold_ddeg = 0};

    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
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
                {"eps: set, field: angle, value: FFFFh, frames: 3", true},
                {"vcu: set, field: alarms, value: 10h, frames: 1", true},
                {"eps: mute, message: eps_status, frames: 7", true}};
    const stub_t later = {
        .safe_ms = TRIP_MS, .open_ms = TRIP_MS + 500, .holds = true, .hold_ms = TRIP_MS + 1300, .hold_ddeg = -800};

    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        const char *const steps = with("  - {at_ms: 2950, vcu: ignore, message: turn_signal_command}\n"
                                       "  - {at_ms: 3010, ai: drive, gear: D, throttle_pct: 60, steer_deg: -60}\n"
                                       "  - {at_ms: 3110, %s}\n"
                                       "  - {at_ms: 3800, ai: drive, gear: D, throttle_pct: 60, steer_deg: 20}\n"
                                       "  - {at_ms: 4200, ai: mute, message: steering_command}\n",
                                       rows[i].steps);
        expect_another_angle(!rows[i].may, &later, steps);
    }
}

/** With status_invalid_frames of 1 the first valid 067h, at 3141 ms, ends the drop. Then 067h is silent for a moment. */
void test_h2_the_first_angle_that_is_valid_again_may_be_held(void) {
    static const unsigned muted_ms[] = {3138, 3145};
    const stub_t returns = {.safe_ms = TRIP_MS,
                            .open_ms = TRIP_MS + 300,
                            .holds = true,
                            .hold_ms = TRIP_MS + 225,
                            .setting = "status_invalid_frames: 1\n"};

    for (unsigned i = 0; i < 2; i++) {
        const char *const steps = with("  - {at_ms: 2950, vcu: ignore, message: turn_signal_command}\n"
                                       "  - {at_ms: 3110, eps: set, field: angle, value: FFFFh, frames: 3}\n"
                                       "  - {at_ms: %u, eps: mute, message: steering_status}\n"
                                       "  - {at_ms: 3145, ai: drive, gear: D, throttle_pct: 60, steer_deg: -60}\n"
                                       "  - {at_ms: 3220, ai: mute, message: steering_command}\n",
                                       muted_ms[i]);
        expect_another_angle(i == 0, &returns, steps);
    }
}

/** The supervisor steers to another angle, and a step before the AI computer turns the wheel makes no hazard of it. */
static void expect_excused(const char *unexcused, const char *excuse, unsigned turned_ms) {
    const stub_t holds = {
        .safe_ms = TRIP_MS, .open_ms = TRIP_MS + 100, .holds = true, .hold_ddeg = 600, .hold_ms = TRIP_MS + 900};
    const char *const steps[] = {unexcused, excuse};
    for (unsigned i = 0; i < 2; i++) {
        const char *const all = with("  - {at_ms: 2950, vcu: ignore, message: turn_signal_command}\n"
                                     "  - {at_ms: 3200, ai: drive, gear: D, throttle_pct: 60, steer_deg: 80}\n%s"
                                     "  - {at_ms: %u, ai: drive, gear: D, throttle_pct: 60, steer_deg: -20}\n"
                                     "  - {at_ms: 3880, ai: mute, message: steering_command}\n",
                                     steps[i], turned_ms);
        expect_another_angle(i == 0, &holds, all);
    }
}

void test_h2_a_flipped_bit_is_a_trip_of_its_own(void) {
    expect_excused("", "  - {at_ms: 3500, supervisor: flip_bit, bit: 1}\n", 3520);
}

/** It is not detected, or has no effect: then the angle of the trip is still right. */
void test_h2_a_flipped_bit_without_effect_is_no_other_trip(void) {
    const stub_t holds = {.safe_ms = TRIP_MS, .open_ms = TRIP_MS + 100, .holds = true, .hold_ms = TRIP_MS + 900};
    static const char flip[] = "  - {at_ms: 2950, vcu: ignore, message: turn_signal_command}\n%s"
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

/** At a reported standstill no valid mode is no fault. Both speeds have to report it, all the time. */
void test_h6_no_valid_mode_at_a_reported_standstill(void) {
    const char *const wheels =
        "  - {at_ms: 2900, vcu: set_bytes, message: wheel_speed, bytes: \"00 00 00 00 00 00 00 00\"}\n"
        "  - {at_ms: 3000, vcu: set, field: mode_bits, value: 0h}\n";

    expect_none(&MUTE, with("  - {at_ms: 2900, vcu: set, field: speed, value: 0000h}\n%s", wheels));
    expect_none(
        &MUTE,
        with("  - {at_ms: 2900, vcu: set, field: speed, value: 0000h, frames: 34, again_every_ms: 370}\n%s", wheels));
    expect_hazard(
        HAZARD_FALSE_NODE, "no valid mode is reported", &MUTE,
        with("  - {at_ms: 2900, vcu: set, field: speed, value: 0000h, frames: 8, again_every_ms: 90}\n%s", wheels));
    expect_hazard(HAZARD_FALSE_NODE, "no valid mode is reported", &MUTE,
                  "  - {at_ms: 2900, vcu: set, field: speed, value: 0000h}\n"
                  "  - {at_ms: 3000, vcu: set, field: mode_bits, value: 0h}\n");
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
