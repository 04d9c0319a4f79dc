/* "did you mean". */
#include "text/suggest.h"

#include "unity.h"

#define COMMANDS "campaign|config|demo|monitor|recorder|replay|run|scenario|survey|vehicle"

static void check(const char *words, const char *written, const char *expected) {
    char text[SUGGEST_SIZE];
    TEST_ASSERT_EQUAL_STRING_MESSAGE(expected, suggest_from(words, written, text), written);
}

void test_one_letter_swapped_missing_added_or_wrong(void) {
    check(COMMANDS, "replya", ": did you mean 'replay'?");
    check(COMMANDS, "reply", ": did you mean 'replay'?");
    check(COMMANDS, "repplay", ": did you mean 'replay'?");
    check(COMMANDS, "reploy", ": did you mean 'replay'?");
    check(COMMANDS, "rn", ": did you mean 'run'?");
    check(COMMANDS, "scenarios", ": did you mean 'scenario'?");
}

void test_case_and_the_kind_of_dash_are_no_difference(void) {
    check("at_once|at_standstill", "AT-ONCE", ": did you mean 'at_once'?");
    check("--skip-bad-lines|--store", "-skip_bad_lines", ": did you mean '--skip-bad-lines'?");
}

void test_the_beginning_of_a_word(void) {
    check(COMMANDS, "camp", ": did you mean 'campaign'?");
    check("init_hold_ms|reset_hold_ms", "init", ": did you mean 'init_hold_ms'?");
    check(COMMANDS, "ca", "");
}

void test_the_nearest_one(void) {
    check("gateway|shared", "gatewai", ": did you mean 'gateway'?");
    check("abcd|abcx|abcy", "abcx1", ": did you mean 'abcx'?");
}

void test_what_is_not_near(void) {
    check(COMMANDS, "drive", "");
    check(COMMANDS, "", "");
    check(COMMANDS, "x", "");
    check("P|R|N|D", "1", "");
    check(COMMANDS, "replayreplayreplayreplayreplayreplayreplayreplayreplayreplay", "");
}

void test_only_a_part_of_what_was_written(void) {
    char text[SUGGEST_SIZE];
    suggestion_t suggestion = suggest_begin("--tial=17", 6);
    suggest_offer(&suggestion, "--tail", 6);
    TEST_ASSERT_EQUAL_STRING(": did you mean '--tail'?", suggest_text(&suggestion, text));
}
