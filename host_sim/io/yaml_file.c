#include "io/yaml_file.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/report.h"

/** Read a whole file. @return NULL: reported. The caller frees it. */
static unsigned char *read_file(const char *path, size_t *size) {
    if (strcmp(path, "-") == 0) { /* of a log it means that, so it is not taken for a name here */
        (void)report("-: standard input is not read here; give the name of a file");
        return NULL;
    }
    FILE *file = fopen(path, "rb");
    if (file == NULL) {
        (void)report("%s: %s", path, strerror(errno));
        return NULL;
    }
    unsigned char *bytes = malloc(YAML_FILE_SIZE_MAX + 1);
    errno = 0;
    *size = (bytes != NULL) ? fread(bytes, 1, YAML_FILE_SIZE_MAX + 1, file) : 0;
    const char *wrong = NULL;
    if ((bytes == NULL) || (ferror(file) != 0)) {
        wrong = strerror((errno != 0) ? errno : EIO);
    } else if (*size > YAML_FILE_SIZE_MAX) {
        wrong = "the file is larger than 1 MiB";
    }
    (void)fclose(file);
    if (wrong != NULL) {
        (void)report("%s: %s", path, wrong);
        free(bytes);
        return NULL;
    }
    return bytes;
}

static size_t line_of_offset(const unsigned char *bytes, size_t size, size_t offset) {
    size_t line = 1;
    for (size_t i = 0; (i < size) && (i < offset); i++) {
        line += (bytes[i] == '\n') ? 1 : 0;
    }
    return line;
}

static void report_problem(const char *path, const yaml_parser_t *parser, const unsigned char *bytes, size_t size) {
    const char *problem = (parser->problem != NULL) ? parser->problem : "out of memory";
    /* Characters are decoded before lines are counted. */
    size_t line = (parser->error == YAML_READER_ERROR) ? line_of_offset(bytes, size, parser->problem_offset)
                                                       : parser->problem_mark.line + 1;
    const size_t at = parser->problem_mark.index;
    const bool is_tab = (parser->error == YAML_SCANNER_ERROR) && (at < size) && (bytes[at] == '\t');
    (void)report_at(path, line, "not YAML: %s%s", problem, is_tab ? ": a tab; YAML is indented with blanks" : "");
}

/** Follow an event. @return what is wrong with it, or NULL */
static const char *check_event(const yaml_event_t *event, size_t *depth, size_t *documents) {
    switch (event->type) {
    case YAML_DOCUMENT_START_EVENT:
        (*documents)++;
        return (*documents == 1) ? NULL : "a second YAML document begins here";
    case YAML_SEQUENCE_START_EVENT:
    case YAML_MAPPING_START_EVENT:
        (*depth)++;
        return (*depth <= YAML_FILE_DEPTH_MAX) ? NULL : "nested too deeply";
    case YAML_SEQUENCE_END_EVENT:
    case YAML_MAPPING_END_EVENT:
        (*depth)--;
        return NULL;
    default:
        return NULL;
    }
}

/**
 * Look through a file before it is loaded: the time that the library takes grows with the square of the depth, and it
 * leaves what follows the first document unread.
 */
static bool check(const char *path, const unsigned char *bytes, size_t size) {
    yaml_parser_t parser;
    if (yaml_parser_initialize(&parser) == 0) {
        return report("%s: out of memory", path);
    }
    yaml_parser_set_input_string(&parser, bytes, size);
    size_t depth = 0;
    size_t documents = 0;
    bool good = true;
    for (bool at_end = false; good && !at_end;) {
        yaml_event_t event;
        good = yaml_parser_parse(&parser, &event) != 0;
        if (!good) {
            report_problem(path, &parser, bytes, size);
            break;
        }
        const char *wrong = check_event(&event, &depth, &documents);
        if (wrong != NULL) {
            good = report_at(path, event.start_mark.line + 1, "%s", wrong);
        }
        at_end = event.type == YAML_STREAM_END_EVENT;
        yaml_event_delete(&event);
    }
    yaml_parser_delete(&parser);
    return good;
}

static bool load(const char *path, const unsigned char *bytes, size_t size, yaml_document_t *document) {
    yaml_parser_t parser;
    if (yaml_parser_initialize(&parser) == 0) {
        return report("%s: out of memory", path);
    }
    yaml_parser_set_input_string(&parser, bytes, size);
    bool loaded = yaml_parser_load(&parser, document) != 0;
    if (!loaded) {
        report_problem(path, &parser, bytes, size);
    }
    yaml_parser_delete(&parser);
    return loaded;
}

bool yaml_file_load(const char *path, yaml_document_t *document) {
    size_t size = 0;
    unsigned char *bytes = read_file(path, &size);
    bool loaded = (bytes != NULL) && check(path, bytes, size) && load(path, bytes, size, document);
    free(bytes);
    return loaded;
}

bool yaml_text_load(const char *name, const char *text, yaml_document_t *document) {
    const unsigned char *bytes = (const unsigned char *)text;
    const size_t size = strlen(text);
    return check(name, bytes, size) && load(name, bytes, size, document);
}

size_t yaml_node_line(const yaml_node_t *node) {
    return node->start_mark.line + 1;
}

const char *yaml_node_text(const yaml_node_t *node) {
    if ((node == NULL) || (node->type != YAML_SCALAR_NODE)) {
        return NULL;
    }
    const char *text = (const char *)node->data.scalar.value;
    return (strlen(text) == node->data.scalar.length) ? text : NULL;
}

const char *yaml_node_plain(const yaml_node_t *node) {
    const char *text = yaml_node_text(node);
    return ((text != NULL) && (node->data.scalar.style == YAML_PLAIN_SCALAR_STYLE)) ? text : NULL;
}
