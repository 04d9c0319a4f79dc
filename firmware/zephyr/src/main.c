/* The firmware: one supervisor, whose thread this is. */
#include "image.h"
#include "supervise.h"

static ZEPHYR_HAL_RETAINED agv_recorder_t recorder;
static ZEPHYR_HAL_RETAINED zephyr_hal_retained_t retained;

supervise_t agv_supervise; /* the shell reads it */

int main(void) {
    supervise_start(&agv_supervise, &recorder, &retained);
    for (;;) {
        supervise_once(&agv_supervise);
        image_follow(&agv_supervise.supervisor);
    }
    return 0;
}
