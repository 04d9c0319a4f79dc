#include "live/live_files.h"

#include <errno.h>
#include <string.h>

#include "common/report.h"

enum { NO_FILE = -1 };

void live_files_none(live_files_t *files) {
    for (int side = 0; side < HAL_CAN_SIDES; side++) {
        files->fds[side] = NO_FILE;
    }
}

void live_files_leave(live_files_t *files, linux_loop_t *loop) {
    for (int side = 0; side < HAL_CAN_SIDES; side++) {
        if (files->fds[side] != NO_FILE) {
            linux_loop_remove(loop, files->fds[side]); /* nothing when it was closed meanwhile */
            files->fds[side] = NO_FILE;
        }
    }
}

bool live_files_follow(live_files_t *files, linux_loop_t *loop, const node_t *node) {
    live_files_leave(files, loop); /* all before the first new one: a new file may have the number of an old one */
    for (int side = 0; side < HAL_CAN_SIDES; side++) {
        const int fd = node_fd(node, (hal_can_side_t)side);
        if (fd == NO_FILE) {
            continue;
        }
        if (!linux_loop_add(loop, fd)) {
            return report("cannot wait for the interfaces: %s", strerror(errno));
        }
        files->fds[side] = fd;
    }
    return true;
}
