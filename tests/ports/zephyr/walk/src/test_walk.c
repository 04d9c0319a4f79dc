/*
 * The firmware's supervisor in its own thread, with frames of a vehicle injected in interrupts: power-on, engagement,
 * the AI computer falls silent, the vehicle confirms, the operator resets; then a fault bit in a frame.
 */
#include <zephyr/ztest.h>

#include "agv/codec.h"
#include "fake_parts.h"
#include "supervise.h"
#include "vehicle.h"

static ZEPHYR_HAL_RETAINED agv_recorder_t recorder;
static ZEPHYR_HAL_RETAINED zephyr_hal_retained_t retained;
static supervise_t self;
static uint32_t started_ms;
static uint32_t first_frame_ms;

static K_THREAD_STACK_DEFINE(stack, 2048);
static struct k_thread thread;

static void supervise(void *a, void *b, void *c) {
    ARG_UNUSED(a);
    ARG_UNUSED(b);
    ARG_UNUSED(c);
    supervise_start(&self, &recorder, &retained);
    for (;;) {
        supervise_once(&self);
    }
}

static void *setup(void) {
    fake_parts_reset();
    fake_buses[HAL_CAN_VEHICLE].sends_at_once = true;
    vehicle = (vehicle_t){.park = true};
    started_ms = k_uptime_get_32();
    (void)k_thread_create(&thread, stack, K_THREAD_STACK_SIZEOF(stack), supervise, NULL, NULL, NULL, K_PRIO_COOP(2), 0,
                          K_NO_WAIT);
    k_thread_name_set(&thread, "supervisor");
    while (fake_buses[HAL_CAN_VEHICLE].sent_count == 0u) {
        vehicle_run(2u);
    }
    first_frame_ms = fake_buses[HAL_CAN_VEHICLE].sent_ms[0] - started_ms;
    return NULL;
}

static void before(void *unused) {
    ARG_UNUSED(unused);
    fake_parts_connect();
}

ZTEST_SUITE(walk, NULL, setup, before, NULL, NULL);

static void assert_state(agv_state_t state, const char *what) {
    zassert_equal(agv_supervisor_state(&self.supervisor), state, "%s: the state is %x", what,
                  agv_supervisor_state(&self.supervisor));
}

static const struct can_frame *frame_since(uint32_t since, uint32_t id) {
    const fake_bus_t *const bus = &fake_buses[HAL_CAN_VEHICLE];
    for (uint32_t i = since; i < bus->sent_count; i++) {
        if (bus->sent[i % FAKE_SENT_MAX].id == id) {
            return &bus->sent[i % FAKE_SENT_MAX];
        }
    }
    return NULL;
}

static void assert_safe_commands_since(uint32_t since) {
    const struct can_frame *const gear = frame_since(since, 0x168u);
    const struct can_frame *const throttle = frame_since(since, 0x075u);
    const struct can_frame *const lights = frame_since(since, 0x43Fu);
    zassert_not_null(gear);
    zassert_equal(gear->data[0], AGV_GEAR_P);
    zassert_not_null(throttle);
    zassert_equal(throttle->data[0], 0u);
    zassert_not_null(lights);
    zassert_equal(lights->data[4] & AGV_SIGNAL_AUTOPILOT_OFF, AGV_SIGNAL_AUTOPILOT_OFF);
}

static void start_to_standby(void) {
    assert_state(AGV_STATE_INIT, "after a power-on");
    zassert_false(fake_output_is_closed());
    assert_safe_commands_since(0u);
    zassert_true(first_frame_ms <= 100u, /* after the self-test */
                 "the first safe frame came at %u ms", first_frame_ms);
    vehicle_run(800u);
    assert_state(AGV_STATE_STANDBY, "all well for 500 ms");
    zassert_true(fake_output_is_closed());
}

static uint32_t cycles_a_ms;

static uint64_t cycles_of_the_thread(void) {
    k_thread_runtime_stats_t stats = {0};
    zassert_ok(k_thread_runtime_stats_get(&thread, &stats));
    return stats.execution_cycles;
}

static void assert_only_status_frames_since(uint32_t since, uint32_t count) {
    const fake_bus_t *const bus = &fake_buses[HAL_CAN_VEHICLE];
    zassert_equal(bus->sent_count - since, count, "%u frames", bus->sent_count - since);
    for (uint32_t i = since; i < bus->sent_count; i++) {
        zassert_equal(bus->sent[i % FAKE_SENT_MAX].id, 0x7F0u, "%03x", bus->sent[i % FAKE_SENT_MAX].id);
    }
}

static void drive_off(void) {
    vehicle.autopilot = true;
    vehicle.park = false;
    vehicle.speed_mm_s = 800;
    vehicle_run(300u);
    assert_state(AGV_STATE_ACTIVE, "engaged");
    const uint32_t sent = fake_buses[HAL_CAN_VEHICLE].sent_count;
    const uint64_t cycles = cycles_of_the_thread();
    vehicle_run(300u);
    cycles_a_ms = (uint32_t)((cycles_of_the_thread() - cycles) / 300u);
    assert_only_status_frames_since(sent, 3u);
}

static void obey(void) {
    vehicle.autopilot = false;
    vehicle.speed_mm_s = 0;
    vehicle.park = true;
    vehicle_run(400u);
    assert_state(AGV_STATE_SAFE, "the vehicle obeyed");
    zassert_true(fake_output_is_closed());
}

static void operator_resets(void) {
    vehicle.button_1 = true;
    vehicle_run(1200u);
    vehicle.button_1 = false;
    vehicle_run(50u);
    assert_state(AGV_STATE_STANDBY, "reset");
}

/* Shows: FSM-2, FSM-3, FSM-4, FSM-5, TOP-1, INT-3 */
ZTEST(walk, test_the_whole_round) {
    start_to_standby();
    drive_off();

    uint32_t sent = fake_buses[HAL_CAN_VEHICLE].sent_count;
    vehicle.ai_is_silent = true;
    vehicle_run(200u);
    assert_state(AGV_STATE_TRIPPED, "the AI computer is silent");
    zassert_equal(agv_supervisor_first_reason(&self.supervisor), AGV_FAULT_STEERING_COMMAND_TIMEOUT);
    assert_safe_commands_since(sent);
    obey();
    vehicle.ai_is_silent = false;
    operator_resets();

    drive_off();
    sent = fake_buses[HAL_CAN_VEHICLE].sent_count;
    vehicle.eps_faults = AGV_EPS_FAULT_OVER_CURRENT_SHUTDOWN;
    vehicle_run(20u);
    assert_state(AGV_STATE_TRIPPED, "the EPS reports a fault");
    zassert_equal(agv_supervisor_first_reason(&self.supervisor), AGV_FAULT_EPS_OVER_CURRENT_SHUTDOWN);
    assert_safe_commands_since(sent);
    vehicle.eps_faults = 0u;
    obey();
    vehicle.ai_is_silent = true;
    operator_resets();

    zassert_true(fake_window_watchdog.feeds > 100u);
    zassert_equal(fake_window_watchdog.outside, 0u, "always fed in its window");

    uint8_t event[HAL_STORE_RECORD_SIZE_MAX];
    zassert_equal(hal_store_read_record(&self.hal, 0u, event, sizeof event), sizeof(agv_event_t),
                  "events are in flash");
    size_t unused = 0u;
    zassert_ok(k_thread_stack_space_get(&thread, &unused));
    TC_PRINT("first safe frame: %u ms after the thread's start\n", first_frame_ms);
#if defined(CONFIG_QEMU_ICOUNT_SHIFT)
    TC_PRINT("supervisor's thread: %u instructions a millisecond\n",
             (uint32_t)(k_cyc_to_ns_floor64(cycles_a_ms) >> CONFIG_QEMU_ICOUNT_SHIFT));
#endif
    TC_PRINT("supervisor's stack: %u bytes used\n", (unsigned)(K_THREAD_STACK_SIZEOF(stack) - unused));
}
