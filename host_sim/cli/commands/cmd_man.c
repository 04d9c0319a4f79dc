/**
 * @file cmd_man.c
 * `host_sim man`: a man page.
 */
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "cli/commands/commands.h"
#include "cli/exit_status.h"
#include "cli/options.h"
#include "common/shipped.h"
#include "text/words.h"

/** Print a text so that troff leaves it as it is: no hyphens for dashes, no requests at the beginning of a line. */
static void print_text(const char *text) {
    bool at_start = true;
    for (const char *at = text; *at != '\0'; at++) {
        if (at_start && ((*at == '.') || (*at == '\''))) {
            (void)printf("\\&");
        }
        if (*at == '\\') {
            (void)printf("\\e");
        } else if (*at == '-') {
            (void)printf("\\-");
        } else if (*at == '\'') {
            (void)printf("\\(aq");
        } else {
            (void)putchar(*at);
        }
        at_start = *at == '\n';
    }
}

/** Lines that are filled; an empty line begins a paragraph. */
static void print_paragraphs(const char *text) {
    for (const char *at = text; *at != '\0';) {
        const size_t length = strcspn(at, "\n");
        if (length == 0) {
            (void)printf(".PP\n");
        } else {
            char line[256];
            (void)snprintf(line, sizeof line, "%.*s", (int)length, at);
            print_text(line);
            (void)printf("\n");
        }
        at += length + ((at[length] == '\n') ? 1 : 0);
    }
}

static void print_head(const char *command, const char *help) {
    (void)printf(".TH HOST_SIM");
    if (command != NULL) {
        (void)printf("\\-");
        words_print_upper(command);
    }
    (void)printf(" 1 \"\" \"agv\\-supervisor " HOST_SIM_VERSION "\" \"User Commands\"\n.SH NAME\nhost_sim%s%s \\- ",
                 (command != NULL) ? "\\-" : "", (command != NULL) ? command : "");
    print_text(help);
    (void)printf("\n.SH SYNOPSIS\n");
}

static void print_option(const option_t *option) {
    (void)printf(".TP\n\\fB");
    print_text(option->name);
    (void)printf("\\fR");
    if (option->value != NULL) {
        (void)printf(" \\fI");
        print_text(option->value);
        (void)printf("\\fR");
    }
    (void)printf("\n");
    print_text(option->help);
    (void)printf("%s\n", option->adds_up ? "; may be given several times" : "");
}

static void print_options(const option_syntax_t *syntax) {
    for (size_t g = 0; g < syntax->group_count; g++) {
        const option_group_t *group = &syntax->groups[g];
        if ((group->title != NULL) && (strcmp(group->title, "Options") != 0)) {
            (void)printf(".SS ");
            print_text(group->title);
            (void)printf("\n");
        }
        for (size_t i = 0; i < group->count; i++) {
            print_option(&group->options[i]);
        }
    }
}

static void print_examples(const option_syntax_t *syntax) {
    if (syntax->example_count == 0) {
        return;
    }
    (void)printf(".SH EXAMPLES\n");
    for (size_t i = 0; i < syntax->example_count; i++) {
        char line[512];
        options_example_line(&syntax->examples[i], SHIPPED_PACKAGE, line, sizeof line);
        (void)printf(".TP\n\\fB");
        print_text(line);
        (void)printf("\\fR\n");
        print_text(syntax->examples[i].does);
        (void)printf("\n");
    }
}

static void print_exit_statuses(void) {
    (void)printf(".SH EXIT STATUS\n");
    for (size_t i = 0; i < EXIT_STATUS_COUNT; i++) {
        (void)printf(".TP\n\\fB%d\\fR\n", (int)EXIT_STATUSES[i].status);
        print_text(EXIT_STATUSES[i].means);
        (void)printf("\n");
    }
}

static void print_usage(const char *name, const char *usage) {
    (void)printf("\\fBhost_sim ");
    print_text(name);
    (void)printf("\\fR");
    print_text(&usage[strlen(name)]);
    (void)printf("\n");
}

static void print_command(const void *ctx, const option_syntax_t *syntax) {
    const command_t *command = ctx;
    print_head(command->name, command->help);
    print_usage(command->name, syntax->usage);
    if (syntax->or_usage != NULL) {
        (void)printf(".br\n");
        print_usage(command->name, syntax->or_usage);
    }
    (void)printf(".SH DESCRIPTION\n");
    print_paragraphs(syntax->summary);
    (void)printf(".SH OPTIONS\n.TP\n\\fB\\-h\\fR, \\fB\\-\\-help\\fR\nprint the help\n");
    print_options(syntax);
    print_examples(syntax);
    print_exit_statuses();
    (void)printf(".SH SEE ALSO\n.BR host_sim (1)\n");
}

static void print_program(void) {
    print_head(NULL, "the safety supervisor of an AGV's CAN bus, on a computer");
    (void)printf("\\fBhost_sim\\fR \\fICOMMAND\\fR [\\fIOPTION\\fR]...\n"
                 ".SH DESCRIPTION\n"
                 "host_sim runs the supervisor of the firmware on a computer: with a simulated vehicle, with a "
                 "recorded log, or\n"
                 "as a node on SocketCAN.\n"
                 ".SH COMMANDS\n");
    for (size_t i = 0; i < COMMAND_COUNT; i++) {
        (void)printf(".TP\n.BR host_sim\\-%s (1)\n", COMMANDS[i].name);
        print_text(COMMANDS[i].help);
        (void)printf("\n");
    }
    (void)printf(".SH OPTIONS\n"
                 ".TP\n\\fB\\-h\\fR, \\fB\\-\\-help\\fR\nprint the help; after a command, that of the command\n"
                 ".TP\n\\fB\\-V\\fR, \\fB\\-\\-version\\fR\nprint the version\n");
    print_exit_statuses();
    (void)printf(
        ".SH FILES\n.TP\n" SHIPPED_PACKAGE "\n"
        "scenarios, examples of logs, and the message descriptions (with another prefix of the installation: there)\n"
        ".TP\n/usr/share/doc/agv\\-supervisor\nthe documentation\n");
}

/** @param command NULL: the page of the program */
static void print_page(const command_t *command) {
    if (command == NULL) {
        print_program();
    } else {
        (void)command_show(command, print_command);
    }
}

status_t cmd_man(int argc, char **argv) {
    static const option_example_t examples[] = {
        {"host_sim man > host_sim.1", "for share/man/man1"},
        {"host_sim man replay | man -l -", "read the page of replay"},
    };
    const option_syntax_t syntax = {
        .usage = "man [COMMAND]",
        .summary = "Print the man page of a command, or of the program. An installed host_sim has them in place.\n",
        .operands_max = 1,
        .operand = "COMMAND",
        .words = command_words(),
        .examples = examples,
        .example_count = sizeof examples / sizeof examples[0],
    };
    size_t operands = 0;
    const options_result_t parsed = options_parse(&syntax, argc, argv, &operands);
    if (parsed != OPTIONS_GO) {
        return (parsed == OPTIONS_DONE) ? STATUS_OK : STATUS_UNUSABLE;
    }
    const command_t *command = NULL;
    if (operands > 0) {
        command = command_find(argv[0]);
        if (command == NULL) {
            return STATUS_UNUSABLE;
        }
    }
    print_page(command);
    return STATUS_OK;
}
