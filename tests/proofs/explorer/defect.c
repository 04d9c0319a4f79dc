/* The defects of the vehicle, and their effect on its traffic. */
#include "model.h"

/* TRIPS_NEVER for steering and throttle, because a trip depends on more than the defect. */
const defect_row_t DEFECT_ROWS[DEFECTS] = {
    [DEFECT_NONE] = {"healthy", DEFECT_NONE, TRIPS_NEVER},
    [DEFECT_VCU_SILENT] = {"VCU silent", DEFECT_VCU_SILENT, TRIPS_ALWAYS},
    [DEFECT_VCU_FROZEN] = {"VCU counter frozen", DEFECT_VCU_FROZEN, TRIPS_ALWAYS},
    [DEFECT_VCU_SHORT] = {"VCU sends short frames", DEFECT_VCU_SILENT, TRIPS_ALWAYS},
    [DEFECT_EPS_SILENT] = {"EPS silent", DEFECT_EPS_SILENT, TRIPS_ALWAYS},
    [DEFECT_EPS_FROZEN] = {"EPS counter frozen", DEFECT_EPS_SILENT, TRIPS_ALWAYS},
    [DEFECT_AI_SILENT] = {"AI silent", DEFECT_AI_SILENT, TRIPS_ENGAGED},
    [DEFECT_AI_FROZEN] = {"AI counter frozen", DEFECT_AI_SILENT, TRIPS_ENGAGED},
    [DEFECT_AI_SHORT] = {"AI sends short frames", DEFECT_AI_SILENT, TRIPS_ENGAGED},
    [DEFECT_ALL_SILENT] = {"all silent", DEFECT_ALL_SILENT, TRIPS_ALWAYS},
    [DEFECT_GEAR_STATUS_SILENT] = {"0A3h silent", DEFECT_GEAR_STATUS_SILENT, TRIPS_ALWAYS},
    [DEFECT_THROTTLE_STATUS_SILENT] = {"050h silent", DEFECT_THROTTLE_STATUS_SILENT, TRIPS_ALWAYS},
    [DEFECT_WHEELS_SILENT] = {"101h silent", DEFECT_WHEELS_SILENT, TRIPS_ALWAYS},
    [DEFECT_EPS_STATUS_SILENT] = {"167h silent", DEFECT_THROTTLE_STATUS_SILENT, TRIPS_ALWAYS},
    [DEFECT_GEAR_COMMAND_SILENT] = {"168h silent", DEFECT_AI_SILENT, TRIPS_ENGAGED},
    [DEFECT_STEERING_COMMAND_SILENT] = {"065h silent", DEFECT_AI_SILENT, TRIPS_ENGAGED},
    [DEFECT_EPS_FAULT] = {"EPS fault bit", DEFECT_EPS_FAULT, TRIPS_ALWAYS},
    [DEFECT_EPS_SUPPLY] = {"EPS under voltage", DEFECT_EPS_FAULT, TRIPS_ALWAYS},
    [DEFECT_VCU_ALARM] = {"S-driver alarm", DEFECT_EPS_FAULT, TRIPS_ALWAYS},
    [DEFECT_VCU_AI_ALARM] = {"VCU alarm: AI lost", DEFECT_AI_SILENT, TRIPS_NEVER},
    [DEFECT_AI_OUT_OF_RANGE] = {"AI gear out of range", DEFECT_AI_SILENT, TRIPS_ENGAGED},
    [DEFECT_AI_BABBLES] = {"AI babbles 168h", DEFECT_AI_SILENT, TRIPS_NEVER},
    [DEFECT_GEAR_INVALID] = {"0A3h invalid", DEFECT_GEAR_STATUS_SILENT, TRIPS_ENGAGED},
    [DEFECT_ANGLE_INVALID] = {"067h angle invalid", DEFECT_THROTTLE, TRIPS_ENGAGED},
    [DEFECT_EPS_MODE_OFF] = {"EPS mode off", DEFECT_THROTTLE, TRIPS_ENGAGED},
    [DEFECT_STEERING_OFF] = {"steering 60 degrees off", DEFECT_THROTTLE, TRIPS_NEVER},
    [DEFECT_THROTTLE] = {"050h above 0", DEFECT_THROTTLE, TRIPS_NEVER},
    [DEFECT_THROTTLE_ABOVE] = {"050h above the command", DEFECT_THROTTLE, TRIPS_ENGAGED},
    [DEFECT_GEAR_AGAINST] = {"0A3h R against the command", DEFECT_GEAR_AGAINST, TRIPS_FOLLOWED},
    [DEFECT_AUTOPILOT_STAYS] = {"autopilot off is ignored", DEFECT_AI_SILENT, TRIPS_FOLLOWED},
    [DEFECT_MODE_FLAPS] = {"modes that flap", DEFECT_MODE_FLAPS, TRIPS_FLAPPING},
    [DEFECT_FOREIGN] = {"foreign 168h D on the vehicle side", DEFECT_FOREIGN, TRIPS_NEVER},
    [DEFECT_RECEIVE_DEAD] = {"receive path does not check in", DEFECT_RECEIVE_DEAD, TRIPS_NEVER},
};

/* FLAP_MS: period of the mode changes, long enough to count as a new engagement each time. */
enum { FLAP_MS = 200, R = 2, SIGNALS = 4, AUTOPILOT_OFF = 0x40 };
enum { SHORT = 5, EPS_FAULTS = 7, ALARMS = 4, EPS_MODE = 3, ANGLE_LOW = 2, ANGLE_HIGH = 3 };

/* What a defect does to the messages from `first` to `last`; BYTE sets one byte of the first. */
typedef enum { MUTED, FROZEN, SHORTENED, BYTE } effect_t;

static const struct {
    defect_t defect;
    effect_t effect;
    uint8_t first;
    uint8_t last;
    uint8_t at;
    uint8_t value;
} EFFECTS[] = {
    {DEFECT_VCU_SILENT, MUTED, M_VEHICLE, M_THROTTLE_STATUS, 0, 0},
    {DEFECT_VCU_SILENT, MUTED, M_WHEELS, M_WHEELS, 0, 0},
    {DEFECT_EPS_SILENT, MUTED, M_STEERING_STATUS, M_POSITION, 0, 0},
    {DEFECT_AI_SILENT, MUTED, M_SIGNALS, M_STEERING, 0, 0},
    {DEFECT_ALL_SILENT, MUTED, M_SIGNALS, M_WHEELS, 0, 0},
    {DEFECT_GEAR_STATUS_SILENT, MUTED, M_GEAR_STATUS, M_GEAR_STATUS, 0, 0},
    {DEFECT_THROTTLE_STATUS_SILENT, MUTED, M_THROTTLE_STATUS, M_THROTTLE_STATUS, 0, 0},
    {DEFECT_WHEELS_SILENT, MUTED, M_WHEELS, M_WHEELS, 0, 0},
    {DEFECT_EPS_STATUS_SILENT, MUTED, M_EPS_STATUS, M_EPS_STATUS, 0, 0},
    {DEFECT_GEAR_COMMAND_SILENT, MUTED, M_GEAR, M_GEAR, 0, 0},
    {DEFECT_STEERING_COMMAND_SILENT, MUTED, M_STEERING, M_STEERING, 0, 0},
    {DEFECT_VCU_SHORT, SHORTENED, M_VEHICLE, M_THROTTLE_STATUS, 0, 0},
    {DEFECT_VCU_SHORT, SHORTENED, M_WHEELS, M_WHEELS, 0, 0},
    {DEFECT_AI_SHORT, SHORTENED, M_SIGNALS, M_STEERING, 0, 0},
    {DEFECT_VCU_FROZEN, FROZEN, M_VEHICLE, M_VEHICLE, 0, 0},
    {DEFECT_EPS_FROZEN, FROZEN, M_STEERING_STATUS, M_STEERING_STATUS, 0, 0},
    {DEFECT_AI_FROZEN, FROZEN, M_SIGNALS, M_SIGNALS, 0, 0},
    {DEFECT_EPS_FAULT, BYTE, M_EPS_STATUS, M_EPS_STATUS, EPS_FAULTS, 0x08},
    {DEFECT_EPS_SUPPLY, BYTE, M_EPS_STATUS, M_EPS_STATUS, EPS_FAULTS, 0x01},
    {DEFECT_VCU_ALARM, BYTE, M_VEHICLE, M_VEHICLE, ALARMS, 0x80},
    {DEFECT_VCU_AI_ALARM, BYTE, M_VEHICLE, M_VEHICLE, ALARMS, 0x08},
    {DEFECT_AI_OUT_OF_RANGE, BYTE, M_GEAR, M_GEAR, 0, 3},
    {DEFECT_GEAR_INVALID, BYTE, M_GEAR_STATUS, M_GEAR_STATUS, 0, 3},
    {DEFECT_ANGLE_INVALID, BYTE, M_STEERING_STATUS, M_STEERING_STATUS, ANGLE_LOW, 0xFF},
    {DEFECT_ANGLE_INVALID, BYTE, M_STEERING_STATUS, M_STEERING_STATUS, ANGLE_HIGH, 0xFF},
    {DEFECT_EPS_MODE_OFF, BYTE, M_EPS_STATUS, M_EPS_STATUS, EPS_MODE, 0},
    /* 20D0h: 60.0 degrees from the middle, 66.0 from the command */
    {DEFECT_STEERING_OFF, BYTE, M_STEERING_STATUS, M_STEERING_STATUS, ANGLE_LOW, 0xD0},
    {DEFECT_STEERING_OFF, BYTE, M_STEERING_STATUS, M_STEERING_STATUS, ANGLE_HIGH, 0x20},
    {DEFECT_THROTTLE, BYTE, M_THROTTLE_STATUS, M_THROTTLE_STATUS, 0, 100},
    {DEFECT_THROTTLE_ABOVE, BYTE, M_THROTTLE_STATUS, M_THROTTLE_STATUS, 0, 150}, /* the command is 100 */
    {DEFECT_GEAR_AGAINST, BYTE, M_GEAR_STATUS, M_GEAR_STATUS, 0, R},
    {DEFECT_GEAR_AGAINST, BYTE, M_THROTTLE_STATUS, M_THROTTLE_STATUS, 0, 100},
    {DEFECT_AUTOPILOT_STAYS, BYTE, M_SIGNALS, M_SIGNALS, SIGNALS, AUTOPILOT_OFF},
};

void defect_apply(defect_t defect) {
    for (unsigned i = 0; i < sizeof EFFECTS / sizeof EFFECTS[0]; i++) {
        for (unsigned m = EFFECTS[i].first; (EFFECTS[i].defect == defect) && (m <= EFFECTS[i].last); m++) {
            traffic_message_t *message = &testbed.traffic[m];
            message->muted = message->muted || (EFFECTS[i].effect == MUTED);
            message->frozen = message->frozen || (EFFECTS[i].effect == FROZEN);
            message->length = (EFFECTS[i].effect == SHORTENED) ? SHORT : message->length;
            if (EFFECTS[i].effect == BYTE) {
                message->data[EFFECTS[i].at] = EFFECTS[i].value;
            }
        }
    }
    if (defect == DEFECT_MODE_FLAPS) {
        const uint64_t period = (testbed.now_ms - model.defect_ms) / FLAP_MS;
        traffic_mode(testbed.traffic, (period % 2 == 0) ? MODEL_ENGAGED : MODEL_MANUAL);
    }
    testbed.receive_path_dead = defect == DEFECT_RECEIVE_DEAD;
}
