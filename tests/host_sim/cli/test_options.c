/* The tables of options: values, numbers, operands, and what is refused. */
#include "cli/options.h"

#include <stdio.h>
#include <string.h>

#include "scratch.h"
#include "unity.h"

typedef struct {
    bool flag;
    const char *text;
    uint64_t number;
    uint64_t time;
    uint64_t hours;
    int word;
    unsigned times;
    size_t operands;
} given_t;

static given_t given;
static char *arguments[16];

void setUp(void) {
    scratch_open();
    memset(&given, 0, sizeof given);
    given.word = -1;
}

static bool count(void *ctx, const char *value) {
    (void)ctx;
    given.times++;
    return strcmp(value, "bad") != 0;
}

/* Parse a command line, words separated by blanks; `_` is an empty word. */
static options_result_t parse(const char *line) {
    static char text[256];
    const option_t rows[] = {
        {.name = "--flag", .help = "a flag", .flag = &given.flag},
        {.name = "--text", .value = "TEXT", .help = "a text", .text = &given.text},
        {.name = "--number", .value = "N", .help = "a number", .number = &given.number, .lowest = 5, .highest = 1000},
        {.name = "--word", .value = "a|b|cc", .help = "a word", .word = &given.word, .words = "a|b|cc"},
    };
    const option_t more[] = {
        {.name = "--each", .value = "WHAT", .help = "more", .each = count, .ctx = &given, .adds_up = true},
        {.name = "--once", .value = "WHAT", .help = "one", .each = count, .ctx = &given},
        OPTION_DURATION("--time", "a time", &given.time, 1, 5000),
        OPTION_DURATION_IN(DURATION_H, "--hours", "a long time", &given.hours, 1, 100),
    };
    const option_group_t groups[] = {{"Options", rows, 4}, {"More", more, 4}};
    const option_syntax_t syntax = {.usage = "try [OPTION]... FILE...",
                                    .summary = "Try.\n",
                                    .groups = groups,
                                    .group_count = 2,
                                    .operands_min = 1,
                                    .operands_max = 2,
                                    .operand = "FILE"};
    int argc = 0;
    (void)snprintf(text, sizeof text, "%s", line);
    for (char *word = strtok(text, " "); word != NULL; word = strtok(NULL, " ")) {
        word[strcmp(word, "_") == 0 ? 0 : strlen(word)] = '\0';
        arguments[argc++] = word;
    }
    return options_parse(&syntax, argc, arguments, &given.operands);
}

static void parse_good(const char *line) {
    TEST_ASSERT_EQUAL_INT_MESSAGE(OPTIONS_GO, parse(line), scratch_said());
}

static void parse_bad(const char *line, const char *expected) {
    char message[256];
    TEST_ASSERT_EQUAL_INT_MESSAGE(OPTIONS_BAD, parse(line), line);
    (void)snprintf(message, sizeof message, "host_sim: %s\n", expected);
    TEST_ASSERT_EQUAL_STRING(message, scratch_said());
}

void test_values_come_in_two_ways(void) {
    parse_good("--text a --number=17 --word cc --flag f");
    TEST_ASSERT_EQUAL_STRING("a", given.text);
    TEST_ASSERT_EQUAL_UINT64(17, given.number);
    TEST_ASSERT_EQUAL_INT(2, given.word);
    TEST_ASSERT_TRUE(given.flag);
    parse_good("--text=b=c f");
    TEST_ASSERT_EQUAL_STRING("b=c", given.text);
    parse_good("--text=--flag f");
    TEST_ASSERT_EQUAL_STRING("--flag", given.text);
    parse_good("--text - f");
    TEST_ASSERT_EQUAL_STRING("-", given.text);
}

void test_an_option_given_twice_is_refused(void) {
    parse_bad("--text a --number 5 --text a f", "--text is given twice");
    parse_bad("--number 5 f --number=6", "--number is given twice");
    parse_bad("--flag --flag f", "--flag is given twice");
    parse_bad("--once a --once b f", "--once is given twice");
}

void test_some_add_up(void) {
    parse_good("--each a --each=b f --each c");
    TEST_ASSERT_EQUAL_UINT(3, given.times);
    TEST_ASSERT_EQUAL_INT(OPTIONS_BAD, parse("--each bad f"));
}

void test_a_time_has_a_unit_or_is_in_that_of_the_option(void) {
    parse_good("--time 1.5s f");
    TEST_ASSERT_EQUAL_UINT64(1500, given.time);
    parse_good("--time 70 f");
    TEST_ASSERT_EQUAL_UINT64(70, given.time);
    parse_good("--hours 2d f");
    TEST_ASSERT_EQUAL_UINT64(48, given.hours);
    parse_good("--hours 7 f");
    TEST_ASSERT_EQUAL_UINT64(7, given.hours);
    parse_bad("--time 10parsecs f",
              "--time: '10parsecs' is not a time: 250ms, 10s, 1.5min, 2h, or whole milliseconds alone");
    parse_bad("--time 1e9999s f",
              "--time: '1e9999s' is not a time: 250ms, 10s, 1.5min, 2h, or whole milliseconds alone");
    parse_bad("--time -1s f", "--time: '-1s' is not a time: 250ms, 10s, 1.5min, 2h, or whole milliseconds alone");
    parse_bad("--time 6s f", "--time: '6s' is not within 1ms to 5s");
    parse_bad("--time 1us f", "--time: '1us' is not a whole number of milliseconds");
    parse_bad("--hours 30min f", "--hours: '30min' is not a whole number of hours");
    parse_bad("--hours 101h f", "--hours: '101h' is not within 1h to 100h");
}

static bool show_called;

static void show(const void *ctx, const option_syntax_t *syntax) {
    show_called = true;
    TEST_ASSERT_EQUAL_PTR(&given, ctx);
    TEST_ASSERT_EQUAL_STRING("--flag", options_at(syntax, 0)->name);
    TEST_ASSERT_EQUAL_STRING("--each", options_at(syntax, 4)->name);
    TEST_ASSERT_NULL(options_at(syntax, 8));
}

void test_what_a_command_takes_can_be_shown_in_another_way(void) {
    options_show_with(show, &given);
    TEST_ASSERT_EQUAL_INT(OPTIONS_DONE, parse("--help"));
    options_show_with(NULL, NULL);
    TEST_ASSERT_TRUE(show_called);
}

void test_the_line_of_an_example(void) {
    static const option_example_t example = {"host_sim replay --why=a@b @/examples/a.log", ""};
    char line[64];
    options_example_line(&example, "/usr/share", line, sizeof line);
    TEST_ASSERT_EQUAL_STRING("host_sim replay --why=a@b /usr/share/examples/a.log", line);
    options_example_line(&example, "/usr/share", line, 20);
    TEST_ASSERT_EQUAL_STRING("host_sim replay --w", line);
}

void test_operands_move_to_the_front(void) {
    parse_good("--flag x --text t y");
    TEST_ASSERT_EQUAL_UINT(2, given.operands);
    TEST_ASSERT_EQUAL_STRING("x", arguments[0]);
    TEST_ASSERT_EQUAL_STRING("y", arguments[1]);
    parse_good("-- --flag -x");
    TEST_ASSERT_EQUAL_STRING("--flag", arguments[0]);
    TEST_ASSERT_EQUAL_STRING("-x", arguments[1]);
    parse_good("-");
    TEST_ASSERT_EQUAL_STRING("-", arguments[0]);
}

void test_numbers_are_checked_completely(void) {
    static const char *const bad[] = {"4", "1001", "-5", "+5", "5x", "x", "0x10", "5.0", "18446744073709551616", "1e2"};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        char line[64];
        char message[128];
        (void)snprintf(line, sizeof line, "--number %s f", bad[i]);
        (void)snprintf(message, sizeof message, "--number: '%s' is not a number from 5 to 1000", bad[i]);
        parse_bad(line, message);
    }
    parse_bad("--number _ f", "--number: '' is not a number from 5 to 1000");
}

void test_what_is_refused(void) {
    parse_bad("--flags f", "unknown option '--flags': did you mean '--flag'?");
    parse_bad("-x f", "unknown option '-x'; see host_sim try --help");
    parse_bad("--fla f", "unknown option '--fla': did you mean '--flag'?");
    parse_bad("--txet=x=y f", "unknown option '--txet=x=y': did you mean '--text'?");
    parse_bad("--text=x=y --fast=x f", "unknown option '--fast=x'; see host_sim try --help");
    parse_bad("--flag=1 f", "--flag takes no value");
    parse_bad("f --text", "--text needs a value: TEXT");
    parse_bad("--text --flag f", "--text needs a value: TEXT");
    parse_bad("--text= f", "--text: the value is empty");
    parse_bad("--text _ f", "--text: the value is empty");
    parse_bad("--word CC f", "--word: 'CC' is not one of a|b|cc: did you mean 'cc'?");
    parse_bad("--word c f", "--word: 'c' is not one of a|b|cc");
    parse_bad("--word a|b f", "--word: 'a|b' is not one of a|b|cc");
    parse_bad("--word _ f", "--word: '' is not one of a|b|cc");
    parse_bad("--flag", "FILE is missing; see host_sim try --help");
    parse_bad("x y z", "FILE: more than 2 were given");
}

void test_a_message_is_one_line_whatever_it_quotes(void) {
    parse_bad("--bad\nname\x7F\x1B[2J", "unknown option '--bad?name??[2J'; see host_sim try --help");
}
