#include "supervise.h"

#include <zephyr/sys/byteorder.h>

#include "agv_revision.h"
#include "events.h"
#include "kconfig.h"

/* The queues hold half as many, so all that came up to the tick is taken. What comes meanwhile must not delay the tick. */
enum { FRAMES_A_ROUND = 2 * HAL_CAN_SIDES * CONFIG_AGV_CAN_RX_QUEUE };

static const agv_version_t version = {AGV_VERSION_MAJOR, AGV_VERSION_MINOR, AGV_VERSION_PATCH, AGV_REVISION_NUMBER};

__weak bool supervise_self_test(void) {
    return true;
}

static void print_new(supervise_t *self) {
    events_print(self->ports.recorder, &self->printed);
    events_print_led(self->ticked_ms, agv_supervisor_led_code(&self->supervisor), &self->printed_led);
}

/* After a reset that was no power-on: how the run before ended. */
static void record_end(supervise_t *self, agv_recorder_t *recorder) {
    const hal_reset_cause_t cause = hal_reset_cause(&self->hal);
    const zephyr_hal_end_t *const end = &self->hal.end_before;
    const agv_entry_t entry = {.kind = (uint8_t)AGV_EVENT_CRASH,
                               .a = (uint8_t)cause,
                               .b = (uint8_t)end->reason,
                               .state = (uint8_t)agv_supervisor_state(&self->supervisor),
                               .first_reason = (uint8_t)agv_supervisor_first_reason(&self->supervisor)};
    uint8_t addresses[AGV_DLC];
    if (cause != HAL_RESET_POWER_ON) {
        sys_put_le32(end->pc, &addresses[0]);
        sys_put_le32(end->lr, &addresses[sizeof end->pc]);
        agv_recorder_add_crash(recorder, &entry, addresses, self->ticked_ms);
    }
}

void supervise_start(supervise_t *self, agv_recorder_t *recorder, zephyr_hal_retained_t *retained) {
    agv_config_t config;
    kconfig_read(&config);
    const zephyr_hal_memory_t memory[] = {{.start = self, .size = sizeof *self, .is_kept = false},
                                          {.start = recorder, .size = sizeof *recorder, .is_kept = true},
                                          {.start = retained, .size = sizeof *retained, .is_kept = true}};
    const zephyr_hal_config_t wiring = {.memory = memory,
                                        .memory_count = ARRAY_SIZE(memory),
                                        .bitrate = CONFIG_AGV_CAN_BITRATE,
                                        .sample_point_permille = CONFIG_AGV_CAN_SAMPLE_POINT,
                                        .watchdog_ms = CONFIG_AGV_WATCHDOG_PERIOD_MS,
                                        .listen_only = IS_ENABLED(CONFIG_AGV_CAN_LISTEN_ONLY),
                                        .retained = retained};
    (void)zephyr_hal_init(&self->hal, &wiring);
    self->hal.failed |= supervise_self_test() ? 0u : HAL_SELF_TEST_PROCESSOR;
    self->ports = (agv_ports_t){.hal = &self->hal, .recorder = recorder, .version = &version};
    self->ticked_ms = hal_clock_now_ms(&self->hal);
    agv_supervisor_start(&self->supervisor, &self->ports, &config, self->ticked_ms);
    record_end(self, recorder);
#if defined(CONFIG_AGV_SHELL)
    agv_config_ids(agv_supervisor_config(&self->supervisor), &self->ids);
#endif
    self->printed = events_begin(&config, recorder);
    self->printed_led = EVENTS_NO_LED;
    print_new(self);
}

static void count(supervise_t *self, const hal_can_frame_t *frame) {
#if defined(CONFIG_AGV_SHELL)
    const uint32_t message = agv_ids_find(&self->ids, frame->id);
    if (message < (uint32_t)AGV_MSG_COUNT) {
        self->frames[message]++;
    }
#else
    ARG_UNUSED(self);
    ARG_UNUSED(frame);
#endif
}

static void take_frames(supervise_t *self) {
    hal_can_side_t side;
    hal_can_frame_t frame;
    for (uint32_t i = 0u; i < (uint32_t)FRAMES_A_ROUND; i++) {
        if (!zephyr_hal_receive(&self->hal, &side, &frame)) {
            return;
        }
        agv_supervisor_frame(&self->supervisor, &self->ports, side, &frame);
        zephyr_hal_transmit(&self->hal); /* the safe commands of a trip do not wait for a backlog */
        count(self, &frame);
    }
}

void supervise_once(supervise_t *self) {
    zephyr_hal_wait(&self->hal);
    const uint32_t now_ms = hal_clock_now_ms(&self->hal); /* before the frames: all stamped up to it are handed over */
    take_frames(self);
    agv_supervisor_receive_alive(&self->supervisor);
    if (now_ms != self->ticked_ms) {
        self->ticked_ms = now_ms;
        agv_supervisor_tick(&self->supervisor, &self->ports, now_ms);
    }
    zephyr_hal_transmit(&self->hal);
    print_new(self);
}
