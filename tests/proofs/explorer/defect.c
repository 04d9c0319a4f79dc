/* The defects of the vehicle, and their effect on its traffic. */
#include "model.h"

/* TRIPS_NEVER for steering and throttle, because a trip depends on more than the defect. */
const defect_row_t SET_DEFECT[DEFECTS] = {
    [DEFECT_NONE] = {"healthy", NULL, NULL, DEFECT_NONE, TRIPS_NEVER},
    [DEFECT_VCU_SILENT] = {"VCU silent", "VCU_HEARTBEAT_LOST", NULL, DEFECT_VCU_SILENT, TRIPS_ALWAYS},
    [DEFECT_VCU_FROZEN] = {"VCU counter frozen", "VCU_HEARTBEAT_STUCK", NULL, DEFECT_VCU_FROZEN, TRIPS_ALWAYS},
    [DEFECT_VCU_SHORT] = {"VCU sends short frames", "VCU_HEARTBEAT_LOST", NULL, DEFECT_VCU_SILENT, TRIPS_ALWAYS},
    [DEFECT_EPS_SILENT] = {"EPS silent", "EPS_HEARTBEAT_LOST", NULL, DEFECT_EPS_SILENT, TRIPS_ALWAYS},
    [DEFECT_EPS_FROZEN] = {"EPS counter frozen", "EPS_HEARTBEAT_STUCK", NULL, DEFECT_EPS_SILENT, TRIPS_ALWAYS},
    [DEFECT_AI_SILENT] = {"AI silent", "STEERING_COMMAND_TIMEOUT", NULL, DEFECT_AI_SILENT, TRIPS_ENGAGED},
    [DEFECT_AI_FROZEN] = {"AI counter frozen", "AI_HEARTBEAT_STUCK", NULL, DEFECT_AI_SILENT, TRIPS_ENGAGED},
    [DEFECT_AI_SHORT] = {"AI sends short frames", "STEERING_COMMAND_TIMEOUT", NULL, DEFECT_AI_SILENT, TRIPS_ENGAGED},
    [DEFECT_ALL_SILENT] = {"all silent", "VCU_HEARTBEAT_LOST", "EPS_HEARTBEAT_LOST", DEFECT_ALL_SILENT, TRIPS_ALWAYS},
    [DEFECT_GEAR_STATUS_SILENT] = {"0A3h silent", "GEAR_STATUS_TIMEOUT", NULL, DEFECT_GEAR_STATUS_SILENT, TRIPS_ALWAYS},
    [DEFECT_THROTTLE_STATUS_SILENT] = {"050h silent", "THROTTLE_STATUS_TIMEOUT", NULL, DEFECT_THROTTLE_STATUS_SILENT,
                                       TRIPS_ALWAYS},
    [DEFECT_WHEELS_SILENT] = {"101h silent", "WHEEL_SPEED_TIMEOUT", NULL, DEFECT_WHEELS_SILENT, TRIPS_ALWAYS},
    [DEFECT_EPS_STATUS_SILENT] = {"167h silent", "EPS_STATUS_TIMEOUT", NULL, DEFECT_THROTTLE_STATUS_SILENT,
                                  TRIPS_ALWAYS},
    [DEFECT_GEAR_COMMAND_SILENT] = {"168h silent", "GEAR_COMMAND_TIMEOUT", NULL, DEFECT_AI_SILENT, TRIPS_ENGAGED},
    [DEFECT_STEERING_COMMAND_SILENT] = {"065h silent", "STEERING_COMMAND_TIMEOUT", NULL, DEFECT_AI_SILENT,
                                        TRIPS_ENGAGED},
    [DEFECT_EPS_FAULT] = {"EPS fault bit", "EPS_OVER_CURRENT_SHUTDOWN", NULL, DEFECT_EPS_FAULT, TRIPS_ALWAYS},
    [DEFECT_EPS_SUPPLY] = {"EPS under voltage", "EPS_UNDER_VOLTAGE", NULL, DEFECT_EPS_FAULT, TRIPS_ALWAYS},
    [DEFECT_VCU_ALARM] = {"S-driver alarm", "S_DRIVER_ALARM", NULL, DEFECT_EPS_FAULT, TRIPS_ALWAYS},
    [DEFECT_VCU_AI_ALARM] = {"VCU alarm: AI lost", "VCU_AI_CAN_LOST", NULL, DEFECT_AI_SILENT, TRIPS_NEVER},
    [DEFECT_AI_OUT_OF_RANGE] = {"AI gear out of range", "AI_COMMAND_OUT_OF_RANGE", NULL, DEFECT_AI_SILENT,
                                TRIPS_ENGAGED},
    [DEFECT_AI_BABBLES] = {"AI babbles 168h", "COMMAND_TOO_FAST", NULL, DEFECT_AI_SILENT, TRIPS_NEVER},
    [DEFECT_GEAR_INVALID] = {"0A3h invalid", "GEAR_STATUS_INVALID", NULL, DEFECT_GEAR_STATUS_SILENT, TRIPS_ENGAGED},
    [DEFECT_ANGLE_INVALID] = {"067h angle invalid", "STEERING_ANGLE_INVALID", NULL, DEFECT_THROTTLE, TRIPS_ENGAGED},
    [DEFECT_EPS_MODE_OFF] = {"EPS mode off", "EPS_MODE_OFF", NULL, DEFECT_THROTTLE, TRIPS_ENGAGED},
    [DEFECT_STEERING_OFF] = {"steering 60 degrees off", "STEERING_DEVIATION", NULL, DEFECT_THROTTLE, TRIPS_NEVER},
    [DEFECT_THROTTLE] = {"050h above 0", "THROTTLE_IN_PARK", NULL, DEFECT_THROTTLE, TRIPS_NEVER},
    [DEFECT_THROTTLE_ABOVE] = {"050h above the command", "THROTTLE_DEVIATION", NULL, DEFECT_THROTTLE, TRIPS_ENGAGED},
    [DEFECT_GEAR_AGAINST] = {"0A3h R against the command", "GEAR_DEVIATION", NULL, DEFECT_GEAR_AGAINST, TRIPS_FOLLOWED},
    [DEFECT_AUTOPILOT_STAYS] = {"autopilot off is ignored", "AUTOPILOT_OFF_IGNORED", NULL, DEFECT_AI_SILENT,
                                TRIPS_FOLLOWED},
    [DEFECT_MODE_FLAPS] = {"modes that flap", "MODE_FLAPPING", NULL, DEFECT_MODE_FLAPS, TRIPS_FLAPPING},
    [DEFECT_FOREIGN] = {"foreign 168h D on the vehicle side", "FOREIGN_COMMAND_SENDER", NULL, DEFECT_FOREIGN,
                        TRIPS_NEVER},
    [DEFECT_RECEIVE_DEAD] = {"receive path does not check in", NULL, NULL, DEFECT_RECEIVE_DEAD, TRIPS_NEVER},
};

/* FLAP_MS: period of the mode changes, long enough to count as a new engagement each time. */
enum { FLAP_MS = 200, R = 2, SIGNALS = 4, AUTOPILOT_OFF = 0x40 };
enum { SHORT = 5, EPS_FAULTS = 7, ALARMS = 4, EPS_MODE = 3, ANGLE_LOW = 2, ANGLE_HIGH = 3 };

static void mute(unsigned first, unsigned last) {
    for (unsigned m = first; m <= last; m++) {
        testbed.traffic[m].muted = true;
    }
}

static void shorten(unsigned first, unsigned last) {
    for (unsigned m = first; m <= last; m++) {
        testbed.traffic[m].length = SHORT;
    }
}

/* Silent nodes and messages, and short frames. */
static void apply_silent(defect_t defect) {
    switch (defect) {
    case DEFECT_VCU_SILENT:
        mute(M_VEHICLE, M_THROTTLE_STATUS);
        mute(M_WHEELS, M_WHEELS);
        break;
    case DEFECT_EPS_SILENT:
        mute(M_STEERING_STATUS, M_POSITION);
        break;
    case DEFECT_AI_SILENT:
        mute(M_SIGNALS, M_STEERING);
        break;
    case DEFECT_ALL_SILENT:
        mute(M_SIGNALS, M_WHEELS);
        break;
    case DEFECT_GEAR_STATUS_SILENT:
        mute(M_GEAR_STATUS, M_GEAR_STATUS);
        break;
    case DEFECT_THROTTLE_STATUS_SILENT:
        mute(M_THROTTLE_STATUS, M_THROTTLE_STATUS);
        break;
    case DEFECT_WHEELS_SILENT:
        mute(M_WHEELS, M_WHEELS);
        break;
    case DEFECT_EPS_STATUS_SILENT:
        mute(M_EPS_STATUS, M_EPS_STATUS);
        break;
    case DEFECT_GEAR_COMMAND_SILENT:
        mute(M_GEAR, M_GEAR);
        break;
    case DEFECT_STEERING_COMMAND_SILENT:
        mute(M_STEERING, M_STEERING);
        break;
    case DEFECT_VCU_SHORT:
        shorten(M_VEHICLE, M_THROTTLE_STATUS);
        shorten(M_WHEELS, M_WHEELS);
        break;
    case DEFECT_AI_SHORT:
        shorten(M_SIGNALS, M_STEERING);
        break;
    default:
        break;
    }
}

/* Wrong values. */
static void apply_values(defect_t defect) {
    traffic_message_t *t = testbed.traffic;
    switch (defect) {
    case DEFECT_VCU_FROZEN:
        t[M_VEHICLE].frozen = true;
        break;
    case DEFECT_EPS_FROZEN:
        t[M_STEERING_STATUS].frozen = true;
        break;
    case DEFECT_AI_FROZEN:
        t[M_SIGNALS].frozen = true;
        break;
    case DEFECT_EPS_FAULT:
        t[M_EPS_STATUS].data[EPS_FAULTS] = 0x08;
        break;
    case DEFECT_EPS_SUPPLY:
        t[M_EPS_STATUS].data[EPS_FAULTS] = 0x01;
        break;
    case DEFECT_VCU_ALARM:
        t[M_VEHICLE].data[ALARMS] = 0x80;
        break;
    case DEFECT_VCU_AI_ALARM:
        t[M_VEHICLE].data[ALARMS] = 0x08;
        break;
    case DEFECT_AI_OUT_OF_RANGE:
        t[M_GEAR].data[0] = 3;
        break;
    case DEFECT_GEAR_INVALID:
        t[M_GEAR_STATUS].data[0] = 3;
        break;
    case DEFECT_ANGLE_INVALID:
        t[M_STEERING_STATUS].data[ANGLE_LOW] = 0xFF;
        t[M_STEERING_STATUS].data[ANGLE_HIGH] = 0xFF;
        break;
    case DEFECT_EPS_MODE_OFF:
        t[M_EPS_STATUS].data[EPS_MODE] = 0;
        break;
    case DEFECT_STEERING_OFF:
        t[M_STEERING_STATUS].data[ANGLE_LOW] = 0xD0; /* 20D0h: 60.0 degrees from the middle, 66.0 from the command */
        t[M_STEERING_STATUS].data[ANGLE_HIGH] = 0x20;
        break;
    case DEFECT_THROTTLE:
        t[M_THROTTLE_STATUS].data[0] = 100;
        break;
    case DEFECT_THROTTLE_ABOVE:
        t[M_THROTTLE_STATUS].data[0] = 150; /* the command is 100 */
        break;
    case DEFECT_GEAR_AGAINST:
        t[M_GEAR_STATUS].data[0] = R;
        t[M_THROTTLE_STATUS].data[0] = 100;
        break;
    case DEFECT_AUTOPILOT_STAYS:
        t[M_SIGNALS].data[SIGNALS] = AUTOPILOT_OFF;
        break;
    case DEFECT_MODE_FLAPS:
        testbed_mode(((testbed.now_ms - model.defect_ms) / (uint64_t)FLAP_MS % 2u == 0u) ? MODEL_ENGAGED
                                                                                         : MODEL_MANUAL);
        break;
    default:
        break;
    }
}

void defect_apply(defect_t defect) {
    apply_silent(defect);
    apply_values(defect);
    testbed.receive_path_dead = defect == DEFECT_RECEIVE_DEAD;
}
