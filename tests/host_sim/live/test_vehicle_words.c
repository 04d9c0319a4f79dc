/* Steps that are typed, or follow --fault: the same as in a scenario file, and one line for what makes no sense. */
#include "live/vehicle_words.h"

#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "scratch.h"
#include "unity.h"

static agv_config_t config;
static vehicle_words_t words;

void setUp(void) {
    scratch_open();
    agv_config_defaults(&config);
    memset(&words, 0, sizeof words);
}

/* It is refused with one line, which begins with what was typed. */
static void refused_when_typed(const char *line, const char *said) {
    char expected[2 * VEHICLE_WORDS_MAX];
    (void)snprintf(expected, sizeof expected, "host_sim: '%s': %s\n", line, said);
    TEST_ASSERT_FALSE_MESSAGE(vehicle_words_typed(line, &config, &words), line);
    TEST_ASSERT_EQUAL_STRING(expected, scratch_said());
}

void test_a_typed_line_is_a_step(void) {
    TEST_ASSERT_TRUE(vehicle_words_typed("eps set field=faults value=08h frames=3", &config, &words));
    TEST_ASSERT_EQUAL_STRING("eps", words.step.actor);
    TEST_ASSERT_EQUAL_STRING("set", words.step.word);
    TEST_ASSERT_EQUAL_STRING("set field=faults value=08h frames=3", words.what);
    TEST_ASSERT_TRUE(words.step.of_vehicle);
    TEST_ASSERT_EQUAL(VEHICLE_DO_PATCH, words.step.vehicle.what);
    TEST_ASSERT_EQUAL(AGV_MSG_EPS_STATUS, words.step.vehicle.message);
    TEST_ASSERT_EQUAL_HEX8(0x08, words.step.vehicle.value[7]);
    TEST_ASSERT_EQUAL_HEX8(0x00, words.step.vehicle.keep[7]);
    TEST_ASSERT_EQUAL_HEX8(0xFF, words.step.vehicle.keep[6]);
    TEST_ASSERT_EQUAL(3, words.step.vehicle.count);
}

void test_what_follows_fault_is_a_step_with_a_time(void) {
    TEST_ASSERT_TRUE(vehicle_words_fault("ai-drive,gear=R,throttle_pct=15,steer_deg=-20@86400000", &config, &words));
    TEST_ASSERT_EQUAL(86400000, words.step.at_ms);
    TEST_ASSERT_EQUAL(VEHICLE_DO_AI_DRIVE, words.step.vehicle.what);
    TEST_ASSERT_EQUAL(AGV_GEAR_R, words.step.vehicle.gear);
    TEST_ASSERT_EQUAL(150, words.step.vehicle.throttle_permille);
    TEST_ASSERT_EQUAL(-200, words.step.vehicle.angle_ddeg);
    TEST_ASSERT_EQUAL_STRING("drive gear=R throttle_pct=15 steer_deg=-20", words.what);
    TEST_ASSERT_TRUE(vehicle_words_fault("operator-lose_remote_signal@0", &config, &words));
    TEST_ASSERT_EQUAL(0, words.step.at_ms);
    TEST_ASSERT_EQUAL_STRING("lose_remote_signal", words.what);
}

void test_values_with_blanks_stand_in_quotes(void) {
    static const char *const lines[] = {"bus send id=7FFh bytes=\"01 0A\"", "bus send id=7FFh 'bytes=01 0A'",
                                        " \tbus  send\tid='7FFh' bytes='01 0A' "};
    for (size_t i = 0; i < sizeof lines / sizeof lines[0]; i++) {
        TEST_ASSERT_TRUE_MESSAGE(vehicle_words_typed(lines[i], &config, &words), lines[i]);
        TEST_ASSERT_EQUAL_HEX32(0x7FF, words.step.vehicle.frame.id);
        TEST_ASSERT_EQUAL(2, words.step.vehicle.frame.length);
        TEST_ASSERT_EQUAL_HEX8(0x0A, words.step.vehicle.frame.data[1]);
    }
    TEST_ASSERT_TRUE(vehicle_words_fault("bus-send,id=1h,bytes=01 0A@5", &config, &words));
    TEST_ASSERT_EQUAL(2, words.step.vehicle.frame.length);
}

void test_identifiers_and_topology_are_those_of_the_vehicle(void) {
    refused_when_typed("bus send message=vehicle_status bytes='' side=ai",
                       "side: only topology: gateway has an AI side");
    config.topology = AGV_TOPOLOGY_GATEWAY;
    config.id_set = AGV_ID_SET_TABLE;
    TEST_ASSERT_TRUE(vehicle_words_typed("bus send message=vehicle_status bytes='' side=ai", &config, &words));
    TEST_ASSERT_EQUAL_HEX32(0x203, words.step.vehicle.frame.id);
    TEST_ASSERT_EQUAL(HAL_CAN_AI, words.step.vehicle.side);
    config.id_gear_command = 0x169;
    TEST_ASSERT_TRUE(vehicle_words_typed("bus send message=gear_command bytes=''", &config, &words));
    TEST_ASSERT_EQUAL_HEX32(0x169, words.step.vehicle.frame.id);
}

/** What `help` prints. */
static const char *help(void) {
    (void)fflush(stdout);
    const int real_stdout = dup(STDOUT_FILENO);
    const int file = open(scratch_path("help"), O_WRONLY | O_CREAT, 0600);
    (void)dup2(file, STDOUT_FILENO);
    vehicle_words_help();
    (void)fflush(stdout);
    (void)dup2(real_stdout, STDOUT_FILENO);
    (void)close(real_stdout);
    (void)close(file);
    return scratch_read("help");
}

void test_help_lists_the_actors_that_are_taken(void) {
    static const char *const first[] = {"vcu, eps, ai ", "vcu ", "eps ",    "ai ",
                                        "operator ",     "bus ", "field= ", "message= "};
    const char *line = help();
    for (size_t i = 0; i < sizeof first / sizeof first[0]; i++) {
        TEST_ASSERT_EQUAL_STRING_LEN(first[i], line, strlen(first[i]));
        do {
            line = strchr(line, '\n') + 1;
        } while (*line == ' ');
    }
    TEST_ASSERT_EQUAL_STRING("this program  help, status, quit\n", line);
}

void test_commands_stand_alone(void) {
    TEST_ASSERT_EQUAL(VEHICLE_COMMAND_HELP, vehicle_words_command("help"));
    TEST_ASSERT_EQUAL(VEHICLE_COMMAND_STATUS, vehicle_words_command(" \tstatus "));
    TEST_ASSERT_EQUAL(VEHICLE_COMMAND_QUIT, vehicle_words_command("quit"));
    TEST_ASSERT_EQUAL(VEHICLE_COMMAND_NONE, vehicle_words_command("ai stop"));
    TEST_ASSERT_EQUAL(VEHICLE_COMMAND_NONE, vehicle_words_command("statu"));
    TEST_ASSERT_EQUAL(VEHICLE_COMMAND_NONE, vehicle_words_command("statuss"));
    TEST_ASSERT_EQUAL(VEHICLE_COMMAND_NONE, vehicle_words_command(""));
    TEST_ASSERT_EQUAL_STRING("", scratch_said());
    TEST_ASSERT_EQUAL(VEHICLE_COMMAND_BAD, vehicle_words_command("status x"));
    TEST_ASSERT_EQUAL_STRING("host_sim: 'status x': 'status' takes no argument\n", scratch_said());
}

void test_what_makes_no_sense_is_one_line(void) {
    refused_when_typed("nobody stop", "'nobody' is not one of vcu, eps, ai, operator, bus, help, status, quit");
    refused_when_typed("ai", "the action of ai is missing");
    refused_when_typed(" ", "actor and action are missing");
    refused_when_typed("ai explode", "ai: unknown action 'explode'; docs/scenarios.md lists them");
    refused_when_typed("vcu mute", "'mute' needs 'message'");
    refused_when_typed("ai stop now", "'now': NAME=VALUE is needed here");
    refused_when_typed("ai stop vcu=stop", "a step has one actor; 'vcu' is the second");
    refused_when_typed("vcu 'mute", "a quote is not closed");
    refused_when_typed("vcu mute message=", "message: a word or a text is missing");
    refused_when_typed("ai lag by_ms=1 by_ms=2", "'by_ms' is given twice in a step");
    refused_when_typed("ai a=1 b=2 c=3 d=4 e=5 f=6 g=7 h=8 i=9 j=10 k=11 l=12", "too many words");
    TEST_ASSERT_FALSE(vehicle_words_typed("ai sto\xFFp", &config, &words));
    TEST_ASSERT_EQUAL_STRING("host_sim: 'ai sto?p': not UTF-8 text\n", scratch_said());
}

void test_what_makes_no_sense_in_the_parameters_of_a_fault_is_one_line(void) {
    static const char *const rows[][2] = {
        {"vcu set field=gear value=1h every_frames=5", "every_frames: 'frames' is needed with it"},
        {"vcu set field=gear value=1h frames=5 every_frames=5", "every_frames: must be more than 'frames', which is 5"},
        {"vcu mute message=gear_status frames=3 every_frames=2",
         "every_frames: must be more than 'frames', which is 3"},
        {"bus send id=123h bytes=01 times=0", "times: at least 1 for 'send'"},
        {"vcu delay message=vehicle_status by_ms=1001", "by_ms: at most 1000 for 'delay'"},
        {"vcu delay message=eps_status by_ms=10", "message: another node sends eps_status"},
        {"vcu ignore message=steering_command", "message: steering_command is not a command that this node obeys"},
        {"eps ignore message=gear_command", "message: gear_command is not a command that this node obeys"},
        {"vcu ignore message=gear_status", "message: gear_status is not a command that this node obeys"},
        {"ai ignore message=gear_command", "ai: unknown action 'ignore'; docs/scenarios.md lists them"},
        {"vcu roll speed_mm_s=20001", "speed_mm_s: 20001 is not within -20000 to 20000"},
        {"vcu ramp_throttle pct_s=0", "pct_s: 0 is not within 1 to 10000"},
        {"vcu set field=speed value=10000h", "value: 10000h is above FFFFh"},
        {"vcu freeze_field field=angle", "field: this node has no field 'angle'; docs/scenarios.md lists them"},
        {"vcu freeze_field field=speed value=1h", "'freeze_field' takes no 'value'"},
        {"eps hunt steer_deg=901 every_ms=500", "steer_deg: 901 is not within -900 to 900"},
        {"eps hunt steer_deg=60", "'hunt' needs 'every_ms'"},
        {"ai weave steer_deg=60 every_ms=0", "every_ms: 0 is not within 1 to 60000"},
        {"bus send message=gear_command kind=fd bytes=08", "kind: fd is for the simulated bus only"},
        {"bus send message=gear_command kind=error bytes=08", "kind: error is only for deliver"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        refused_when_typed(rows[i][0], rows[i][1]);
    }
}

void test_the_parameters_of_a_fault_reach_the_vehicle(void) {
    const vehicle_action_t *action = &words.step.vehicle;

    TEST_ASSERT_TRUE(
        vehicle_words_fault("vcu-set,field=mode_bits,value=2h,frames=1,every_frames=40@7", &config, &words));
    TEST_ASSERT_EQUAL(1, action->count);
    TEST_ASSERT_EQUAL(40, action->every);
    TEST_ASSERT_TRUE(vehicle_words_fault("vcu-set,field=left_speed,value=FFFFFF9Ch@7", &config, &words));
    TEST_ASSERT_EQUAL_HEX8(0x9C, action->value[0]);
    TEST_ASSERT_EQUAL_HEX8(0xFF, action->value[3]);
    TEST_ASSERT_EQUAL_HEX8(0x00, action->keep[3]);
    TEST_ASSERT_EQUAL_HEX8(0xFF, action->keep[4]);
    TEST_ASSERT_TRUE(vehicle_words_fault("vcu-roll,speed_mm_s=-300@7", &config, &words));
    TEST_ASSERT_EQUAL(VEHICLE_DO_VCU_ROLL, action->what);
    TEST_ASSERT_EQUAL(-300, action->speed_mm_s);
    TEST_ASSERT_TRUE(vehicle_words_fault("vcu-roll@7", &config, &words));
    TEST_ASSERT_EQUAL(VEHICLE_DO_VCU_ROLL_ON, action->what);
    TEST_ASSERT_TRUE(vehicle_words_fault("vcu-hold@7", &config, &words));
    TEST_ASSERT_EQUAL(VEHICLE_DO_VCU_ROLL, action->what);
    TEST_ASSERT_FALSE(action->on);
    TEST_ASSERT_TRUE(vehicle_words_fault("eps-ignore,message=steering_command@7", &config, &words));
    TEST_ASSERT_EQUAL(AGV_MSG_STEERING_COMMAND, action->message);
    TEST_ASSERT_TRUE(action->on);
}

void test_what_needs_a_simulated_bus_is_refused(void) {
    refused_when_typed("supervisor bus_off",
                       "'supervisor' is not one of vcu, eps, ai, operator, bus, help, status, quit");
    refused_when_typed("bus destroy frames=1", "bus: 'destroy' is for the simulated bus only");
}

void test_a_line_may_be_long_but_not_too_long(void) {
    char line[VEHICLE_WORDS_MAX + 1];
    memset(line, ' ', sizeof line);
    memcpy(line, "ai stop", strlen("ai stop"));
    line[VEHICLE_WORDS_MAX] = '\0';
    TEST_ASSERT_FALSE(vehicle_words_typed(line, &config, &words));
    TEST_ASSERT_NOT_NULL(strstr(scratch_said(), ": longer than 255 characters\n"));
    line[VEHICLE_WORDS_MAX - 1] = '\0';
    TEST_ASSERT_TRUE(vehicle_words_typed(line, &config, &words));
}
