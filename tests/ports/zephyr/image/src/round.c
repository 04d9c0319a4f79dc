/*
 * A simulated vehicle on the bus of the firmware's image: start, engagement, the AI computer falls silent, the vehicle
 * confirms, the operator resets; then bus-off; then a flood. The test receives the image's frames on the bus and reads
 * its output at the pin.
 */
#include <string.h>

#include <zephyr/drivers/can.h>
#include <zephyr/drivers/gpio/gpio_emul.h>
#include <zephyr/drivers/hwinfo.h>
#include <zephyr/init.h>
#include <zephyr/kernel.h>
#include <zephyr/sys/printk.h>

#include "agv/codec.h"
#include "agv/names.h"
#include "agv/protocol.h"
#include "node.h"
#include "supervise.h"
#include "vehicle.h"

enum { HEARD_MAX = 256, PIN_OUTPUT = 1, STACK_SIZE = 2048, PRIORITY = 5, FIRST_FRAME_LATEST_MS = 100 };

extern supervise_t agv_supervise;
extern struct k_thread z_main_thread; /* the supervisor's */

static struct can_frame heard[HEARD_MAX];
static uint32_t heard_count;
static uint32_t first_ticks;
static uint64_t cycles_a_ms;
static bool failed;

/* This machine has no reset flags; each start is a power-on. */
int z_impl_hwinfo_get_reset_cause(uint32_t *cause) {
    *cause = RESET_POR;
    return 0;
}

int z_impl_hwinfo_get_supported_reset_cause(uint32_t *supported) {
    *supported = RESET_POR | RESET_BROWNOUT;
    return 0;
}

int z_impl_hwinfo_clear_reset_cause(void) {
    return 0;
}

/* Runs in the thread of the bus. */
static void on_frame(const struct device *wire, struct can_frame *frame, void *unused) {
    ARG_UNUSED(wire);
    ARG_UNUSED(unused);
    if (test_node_sent_it()) {
        first_ticks = (heard_count == 0u) ? (uint32_t)k_uptime_ticks() : first_ticks;
        heard[heard_count % HEARD_MAX] = *frame;
        heard_count++;
    }
}

static void on_sent(const struct device *wire, int error, void *unused) {
    ARG_UNUSED(wire);
    ARG_UNUSED(error);
    ARG_UNUSED(unused);
    test_node_others_send();
}

void vehicle_sends(const struct can_frame *frame) {
    (void)can_send(test_wire, frame, K_FOREVER, on_sent, NULL);
}

static void expect(bool holds, const char *what) {
    const char *const state = agv_state_name(agv_supervisor_state(&agv_supervise.supervisor));
    failed = failed || !holds;
    printk("%s: %s (%s)\n", holds ? "ok" : "FAILED", what, state);
}

static void expect_state(agv_state_t state, const char *what) {
    expect(agv_supervisor_state(&agv_supervise.supervisor) == state, what);
}

static void expect_output(bool closed, const char *what) {
    expect(gpio_emul_output_get(DEVICE_DT_GET(DT_NODELABEL(test_pins)), PIN_OUTPUT) == (closed ? 1 : 0), what);
}

static const struct can_frame *frame_since(uint32_t since, uint32_t id) {
    for (uint32_t i = since; i < heard_count; i++) {
        if (heard[i % HEARD_MAX].id == id) {
            return &heard[i % HEARD_MAX];
        }
    }
    return NULL;
}

static void expect_safe_commands_since(uint32_t since, const char *what) {
    const struct can_frame *const gear = frame_since(since, 0x168u);
    const struct can_frame *const throttle = frame_since(since, 0x075u);
    const struct can_frame *const lights = frame_since(since, 0x43Fu);
    expect((gear != NULL) && (gear->data[0] == (uint8_t)AGV_GEAR_P) && (throttle != NULL) &&
               (throttle->data[0] == 0u) && (lights != NULL) && ((lights->data[4] & 0x70u) == 0x70u),
           what);
}

static uint64_t supervisors_cycles(void) {
    k_thread_runtime_stats_t stats = {0};
    (void)k_thread_runtime_stats_get(&z_main_thread, &stats);
    return stats.execution_cycles;
}

static void drive_off(void) {
    vehicle.autopilot = true;
    vehicle.park = false;
    vehicle.speed_mm_s = 800;
    vehicle_run(300u);
    expect_state(AGV_STATE_ACTIVE, "engaged");
    const uint32_t before = heard_count;
    const uint64_t cycles = supervisors_cycles();
    vehicle_run(300u);
    cycles_a_ms = (supervisors_cycles() - cycles) / 300u;
    expect((heard_count - before) == 3u, "only the status frame leaves, every 100 ms");
}

static void obey_and_reset(void) {
    vehicle.autopilot = false;
    vehicle.speed_mm_s = 0;
    vehicle.park = true;
    vehicle_run(400u);
    expect_state(AGV_STATE_SAFE, "the vehicle obeyed");
    vehicle.ai_is_silent = false;
    vehicle.button_1 = true;
    vehicle_run(1200u);
    vehicle.button_1 = false;
    vehicle_run(50u);
    expect_state(AGV_STATE_STANDBY, "the operator reset it");
    expect_output(true, "the output is closed again");
}

static void silent_ai(void) {
    drive_off();
    const uint32_t before = heard_count;
    vehicle.ai_is_silent = true;
    vehicle_run(200u);
    expect_state(AGV_STATE_TRIPPED, "the AI computer is silent");
    expect(agv_supervisor_first_reason(&agv_supervise.supervisor) == AGV_FAULT_STEERING_COMMAND_TIMEOUT,
           "and that is the first reason");
    expect_safe_commands_since(before, "safe commands are on the wire");
    expect_output(true, "the output stays closed");
    obey_and_reset();
}

static void bus_off(void) {
    drive_off();
    uint32_t before = heard_count;
    test_node_goes_bus_off();
    vehicle_run(50u);
    expect_state(AGV_STATE_TRIPPED, "bus-off");
    expect(agv_supervisor_first_reason(&agv_supervise.supervisor) == AGV_FAULT_BUS_OFF, "and that is the first reason");
    expect_output(false, "the output is open: no command can be given");
    expect((heard_count == before) && (test_node_recoveries() == 0u), "nothing leaves, nobody recovers by himself");
    vehicle_run(200u);
    expect(test_node_recoveries() == 1u, "asked to recover once");
    expect_safe_commands_since(before, "safe commands are on the wire again");
    obey_and_reset();
}

static hal_can_status_t status_now(void) {
    hal_can_status_t status;
    k_sched_lock();
    hal_can_status(&agv_supervise.hal, HAL_CAN_VEHICLE, &status);
    k_sched_unlock();
    return status;
}

static void flood(void) {
    enum { FLOOD_ID = 0x500 }; /* above the safe commands, below the status frame */
    drive_off();
    test_node_overrun();
    const hal_can_status_t earlier = status_now();
    const uint32_t before = heard_count;
    test_node_flood(FLOOD_ID);
    vehicle_run(250u);
    expect_state(AGV_STATE_TRIPPED, "a flood keeps the status frame in the controller");
    expect(agv_supervisor_first_reason(&agv_supervise.supervisor) == AGV_FAULT_TX_STALLED,
           "and that is the first reason");
    expect_safe_commands_since(before, "safe commands are on the wire, in front of the flood");
    expect(frame_since(before, 0x7F0u) == NULL, "the status frame that waited is not");
    const hal_can_status_t later = status_now();
    expect((later.state == HAL_CAN_ERROR_ACTIVE) && (later.bus_off_count == earlier.bus_off_count),
           "that was no bus-off");
    expect((earlier.overrun_count == 1u) && (later.overrun_count == 1u), "the lost frame is counted once");
    vehicle_run(750u);
    const uint32_t since = heard_count;
    vehicle_run(250u);
    expect_safe_commands_since(since, "and again after a second of the flood");
    test_node_flood(0u);
    obey_and_reset();
}

/* Shows: SUP-7, FSM-2, FSM-3, FSM-4, FSM-5, TOP-1 */
static void test_the_image(void) {
    vehicle = (vehicle_t){.park = true};
    vehicle_run(50u);
    expect_state(AGV_STATE_INIT, "after a power-on");
    expect_output(false, "the output is open");
    expect_safe_commands_since(0u, "safe commands are on the wire at once");
    expect(k_ticks_to_ms_floor64(first_ticks) < (uint64_t)FIRST_FRAME_LATEST_MS, "within milliseconds");
    vehicle_run(750u);
    expect_state(AGV_STATE_STANDBY, "all well for 500 ms");
    expect_output(true, "the output is closed");
    silent_ai();
    bus_off();
    flood();
    size_t unused = 0u;
    (void)k_thread_stack_space_get(&z_main_thread, &unused);
    printk("supervisor's stack: %u of %u bytes used\n", (unsigned)(CONFIG_MAIN_STACK_SIZE - unused),
           (unsigned)CONFIG_MAIN_STACK_SIZE);
    printk("first safe frame: %u us after the kernel's clock began\n", (uint32_t)k_ticks_to_us_floor64(first_ticks));
#if defined(CONFIG_QEMU_ICOUNT_SHIFT)
    printk("supervisor's thread: %u instructions a millisecond\n",
           (uint32_t)(k_cyc_to_ns_floor64(cycles_a_ms) >> CONFIG_QEMU_ICOUNT_SHIFT));
#endif
    printk("PROJECT EXECUTION %s\n", failed ? "FAILED" : "SUCCESSFUL");
}

static int listen(void) {
    static const struct can_filter all = {.flags = 0u};
    return (can_add_rx_filter(test_wire, on_frame, NULL, &all) >= 0) ? 0 : -EIO;
}

SYS_INIT(listen, APPLICATION, 0); /* before main() begins */
K_THREAD_DEFINE(rounds, STACK_SIZE, test_the_image, NULL, NULL, NULL, PRIORITY, 0, 0);
