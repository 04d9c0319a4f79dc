/*
 * An hour in which nothing is wrong: hard braking, an AI computer that weaves, hand-overs every 10 s, a bus at 80 % load, in
 * both topologies, on a board with all parts of HW-1 to HW-4. Nothing may trip and nothing may warn, though each time budget
 * of SUP-5 and SUP-9 to SUP-12 is half its default, and four engagements within twice the default time would trip.
 */
#include <stdio.h>
#include <stdlib.h>

#include "agv/names.h"
#include "agv/state.h"
#include "common/prng.h"
#include "scenario/scenario_testbed.h"
#include "unity.h"

#ifndef HEALTHY_MS
#define HEALTHY_MS 3600000u
#endif

enum { READY_MS = 1000, HAND_OVER_MS = 10000, US_PER_MS = 1000, STANDING_MM_S = 50 };

static scenario_testbed_t *testbed;
static scenario_t scenario;
static uint64_t random_state;
static uint32_t faults_raised;
static uint32_t trips;
static uint32_t engagements;
static uint32_t gear_changes_moving;
static char first_fault[80];
static bool drives_back; /* the direction of the round */
static int32_t fastest_mm_s;

void setUp(void) {
    testbed = malloc(sizeof *testbed);
    TEST_ASSERT_NOT_NULL(testbed);
    random_state = 1;
    faults_raised = 0;
    trips = 0;
    engagements = 0;
    gear_changes_moving = 0;
    fastest_mm_s = 0;
    first_fault[0] = '\0';
}

void tearDown(void) {
    free(testbed);
}

static void on_event(void *ctx, const session_event_t *event) {
    const agv_event_t *recorded = &event->recorded;
    (void)ctx;
    if (event->is_led || (event->t_ms < READY_MS)) {
        return;
    }
    if ((recorded->kind == AGV_EVENT_FAULT) && (recorded->c != 0)) {
        faults_raised++;
        if (first_fault[0] == '\0') {
            (void)snprintf(first_fault, sizeof first_fault, "%s at %lu ms", agv_fault_name((agv_fault_t)recorded->a),
                           (unsigned long)event->t_ms);
        }
    }
    if (recorded->kind == AGV_EVENT_STATE) {
        trips += (recorded->b == AGV_STATE_TRIPPED) ? 1 : 0;
        engagements += (recorded->b == AGV_STATE_ACTIVE) ? 1 : 0;
    }
}

static scenario_testbed_view_t look(void) {
    scenario_testbed_view_t view;
    scenario_testbed_view(testbed, &view);
    return view;
}

/* A 168h with another direction than the vehicle has, while it moves, is one that a gateway drops. */
static void on_frame(void *ctx, uint64_t t_us, hal_can_side_t side, int from, const hal_can_frame_t *frame) {
    const uint8_t gear = frame->data[0];

    (void)ctx;
    (void)side;
    (void)from;
    if ((t_us >= READY_MS * US_PER_MS) && (frame->id == agv_message_id(AGV_MSG_GEAR_COMMAND, AGV_ID_SET_HEADING)) &&
        ((gear == AGV_GEAR_D) || (gear == AGV_GEAR_R))) {
        const vehicle_state_t vehicle = look().vehicle;
        const bool moving = abs(vehicle.speed_mm_s) >= STANDING_MM_S;
        gear_changes_moving += (vehicle.autopilot && moving && (vehicle.gear != gear)) ? 1 : 0;
    }
}

static void act(uint32_t t_ms, vehicle_action_t action) {
    const scenario_step_t step = {.at_ms = t_ms, .of_vehicle = true, .vehicle = action};
    scenario_testbed_do(testbed, &step);
}

static int32_t draw_angle_ddeg(int32_t most) {
    return (int32_t)prng_draw(&random_state, 0, 2 * (uint32_t)most) - most;
}

static void ai_drives(uint32_t t_ms, uint8_t gear, uint16_t throttle_permille) {
    act(t_ms, (vehicle_action_t){.what = VEHICLE_DO_AI_DRIVE,
                                 .gear = gear,
                                 .throttle_permille = throttle_permille,
                                 .angle_ddeg = draw_angle_ddeg(900)});
}

/* From manual to autopilot, at standstill or under way, in whatever direction. */
static void engage(uint32_t t_ms) {
    drives_back = prng_draw(&random_state, 0, 3) == 0;
    ai_drives(t_ms, drives_back ? AGV_GEAR_R : AGV_GEAR_D, (uint16_t)prng_draw(&random_state, 200, 1000));
    act(t_ms, (vehicle_action_t){.what = VEHICLE_DO_AI_WEAVE,
                                 .angle_ddeg = draw_angle_ddeg(1500),
                                 .ms = prng_draw(&random_state, 2000, 8000)});
    act(t_ms, (vehicle_action_t){.what = VEHICLE_DO_ENGAGE});
}

/* It brakes hard: by throttle 0, by gear P, or to go the other way. */
static void brake(uint32_t t_ms) {
    switch (prng_draw(&random_state, 0, 3)) {
    case 0:
        ai_drives(t_ms, drives_back ? AGV_GEAR_R : AGV_GEAR_D, 0);
        break;
    case 1:
        ai_drives(t_ms, AGV_GEAR_P, 0);
        break;
    case 2:
        ai_drives(t_ms, drives_back ? AGV_GEAR_D : AGV_GEAR_R, 500);
        break;
    default:
        ai_drives(t_ms, AGV_GEAR_N, 0);
        break;
    }
}

/* From autopilot to manual; the operator drives on, or stops, or lets it roll. */
static void disengage(uint32_t t_ms) {
    static const uint8_t gears[] = {AGV_GEAR_D, AGV_GEAR_R, AGV_GEAR_N, AGV_GEAR_P};
    const uint8_t gear = gears[prng_draw(&random_state, 0, 3)];

    act(t_ms, (vehicle_action_t){.what = VEHICLE_DO_DISENGAGE});
    act(t_ms, (vehicle_action_t){.what = VEHICLE_DO_HAND_STEER, .angle_ddeg = draw_angle_ddeg(1800)});
    act(t_ms, (vehicle_action_t){.what = VEHICLE_DO_REMOTE_DRIVE,
                                 .gear = gear,
                                 .throttle_permille = (uint16_t)prng_draw(&random_state, 0, 800)});
}

/* Somebody honks: a press that is none of a reset. */
static void press(uint32_t t_ms, bool on) {
    act(t_ms, (vehicle_action_t){.what = VEHICLE_DO_BUTTON, .count = 1, .on = on});
}

static void operator(uint32_t t_ms) {
    const uint32_t round_ms = t_ms % (2 * HAND_OVER_MS);
    static uint32_t brake_ms;

    if (round_ms == 0) {
        engage(t_ms);
        brake_ms = prng_draw(&random_state, 2000, 9000);
    } else if (round_ms == brake_ms) {
        brake(t_ms);
    } else if (round_ms == HAND_OVER_MS) {
        disengage(t_ms);
    } else if ((round_ms == 13000) || (round_ms == 13400)) {
        press(t_ms, round_ms == 13000);
    } else {
        /* they drive */
    }
}

/* Other nodes, three of them: with what vehicle and supervisor send, 80 % of what the wire can carry. */
static void load(hal_can_side_t side) {
    static const struct {
        uint32_t id;
        uint32_t every_ms;
    } senders[] = {{0x010u, 1}, {0x400u, 1}, {0x7FEu, 4}};

    for (size_t i = 0; i < sizeof senders / sizeof senders[0]; i++) {
        act(READY_MS, (vehicle_action_t){.what = VEHICLE_DO_SEND,
                                         .side = side,
                                         .ms = senders[i].every_ms,
                                         .count = VEHICLE_FOREVER,
                                         .frame = {.id = senders[i].id, .length = AGV_DLC, .data = {0xA5u}}});
    }
}

/* Its clock is 3 % slow: within what HW-4 allows. */
static sim_board_t board_with_all_parts(void) {
    return (sim_board_t){.has_feedback = true,
                         .has_emergency_stop = true,
                         .has_reset_button = true,
                         .has_second_clock = true,
                         .clock_permille = 30};
}

static void halve_the_budgets(agv_config_t *config) {
    config->mode_none_ms /= 2;
    config->steering_deviation_ms /= 2;
    config->throttle_deviation_ms /= 2;
    config->gear_deviation_ms /= 2;
    config->autopilot_off_ms /= 2;
    config->throttle_in_park_ms /= 2;
    config->speed_implausible_ms /= 2;
    config->mode_flapping_ms *= 2;
    TEST_ASSERT_EQUAL_INT(AGV_CONFIG_OK, agv_config_check(config).problem);
}

static void begin(bool gateway) {
    const scenario_watch_t watch = {.on_event = on_event, .on_frame = on_frame};

    scenario = (scenario_t){.bitrate = SCENARIO_DEFAULT_BITRATE};
    agv_config_defaults(&scenario.config);
    vehicle_defaults(&scenario.vehicle);
    scenario.board = board_with_all_parts();
    scenario.vehicle.coasting_mm_s2 = 3000; /* its drive brakes hard when it gets no throttle */
    scenario.vehicle.gateway = gateway;
    scenario.config.topology = gateway ? AGV_TOPOLOGY_GATEWAY : AGV_TOPOLOGY_SHARED;
    halve_the_budgets(&scenario.config);
    agv_config_ids(&scenario.config, &scenario.ids);
    TEST_ASSERT_TRUE(scenario_testbed_init(testbed, &scenario));
    scenario_testbed_watch(testbed, &watch);
    scenario_testbed_start(testbed);
}

static void drive(bool gateway) {
    begin(gateway);
    for (uint32_t t_ms = 0; t_ms < HEALTHY_MS; t_ms++) {
        if (t_ms == READY_MS) {
            load(HAL_CAN_VEHICLE);
            if (gateway) {
                load(HAL_CAN_AI);
            }
        }
        if (t_ms > READY_MS) {
            operator(t_ms);
        }
        scenario_testbed_tick(testbed, t_ms);
        const scenario_testbed_view_t view = look();
        const int32_t speed_mm_s = abs(view.vehicle.speed_mm_s);
        fastest_mm_s = (speed_mm_s > fastest_mm_s) ? speed_mm_s : fastest_mm_s;
        if (((t_ms > READY_MS) && !view.output_closed) || (faults_raised > 0)) {
            TEST_FAIL_MESSAGE((first_fault[0] != '\0') ? first_fault : "the safety output is open");
        }
    }
}

static uint32_t load_permille(hal_can_side_t side) {
    sim_bus_stats_t stats;
    scenario_testbed_bus_stats(testbed, side, &stats);
    return (uint32_t)(stats.busy_us / HEALTHY_MS);
}

static void judge(bool gateway) {
    const agv_counters_t *counters = agv_supervisor_counters(&scenario_testbed_session(testbed)->supervisor);

    TEST_ASSERT_EQUAL_UINT32(0, trips);
    TEST_ASSERT_EQUAL_UINT32(0, counters->warnings);
    TEST_ASSERT_EQUAL_UINT32(0, counters->gate_refused);
    TEST_ASSERT_EQUAL_UINT32(0, look().lost_frames);
    TEST_ASSERT_EQUAL_UINT32(0, look().bites);
    TEST_ASSERT_GREATER_OR_EQUAL_UINT32(HEALTHY_MS / (2 * HAND_OVER_MS) - 1, engagements);
    TEST_ASSERT_GREATER_OR_EQUAL_INT32(3500, fastest_mm_s);
    TEST_ASSERT_UINT32_WITHIN(20, 800, load_permille(HAL_CAN_VEHICLE));
    if (gateway) {
        TEST_ASSERT_GREATER_OR_EQUAL_UINT32(750, load_permille(HAL_CAN_AI));
    }
    TEST_ASSERT_EQUAL_UINT32(0, gear_changes_moving);
}

/* Shows: SUP-5, TOP-1, HW-1, HW-4 */
void test_an_hour_on_the_shared_bus(void) {
    drive(false);
    judge(false);
}

/* Shows: SUP-5, TOP-2 */
void test_an_hour_in_the_gateway(void) {
    drive(true);
    judge(true);
}
