/* An application with a main() of its own: it runs the supervisor, and prints each new state. */
#include <zephyr/logging/log.h>

#include "agv/names.h"
#include "agv/recorder.h"
#include "agv/supervisor.h"
#include "hal_zephyr/zephyr_hal.h"
#include "kconfig.h"

LOG_MODULE_REGISTER(supervisor); /* a thread of the lowest priority prints: printk() would make the supervisor wait */

static ZEPHYR_HAL_RETAINED agv_recorder_t recorder;
static ZEPHYR_HAL_RETAINED zephyr_hal_retained_t retained;
static hal_t hal;
static agv_supervisor_t supervisor;
static agv_ports_t ports = {.hal = &hal, .recorder = &recorder};

/* The queues hold half as many, so all that came up to the tick is taken. What comes meanwhile must not delay the tick. */
enum { FRAMES_A_ROUND = 2 * HAL_CAN_SIDES * CONFIG_AGV_CAN_RX_QUEUE };

static void take_frames(void) {
    hal_can_side_t side;
    hal_can_frame_t frame;
    for (uint32_t i = 0u; i < (uint32_t)FRAMES_A_ROUND; i++) {
        if (!zephyr_hal_receive(&hal, &side, &frame)) {
            return;
        }
        agv_supervisor_frame(&supervisor, &ports, side, &frame);
        zephyr_hal_transmit(&hal); /* the safe commands of a trip do not wait for a backlog */
    }
}

int main(void) {
    const zephyr_hal_memory_t memory[] = {{.start = &supervisor, .size = sizeof supervisor, .is_kept = false},
                                          {.start = &recorder, .size = sizeof recorder, .is_kept = true},
                                          {.start = &retained, .size = sizeof retained, .is_kept = true}};
    const zephyr_hal_config_t wiring = {.memory = memory,
                                        .memory_count = ARRAY_SIZE(memory),
                                        .bitrate = CONFIG_AGV_CAN_BITRATE,
                                        .sample_point_permille = CONFIG_AGV_CAN_SAMPLE_POINT,
                                        .watchdog_ms = CONFIG_AGV_WATCHDOG_PERIOD_MS,
                                        .retained = &retained};
    agv_config_t config;
    kconfig_read(&config);
    (void)zephyr_hal_init(&hal, &wiring); /* what does not work is reported by the self-test */
    uint32_t ticked_ms = hal_clock_now_ms(&hal);
    agv_supervisor_start(&supervisor, &ports, &config, ticked_ms);
    for (int printed = -1;;) {
        zephyr_hal_wait(&hal);
        const uint32_t now_ms = hal_clock_now_ms(&hal); /* before the frames: all stamped up to it are handed over */
        take_frames();
        agv_supervisor_receive_alive(&supervisor);
        if (now_ms != ticked_ms) {
            ticked_ms = now_ms;
            agv_supervisor_tick(&supervisor, &ports, now_ms);
        }
        zephyr_hal_transmit(&hal);
        if ((int)agv_supervisor_state(&supervisor) != printed) {
            printed = (int)agv_supervisor_state(&supervisor);
            LOG_INF("%s", agv_state_name((agv_state_t)printed));
        }
    }
    return 0;
}
