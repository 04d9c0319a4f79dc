/*
 * An hour in which nothing is wrong: hard braking, an AI computer that weaves, hand-overs every 10 s, a bus at 80 % load, in
 * both topologies, on a board with all parts of HW-1 to HW-4. Nothing may trip and nothing may warn. A witness beside the
 * supervisor reads the same wire and judges the vehicle by SUP-5 and SUP-9 to SUP-12 of the requirements: it must stay below
 * half of each limit.
 */
#include <stdio.h>
#include <stdlib.h>

#include "agv/codec.h"
#include "agv/names.h"
#include "agv/state.h"
#include "common/prng.h"
#include "scenario/scenario_testbed.h"
#include "unity.h"

#ifndef HEALTHY_MS
#define HEALTHY_MS 3600000u
#endif

enum {
    READY_MS = 1000,
    HAND_OVER_MS = 10000,
    US_PER_MS = 1000,
    JUDGED_MS = 500,
    THROTTLE_MARGIN = 25,
    IDLE = 2,
    ANGLE_MARGIN_DDEG = 500,
    ANGLE_NEARER_DDEG = 250,
    STANDING_MM_S = 50
};

/* The limits of the requirements. */
enum { W_THROTTLE, W_GEAR, W_STEERING, W_THROTTLE_IN_PARK, W_AUTOPILOT_OFF, W_MODE_NONE, W_SPEED, W_COUNT };
static const struct {
    const char *name;
    uint32_t limit_ms;
} LIMITS[W_COUNT] = {
    [W_THROTTLE] = {"THROTTLE_DEVIATION", 500u},
    [W_GEAR] = {"GEAR_DEVIATION", 1000u},
    [W_STEERING] = {"STEERING_DEVIATION", 500u},
    [W_THROTTLE_IN_PARK] = {"THROTTLE_IN_PARK", 200u},
    [W_AUTOPILOT_OFF] = {"AUTOPILOT_OFF_IGNORED", 1000u},
    [W_MODE_NONE] = {"MODE_NONE", 500u},
    [W_SPEED] = {"SPEED_IMPLAUSIBLE", 1000u},
};

/* What the wire said last, and what follows from it. A budget counts half milliseconds. */
typedef struct {
    int throttle_command, throttle, gear_command, gear, angle_command_ddeg, angle_ddeg;
    int fallen, nearer_ddeg;
    bool autopilot_off, engaged, manual, moving;
    uint32_t wheels_mm_s, vcu_mm_s;
    uint64_t engaged_ms;
    uint64_t engagements[4];
    uint32_t engagement_count;
    uint32_t budget[W_COUNT];
    uint32_t worst[W_COUNT];
    uint32_t quickest_four_ms; /* the shortest time in which four engagements began */
    uint32_t gear_changes_moving;
} witness_t;

static scenario_testbed_t *testbed;
static scenario_t scenario;
static witness_t witness;
static uint64_t random_state;
static uint32_t faults_raised;
static uint32_t trips;
static char first_fault[80];
static bool drives_back; /* the direction of the round */
static int32_t fastest_mm_s;

void setUp(void) {
    testbed = malloc(sizeof *testbed);
    TEST_ASSERT_NOT_NULL(testbed);
    witness = (witness_t){.throttle_command = -1, .gear_command = -1, .angle_command_ddeg = INT32_MAX};
    witness.quickest_four_ms = UINT32_MAX;
    random_state = 1u;
    faults_raised = 0u;
    trips = 0u;
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
    if ((recorded->kind == (uint8_t)AGV_EVENT_FAULT) && (recorded->c != 0u)) {
        faults_raised++;
        if (first_fault[0] == '\0') {
            (void)snprintf(first_fault, sizeof first_fault, "%s at %lu ms", agv_fault_name((agv_fault_t)recorded->a),
                           (unsigned long)event->t_ms);
        }
    }
    trips += ((recorded->kind == (uint8_t)AGV_EVENT_STATE) && (recorded->b == (uint8_t)AGV_STATE_TRIPPED)) ? 1u : 0u;
}

/* An engagement began: no command of the one before counts. */
static void witness_engagement(uint64_t t_ms) {
    const uint64_t fourth_ms = witness.engagements[(witness.engagement_count + 1u) % 4u];

    witness.engaged_ms = t_ms;
    witness.throttle_command = -1;
    witness.gear_command = -1;
    witness.angle_command_ddeg = INT32_MAX;
    witness.autopilot_off = false;
    witness.engagements[witness.engagement_count % 4u] = t_ms;
    witness.engagement_count++;
    if ((witness.engagement_count >= 4u) && (t_ms - fourth_ms < witness.quickest_four_ms)) {
        witness.quickest_four_ms = (uint32_t)(t_ms - fourth_ms);
    }
}

static void hear_vehicle_status(uint64_t t_ms, const uint8_t data[AGV_DLC]) {
    const bool engaged = (data[6] & 0xC0u) == 0x80u;

    if (engaged && !witness.engaged) {
        witness_engagement(t_ms);
    }
    witness.engaged = engaged;
    witness.manual = (data[6] & 0xC0u) == 0x40u;
    witness.vcu_mm_s = (uint32_t)(data[0] + (data[1] * 256)) * 5u / 18u;
}

static void hear_wheels(const uint8_t data[AGV_DLC]) {
    agv_wheel_speed_t speed;

    (void)agv_unpack_wheel_speed(&speed, data);
    witness.wheels_mm_s = (uint32_t)abs((speed.left_mm_s + speed.right_mm_s) / 2);
    witness.moving = abs(speed.left_mm_s) >= STANDING_MM_S;
    fastest_mm_s = (abs(speed.left_mm_s) > fastest_mm_s) ? abs(speed.left_mm_s) : fastest_mm_s;
}

static void hear_throttle(int throttle) {
    witness.fallen += witness.throttle - throttle;
    witness.throttle = throttle;
    if (witness.fallen >= THROTTLE_MARGIN) {
        witness.fallen = 0;
        witness.budget[W_THROTTLE] = 0u;
    }
}

static void hear_angle(int angle_ddeg) {
    const int command_ddeg = witness.angle_command_ddeg;

    if (command_ddeg != INT32_MAX) {
        witness.nearer_ddeg += abs(command_ddeg - witness.angle_ddeg) - abs(command_ddeg - angle_ddeg);
    }
    witness.angle_ddeg = angle_ddeg;
    if (witness.nearer_ddeg >= ANGLE_NEARER_DDEG) {
        witness.nearer_ddeg = 0;
        witness.budget[W_STEERING] = 0u;
    }
}

/* A 168h with another direction than 0A3h reports, while the vehicle moves, is one that a gateway drops. */
static void hear_gear_command(int gear) {
    const bool is_direction = (gear == AGV_GEAR_D) || (gear == AGV_GEAR_R);

    witness.gear_command = gear;
    witness.gear_changes_moving += (is_direction && (gear != witness.gear) && witness.moving) ? 1u : 0u;
}

static void hear_command(agv_message_t message, const uint8_t data[AGV_DLC]) {
    switch (message) {
    case AGV_MSG_GEAR_COMMAND:
        hear_gear_command(data[0]);
        break;
    case AGV_MSG_THROTTLE_COMMAND:
        witness.throttle_command = data[0];
        break;
    case AGV_MSG_STEERING_COMMAND:
        witness.angle_command_ddeg = data[0] + (data[1] * 256) - 9000;
        break;
    default:
        witness.autopilot_off = (data[4] & 0x40u) != 0u;
        break;
    }
}

static void hear_status(agv_message_t message, uint64_t t_ms, const uint8_t data[AGV_DLC]) {
    switch (message) {
    case AGV_MSG_VEHICLE_STATUS:
        hear_vehicle_status(t_ms, data);
        break;
    case AGV_MSG_GEAR_STATUS:
        witness.gear = data[0];
        break;
    case AGV_MSG_THROTTLE_STATUS:
        hear_throttle(data[0]);
        break;
    case AGV_MSG_STEERING_STATUS:
        hear_angle(data[2] + (data[3] * 256) - 9000);
        break;
    case AGV_MSG_WHEEL_SPEED:
        hear_wheels(data);
        break;
    default:
        break;
    }
}

static void on_frame(void *ctx, uint64_t t_us, hal_can_side_t side, int from, const hal_can_frame_t *frame) {
    const agv_message_t message = agv_message_from_id(frame->id, AGV_ID_SET_HEADING);

    (void)ctx;
    if ((side != HAL_CAN_VEHICLE) || (message == AGV_MSG_NONE) || (t_us < READY_MS * US_PER_MS)) {
        return;
    }
    if (vehicle_sender_of(message) != VEHICLE_AI) {
        hear_status(message, t_us / US_PER_MS, frame->data);
    } else if (witness.engaged) {
        hear_command(message, frame->data);
    } else {
        /* in manual the VCU obeys none of them */
    }
    (void)from;
}

static void spend(unsigned which, bool holds) {
    uint32_t *budget = &witness.budget[which];

    *budget = holds ? *budget + 2u : *budget - ((*budget > 0u) ? 1u : 0u);
    witness.worst[which] = (*budget > witness.worst[which]) ? *budget : witness.worst[which];
}

static void witness_speed(void) {
    const uint32_t a = witness.wheels_mm_s;
    const uint32_t b = witness.vcu_mm_s;
    const uint32_t larger = (a > b) ? a : b;

    spend(W_SPEED, larger - ((a > b) ? b : a) > 500u + (larger / 4u));
}

static void witness_tick(uint64_t t_ms) {
    const bool evaluated = witness.engaged && (t_ms - witness.engaged_ms >= JUDGED_MS);
    const bool is_direction = (witness.gear == AGV_GEAR_D) || (witness.gear == AGV_GEAR_R);
    const bool other_gear = is_direction && (witness.gear_command >= 0) && (witness.gear_command != witness.gear);

    witness.fallen = (witness.budget[W_THROTTLE] == 0u) ? 0 : witness.fallen;
    witness.nearer_ddeg = (witness.budget[W_STEERING] == 0u) ? 0 : witness.nearer_ddeg;
    spend(W_MODE_NONE, !witness.engaged && !witness.manual && witness.moving);
    witness_speed();
    if (!evaluated) {
        return;
    }
    spend(W_THROTTLE,
          (witness.throttle_command >= 0) && (witness.throttle > witness.throttle_command + THROTTLE_MARGIN));
    spend(W_GEAR, other_gear && (witness.throttle > IDLE));
    spend(W_STEERING, (witness.angle_command_ddeg != INT32_MAX) &&
                          (abs(witness.angle_command_ddeg - witness.angle_ddeg) > ANGLE_MARGIN_DDEG));
    spend(W_THROTTLE_IN_PARK, (witness.gear == AGV_GEAR_P) && (witness.throttle > IDLE));
    spend(W_AUTOPILOT_OFF, witness.autopilot_off);
}

static void act(uint32_t t_ms, vehicle_action_t action) {
    const scenario_step_t step = {.at_ms = t_ms, .of_vehicle = true, .vehicle = action};
    scenario_testbed_do(testbed, &step);
}

static int32_t draw_angle_ddeg(int32_t most) {
    return (int32_t)prng_draw(&random_state, 0u, 2u * (uint32_t)most) - most;
}

static void ai_drives(uint32_t t_ms, uint8_t gear, uint16_t throttle_permille) {
    act(t_ms, (vehicle_action_t){.what = VEHICLE_DO_AI_DRIVE,
                                 .gear = gear,
                                 .throttle_permille = throttle_permille,
                                 .angle_ddeg = draw_angle_ddeg(900)});
}

/* From manual to autopilot, at standstill or under way, in whatever direction. */
static void engage(uint32_t t_ms) {
    drives_back = prng_draw(&random_state, 0u, 3u) == 0u;
    ai_drives(t_ms, drives_back ? AGV_GEAR_R : AGV_GEAR_D, (uint16_t)prng_draw(&random_state, 200u, 1000u));
    act(t_ms, (vehicle_action_t){.what = VEHICLE_DO_AI_WEAVE,
                                 .angle_ddeg = draw_angle_ddeg(1500),
                                 .ms = prng_draw(&random_state, 2000u, 8000u)});
    act(t_ms, (vehicle_action_t){.what = VEHICLE_DO_ENGAGE});
}

/* It brakes hard: by throttle 0, by gear P, or to go the other way. */
static void brake(uint32_t t_ms) {
    switch (prng_draw(&random_state, 0u, 3u)) {
    case 0:
        ai_drives(t_ms, drives_back ? AGV_GEAR_R : AGV_GEAR_D, 0u);
        break;
    case 1:
        ai_drives(t_ms, AGV_GEAR_P, 0u);
        break;
    case 2:
        ai_drives(t_ms, drives_back ? AGV_GEAR_D : AGV_GEAR_R, 500u);
        break;
    default:
        ai_drives(t_ms, AGV_GEAR_N, 0u);
        break;
    }
}

/* From autopilot to manual; the operator drives on, or stops, or lets it roll. */
static void disengage(uint32_t t_ms) {
    static const uint8_t gears[] = {AGV_GEAR_D, AGV_GEAR_R, AGV_GEAR_N, AGV_GEAR_P};
    const uint8_t gear = gears[prng_draw(&random_state, 0u, 3u)];

    act(t_ms, (vehicle_action_t){.what = VEHICLE_DO_DISENGAGE});
    act(t_ms, (vehicle_action_t){.what = VEHICLE_DO_HAND_STEER, .angle_ddeg = draw_angle_ddeg(1800)});
    act(t_ms, (vehicle_action_t){.what = VEHICLE_DO_REMOTE_DRIVE,
                                 .gear = gear,
                                 .throttle_permille = (uint16_t)prng_draw(&random_state, 0u, 800u)});
}

/* Somebody honks: a press that is none of a reset. */
static void press(uint32_t t_ms, bool on) {
    act(t_ms, (vehicle_action_t){.what = VEHICLE_DO_BUTTON, .count = 1u, .on = on});
}

static void operator(uint32_t t_ms) {
    const uint32_t round_ms = t_ms % (2u * HAND_OVER_MS);
    static uint32_t brake_ms;

    if (round_ms == 0u) {
        engage(t_ms);
        brake_ms = prng_draw(&random_state, 2000u, 9000u);
    } else if (round_ms == brake_ms) {
        brake(t_ms);
    } else if (round_ms == HAND_OVER_MS) {
        disengage(t_ms);
    } else if ((round_ms == 13000u) || (round_ms == 13400u)) {
        press(t_ms, round_ms == 13000u);
    } else {
        /* they drive */
    }
}

/* Other nodes, three of them: with what vehicle and supervisor send, 80 % of what the wire can carry. */
static void load(hal_can_side_t side) {
    static const struct {
        uint32_t id;
        uint32_t every_ms;
    } senders[] = {{0x010u, 1u}, {0x400u, 1u}, {0x7FEu, 4u}};

    for (size_t i = 0u; i < sizeof senders / sizeof senders[0]; i++) {
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

static void begin(bool gateway, bool shadow) {
    const scenario_watch_t watch = {.on_event = on_event, .on_frame = on_frame};

    scenario = (scenario_t){.bitrate = SCENARIO_DEFAULT_BITRATE};
    agv_config_defaults(&scenario.config);
    vehicle_defaults(&scenario.vehicle);
    scenario.board = board_with_all_parts();
    scenario.vehicle.coasting_mm_s2 = 3000u; /* its drive brakes hard when it gets no throttle */
    scenario.vehicle.gateway = gateway;
    scenario.config.topology = gateway ? AGV_TOPOLOGY_GATEWAY : AGV_TOPOLOGY_SHARED;
    scenario.config.shadow = shadow ? AGV_SHADOW_ON : AGV_SHADOW_OFF;
    agv_config_ids(&scenario.config, &scenario.ids);
    TEST_ASSERT_TRUE(scenario_testbed_init(testbed, &scenario));
    scenario_testbed_watch(testbed, &watch);
    scenario_testbed_start(testbed);
}

static scenario_testbed_view_t look(void) {
    scenario_testbed_view_t view;
    scenario_testbed_view(testbed, &view);
    return view;
}

static void drive(bool gateway) {
    begin(gateway, false);
    for (uint32_t t_ms = 0u; t_ms < HEALTHY_MS; t_ms++) {
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
        witness_tick(t_ms);
        if (((t_ms > READY_MS) && !look().output_closed) || (faults_raised > 0u)) {
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

    TEST_ASSERT_EQUAL_UINT32(0u, trips);
    TEST_ASSERT_EQUAL_UINT32(0u, counters->warnings);
    TEST_ASSERT_EQUAL_UINT32(0u, counters->gate_refused);
    TEST_ASSERT_EQUAL_UINT32(0u, look().lost_frames);
    TEST_ASSERT_EQUAL_UINT32(0u, look().bites);
    TEST_ASSERT_GREATER_OR_EQUAL_UINT32(HEALTHY_MS / (2u * HAND_OVER_MS) - 1u, witness.engagement_count);
    TEST_ASSERT_GREATER_OR_EQUAL_INT32(3500, fastest_mm_s);
    TEST_ASSERT_UINT32_WITHIN(20u, 800u, load_permille(HAL_CAN_VEHICLE));
    if (gateway) {
        TEST_ASSERT_GREATER_OR_EQUAL_UINT32(750u, load_permille(HAL_CAN_AI));
    }
    TEST_ASSERT_GREATER_OR_EQUAL_UINT32(10000u, witness.quickest_four_ms); /* MODE_FLAPPING: within 5000 ms */
    TEST_ASSERT_EQUAL_UINT32(0u, witness.gear_changes_moving);
    for (unsigned i = 0u; i < W_COUNT; i++) {
        (void)printf("%-22s at most %4u of %4u ms\n", LIMITS[i].name, (unsigned)witness.worst[i] / 2u,
                     (unsigned)LIMITS[i].limit_ms);
        TEST_ASSERT_LESS_OR_EQUAL_UINT32_MESSAGE(LIMITS[i].limit_ms, witness.worst[i], LIMITS[i].name);
    }
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

/* The VCU goes on as it was told before, the steering is stuck while the AI computer weaves. */
static void go_wrong(uint32_t t_ms) {
    act(t_ms, (vehicle_action_t){.what = VEHICLE_DO_IGNORE, .message = AGV_MSG_THROTTLE_COMMAND, .on = true});
    act(t_ms, (vehicle_action_t){.what = VEHICLE_DO_IGNORE, .message = AGV_MSG_GEAR_COMMAND, .on = true});
    act(t_ms, (vehicle_action_t){.what = VEHICLE_DO_EPS_STUCK, .on = true});
    act(t_ms, (vehicle_action_t){.what = VEHICLE_DO_AI_WEAVE, .angle_ddeg = 3000, .ms = 8000u});
    ai_drives(t_ms, AGV_GEAR_N, 0u);
}

/* In shadow, as a supervisor that sends ends the engagement before all of it shows. */
void test_the_witness_sees_what_is_wrong(void) {
    begin(false, true);
    for (uint32_t t_ms = 0u; t_ms < 15000u; t_ms++) {
        if (t_ms == 8000u) {
            ai_drives(t_ms, AGV_GEAR_D, 800u);
            act(t_ms, (vehicle_action_t){.what = VEHICLE_DO_ENGAGE});
        } else if (t_ms == 12000u) {
            go_wrong(t_ms);
        } else {
            /* it drives */
        }
        scenario_testbed_tick(testbed, t_ms);
        witness_tick(t_ms);
    }
    TEST_ASSERT_GREATER_THAN_UINT32(LIMITS[W_THROTTLE].limit_ms, witness.worst[W_THROTTLE]);
    TEST_ASSERT_GREATER_THAN_UINT32(LIMITS[W_GEAR].limit_ms, witness.worst[W_GEAR]);
    TEST_ASSERT_GREATER_THAN_UINT32(LIMITS[W_STEERING].limit_ms, witness.worst[W_STEERING]);
}
