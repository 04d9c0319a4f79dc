/*
 * A session with a stub supervisor, linked before the real one: every scenario, campaign and soak must fail against it.
 * It reports INIT and does nothing; with STUB_TRIPPED it reports TRIPPED and sends the safe commands all the time.
 */
#include <string.h>

#include "agv/codec.h"
#include "hal/watchdog.h"
#include "session/session.h"

enum { CYCLE_MS = 100 };

#ifdef STUB_TRIPPED
static const bool TRIPPED = true;
#else
static const bool TRIPPED = false;
#endif

static agv_ids_t ids;

void session_init(session_t *session, hal_t *hal) {
    memset(session, 0, sizeof *session);
    session->ports.hal = hal;
    session->ports.recorder = &session->recorder;
}

bool session_observe(session_t *session, session_observer_fn *fn, void *ctx) {
    session->observers[0].fn = fn;
    session->observers[0].ctx = ctx;
    session->observer_count = 1;
    return true;
}

void session_start(session_t *session, const agv_config_t *config, uint64_t t_ms, uint32_t clock_ms) {
    const session_event_t event = {.t_ms = t_ms,
                                   .recorded = {.kind = AGV_EVENT_STATE,
                                                .b = TRIPPED ? AGV_STATE_TRIPPED : AGV_STATE_INIT,
                                                .c = TRIPPED ? AGV_FAULT_SUPERVISOR_RESET : AGV_FAULT_NONE}};
    (void)clock_ms;
    agv_config_ids(config, &ids);
    session->observers[0].fn(session->observers[0].ctx, &event);
}

void session_stop(session_t *session, uint64_t t_ms) {
    (void)session;
    (void)t_ms;
}

agv_counters_t session_counters(const session_t *session) {
    return session->before;
}

void session_frame(session_t *session, hal_can_side_t side, const hal_can_frame_t *frame, uint64_t t_ms) {
    (void)session;
    (void)side;
    (void)frame;
    (void)t_ms;
}

static void send(session_t *session, agv_message_t message, hal_can_frame_t *frame) {
    frame->id = ids.of[message];
    frame->length = AGV_DLC;
    (void)hal_can_send(session->ports.hal, HAL_CAN_VEHICLE, frame);
}

static void send_safe_commands(session_t *session, uint64_t t_ms) {
    const agv_turn_signal_command_t signals = {true, true, true, true, (uint8_t)(t_ms / CYCLE_MS)};
    const agv_gear_command_t park = {AGV_GEAR_P};
    hal_can_frame_t frame = {0};

    (void)agv_pack_gear_command(frame.data, &park);
    send(session, AGV_MSG_GEAR_COMMAND, &frame);
    (void)agv_pack_turn_signal_command(frame.data, &signals);
    send(session, AGV_MSG_TURN_SIGNAL_COMMAND, &frame);
    memset(frame.data, 0, sizeof frame.data);
    send(session, AGV_MSG_THROTTLE_COMMAND, &frame);
}

void session_tick(session_t *session, uint64_t t_ms, uint32_t clock_ms) {
    (void)clock_ms;
    hal_watchdog_feed(session->ports.hal);
    if (TRIPPED && (t_ms % CYCLE_MS == 0)) {
        send_safe_commands(session, t_ms);
    }
}

void session_tick_behind(session_t *session, uint64_t t_ms, uint32_t clock_ms) {
    session_tick(session, t_ms, clock_ms);
}
