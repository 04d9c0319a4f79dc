#include "alphabet.h"

#include <stdint.h>
#include <string.h>

#include "abstract.h"
#include "model.h"

enum { LATE_MS = 101, BIT_LATE_MS = 40, SLEEP_MS = 1000000000 };

/* A symbol: a function and its argument. */
typedef struct {
    const char *name;
    void (*apply)(unsigned how);
    bool (*enabled)(unsigned how);
    unsigned how;
} symbol_t;

static bool always(unsigned how) {
    (void)how;
    return true;
}

static bool gateway(unsigned how) {
    (void)how;
    return testbed.config.topology == AGV_TOPOLOGY_GATEWAY;
}

/* ---- Time ---- */

static void run_ticks(unsigned how) {
    const uint32_t horizon_ms = abstract_horizon_ms();
    abstract_t before;
    abstract_t now;
    (void)how;
    abstract_now(&before);
    for (uint32_t ms = 0; ms < horizon_ms; ms++) {
        model_run(1);
        abstract_now(&now);
        if ((memcmp(&before, &now, sizeof now) != 0) || (model_broken()[0] != '\0')) {
            return;
        }
    }
}

/* ---- The vehicle's own frames ---- */

static void apply_mode(unsigned mode) {
    model.mode = (uint8_t)mode;
    model.mode_ms = testbed.now_ms;
    model_apply_defect();
    model_run_past(M_VEHICLE);
}

static bool other_mode(unsigned mode) {
    return (model.mode != (uint8_t)mode) && model_flows(M_VEHICLE);
}

static void apply_button(unsigned down) {
    model.button = down != 0;
    model_apply_defect();
    model_run_past(M_VEHICLE);
}

static bool other_button(unsigned down) {
    return (model.button != (down != 0)) && model_flows(M_VEHICLE);
}

static void apply_gear(unsigned gear) {
    model.gear = (uint8_t)gear;
    model_apply_defect();
    model_run_past(M_GEAR_STATUS);
}

static bool other_gear(unsigned gear) {
    return (model.gear != (uint8_t)gear) && model_flows(M_GEAR_STATUS);
}

static void apply_wheels(unsigned turn) {
    model.wheels_turn = turn != 0;
    model.wheels_ms = testbed.now_ms;
    model_apply_defect();
    model_run_past(M_WHEELS);
}

static bool other_wheels(unsigned turn) {
    return (model.wheels_turn != (turn != 0)) && model_flows(M_WHEELS);
}

bool alphabet_pairs;

/* Whether a controller or the stored latch has a trouble. */
static bool has_hal_defect(void) {
    const sim_hal_can_t *can = testbed.hal.can;
    return (model.bus != BUS_FINE) || model.ai_off || model.stalled || model.bad_latch || can[HAL_CAN_VEHICLE].full ||
           can[HAL_CAN_AI].full;
}

static bool has_defect(void) {
    return model.defect != DEFECT_NONE;
}

/* Only one defect or trouble exists at a time. With `alphabet_pairs` one of each may exist. */
static bool may_have_defect(void) {
    return !has_defect() && (alphabet_pairs || !has_hal_defect());
}

static bool may_have_hal_defect(void) {
    return !has_hal_defect() && (alphabet_pairs || !has_defect());
}

static void apply_defect(unsigned defect) {
    model.defect = (uint8_t)defect;
    model.foreign_ms = testbed.now_ms + 1;
    model.defect_ms = testbed.now_ms;
    model_apply_defect();
    model_run(1);
}

static bool other_defect(unsigned defect) {
    return (defect == DEFECT_NONE) ? has_defect() : may_have_defect();
}

/* A silent or frozen node sends one frame just before the tick. */
static void send_late_frame(unsigned how) {
    (void)how;
    model_speak();
}

/* Not in variants whose clock wraps: there the wrap must come during normal operation. */
static bool may_sleep(unsigned how) {
    (void)how;
    return !model_variant->wraps;
}

static bool can_speak(unsigned how) {
    (void)how;
    return model_can_speak();
}

/* ---- Frames of rogue nodes ---- */

enum { S_GEAR, S_SHORT, S_SIGNALS, S_FAULT, S_MALFORMED, S_OTHER_SET, S_AI_SIDE };

static uint32_t signal_id(bool other) {
    const bool table = testbed.config.id_set == AGV_ID_SET_TABLE;
    return (table != other) ? 0x201u : 0x43Fu;
}

static void deliver_one(hal_can_side_t side, uint32_t id, uint8_t length, uint8_t byte0, uint8_t byte7) {
    const hal_can_frame_t frame = {.id = id, .length = length, .data = {byte0, 0, 0, 0, 0, 0, 0, byte7}};
    model_deliver(side, &frame, 1);
}

static void malformed(void) {
    static const uint8_t FLAGS[] = {HAL_CAN_EXTENDED, HAL_CAN_REMOTE, HAL_CAN_FD, HAL_CAN_ERROR};
    hal_can_frame_t frames[4];
    memset(frames, 0, sizeof frames);
    for (unsigned i = 0; i < 4; i++) {
        frames[i].id = ((i % 2) == 0) ? 0x168u : 0x167u;
        frames[i].flags = FLAGS[i];
        frames[i].length = 8;
        frames[i].data[0] = (FLAGS[i] == HAL_CAN_REMOTE) ? (uint8_t)0 : (uint8_t)MODEL_D;
        frames[i].data[7] = (FLAGS[i] == HAL_CAN_REMOTE) ? (uint8_t)0 : (uint8_t)0xFF;
    }
    model_deliver(HAL_CAN_VEHICLE, frames, 4);
}

static void rogue_node(unsigned how) {
    switch (how) {
    case S_GEAR:
        deliver_one(HAL_CAN_VEHICLE, 0x168, 8, MODEL_D, 0);
        break;
    case S_SHORT:
        deliver_one(HAL_CAN_VEHICLE, 0x168, 1, MODEL_D, 0);
        break;
    case S_SIGNALS:
        deliver_one(HAL_CAN_VEHICLE, signal_id(false), 8, 0, 200);
        break;
    case S_FAULT:
        deliver_one(HAL_CAN_VEHICLE, 0x167, 8, 0, 0x40);
        break;
    case S_OTHER_SET:
        deliver_one(HAL_CAN_VEHICLE, signal_id(true), 8, 0, 200);
        break;
    case S_AI_SIDE:
        deliver_one(HAL_CAN_AI, 0x167, 8, 0, 0x40);
        break;
    default:
        malformed();
        break;
    }
}

static bool vehicle_hears(unsigned how) {
    (void)how;
    return testbed.hal.can[HAL_CAN_VEHICLE].status.state != HAL_CAN_BUS_OFF;
}

static bool ai_side_hears(unsigned how) {
    return gateway(how) && !model.ai_off;
}

/* ---- Controllers ---- */

enum { C_OVERRUN, C_FULL, C_FREE, C_STALL, C_FLOW, C_AI_OFF, C_AI_BACK, C_AI_FULL, C_AI_FREE };

static void apply_bus(unsigned bus) {
    model_set_bus((model_bus_t)bus);
    model_run(1);
}

static bool other_bus(unsigned bus) {
    const bool stays = (model.bus == BUS_PASSIVE) || (model.bus == BUS_DEAD);
    return (bus == BUS_FINE) ? stays : may_have_hal_defect();
}

static void controller(unsigned how) {
    switch (how) {
    case C_OVERRUN:
        sim_hal_add_overrun(&testbed.hal, HAL_CAN_VEHICLE);
        break;
    case C_FULL:
    case C_FREE:
        testbed_disturb(HAL_CAN_VEHICLE, 1, (how == C_FULL) ? 1 : 0);
        break;
    case C_STALL:
    case C_FLOW:
        model.stalled = how == C_STALL;
        testbed_disturb(HAL_CAN_VEHICLE, 2, 0);
        break;
    case C_AI_OFF:
    case C_AI_BACK:
        model_set_ai_off(how == C_AI_OFF);
        break;
    default:
        testbed_disturb(HAL_CAN_AI, 1, (how == C_AI_FULL) ? 1 : 0);
        break;
    }
    model_run(1);
}

static bool other_controller(unsigned how) {
    switch (how) {
    case C_FULL:
    case C_STALL:
        return may_have_hal_defect();
    case C_AI_OFF:
    case C_AI_FULL:
        return gateway(0) && may_have_hal_defect();
    case C_FREE:
        return testbed.hal.can[HAL_CAN_VEHICLE].full;
    case C_FLOW:
        return model.stalled;
    case C_AI_BACK:
        return model.ai_off;
    case C_AI_FREE:
        return testbed.hal.can[HAL_CAN_AI].full;
    default:
        return true;
    }
}

/* ---- The supervisor itself ---- */

static void late(unsigned ms) {
    model_late(ms);
}

static void sleep_ms(unsigned ms) {
    model_sleep(ms);
}

static void restart(unsigned cause) {
    model_restart((hal_reset_cause_t)cause);
}

static void spoil_latch(unsigned how) {
    (void)how;
    (void)sim_store_corrupt_latch(&testbed.store, 0, 1);
    model.bad_latch = true;
    model_run(1);
}

static bool latch_is_good(unsigned how) {
    (void)how;
    return may_have_hal_defect();
}

/* ---- The table. The short alphabet comes first. ---- */

#define DEFECT(kind) {NULL, apply_defect, other_defect, DEFECT_##kind}

static const symbol_t SYMBOLS[] = {
    {"time passes", run_ticks, always, 0},
    {"363h: manual", apply_mode, other_mode, MODEL_MANUAL},
    {"363h: autopilot", apply_mode, other_mode, MODEL_ENGAGED},
    {"button 1 down", apply_button, other_button, 1},
    {"button 1 up", apply_button, other_button, 0},
    {"0A3h: P", apply_gear, other_gear, MODEL_P},
    {"0A3h: D", apply_gear, other_gear, MODEL_D},
    {"wheels turn", apply_wheels, other_wheels, 1},
    {"wheels stop", apply_wheels, other_wheels, 0},
    DEFECT(NONE),
    DEFECT(VCU_SILENT),
    DEFECT(AI_SILENT),
    DEFECT(EPS_FAULT),
    {"rogue node: 168h D", rogue_node, vehicle_hears, S_GEAR},
    {"bus-off", apply_bus, other_bus, BUS_OFF},
    {"restart: power-on", restart, always, HAL_RESET_POWER_ON},
    {"restart: watchdog", restart, always, HAL_RESET_WATCHDOG},
    {"tick late by 101 ms", late, always, LATE_MS},
    /* end of the short alphabet */
    {"363h: both modes", apply_mode, other_mode, MODEL_BOTH},
    {"363h: neither mode", apply_mode, other_mode, MODEL_NEITHER},
    {"silent node sends one frame", send_late_frame, can_speak, 0},
    DEFECT(VCU_FROZEN),
    DEFECT(VCU_SHORT),
    DEFECT(EPS_SILENT),
    DEFECT(EPS_FROZEN),
    DEFECT(AI_FROZEN),
    DEFECT(AI_SHORT),
    DEFECT(ALL_SILENT),
    DEFECT(GEAR_STATUS_SILENT),
    DEFECT(THROTTLE_STATUS_SILENT),
    DEFECT(WHEELS_SILENT),
    DEFECT(EPS_STATUS_SILENT),
    DEFECT(GEAR_COMMAND_SILENT),
    DEFECT(STEERING_COMMAND_SILENT),
    DEFECT(EPS_SUPPLY),
    DEFECT(VCU_ALARM),
    DEFECT(VCU_AI_ALARM),
    DEFECT(AI_OUT_OF_RANGE),
    DEFECT(AI_BABBLES),
    DEFECT(GEAR_INVALID),
    DEFECT(ANGLE_INVALID),
    DEFECT(EPS_MODE_OFF),
    DEFECT(STEERING_OFF),
    DEFECT(THROTTLE),
    DEFECT(THROTTLE_ABOVE),
    DEFECT(GEAR_AGAINST),
    DEFECT(AUTOPILOT_STAYS),
    DEFECT(MODE_FLAPS),
    DEFECT(FOREIGN),
    DEFECT(RECEIVE_DEAD),
    {"rogue node: 168h of one byte", rogue_node, vehicle_hears, S_SHORT},
    {"rogue node: 43Fh", rogue_node, vehicle_hears, S_SIGNALS},
    {"rogue node: 167h with a fault bit", rogue_node, vehicle_hears, S_FAULT},
    {"malformed frames", rogue_node, vehicle_hears, S_MALFORMED},
    {"rogue node: 43Fh of the other ID set", rogue_node, vehicle_hears, S_OTHER_SET},
    {"rogue node: 167h on the AI side", rogue_node, ai_side_hears, S_AI_SIDE},
    {"error-active", apply_bus, other_bus, BUS_FINE},
    {"error-passive", apply_bus, other_bus, BUS_PASSIVE},
    {"bus-off without recovery", apply_bus, other_bus, BUS_DEAD},
    {"overrun", controller, other_controller, C_OVERRUN},
    {"queue full", controller, other_controller, C_FULL},
    {"queue free", controller, other_controller, C_FREE},
    {"frames are not sent", controller, other_controller, C_STALL},
    {"frames are sent again", controller, other_controller, C_FLOW},
    {"AI side: bus-off", controller, other_controller, C_AI_OFF},
    {"AI side: recovered", controller, other_controller, C_AI_BACK},
    {"AI side: queue full", controller, other_controller, C_AI_FULL},
    {"AI side: queue free", controller, other_controller, C_AI_FREE},
    {"tick late by 40 ms", late, always, BIT_LATE_MS},
    {"eleven days without a tick", sleep_ms, may_sleep, SLEEP_MS},
    {"the stored latch is damaged", spoil_latch, latch_is_good, 0},
    {"restart: brown-out", restart, always, HAL_RESET_BROWN_OUT},
    {"restart: unknown", restart, always, HAL_RESET_UNKNOWN},
};
enum { SIZE = sizeof SYMBOLS / sizeof SYMBOLS[0], QUICK_SIZE = 18 };

unsigned alphabet_size(bool quick) {
    return quick ? (unsigned)QUICK_SIZE : (unsigned)SIZE;
}

const char *alphabet_name(unsigned symbol) {
    const symbol_t *s = &SYMBOLS[symbol];
    return (s->name != NULL) ? s->name : DEFECT_ROWS[s->how].name;
}

bool alphabet_enabled(unsigned symbol) {
    return SYMBOLS[symbol].enabled(SYMBOLS[symbol].how);
}

bool alphabet_leaves_no_trace(unsigned symbol) {
    void (*const apply)(unsigned) = SYMBOLS[symbol].apply;
    return (apply == rogue_node) || (apply == controller) || (apply == late) || (apply == send_late_frame) ||
           (apply == restart);
}

void alphabet_apply(unsigned symbol) {
    SYMBOLS[symbol].apply(SYMBOLS[symbol].how);
}
