/* The first words of a report. */
#include "report/sentence.h"

#include <string.h>

#include "agv/recorder.h"
#include "unity.h"

enum { MS = 1000 };

static agv_config_t config;
static report_page_t page;
static why_trip_t trip;
static sentence_t sentence;

void setUp(void) {
    agv_config_defaults(&config);
    page = (report_page_t){.name = "my.log", .config = &config};
    trip = (why_trip_t){.t_us = 62109000,
                        .reason = AGV_FAULT_STEERING_COMMAND_TIMEOUT,
                        .kind = WHY_SILENCE,
                        .message = AGV_MSG_STEERING_COMMAND,
                        .id = 0x065,
                        .cause_us = 62009000,
                        .last_good_us = 61984000,
                        .next_us = 63002000,
                        .limit = 125,
                        .unit = "ms",
                        .first_safe_us = 62109300,
                        .confirmed_us = 62420000,
                        .stopped_us = 62900000};
}

static void say(void) {
    sentence_trip(&sentence, &page, &trip, WHY_NEVER);
}

/* A part of the sentence, once it was said. */
static void is(const char *part, const char *expected) {
    say();
    TEST_ASSERT_EQUAL_STRING(expected, part);
}

static void has(const char *text, const char *part) {
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(text, part), text);
}

void test_silence(void) {
    is(sentence.headline, "The vehicle stands because the AI computer no longer sent steering commands.");
    is(sentence.cause, "steering_command (065h) came for the last time at 61.984 s. Its deadline is 125 ms. The "
                       "next one came at 63.002 s.");
    is(sentence.action, "The supervisor tripped at 62.109 s (STEERING_COMMAND_TIMEOUT). 0.3 ms later it began "
                        "to send the safe commands: gear P, throttle 0, autopilot off. The safety output stayed "
                        "closed.");
    is(sentence.outcome,
       "The VCU reported gear P and autopilot off 311 ms after the trip. The wheels stood 791 ms "
       "after the trip. Only the operator can end the safe state, by a reset at standstill in manual.");
}

void test_a_message_that_never_came(void) {
    trip.last_good_us = WHY_NEVER;
    trip.next_us = WHY_NEVER;
    is(sentence.cause, "steering_command (065h) never came. The deadline for the first one is 125 ms.");
    is(sentence.headline, "The vehicle stands because the AI computer never sent steering commands.");
    trip.reason = AGV_FAULT_EPS_HEARTBEAT_LOST;
    is(sentence.headline, "The vehicle stands because the EPS (power steering) never sent its heartbeat.");
}

void test_every_silence_of_a_message_that_never_came_has_words(void) {
    trip.last_good_us = WHY_NEVER;
    for (uint32_t fault = 0; fault < AGV_FAULT_COUNT; fault++) {
        if (why_row((agv_fault_t)fault)->kind == WHY_SILENCE) {
            trip.reason = (agv_fault_t)fault;
            say();
            has(sentence.headline, " never ");
        }
    }
}

static void refuse(hal_can_frame_t frame) {
    trip.was_heard = true;
    trip.next_us = WHY_NEVER;
    trip.refused = (why_refused_t){.count = 5, .first = {.t_us = 62009000, .frame = frame}};
}

void test_a_message_in_another_form(void) {
    refuse((hal_can_frame_t){.id = 0x065, .length = 7});
    is(sentence.headline,
       "The vehicle stands because steering_command (065h) came in a form that the protocol does not have.");
    is(sentence.cause, "steering_command (065h) came for the last time at 61.984 s. Its deadline is 125 ms. 5 "
                       "frames came with a length of 7, the first at 62.009 s.");
}

void test_a_command_that_was_withheld(void) {
    refuse((hal_can_frame_t){.id = 0x065, .length = 8});
    is(sentence.headline, "The vehicle stands because the gateway withheld steering_command (065h), because the VCU "
                          "did not report autopilot.");
    has(sentence.cause, "steering_command (065h) was passed on for the last time at 61.984 s.");
}

void test_a_counter_with_wrong_steps(void) {
    trip.kind = WHY_STUCK;
    trip.reason = AGV_FAULT_AI_HEARTBEAT_STUCK;
    trip.wrong_steps = true;
    is(sentence.headline, "The vehicle stands because the alive counter of steering_command (065h) did not always "
                          "step by 1 to 3.");
    has(sentence.cause, "The alive counter of steering_command (065h) stepped by 1 to 3 for the last time at "
                        "61.984 s.");
}

void test_a_vehicle_that_parks_at_standstill(void) {
    config.park = AGV_PARK_AT_STANDSTILL;
    config.park_timeout_ms = 6000;
    say();
    has(sentence.action, "it began to send the safe commands: throttle 0, autopilot off, and gear P when "
                         "the wheels stand, or 6000 ms after the trip.");
}

void test_a_message_that_came_at_a_time_that_is_not_known(void) {
    trip.cause_us = 61984000;
    trip.last_good_us = WHY_NEVER;
    trip.next_us = WHY_NEVER;
    trip.was_heard = true;
    trip.from_engagement = true;
    is(sentence.cause, "steering_command (065h) did not come from the engagement at 61.984 s on. Its deadline is "
                       "125 ms.");
    trip.kind = WHY_STUCK;
    is(sentence.cause, "The alive counter of steering_command (065h) did not change from the engagement at 61.984 s "
                       "on. Its deadline is 125 ms.");
    trip.cause_us = WHY_NEVER;
    is(sentence.cause, "The alive counter of steering_command (065h) did not change. Its deadline is 125 ms.");
}

void test_since_when_a_score_counts(void) {
    trip.kind = WHY_SCORE;
    trip.limit = WHY_NO_LIMIT;
    trip.at_the_latest = true;
    is(sentence.cause, "The cause began at 62.009 s at the latest, as steering_command (065h) shows.");
    trip.at_the_latest = false;
    trip.from_engagement = true;
    is(sentence.cause, "The cause counted from the engagement at 62.009 s on, as steering_command (065h) shows.");
}

void test_a_counter_that_stands_still(void) {
    trip.kind = WHY_STUCK;
    trip.reason = AGV_FAULT_VCU_HEARTBEAT_STUCK;
    trip.message = AGV_MSG_VEHICLE_STATUS;
    trip.id = 0x363;
    trip.limit = 50;
    trip.next_us = WHY_NEVER;
    is(sentence.headline, "The vehicle stands because the VCU hung: its alive counter stood still.");
    is(sentence.cause, "The alive counter of vehicle_status (363h) changed for the last time at 61.984 s. Its "
                       "deadline is 50 ms.");
}

void test_a_budget_names_the_limit_and_the_time(void) {
    trip.kind = WHY_BUDGET;
    trip.reason = AGV_FAULT_STEERING_DEVIATION;
    trip.message = AGV_MSG_STEERING_STATUS;
    trip.id = 0x067;
    trip.limit = 500;
    trip.unit = "ddeg";
    config.steering_deviation_ms = 700;
    is(sentence.cause,
       "The cause began at 62.009 s, as steering_status (067h) shows. The limit of this fault is 50.0° for 700 ms in "
       "all.");
}

void test_a_bit_that_trips_at_once_trips_with_its_frame(void) {
    trip.kind = WHY_BIT;
    trip.reason = AGV_FAULT_EPS_MOTOR_ENCODER;
    trip.message = AGV_MSG_EPS_STATUS;
    trip.id = 0x167;
    trip.cause_us = trip.t_us + 200; /* the event says the millisecond, the frame the microsecond */
    trip.limit = WHY_NO_LIMIT;
    trip.unit = NULL;
    say();
    TEST_ASSERT_EQUAL_UINT64(62109200, sentence_trip_us(&trip));
    is(sentence.cause, "The cause began at 62.109 s, as eps_status (167h) shows.");
    has(sentence.action, " 0.1 ms later it began to send");
    trip.first_safe_us = trip.cause_us;
    say();
    has(sentence.action, " At once it began to send");
}

void test_a_recording_cannot_obey(void) {
    page.is_recording = true;
    trip.confirmed_us = WHY_NEVER;
    trip.stopped_us = WHY_NEVER;
    is(sentence.headline,
       "The supervisor would have stopped this vehicle because the AI computer no longer sent steering commands.");
    is(sentence.outcome,
       "This is a recording: the vehicle did not receive the supervisor's commands, and what it did after the trip is "
       "no "
       "reaction to them. Only the operator can end the safe state, by a reset at standstill in manual.");
}

void test_a_trip_that_an_earlier_run_latched(void) {
    trip.from_earlier_run = true;
    is(sentence.cause, "This trip was latched in an earlier run.");
}

void test_what_no_reset_ends(void) {
    trip.reason = AGV_FAULT_OUTPUT_FEEDBACK;
    say();
    has(sentence.outcome, " Only a power-on can end the safe state.");
    TEST_ASSERT_NULL(strstr(sentence.outcome, "operator"));
}

void test_shadow_sends_nothing(void) {
    config.shadow = AGV_SHADOW_ON;
    trip.first_safe_us = WHY_NEVER;
    say();
    has(sentence.headline, "The supervisor would have stopped");
    has(sentence.action, "It sent nothing, because it runs in shadow mode.");
}

void test_a_vehicle_that_stood_before_the_trip(void) {
    trip.stopped_us = trip.t_us;
    is(sentence.headline,
       "The supervisor keeps the vehicle at standstill because the AI computer no longer sent steering commands.");
    has(sentence.outcome, "The vehicle stood already.");
}

void test_a_vehicle_that_does_not_stop_is_not_said_to_stand(void) {
    trip.stopped_us = WHY_NEVER;
    say();
    has(sentence.headline, "The supervisor stopped the vehicle because");
    TEST_ASSERT_NOT_NULL(
        strstr(sentence.outcome, "No standstill of the wheels was reported until the end of the run."));
}

void test_the_safety_output(void) {
    sentence_trip(&sentence, &page, &trip, trip.t_us);
    has(sentence.action, "The safety output was opened at once.");
    sentence_trip(&sentence, &page, &trip, 0);
    has(sentence.action, "The safety output was open already.");
    sentence_trip(&sentence, &page, &trip, trip.t_us + (500 * MS));
    has(sentence.action, "The safety output was opened 500 ms after the trip.");
}

void test_every_fault_has_words_of_its_own(void) {
    for (uint32_t fault = 0; fault < AGV_FAULT_COUNT; fault++) {
        const char *phrase = sentence_phrase((agv_fault_t)fault);
        TEST_ASSERT_NOT_NULL(phrase);
        TEST_ASSERT_GREATER_THAN(10, strlen(phrase));
        TEST_ASSERT_NOT_EQUAL('.', phrase[strlen(phrase) - 1]);
        for (uint32_t other = 0; other < fault; other++) {
            TEST_ASSERT_TRUE(strcmp(phrase, sentence_phrase((agv_fault_t)other)) != 0);
        }
    }
    TEST_ASSERT_EQUAL_STRING("", sentence_phrase(AGV_FAULT_NONE));
}

void test_every_missing_condition_has_words(void) {
    for (unsigned bit = 0; (AGV_MISSING_ALL & (1u << bit)) != 0; bit++) {
        TEST_ASSERT_GREATER_THAN(5, strlen(sentence_missing(bit)));
    }
    TEST_ASSERT_EQUAL_STRING("", sentence_missing(31));
}

/** A run in one state after the other. */
static why_t *run(agv_state_t second, uint64_t from_ms) {
    why_t *why = why_new(&config);
    session_event_t event = {
        .t_ms = 0, .recorded = {.kind = AGV_EVENT_STATE, .b = (uint8_t)AGV_STATE_INIT, .c = (uint8_t)AGV_FAULT_NONE}};
    why_event(why, &event);
    if (second != AGV_STATE_INIT) {
        event = (session_event_t){.t_ms = from_ms,
                                  .recorded = {.kind = AGV_EVENT_STATE,
                                               .a = (uint8_t)AGV_STATE_INIT,
                                               .b = (uint8_t)second,
                                               .c = (uint8_t)AGV_FAULT_NONE}};
        why_event(why, &event);
    }
    why_end(why, 86000 * MS);
    return why;
}

void test_what_was_not_supervised_is_no_pass(void) {
    why_t *why = run(AGV_STATE_INIT, 0);
    sentence_no_trip(&sentence, why, 86000 * MS);
    why_free(why);
    TEST_ASSERT_EQUAL_STRING("Nothing was supervised: the supervisor never left INIT.", sentence.headline);
    TEST_ASSERT_EQUAL_STRING(
        "The run took 86.000 s. The supervisor stayed in INIT because the VCU is not alive (363h never received); the "
        "EPS is not alive "
        "(067h never received); the vehicle does not stand (101h never received); the VCU does not report manual (363h "
        "never "
        "received); a status message is missing or late (0A3h, 050h, 167h, 267h, 101h never received).",
        sentence.cause); /* nothing was heard */
    TEST_ASSERT_EQUAL_STRING("This says nothing about the vehicle, and does not count as passed.", sentence.outcome);
}

void test_no_trip_and_never_engaged(void) {
    why_t *why = run(AGV_STATE_STANDBY, 500);
    sentence_no_trip(&sentence, why, 86000 * MS);
    why_free(why);
    TEST_ASSERT_EQUAL_STRING("No trip: the supervisor found no reason to stop the vehicle.", sentence.headline);
    TEST_ASSERT_EQUAL_STRING("It supervised 85.500 s of 86.000 s. For the other 0.500 s it was in INIT.",
                             sentence.cause);
    TEST_ASSERT_EQUAL_STRING("The autopilot was never engaged: the commands of the AI computer were not judged.",
                             sentence.outcome);
}

void test_a_fault_that_did_not_trip_in_init_is_no_warning(void) {
    why_t *why = why_new(&config);
    session_event_t event = {
        .t_ms = 0, .recorded = {.kind = AGV_EVENT_STATE, .b = (uint8_t)AGV_STATE_INIT, .c = (uint8_t)AGV_FAULT_NONE}};
    why_event(why, &event);
    event.recorded =
        (agv_event_t){.kind = AGV_EVENT_FAULT, .a = AGV_FAULT_EPS_TEMP_ABOVE_120, .b = AGV_CLASS_TRIP, .c = 1};
    why_event(why, &event);
    event.t_ms = 1000;
    event.recorded = (agv_event_t){
        .kind = AGV_EVENT_STATE, .a = (uint8_t)AGV_STATE_INIT, .b = (uint8_t)AGV_STATE_STANDBY, .c = AGV_FAULT_NONE};
    why_event(why, &event);
    why_end(why, 2000 * MS);
    sentence_no_trip(&sentence, why, 2000 * MS);
    TEST_ASSERT_TRUE(why_did_not_trip(why_fault(why, 0)));
    why_free(why);
    TEST_ASSERT_EQUAL_STRING("1 fault occurred in INIT, where nothing trips.", sentence.action);
}
