/**
 * @file codec_lines.c
 * The C codec on a line protocol, for tests in other languages. One answer line a request line:
 *
 *   info                        several lines, ended by "end" (see print_info)
 *   unpack NAME 0011223344556677  "valid FIELD=VALUE ..." or "invalid FIELD=VALUE ..."
 *   pack NAME VALUE ...         values in the order of the struct: 16 hex digits, or "refused"
 *   from_id ID SET              name of the message, or "none"
 *
 * A malformed request, a refused pack that touched the payload or an unpack that left a field unwritten ends the
 * program with a message and exit status 1.
 */
#include "agv/codec.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Every message with its fields: X(type, field). All that follows is made from these lists. */
#define FIELDS_turn_signal_command(X)                                                                                  \
    X(bool, turn_left_on) X(bool, turn_right_on) X(bool, autopilot_off) X(bool, headlight_on) X(uint8_t, alive_counter)
#define FIELDS_gear_command(X) X(uint8_t, gear)
#define FIELDS_throttle_command(X) X(uint16_t, throttle_permille)
#define FIELDS_steering_command(X) X(int32_t, angle_ddeg)
#define FIELDS_vehicle_status(X)                                                                                       \
    X(uint16_t, speed_m_per_h)                                                                                         \
    X(uint8_t, level1_alarms)                                                                                          \
    X(uint8_t, level2_alarms)                                                                                          \
    X(bool, button_1)                                                                                                  \
    X(bool, button_2)                                                                                                  \
    X(bool, turn_left_on)                                                                                              \
    X(bool, turn_right_on) X(bool, manual_mode) X(bool, autopilot_mode) X(uint8_t, alive_counter)
#define FIELDS_gear_status(X) X(uint8_t, gear)
#define FIELDS_throttle_status(X) X(uint16_t, throttle_permille)
#define FIELDS_steering_status(X)                                                                                      \
    X(uint8_t, alive_counter)                                                                                          \
    X(uint8_t, supply_pct_of_12v) X(int32_t, angle_ddeg) X(uint16_t, torque_raw) X(uint16_t, speed_raw)
#define FIELDS_eps_status(X) X(uint8_t, mode) X(uint8_t, faults)
#define FIELDS_steering_position(X) X(uint16_t, centre_raw) X(uint16_t, left_raw) X(uint16_t, right_raw)
#define FIELDS_wheel_speed(X) X(int32_t, left_mm_s) X(int32_t, right_mm_s)

#define MESSAGES(X)                                                                                                    \
    X(AGV_MSG_TURN_SIGNAL_COMMAND, turn_signal_command)                                                                \
    X(AGV_MSG_GEAR_COMMAND, gear_command)                                                                              \
    X(AGV_MSG_THROTTLE_COMMAND, throttle_command)                                                                      \
    X(AGV_MSG_STEERING_COMMAND, steering_command)                                                                      \
    X(AGV_MSG_VEHICLE_STATUS, vehicle_status)                                                                          \
    X(AGV_MSG_GEAR_STATUS, gear_status)                                                                                \
    X(AGV_MSG_THROTTLE_STATUS, throttle_status)                                                                        \
    X(AGV_MSG_STEERING_STATUS, steering_status)                                                                        \
    X(AGV_MSG_EPS_STATUS, eps_status)                                                                                  \
    X(AGV_MSG_STEERING_POSITION, steering_position)                                                                    \
    X(AGV_MSG_WHEEL_SPEED, wheel_speed)

/** The 8 bytes that a pack must not touch when it refuses. */
static const uint8_t UNTOUCHED[AGV_DLC] = {0xA5, 0x5A, 0xA5, 0x5A, 0xA5, 0x5A, 0xA5, 0x5A};

static char request[512];

static _Noreturn void give_up(const char *why) {
    (void)fprintf(stderr, "codec_lines: %s: %s\n", why, request);
    exit(1);
}

static const char *next_word(void) {
    const char *word = strtok(NULL, " \n");
    if (word == NULL) {
        give_up("too few words");
    }
    return word;
}

/* The next number, which must fit the field. */
static int64_t next_number(int64_t lowest, int64_t highest) {
    const char *word = next_word();
    char *end = NULL;
    const int64_t number = strtoll(word, &end, 0);
    if (*end != '\0' || number < lowest || number > highest) {
        give_up("not a number that fits");
    }
    return number;
}

static void end_of_request(void) {
    if (strtok(NULL, " \n") != NULL) {
        give_up("too many words");
    }
}

static void next_payload(uint8_t data[AGV_DLC]) {
    const char *word = next_word();
    if (strlen(word) != 2 * AGV_DLC || strspn(word, "0123456789abcdef") != 2 * AGV_DLC) {
        give_up("not 16 hex digits");
    }
    for (size_t i = 0; i < AGV_DLC; i++) {
        const char digits[3] = {word[2 * i], word[2 * i + 1], '\0'};
        data[i] = (uint8_t)strtoul(digits, NULL, 16);
    }
}

static void print_packed(bool packed, const uint8_t data[AGV_DLC]) {
    if (!packed) {
        if (memcmp(data, UNTOUCHED, AGV_DLC) != 0) {
            give_up("a refused pack touched the payload");
        }
        puts("refused");
        return;
    }
    for (size_t i = 0; i < AGV_DLC; i++) {
        printf("%02x", data[i]);
    }
    puts("");
}

#define LOWEST(type) _Generic((type)0, int32_t: INT32_MIN, default: 0)
#define HIGHEST(type) _Generic((type)0, bool: 1, uint8_t: UINT8_MAX, uint16_t: UINT16_MAX, int32_t: INT32_MAX)
#define READ_FIELD(type, field) in.field = (type)next_number(LOWEST(type), HIGHEST(type));
#define PRINT_FIELD(type, field) printf(" " #field "=%" PRId64, (int64_t)out.field);
#define CHECK_FIELD(type, field)                                                                                       \
    if (out.field != again.field) {                                                                                    \
        give_up("unpack left " #field " unwritten");                                                                   \
    }
#define NAME_FIELD(type, field)                                                                                        \
    printf(" " #field ":%" PRId64 ":%" PRId64, (int64_t)LOWEST(type), (int64_t)HIGHEST(type));

#define DEFINE_PACK_AND_UNPACK(message, name)                                                                          \
    static void pack_##name(void) {                                                                                    \
        agv_##name##_t in;                                                                                             \
        uint8_t data[AGV_DLC];                                                                                         \
        memset(&in, 0, sizeof in);                                                                                     \
        memcpy(data, UNTOUCHED, sizeof data);                                                                          \
        FIELDS_##name(READ_FIELD);                                                                                     \
        end_of_request();                                                                                              \
        const bool packed = agv_pack_##name(data, &in);                                                                \
        print_packed(packed, data);                                                                                    \
    }                                                                                                                  \
    static void unpack_##name(void) {                                                                                  \
        agv_##name##_t out;                                                                                            \
        agv_##name##_t again;                                                                                          \
        uint8_t data[AGV_DLC];                                                                                         \
        memset(&out, 0, sizeof out);                                                                                   \
        memset(&again, 1, sizeof again);                                                                               \
        next_payload(data);                                                                                            \
        end_of_request();                                                                                              \
        const bool valid = agv_unpack_##name(&out, data);                                                              \
        if (agv_unpack_##name(&again, data) != valid) {                                                                \
            give_up("unpack answers differently the second time");                                                     \
        }                                                                                                              \
        FIELDS_##name(CHECK_FIELD);                                                                                    \
        fputs(valid ? "valid" : "invalid", stdout);                                                                    \
        FIELDS_##name(PRINT_FIELD);                                                                                    \
        puts("");                                                                                                      \
    }
MESSAGES(DEFINE_PACK_AND_UNPACK)

typedef struct {
    agv_message_t message;
    const char *name;
    void (*pack)(void);
    void (*unpack)(void);
} row_t;

#define ROW(message, name) {message, #name, pack_##name, unpack_##name},
static const row_t ROWS[AGV_MSG_COUNT] = {MESSAGES(ROW)};

static const row_t *next_row(void) {
    const char *name = next_word();
    for (size_t i = 0; i < AGV_MSG_COUNT; i++) {
        if (strcmp(ROWS[i].name, name) == 0) {
            return &ROWS[i];
        }
    }
    give_up("no such message");
}

#define PRINT_CONSTANT(name) printf("constant " #name " %d\n", (int)(name));
#define PRINT_FIELDS(message, name)                                                                                    \
    fputs("fields " #name, stdout);                                                                                    \
    FIELDS_##name(NAME_FIELD);                                                                                         \
    puts("");

/* message NAME ID-IN-HEADING-SET ID-IN-TABLE-SET CYCLE, fields NAME FIELD:LOWEST:HIGHEST ..., constant NAME VALUE. */
static void print_info(void) {
    for (size_t i = 0; i < AGV_MSG_COUNT; i++) {
        const agv_message_t message = ROWS[i].message;
        printf("message %s %u %u %u\n", ROWS[i].name, (unsigned)agv_message_id(message, AGV_ID_SET_HEADING),
               (unsigned)agv_message_id(message, AGV_ID_SET_TABLE), (unsigned)agv_message_cycle_ms(message));
    }
    MESSAGES(PRINT_FIELDS)
    PRINT_CONSTANT(AGV_GEAR_D)
    PRINT_CONSTANT(AGV_GEAR_R)
    PRINT_CONSTANT(AGV_GEAR_N)
    PRINT_CONSTANT(AGV_GEAR_P)
    PRINT_CONSTANT(AGV_EPS_MODE_ASSIST)
    PRINT_CONSTANT(AGV_EPS_MODE_ANGLE)
    PRINT_CONSTANT(AGV_EPS_MODE_SPEED)
    PRINT_CONSTANT(AGV_EPS_MODE_TORQUE)
    PRINT_CONSTANT(AGV_EPS_MODE_OFF)
    PRINT_CONSTANT(AGV_VCU_ALARM_REMOTE_SIGNAL_LOST)
    PRINT_CONSTANT(AGV_VCU_ALARM_REMOTE_POWER_LOST)
    PRINT_CONSTANT(AGV_VCU_ALARM_AI_CAN_LOST)
    PRINT_CONSTANT(AGV_VCU_ALARM_EPS_HARDWARE)
    PRINT_CONSTANT(AGV_VCU_ALARM_EPS_CAN_BUS)
    PRINT_CONSTANT(AGV_VCU_ALARM_S_DRIVER)
    PRINT_CONSTANT(AGV_EPS_FAULT_UNDER_VOLTAGE)
    PRINT_CONSTANT(AGV_EPS_FAULT_OVER_VOLTAGE)
    PRINT_CONSTANT(AGV_EPS_FAULT_EXCESSIVE_CURRENT)
    PRINT_CONSTANT(AGV_EPS_FAULT_OVER_CURRENT_SHUTDOWN)
    PRINT_CONSTANT(AGV_EPS_FAULT_TEMP_ABOVE_110)
    PRINT_CONSTANT(AGV_EPS_FAULT_TEMP_ABOVE_120)
    PRINT_CONSTANT(AGV_EPS_FAULT_MOTOR_ENCODER)
    PRINT_CONSTANT(AGV_EPS_FAULT_POSITION_ENCODER)
    puts("end");
}

static void answer_from_id(void) {
    const uint32_t id = (uint32_t)next_number(0, UINT32_MAX);
    const agv_id_set_t id_set = (next_number(0, 1) == 0) ? AGV_ID_SET_HEADING : AGV_ID_SET_TABLE;
    end_of_request();
    const agv_message_t message = agv_message_from_id(id, id_set);
    puts((message == AGV_MSG_NONE) ? "none" : ROWS[message].name);
}

static void answer(const char *command) {
    if (strcmp(command, "info") == 0) {
        end_of_request();
        print_info();
    } else if (strcmp(command, "pack") == 0) {
        next_row()->pack();
    } else if (strcmp(command, "unpack") == 0) {
        next_row()->unpack();
    } else if (strcmp(command, "from_id") == 0) {
        answer_from_id();
    } else {
        give_up("unknown request");
    }
}

int main(void) {
    while (fgets(request, (int)sizeof request, stdin) != NULL) {
        const char *command = strtok(request, " \n");
        if (command == NULL) {
            give_up("empty request");
        }
        answer(command);
    }
    return ferror(stdin) ? 1 : 0;
}
