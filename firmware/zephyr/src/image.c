/* Confirming the image, and the conditions of an update: only in STANDBY at standstill, and without the permanent swap. */
#include "image.h"

#include <zephyr/dfu/mcuboot.h>
#include <zephyr/kernel.h>

static struct {
    bool confirming; /* requested once in a run */
    atomic_t may_update;
} image;

/* Runs in the system work queue: writing flash takes longer than a tick. */
static void confirm(struct k_work *work) {
    ARG_UNUSED(work);
    (void)boot_write_img_confirmed(); /* after a failure the image before comes back at the next reset */
}

static K_WORK_DEFINE(confirmation, confirm);

void image_follow(const agv_supervisor_t *supervisor) {
    const bool standby = agv_supervisor_state(supervisor) == AGV_STATE_STANDBY;
    if (standby && !image.confirming) {
        image.confirming = true;
        (void)k_work_submit(&confirmation);
    }
    (void)atomic_set(&image.may_update, (standby && agv_supervisor_is_at_standstill(supervisor)) ? 1 : 0);
}

#if defined(CONFIG_AGV_UPDATE)

#include <zephyr/init.h>
#include <zephyr/mgmt/mcumgr/grp/img_mgmt/img_mgmt.h>
#include <zephyr/mgmt/mcumgr/grp/os_mgmt/os_mgmt.h>
#include <zephyr/mgmt/mcumgr/mgmt/callbacks.h>
#include <zephyr/mgmt/mcumgr/mgmt/mgmt.h>

BUILD_ASSERT(IS_ENABLED(CONFIG_MCUMGR_SMP_COMMAND_STATUS_HOOKS), "an update is refused through MCUmgr's hooks");
BUILD_ASSERT(IS_ENABLED(CONFIG_IMG_ERASE_PROGRESSIVELY), "a slot is erased sector by sector while it is written");
BUILD_ASSERT(!IS_ENABLED(CONFIG_MCUMGR_GRP_IMG_ALLOW_CONFIRM_NON_ACTIVE_IMAGE_SECONDARY),
             "a new image is tried before it is confirmed");

/* Commands that change something and are accepted in STANDBY at standstill. All others are refused. */
static bool is_of_an_update(const struct mgmt_evt_op_cmd_arg *command) {
    return ((command->group == MGMT_GROUP_ID_IMAGE) &&
            ((command->id == IMG_MGMT_ID_UPLOAD) || (command->id == IMG_MGMT_ID_STATE))) ||
           ((command->group == MGMT_GROUP_ID_OS) && (command->id == OS_MGMT_ID_RESET));
}

static enum mgmt_cb_return on_command(uint32_t event, enum mgmt_cb_return previous, int32_t *rc, uint16_t *group,
                                      bool *abort_more, void *data, size_t size) {
    const struct mgmt_evt_op_cmd_arg *const command = data;
    ARG_UNUSED(event);
    ARG_UNUSED(previous);
    ARG_UNUSED(group);
    ARG_UNUSED(abort_more);
    ARG_UNUSED(size);
    if ((command->op == MGMT_OP_READ) || (is_of_an_update(command) && (atomic_get(&image.may_update) != 0))) {
        return MGMT_CB_OK;
    }
    *rc = MGMT_ERR_EACCESSDENIED;
    return MGMT_CB_ERROR_RC;
}

static int register_hook(void) {
    static struct mgmt_callback hook = {.callback = on_command, .event_id = MGMT_EVT_OP_CMD_RECV};
    mgmt_callback_register(&hook);
    return 0;
}

SYS_INIT(register_hook, APPLICATION, CONFIG_APPLICATION_INIT_PRIORITY);

#endif
