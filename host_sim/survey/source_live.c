#include <errno.h>
#include <stdio.h>
#include <string.h>

#include "common/interrupt.h"
#include "hal_linux/linux_can.h"
#include "hal_linux/linux_loop.h"
#include "survey/sources.h"
#include "text/units.h"

enum { RECEIVE_BUFFER_BYTES = 4 << 20, FRAMES_AT_ONCE = 512 };

/** A survey of interfaces as it runs. */
typedef struct {
    const survey_request_t *request;
    observation_t *observation;
    source_t *source;
    linux_can_t sockets[HAL_CAN_SIDES];
    uint32_t lost[HAL_CAN_SIDES];
    linux_loop_t loop;
} live_t;

static bool open_sockets(live_t *live) {
    const linux_can_options_t options = {.error_frames = true, .receive_size = RECEIVE_BUFFER_BYTES};
    for (size_t side = 0; side < HAL_CAN_SIDES; side++) {
        const char *interface = live->request->bus.interfaces[side];
        char error[LINUX_CAN_ERROR_SIZE];
        if (interface == NULL) {
            continue;
        }
        if (!linux_can_open(&live->sockets[side], interface, &options, error)) {
            return report("%s", error);
        }
        if (!linux_loop_add(&live->loop, live->sockets[side].fd)) {
            return report("%s: %s", interface, strerror(errno));
        }
        observation_interface(live->observation, interface, strlen(interface), true);
    }
    return true;
}

/** Take what has arrived on a side, but for a flood that leaves no time for the rest. @return false: it is gone */
static bool receive(live_t *live, hal_can_side_t side) {
    linux_can_record_t record;
    const char *interface = live->request->bus.interfaces[side];
    for (unsigned i = 0; i < FRAMES_AT_ONCE; i++) {
        switch (linux_can_read(&live->sockets[side], &record)) {
        case LINUX_CAN_RECORD:
            observation_frame(live->observation, side, &record.frame,
                              (record.stamp_us != 0) ? record.stamp_us : time_of_day_us());
            live->source->has_ai_side = live->source->has_ai_side || (side == HAL_CAN_AI);
            live->lost[side] = record.lost;
            break;
        case LINUX_CAN_IS_DOWN:
            note("%s is down", interface);
            break;
        case LINUX_CAN_IS_GONE:
            live->source->gone = interface;
            return false;
        default:
            return true;
        }
    }
    return true;
}

/** Until the time is over, a signal comes, or an interface is gone. */
static void listen(live_t *live) {
    const uint64_t begin_ms = monotonic_ms();
    const uint64_t for_ms = live->request->bus.for_ms;
    uint32_t events = 0;
    bool good = true;
    while (good && ((events & LINUX_LOOP_SIGNAL) == 0) &&
           ((for_ms == INTERFACE_UNTIL_SIGNAL) || (monotonic_ms() - begin_ms < for_ms))) {
        events = linux_loop_wait(&live->loop);
        for (size_t side = 0; good && (side < HAL_CAN_SIDES); side++) {
            good = (live->sockets[side].fd < 0) || receive(live, (hal_can_side_t)side);
        }
    }
}

static bool report_silence(const live_t *live) {
    if (live->source->gone != NULL) {
        return report(SOURCE_GONE, live->source->gone);
    }
    return report("%s: no frame came; check the bit rate and the cable, and that ip link shows the interface as up",
                  live->request->bus.interfaces[HAL_CAN_VEHICLE]);
}

static bool run(live_t *live) {
    if (!open_sockets(live)) {
        return false;
    }
    listen(live);
    if (live->observation->frames == 0) {
        return report_silence(live);
    }
    (void)snprintf(live->source->name, sizeof live->source->name, "%s", live->request->bus.interfaces[HAL_CAN_VEHICLE]);
    live->observation->lost = (uint64_t)live->lost[HAL_CAN_VEHICLE] + live->lost[HAL_CAN_AI];
    observation_end(live->observation, time_of_day_us());
    return true;
}

bool source_live(const survey_request_t *request, observation_t *observation, source_t *source) {
    live_t live = {.request = request, .observation = observation, .source = source};
    for (size_t side = 0; side < HAL_CAN_SIDES; side++) {
        live.sockets[side].fd = -1;
    }
    if (!linux_loop_open(&live.loop)) {
        return report("the event loop cannot be opened: %s", strerror(errno));
    }
    const bool good = run(&live);
    for (size_t side = 0; side < HAL_CAN_SIDES; side++) {
        linux_can_close(&live.sockets[side]);
    }
    linux_loop_close(&live.loop);
    return good;
}
