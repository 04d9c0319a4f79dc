/* When an image is confirmed, and when an update is accepted (HW-6). */
#include <zephyr/dfu/mcuboot.h>
#include <zephyr/mgmt/mcumgr/grp/img_mgmt/img_mgmt.h>
#include <zephyr/mgmt/mcumgr/grp/os_mgmt/os_mgmt.h>
#include <zephyr/mgmt/mcumgr/mgmt/callbacks.h>
#include <zephyr/mgmt/mcumgr/mgmt/mgmt.h>
#include <zephyr/storage/flash_map.h>
#include <zephyr/ztest.h>

#include "image.h"

/* The trailer of a slot whose image is on trial ends with this; the flag "confirmed" before it is erased. */
static const uint32_t trailer_magic[] = {0xf395c277u, 0x7fefd260u, 0x0f505235u, 0x8079b62cu};

enum { WORK_DONE_MS = 50 };

static const agv_state_t states[] = {AGV_STATE_INIT, AGV_STATE_ACTIVE, AGV_STATE_TRIPPED, AGV_STATE_SAFE,
                                     AGV_STATE_STANDBY};

static struct {
    agv_state_t state;
    bool at_standstill;
} vehicle;

agv_state_t agv_supervisor_state(const agv_supervisor_t *supervisor) {
    ARG_UNUSED(supervisor);
    return vehicle.state;
}

bool agv_supervisor_is_at_standstill(const agv_supervisor_t *supervisor) {
    ARG_UNUSED(supervisor);
    return vehicle.at_standstill;
}

static void follow(agv_state_t state, bool at_standstill) {
    vehicle.state = state;
    vehicle.at_standstill = at_standstill;
    image_follow(NULL);
    k_msleep(WORK_DONE_MS);
}

/* What MCUmgr asks before it executes a command. */
static bool is_accepted(uint16_t group, uint8_t id, uint8_t op) {
    struct mgmt_evt_op_cmd_arg command = {.group = group, .id = id, .op = op};
    int32_t rc = 0;
    uint16_t error_group = 0u;
    const bool accepted =
        mgmt_callback_notify(MGMT_EVT_OP_CMD_RECV, &command, sizeof command, &rc, &error_group) == MGMT_CB_OK;
    zassert_equal(rc, accepted ? 0 : MGMT_ERR_EACCESSDENIED);
    return accepted;
}

static void expect_update(bool accepted) {
    zassert_equal(is_accepted(MGMT_GROUP_ID_IMAGE, IMG_MGMT_ID_UPLOAD, MGMT_OP_WRITE), accepted);
    zassert_equal(is_accepted(MGMT_GROUP_ID_IMAGE, IMG_MGMT_ID_STATE, MGMT_OP_WRITE), accepted);
    zassert_equal(is_accepted(MGMT_GROUP_ID_OS, OS_MGMT_ID_RESET, MGMT_OP_WRITE), accepted);
}

static void start_trial(void) {
    const struct flash_area *slot;
    zassert_ok(flash_area_open(FIXED_PARTITION_ID(slot0_partition), &slot));
    zassert_ok(flash_area_erase(slot, 0, slot->fa_size));
    zassert_ok(
        flash_area_write(slot, (off_t)(slot->fa_size - sizeof trailer_magic), trailer_magic, sizeof trailer_magic));
    flash_area_close(slot);
}

/* Before the other tests: an image is confirmed once in a run. */
/* Shows: HW-6 */
ZTEST(update, test_a_trial_is_confirmed_at_the_first_standby) {
    start_trial();
    for (size_t i = 0u; states[i] != AGV_STATE_STANDBY; i++) {
        follow(states[i], true);
        zassert_false(boot_is_img_confirmed(), "confirmed in state %02x", states[i]);
    }
    follow(AGV_STATE_STANDBY, false);
    zassert_true(boot_is_img_confirmed());
}

/* Shows: HW-6 */
ZTEST(update, test_an_update_is_accepted_in_standby_at_standstill_only) {
    for (size_t i = 0u; i < ARRAY_SIZE(states); i++) {
        follow(states[i], true);
        expect_update(states[i] == AGV_STATE_STANDBY);
        follow(states[i], false);
        expect_update(false);
    }
}

ZTEST(update, test_other_commands_are_refused) {
    follow(AGV_STATE_STANDBY, true);
    zassert_false(is_accepted(MGMT_GROUP_ID_IMAGE, IMG_MGMT_ID_ERASE, MGMT_OP_WRITE)); /* stalls too long */
    zassert_false(is_accepted(MGMT_GROUP_ID_OS, OS_MGMT_ID_ECHO, MGMT_OP_WRITE));
    zassert_false(is_accepted(MGMT_GROUP_ID_SHELL, 0u, MGMT_OP_WRITE));
    zassert_false(is_accepted(MGMT_GROUP_ID_SETTINGS, 0u, MGMT_OP_WRITE));
}

ZTEST(update, test_reading_is_always_possible) {
    follow(AGV_STATE_ACTIVE, false);
    zassert_true(is_accepted(MGMT_GROUP_ID_IMAGE, IMG_MGMT_ID_STATE, MGMT_OP_READ));
}

ZTEST_SUITE(update, NULL, NULL, NULL, NULL, NULL);
