#include "yaml_file.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "report.h"

/** Read a whole file. @return NULL: reported. The caller frees it. */
static unsigned char *read_file(const char *path, size_t *size) {
    FILE *file = fopen(path, "rb");
    if (file == NULL) {
        (void)report("%s: %s", path, strerror(errno));
        return NULL;
    }
    unsigned char *bytes = malloc(YAML_FILE_SIZE_MAX + 1u);
    errno = 0;
    *size = (bytes != NULL) ? fread(bytes, 1u, YAML_FILE_SIZE_MAX + 1u, file) : 0u;
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
    size_t line = 1u;
    for (size_t i = 0u; (i < size) && (i < offset); i++) {
        line += (bytes[i] == '\n') ? 1u : 0u;
    }
    return line;
}

static void report_problem(const char *path, const yaml_parser_t *parser, const unsigned char *bytes, size_t size) {
    const char *problem = (parser->problem != NULL) ? parser->problem : "out of memory";
    /* Characters are decoded before lines are counted. */
    size_t line = (parser->error == YAML_READER_ERROR) ? line_of_offset(bytes, size, parser->problem_offset)
                                                       : parser->problem_mark.line + 1u;
    (void)report_at(path, line, "no YAML: %s", problem);
}

/** Check that nothing but the end comes after the first document. */
static bool is_last(const char *path, yaml_parser_t *parser, const unsigned char *bytes, size_t size) {
    yaml_document_t next;
    if (yaml_parser_load(parser, &next) == 0) {
        report_problem(path, parser, bytes, size);
        return false;
    }
    const yaml_node_t *root = yaml_document_get_root_node(&next);
    bool is_end = root == NULL;
    if (!is_end) {
        (void)report_at(path, yaml_node_line(root), "a second YAML document begins here");
    }
    yaml_document_delete(&next);
    return is_end;
}

bool yaml_file_load(const char *path, yaml_document_t *document) {
    size_t size = 0u;
    unsigned char *bytes = read_file(path, &size);
    if (bytes == NULL) {
        return false;
    }
    yaml_parser_t parser;
    if (yaml_parser_initialize(&parser) == 0) {
        free(bytes);
        return report("%s: out of memory", path);
    }
    yaml_parser_set_input_string(&parser, bytes, size);
    bool loaded = yaml_parser_load(&parser, document) != 0;
    if (!loaded) {
        report_problem(path, &parser, bytes, size);
    } else if ((yaml_document_get_root_node(document) != NULL) && !is_last(path, &parser, bytes, size)) {
        yaml_document_delete(document);
        loaded = false;
    }
    yaml_parser_delete(&parser);
    free(bytes);
    return loaded;
}

size_t yaml_node_line(const yaml_node_t *node) {
    return node->start_mark.line + 1u;
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
