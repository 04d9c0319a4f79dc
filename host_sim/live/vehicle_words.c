#include "live/vehicle_words.h"

#include <stdio.h>
#include <string.h>

#include "agv/names.h"
#include "common/report.h"
#include "scenario/parse/scenario_parse.h"
#include "scenario/scenario_actions.h"

#define ACTORS "vcu, eps, ai, operator, bus"
#define FAULT_FORM "WHO-WHAT[,NAME=VALUE]...@TIME"

#define COMMANDS "help, status, quit"

enum { PARTS_MAX = 12, SHOWN_MAX = 80, SOURCE_SIZE = 100, HELP_WIDTH = 100, HELP_INDENT = 14, PARTS_BEFORE_VALUES = 2 };

/** A line in its parts. */
typedef struct {
    char text[VEHICLE_WORDS_MAX];
    const char *parts[PARTS_MAX]; /**< actor, word, NAME=VALUE... */
    unsigned count;
    const char *at_ms;
    bool is_typed;
    char source[SOURCE_SIZE]; /**< how messages call it */
} line_t;

static bool report_wrong_line(const line_t *line, const char *what) {
    return report("%s: %s", line->source, what);
}

/** Take one part off, without its quotes. @return what follows it; NULL: a quote is not closed */
static char *take_part(char *from, const char *separators) {
    char *to = from;
    char quote = '\0';

    for (; *from != '\0'; from++) {
        if ((quote == '\0') && (strchr(separators, *from) != NULL)) {
            from++;
            break;
        }
        if ((quote == '\0') && ((*from == '"') || (*from == '\''))) {
            quote = *from;
        } else if (*from == quote) {
            quote = '\0';
        } else {
            *to = *from;
            to++;
        }
    }
    *to = '\0'; /* not beyond what was read: either the separator stood here, or a quote, or the end */
    return (quote == '\0') ? from : NULL;
}

/** Cut the text at the separators. @return false: reported */
static bool split(line_t *line, const char *separators) {
    char *at = line->text;

    for (;;) {
        at += strspn(at, separators);
        if (*at == '\0') {
            return true;
        }
        if (line->count == PARTS_MAX) {
            return report_wrong_line(line, "too many words");
        }
        line->parts[line->count] = at;
        line->count++;
        at = take_part(at, separators);
        if (at == NULL) {
            return report_wrong_line(line, "a quote is not closed");
        }
    }
}

/** The supervisor and its board are those of the simulated bus only. */
static bool is_on_a_bus(const yaml_word_t *actor) {
    return actor->value < ACTOR_SUPERVISOR;
}

static const yaml_word_t *find_actor(const char *name) {
    for (const yaml_word_t *actor = SCENARIO_ACTORS; actor->word != NULL; actor++) {
        if (is_on_a_bus(actor) && (strcmp(actor->word, name) == 0)) {
            return actor;
        }
    }
    return NULL;
}

/** Check that actor and action exist on a real bus. */
static bool check_actor(const line_t *line) {
    const yaml_word_t *actor = find_actor(line->parts[0]);

    if (actor == NULL) {
        return report("%s: '%.40s' is not one of " ACTORS "%s", line->source, line->parts[0],
                      line->is_typed ? ", " COMMANDS : "");
    }
    if (line->count == 1) {
        return report("%s: the action of %s is missing", line->source, actor->word);
    }
    const scenario_action_row_t *row = scenario_find_action((scenario_actor_t)actor->value, line->parts[1]);
    if ((row != NULL) && !row->of_vehicle) {
        return report("%s: %s: '%s' is for the simulated bus only", line->source, actor->word, row->word);
    }
    return true;
}

/** Add `key: value` to the step. @return false: reported */
static bool add_pair(const line_t *line, yaml_document_t *document, int step, const char *key, size_t key_length,
                     const char *value) {
    const int k =
        yaml_document_add_scalar(document, NULL, (const yaml_char_t *)key, (int)key_length, YAML_PLAIN_SCALAR_STYLE);
    const int v = yaml_document_add_scalar(document, NULL, (const yaml_char_t *)value, (int)strlen(value),
                                           YAML_PLAIN_SCALAR_STYLE);
    return ((k != 0) && (v != 0) && (yaml_document_append_mapping_pair(document, step, k, v) != 0)) ||
           report_wrong_line(line, "not UTF-8 text");
}

/** The step as a scenario file would have it: {at_ms: 3000, eps: set, field: faults, value: 08h}. */
static bool build(const line_t *line, yaml_document_t *document) {
    const int step = yaml_document_add_mapping(document, NULL, YAML_FLOW_MAPPING_STYLE);
    bool good = (step != 0) && add_pair(line, document, step, "at_ms", strlen("at_ms"), line->at_ms) &&
                add_pair(line, document, step, line->parts[0], strlen(line->parts[0]), line->parts[1]);

    for (unsigned i = PARTS_BEFORE_VALUES; good && (i < line->count); i++) {
        const char *part = line->parts[i];
        const size_t length = strcspn(part, "=");
        if (part[length] == '\0') {
            return report("%s: '%.40s': NAME=VALUE is needed here", line->source, part);
        }
        good = add_pair(line, document, step, part, length, &part[length + 1]);
    }
    return good;
}

static bool read_step(const line_t *line, const agv_config_t *config, scenario_step_t *step) {
    yaml_document_t document;
    const yaml_reader_t reader = {.file = line->source, .document = &document, .is_line = true};

    if (yaml_document_initialize(&document, NULL, NULL, NULL, 1, 1) == 0) {
        return report_wrong_line(line, "out of memory");
    }
    const bool good =
        build(line, &document) && scenario_parse_step(&reader, yaml_document_get_root_node(&document), config, step);
    yaml_document_delete(&document);
    return good && ((step->again_every_ms == 0) || report_wrong_line(line, "again_every_ms is for scenario files"));
}

static void describe(const line_t *line, char what[VEHICLE_WORDS_MAX]) {
    size_t used = 0;

    for (unsigned i = 1; i < line->count; i++) {
        used += (size_t)snprintf(&what[used], VEHICLE_WORDS_MAX - used, "%s%s", (i > 1) ? " " : "", line->parts[i]);
    }
}

static bool read_line(line_t *line, const char *separators, const agv_config_t *config, vehicle_words_t *words) {
    if (!split(line, separators)) {
        return false;
    }
    if (line->count == 0) {
        return report_wrong_line(line, "actor and action are missing");
    }
    if (!check_actor(line) || !read_step(line, config, &words->step)) {
        return false;
    }
    describe(line, words->what);
    return true;
}

/** Take a line. @param before, after around the text where a message names its source */
static bool take_text(line_t *line, const char *text, const char *before, const char *after) {
    (void)snprintf(line->source, sizeof line->source, "%s%.*s%s", before, SHOWN_MAX, text, after);
    return (snprintf(line->text, sizeof line->text, "%s", text) < (int)sizeof line->text) ||
           report("%s: longer than %u characters", line->source, VEHICLE_WORDS_MAX - 1);
}

vehicle_command_t vehicle_words_command(const char *text) {
    static const char *const commands[] = {
        [VEHICLE_COMMAND_HELP] = "help", [VEHICLE_COMMAND_STATUS] = "status", [VEHICLE_COMMAND_QUIT] = "quit"};
    const char *word = &text[strspn(text, " \t")];
    const size_t length = strcspn(word, " \t");
    const char *rest = &word[length + strspn(&word[length], " \t")];
    for (size_t i = VEHICLE_COMMAND_HELP; i < sizeof commands / sizeof commands[0]; i++) {
        if ((strlen(commands[i]) != length) || (memcmp(commands[i], word, length) != 0)) {
            continue;
        }
        if (*rest == '\0') {
            return (vehicle_command_t)i;
        }
        (void)report("'%.*s': '%s' takes no argument", SHOWN_MAX, text, commands[i]);
        return VEHICLE_COMMAND_BAD;
    }
    return VEHICLE_COMMAND_NONE;
}

bool vehicle_words_typed(const char *text, const agv_config_t *config, vehicle_words_t *words) {
    line_t line = {.at_ms = "0", .is_typed = true};

    return take_text(&line, text, "'", "'") && read_line(&line, " \t", config, words);
}

/** Whether nothing stands between two separators, or behind the last. */
static bool has_empty_part(const char *text, const char *dash, const char *at) {
    return (strstr(text, ",,") != NULL) || (dash[1] == ',') || (at[-1] == ',');
}

bool vehicle_words_fault(const char *text, const agv_config_t *config, vehicle_words_t *words) {
    line_t line = {.count = 0};

    if (!take_text(&line, text, "--fault ", "")) {
        return false;
    }
    char *at = strrchr(line.text, '@');
    char *dash = strchr(line.text, '-');
    if ((at == NULL) || (dash == NULL) || (dash > at) || has_empty_part(line.text, dash, at)) {
        return report_wrong_line(&line, FAULT_FORM " is needed, such as ai-stop@2s");
    }
    if (at[1] == '\0') {
        return report_wrong_line(&line, "the time after @ is missing, such as @2s");
    }
    *at = '\0';
    *dash = ',';
    line.at_ms = &at[1];
    return read_line(&line, ",", config, words);
}

/** Print a word of a list; on a new line when this one is full. */
static void print_item(int *column, const char *item) {
    const int length = (int)strlen(item);

    if (*column + 2 + length > HELP_WIDTH) {
        (void)printf(",\n%*s", HELP_INDENT, "");
        *column = HELP_INDENT;
    } else if (*column > HELP_INDENT) {
        (void)printf(", ");
        *column += 2;
    }
    (void)printf("%s", item);
    *column += length;
}

/** Add the names of parameters. */
static void add_parameters(char *item, uint32_t parameters, const char *before, const char *after) {
    for (unsigned i = 0; i < SCENARIO_PARAMETERS; i++) {
        const size_t used = strlen(item);
        if ((parameters & (1u << i)) != 0) {
            (void)snprintf(&item[used], HELP_WIDTH - used, "%s%s%s", before, SCENARIO_PARAMETER_ROWS[i].name, after);
        }
    }
}

static void print_action(int *column, const scenario_action_row_t *row) {
    char item[HELP_WIDTH];

    (void)snprintf(item, sizeof item, "%s", row->word);
    add_parameters(item, row->needs, " ", "=");
    add_parameters(item, row->takes, " [", "=]");
    print_item(column, item);
}

static void print_actions(scenario_actor_t actor, const char *who) {
    const scenario_action_row_t *row = scenario_action(0);
    int column = HELP_INDENT;

    (void)printf("%-*s", HELP_INDENT, who);
    for (size_t i = 0; row != NULL; i++, row = scenario_action(i)) {
        if ((row->actor == actor) && row->of_vehicle) {
            print_action(&column, row);
        }
    }
    (void)printf("\n");
}

static void print_fields(void) {
    const scenario_field_row_t *row = scenario_field(0);
    int column = HELP_INDENT;

    (void)printf("%-*s", HELP_INDENT, "field=");
    for (size_t i = 0; row != NULL; i++, row = scenario_field(i)) {
        char item[HELP_WIDTH];
        (void)snprintf(item, sizeof item, "%s %s", SCENARIO_ACTORS[row->actor].word, row->name);
        print_item(&column, item);
    }
    (void)printf("\n");
}

static void print_messages(void) {
    int column = HELP_INDENT;

    (void)printf("%-*s", HELP_INDENT, "message=");
    for (int m = 0; m < AGV_MSG_COUNT; m++) {
        print_item(&column, agv_message_name((agv_message_t)m));
    }
    (void)printf("\n");
}

void vehicle_words_help(void) {
    print_actions(ACTOR_NONE, "vcu, eps, ai");
    for (const yaml_word_t *actor = SCENARIO_ACTORS; actor->word != NULL; actor++) {
        if (is_on_a_bus(actor)) {
            print_actions((scenario_actor_t)actor->value, actor->word);
        }
    }
    print_fields();
    print_messages();
    (void)printf("%-*s" COMMANDS "\n", HELP_INDENT, "this program");
}
