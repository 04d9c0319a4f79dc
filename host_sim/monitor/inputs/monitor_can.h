/**
 * @file monitor_can.h
 * Feeds a monitor from SocketCAN. It only listens; an interface may go away and come back.
 */
#ifndef HOST_SIM_MONITOR_CAN_H
#define HOST_SIM_MONITOR_CAN_H

#include <stdbool.h>
#include <stdint.h>

#include "hal_linux/linux_can.h"
#include "hal_linux/linux_clock.h"
#include "monitor/inputs/monitor_record.h"
#include "monitor/monitor.h"

/** One side. */
typedef struct {
    const char *interface; /**< NULL: it does not exist */
    linux_can_t can;
    bool is_open;
    bool has_next;
    linux_can_record_t next;
    uint64_t next_us;
    uint32_t lost;     /**< as in the last record */
    uint64_t again_us; /**< when to try to open it again */
} monitor_can_side_t;

/** The interfaces. */
typedef struct {
    linux_clock_t clock;
    uint64_t stamp_us;    /**< a stamp of this pass; 0: none yet */
    uint64_t stamp_at_us; /**< and its time */
    monitor_can_side_t sides[HAL_CAN_SIDES];
} monitor_can_t;

/** Open them. The time of the run begins. @return false: was reported */
bool monitor_can_open(monitor_can_t *bus, const char *const interfaces[HAL_CAN_SIDES]);

/** Pass on what has arrived, in the order of time, and what time it is. @param record or NULL */
void monitor_can_pass(monitor_can_t *bus, monitor_t *monitor, monitor_record_t *record);

/** Close them. */
void monitor_can_close(monitor_can_t *bus);

#endif
