#include "campaign/campaign_bounds.h"

#include <jansson.h>

#include "agv/names.h"
#include "campaign/campaign_rows.h"
#include "hal_sim/sim_bus.h"
#include "io/output_json.h"
#include "vehicle/vehicle.h"

static json_t *messages(void) {
    json_t *list = json_array();
    for (int m = 0; m < AGV_MSG_COUNT; m++) {
        const agv_message_t message = (agv_message_t)m;
        (void)json_array_append_new(list, json_pack("{s:s, s:s, s:i, s:i, s:i, s:i}", "name", agv_message_name(message),
                                                    "node", vehicle_node_name(vehicle_sender_of(message)), "heading_id",
                                                    (int)agv_message_id(message, AGV_ID_SET_HEADING), "table_id",
                                                    (int)agv_message_id(message, AGV_ID_SET_TABLE), "cycle_ms",
                                                    (int)agv_message_cycle_ms(message), "bytes", (int)AGV_DLC));
    }
    return list;
}

static json_t *settings(void) {
    agv_config_t config;
    json_t *object = json_object();
    agv_config_defaults(&config);
    for (uint16_t i = 0; i < AGV_SETTING_COUNT; i++) {
        (void)json_object_set_new(object, agv_setting_info(i)->name, json_integer(agv_config_get(&config, i)));
    }
    return object;
}

/** NULL: none. */
static const char *name_of(uint16_t setting) {
    return (setting < AGV_SETTING_COUNT) ? agv_setting_info(setting)->name : NULL;
}

static json_t *flags_of(const campaign_row_t *row) {
    static const char *const names[] = {"gateway", "shared",    "engaged", "manual",     "start",
                                        "later",   "output",    "as_trip", "unreliable", "no_output",
                                        "no_wire", "at_once_p", "late_ai", "again",      "in_gear"};
    _Static_assert(CAMPAIGN_FLAGS_END == (1u << (sizeof names / sizeof names[0])), "a flag has no name");
    json_t *list = json_array();
    for (size_t bit = 0; bit < sizeof names / sizeof names[0]; bit++) {
        if (((row->flags >> bit) & 1) != 0) {
            (void)json_array_append_new(list, json_string(names[bit]));
        }
    }
    return list;
}

static json_t *rows(void) {
    static const char *const kinds[] = {"at_once", "tick",  "frame",       "frames",  "silence", "lasts",
                                        "gaps",    "stall", "unconfirmed", "contact", "clocks"};
    json_t *list = json_array();
    for (size_t i = 0; i < CAMPAIGN_ROW_COUNT; i++) {
        const campaign_row_t *row = &CAMPAIGN_ROWS[i];
        (void)json_array_append_new(
            list, json_pack("{s:s, s:i, s:s, s:s?, s:s?, s:i, s:o}", "fault", agv_fault_name(row->fault), "rank",
                            (int)row->fault, "kind", kinds[row->kind], "message",
                            (row->message != AGV_MSG_NONE) ? agv_message_name(row->message) : NULL, "setting",
                            name_of(row->setting), "highest", (int)row->highest, "flags", flags_of(row)));
    }
    return list;
}

static json_t *engagements(void) {
    json_t *list = json_array();
    for (size_t i = 0; i < CAMPAIGN_ENGAGEMENT_COUNT; i++) {
        const campaign_engagement_t *engagement = &CAMPAIGN_ENGAGEMENTS[i];
        (void)json_array_append_new(list,
                                    json_pack("{s:s, s:s?, s:b}", "fault", agv_fault_name(engagement->fault), "wait",
                                              name_of(engagement->wait), "never_seen", (int)engagement->never_seen));
    }
    return list;
}

static json_t *faults(void) {
    json_t *list = json_array();
    for (int fault = 0; fault < AGV_FAULT_COUNT; fault++) {
        (void)json_array_append_new(list, json_string(agv_fault_name((agv_fault_t)fault)));
    }
    return list;
}

/** Frame lengths of the simulated bus, in bits: of 0 to 8 bytes. */
static json_t *frame_bits(bool extended) {
    json_t *list = json_array();
    for (uint8_t length = 0; length <= AGV_DLC; length++) {
        const hal_can_frame_t frame = {.length = length, .flags = extended ? (uint8_t)HAL_CAN_EXTENDED : (uint8_t)0};
        (void)json_array_append_new(list, json_integer((json_int_t)sim_bus_frame_bits(&frame)));
    }
    return list;
}

static json_t *vehicle(void) {
    vehicle_config_t config;
    vehicle_defaults(&config);
    return json_pack("{s:i, s:i, s:i, s:i, s:i}", "walking_pace_mm_s", (int)config.walking_pace_mm_s, "braking_mm_s2",
                     (int)config.braking_mm_s2, "gear_change_ms", (int)config.gear_change_ms, "speed_mm_s",
                     ((int)config.top_speed_mm_s * (int)CAMPAIGN_THROTTLE_MAX_PCT) / 100, "locked_mm_s2",
                     (int)config.locked_mm_s2);
}

bool campaign_print_tables(output_t *output) {
    json_t *all =
        json_pack("{s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:i, s:i, s:i, s:i}", "messages", messages(), "settings",
                  settings(), "faults", faults(), "rows", rows(), "engagements", engagements(), "vehicle", vehicle(),
                  "standard_bits", frame_bits(false), "extended_bits", frame_bits(true), "interframe_bits",
                  (int)SIM_BUS_INTERFRAME_BITS, "suspend_bits", (int)SIM_BUS_SUSPEND_BITS, "error_bits",
                  (int)SIM_BUS_ERROR_BITS, "recovery_sequences", (int)SIM_BUS_RECOVERY_SEQUENCES);
    output_json(output, all, JSON_INDENT(1));
    return output->error == 0;
}
