#include "port.h"

#include "unity.h"
#include "vcan.h"

static const uint16_t IDS[] = {0x065, 0x100, 0x101, 0x102, 0x103, 0x104, 0x105, 0x106, 0x107,
                               0x108, 0x109, 0x10A, 0x10B, 0x10C, 0x10D, 0x10E, 0x10F};

static void note_left(void *ctx, hal_can_side_t side, const hal_can_frame_t *frame, uint64_t at_us) {
    port_left_t *left = ctx;
    TEST_ASSERT_TRUE(left->count < PORT_LEFT_MAX);
    left->sides[left->count] = side;
    left->frames[left->count] = *frame;
    left->at_us[left->count] = at_us;
    left->count++;
}

void port_open(hal_t *hal, const char *vehicle, const char *ai, port_left_t *left) {
    char error[LINUX_CAN_ERROR_SIZE];
    const linux_hal_config_t config = {.interfaces = {[HAL_CAN_VEHICLE] = vehicle, [HAL_CAN_AI] = ai},
                                       .ids = IDS,
                                       .id_count = sizeof IDS / sizeof IDS[0],
                                       .on_left = (left != NULL) ? note_left : NULL,
                                       .ctx = left};
    if (left != NULL) {
        left->count = 0;
    }
    TEST_ASSERT_TRUE_MESSAGE(linux_hal_open(hal, &config, error), error);
}

port_received_t port_receive(hal_t *hal) {
    port_received_t received = {0};
    bool got = false;
    for (unsigned ms = 0; !got && ms < VCAN_SOON_MS; ms++) {
        got = linux_hal_receive(hal, &received.side, &received.frame, &received.at_us);
        if (!got) {
            vcan_pause_ms(1);
        }
    }
    TEST_ASSERT_TRUE_MESSAGE(got, "no frame came");
    return received;
}

void port_receive_nothing(hal_t *hal) {
    port_received_t received = {0};
    vcan_pause_ms(VCAN_NEVER_MS);
    const bool got = linux_hal_receive(hal, &received.side, &received.frame, &received.at_us);
    TEST_ASSERT_EQUAL_HEX32_MESSAGE(0, received.frame.id, "this frame was not to come");
    TEST_ASSERT_FALSE(got);
}

unsigned port_drain(hal_t *hal) {
    port_received_t received;
    unsigned count = 0;
    unsigned quiet_ms = 0;
    while (quiet_ms < VCAN_SETTLED_MS) {
        if (linux_hal_receive(hal, &received.side, &received.frame, &received.at_us)) {
            count++;
            quiet_ms = 0;
        } else {
            vcan_pause_ms(1);
            quiet_ms++;
        }
    }
    return count;
}

static void turn(hal_t *hal) {
    port_received_t received;
    while (linux_hal_receive(hal, &received.side, &received.frame, &received.at_us)) {
    }
    (void)linux_hal_tick(hal);
}

void port_run_ms(hal_t *hal, unsigned ms) {
    for (unsigned i = 0; i < ms; i++) {
        turn(hal);
        vcan_pause_ms(1);
    }
    (void)port_drain(hal);
}

bool port_send(hal_t *hal, uint32_t id) {
    const hal_can_frame_t frame = vcan_frame(id);
    return hal_can_send(hal, HAL_CAN_VEHICLE, &frame);
}

hal_can_status_t port_status(hal_t *hal, hal_can_side_t side) {
    hal_can_status_t status;
    hal_can_status(hal, side, &status);
    return status;
}
