/*
 * One supervisor over eight starts of an emulated Cortex-M3. Each run but the last ends with another kind of reset, and
 * the next one checks what outlived it: latch, first reason, recorder, cause. The test sets hwinfo's flags, because
 * this machine has none. The task watchdog, the faults, the MPU's stack guard and the hardware watchdog are real. The story
 * itself is in zephyr,sram, and what the supervisor keeps is in a region of its own, as with a bootloader.
 */
#include <zephyr/arch/arm/nmi.h>
#include <zephyr/drivers/gpio.h>
#include <zephyr/drivers/hwinfo.h>
#include <zephyr/sys/byteorder.h>
#include <zephyr/ztest.h>

#include "fake_parts.h"
#include "supervise.h"
#include "vehicle.h"

enum { STORY = 0x53544F52, RUNS = 8, ENDS_MS = 400 };

static ZEPHYR_HAL_RETAINED agv_recorder_t recorder;
static ZEPHYR_HAL_RETAINED zephyr_hal_retained_t retained;
static __noinit struct {
    uint32_t magic;
    uint32_t run;
    uint32_t output_was_open;
} story;

static supervise_t self;
static volatile bool hang;

static void supervise(void) {
    supervise_start(&self, &recorder, &retained);
    while (!hang) {
        supervise_once(&self);
    }
}

K_THREAD_DEFINE(supervisor, 2048, supervise, NULL, NULL, NULL, K_PRIO_COOP(2), 0, SYS_FOREVER_MS);

static void begin(uint32_t flags) {
    fake_parts_reset();
    fake_reset_flags = flags;
    fake_buses[HAL_CAN_VEHICLE].sends_at_once = true;
    vehicle = (vehicle_t){.park = true};
    k_thread_start(supervisor);
    vehicle_run(5u);
}

/* Replaces the kernel's function, which is the last step: the output must be open by then. */
void sys_arch_reboot(int type) {
    ARG_UNUSED(type);
    story.output_was_open = fake_output_is_closed() ? 0u : 1u;
    NVIC_SystemReset();
}

static void drive_and_trip(void) {
    vehicle_run(800u);
    vehicle.autopilot = true;
    vehicle.park = false;
    vehicle_run(300u);
    zassert_equal(agv_supervisor_state(&self.supervisor), AGV_STATE_ACTIVE);
    vehicle.ai_is_silent = true;
    vehicle_run(200u);
    zassert_equal(agv_supervisor_state(&self.supervisor), AGV_STATE_TRIPPED);
    zassert_true(fake_output_is_closed());
    zassert_true(fake_window_watchdog.feeds > 50u);
    zassert_equal(fake_window_watchdog.outside, 0u, "always fed in its window");
}

static uint32_t recurse(volatile uint32_t *above) {
    volatile uint32_t here[64];
    here[0] = *above + 1u;
    if (here[0] == UINT32_MAX) {
        return 0u;
    }
    return recurse(here) + here[63];
}

static void overflow(void) {
    volatile uint32_t begin_of_stack = 0u;
    (void)recurse(&begin_of_stack);
}

K_THREAD_DEFINE(overflowing, 512, overflow, NULL, NULL, NULL, K_PRIO_PREEMPT(1), 0, SYS_FOREVER_MS);

static void end_by_a_supervisor_that_hangs(void) {
    hang = true;
    k_msleep(ENDS_MS);
}

static void end_by_a_fault(void) {
    *(volatile uint32_t *)0xE0200000u = 1u; /* nothing is there */
    k_msleep(ENDS_MS);
}

static void end_by_a_failed_assertion(void) {
    __ASSERT(self.ticked_ms == 0u, "on purpose");
    k_msleep(ENDS_MS);
}

static void end_by_a_stack_that_overflows(void) {
    k_thread_start(overflowing);
    k_msleep(ENDS_MS);
}

/* A thread that is readied by the opening of the output, and closes it: as the supervisor's could be by its timer. */
static K_SEM_DEFINE(opened, 0, 1);
static struct gpio_callback on_opening;

static void close_again(void) {
    (void)k_sem_take(&opened, K_FOREVER);
    hal_safety_output_set(&self.hal, true);
}

static void output_opens(const struct device *port, struct gpio_callback *callback, gpio_port_pins_t pins) {
    ARG_UNUSED(port);
    ARG_UNUSED(callback);
    ARG_UNUSED(pins);
    k_sem_give(&opened);
}

static void fail(void) {
    hal_safety_output_set(&self.hal, true);
    __ASSERT(self.ticked_ms == 0u, "on purpose");
}

K_THREAD_DEFINE(closer, 512, close_again, NULL, NULL, NULL, K_PRIO_COOP(1), 0, SYS_FOREVER_MS);
K_THREAD_DEFINE(failing, 512, fail, NULL, NULL, NULL, K_PRIO_PREEMPT(1), 0, SYS_FOREVER_MS);

static void end_by_a_thread_that_can_be_preempted(void) {
    static const struct gpio_dt_spec output = GPIO_DT_SPEC_GET(DT_NODELABEL(agv_supervisor), safety_output_gpios);
    gpio_init_callback(&on_opening, output_opens, BIT(output.pin));
    zassert_ok(gpio_add_callback(output.port, &on_opening));
    k_thread_start(closer);
    k_thread_start(failing);
    zassert_ok(gpio_pin_interrupt_configure_dt(&output, GPIO_INT_EDGE_FALLING));
    k_msleep(ENDS_MS);
}

static void hang_for_good(void) {
    for (;;) {
    }
}

/* The first timeout of this machine's watchdog is an NMI, the second one a reset. Here the NMI hangs, too. */
static void end_by_a_kernel_that_hangs(void) {
    z_arm_nmi_set_handler(hang_for_good);
    (void)irq_lock();
    hang_for_good();
}

static void end_by_an_nmi(void) {
    SCB->ICSR = SCB_ICSR_NMIPENDSET_Msk;
    k_msleep(ENDS_MS);
}

static const struct {
    const char *what;
    uint32_t flags; /* of the reset before */
    hal_reset_cause_t cause;
    hal_end_t reason;
    void (*place)(void); /* the function whose address must be the program counter; NULL: not looked at */
    void (*end)(void);
} runs[RUNS] = {
    {"power-on", RESET_POR, HAL_RESET_POWER_ON, HAL_END_UNKNOWN, NULL, end_by_a_supervisor_that_hangs},
    {"the task watchdog", RESET_SOFTWARE, HAL_RESET_WATCHDOG, HAL_END_TASK_WATCHDOG, NULL, end_by_a_fault},
    {"a fault", RESET_SOFTWARE, HAL_RESET_LOCK_UP, HAL_END_PROCESSOR, end_by_a_fault, end_by_a_failed_assertion},
    {"a failed assertion", RESET_SOFTWARE, HAL_RESET_LOCK_UP, HAL_END_ASSERTION, end_by_a_failed_assertion,
     end_by_a_stack_that_overflows},
    {"a stack that overflowed", RESET_SOFTWARE, HAL_RESET_LOCK_UP, HAL_END_STACK, NULL, end_by_an_nmi},
    {"an NMI", RESET_SOFTWARE, HAL_RESET_LOCK_UP, HAL_END_NMI, end_by_an_nmi, end_by_a_thread_that_can_be_preempted},
    {"an assertion that failed in a thread that can be preempted", RESET_SOFTWARE, HAL_RESET_LOCK_UP, HAL_END_ASSERTION,
     NULL, end_by_a_kernel_that_hangs},
    {"the hardware watchdog", RESET_WATCHDOG, HAL_RESET_WATCHDOG, HAL_END_UNKNOWN, NULL, NULL},
};

/* The newest event of a crash: cause, reason, and a program counter in the function that ended the run before. */
static void look_at_the_recorded_end(uint32_t run) {
    enum { FUNCTION_SIZE = 64 };
    const uint32_t next = agv_recorder_next_sequence(&recorder);
    agv_event_t event = {0};
    for (uint32_t i = 1u; (i < 16u) && (event.kind != (uint8_t)AGV_EVENT_CRASH); i++) {
        (void)agv_recorder_get(&recorder, next - i, &event);
    }
    zassert_equal(event.kind, AGV_EVENT_CRASH, "after %s: no event", runs[run].what);
    zassert_equal(event.a, runs[run].cause);
    zassert_equal(event.b, runs[run].reason, "after %s: %u", runs[run].what, event.b);
    if (runs[run].place != NULL) {
        const uint32_t pc = sys_get_le32(event.frames[0]);
        const uint32_t place = (uint32_t)(uintptr_t)runs[run].place & ~1u;
        zassert_true((pc - place) < (uint32_t)FUNCTION_SIZE, "after %s: PC %08x", runs[run].what, pc);
    }
}

static void look_at_what_outlived(uint32_t run) {
    zassert_equal(hal_reset_cause(&self.hal), runs[run].cause, "after %s", runs[run].what);
    if (runs[run].flags == (uint32_t)RESET_SOFTWARE) { /* a hardware reset releases the pins by itself */
        zassert_equal(story.output_was_open, 1u, "%s: the output was not open before the reset", runs[run].what);
    }
    zassert_false(fake_output_is_closed(), "and is open after it");
    zassert_equal(agv_supervisor_state(&self.supervisor), AGV_STATE_TRIPPED, "nothing resumes by itself");
    zassert_equal(agv_supervisor_first_reason(&self.supervisor), AGV_FAULT_STEERING_COMMAND_TIMEOUT);
    look_at_the_recorded_end(run);
    zassert_true(agv_recorder_next_sequence(&recorder) > (5u + run), "events of earlier runs are there");
}

ZTEST_SUITE(resets, NULL, NULL, NULL, NULL, NULL);

/* Shows: FSM-4, FSM-5, FSM-7, TIM-3, INT-3 */
ZTEST(resets, test_what_outlives_each_kind_of_reset) {
    if ((story.magic != (uint32_t)STORY) || (story.run >= (uint32_t)RUNS)) {
        story.magic = STORY;
        story.run = 0u;
    }
    const uint32_t run = story.run;
    begin(runs[run].flags);
    TC_PRINT("run %u, after %s\n", run, runs[run].what);
    if (run == 0u) {
        drive_and_trip();
    } else {
        look_at_what_outlived(run);
    }
    story.run = run + 1u;
    story.output_was_open = 0u;
    if (runs[run].end != NULL) {
        hal_safety_output_set(&self.hal, true);
        runs[run].end();
        story.magic = 0u;
        zassert_unreachable("after %s: nothing ended this run", runs[run].what);
    }
    story.magic = 0u;
}
