/* Instructions of the two entry points on an emulated processor, counted by QEMU. Only printed, not checked. */
#include <zephyr/ztest.h>

#include "agv/codec.h"
#include "fake_parts.h"
#include "supervise.h"

#if defined(CONFIG_QEMU_ICOUNT_SHIFT)

enum { TIMES = 1000 };

static agv_recorder_t recorder;
static zephyr_hal_retained_t retained;
static supervise_t self;

static uint32_t instructions(uint32_t begin) {
    return (uint32_t)(k_cyc_to_ns_floor64(k_cycle_get_32() - begin) >> CONFIG_QEMU_ICOUNT_SHIFT) / TIMES;
}

ZTEST_SUITE(cost, NULL, NULL, NULL, NULL, NULL);

/* Interrupts are off, and no other thread runs. */
ZTEST(cost, test_instructions_of_a_frame_and_of_a_tick) {
    agv_config_t config;
    hal_can_frame_t frame = {.id = 0x363u, .length = AGV_DLC};
    agv_config_defaults(&config);
    self.hal.retained = &retained;
    self.ports = (agv_ports_t){.hal = &self.hal, .recorder = &recorder};
    const unsigned int key = irq_lock();
    agv_supervisor_start(&self.supervisor, &self.ports, &config, 0u);
    uint32_t begin = k_cycle_get_32();
    for (uint32_t i = 0u; i < (uint32_t)TIMES; i++) {
        frame.data[7] ^= 1u;
        agv_supervisor_frame(&self.supervisor, &self.ports, HAL_CAN_VEHICLE, &frame);
    }
    const uint32_t of_a_frame = instructions(begin);
    begin = k_cycle_get_32();
    for (uint32_t i = 1u; i <= (uint32_t)TIMES; i++) {
        agv_supervisor_tick(&self.supervisor, &self.ports, i);
    }
    const uint32_t of_a_tick = instructions(begin);
    irq_unlock(key);
    TC_PRINT("instructions: frame arrived %u, tick %u\n", of_a_frame, of_a_tick);
    zassert_true((of_a_frame > 0u) && (of_a_tick > 0u));
}

#endif
