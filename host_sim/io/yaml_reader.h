/**
 * @file yaml_reader.h
 * Reading a YAML document by tables: which keys a mapping may have, and what each holds. Unknown and repeated keys are
 * refused. What is wrong is reported with file and line at once; every function then returns false (or NULL), and its
 * caller does the same, so that one line is printed.
 */
#ifndef HOST_SIM_YAML_READER_H
#define HOST_SIM_YAML_READER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <yaml.h>

#include "text/duration.h"

#define YAML_READER_KEYS_MAX 40u

/** A document that is being read; made with yaml_file_load(). */
typedef struct {
    const char *file;
    yaml_document_t *document;
    bool is_line; /**< no file but a single line, which `file` is: messages name no line number */
} yaml_reader_t;

/** A word and its value; a list ends with the word NULL. */
typedef struct {
    const char *word;
    int value;
} yaml_word_t;

/** Reads the value of a key into @p target. @return false: invalid; was reported. */
typedef bool yaml_read_fn(const yaml_reader_t *reader, const yaml_node_t *value, void *target);

/** How the value of a key is read. */
typedef enum {
    YAML_KIND_CALL, /**< by a function */
    YAML_KIND_LIST, /**< each item by a function */
    YAML_KIND_FLAG, /**< true, false */
    YAML_KIND_NUMBER,
    YAML_KIND_HEX,
    YAML_KIND_ID,
    YAML_KIND_TIME,
    YAML_KIND_WORD,
    YAML_KIND_RANGE,      /**< one number or two, into two members of 32 bits */
    YAML_KIND_TIME_RANGE, /**< the same, of times in milliseconds */
    YAML_KIND_TEXT,       /**< this and what follows: for shapes only */
    YAML_KIND_BYTES,
    YAML_KIND_NAMES, /**< one of the words that a function names */
    YAML_KIND_MAP,   /**< a mapping by a table */
} yaml_kind_t;

/** What a function accepts: yaml_shape.h. */
typedef struct yaml_shape yaml_shape_t;

/** A key of a mapping; made by the macros below. */
typedef struct {
    const char *name;
    bool required;
    yaml_kind_t kind;
    yaml_read_fn *read;
    size_t offset; /**< of the member of the target */
    size_t size;   /**< of this member: 1, 2 or 4 bytes */
    size_t given;  /**< offset of a bool that is set, too; 0: none */
    int64_t lowest;
    int64_t highest;
    duration_unit_t unit; /**< of a time */
    const yaml_word_t *words;
    const yaml_shape_t *shape; /**< what the function of a CALL or a LIST (each item) accepts; NULL: anything */
} yaml_key_t;

/** @name Rows of a table of keys: OPTIONAL or REQUIRED, the key, and what its kind needs @{ */
#define YAML_OPTIONAL(...) {.required = false, __VA_ARGS__}
#define YAML_REQUIRED(...) {.required = true, __VA_ARGS__}
#define YAML_CALL(key, function, shape_) .name = (key), .kind = YAML_KIND_CALL, .read = (function), .shape = (shape_)
#define YAML_LIST(key, function, shape_) .name = (key), .kind = YAML_KIND_LIST, .read = (function), .shape = (shape_)
#define YAML_MEMBER(type, member) .offset = offsetof(type, member), .size = sizeof(((type *)NULL)->member)
#define YAML_FLAG(key, type, member) .name = (key), .kind = YAML_KIND_FLAG, YAML_MEMBER(type, member)
#define YAML_NUMBER(key, type, member, low, high)                                                                      \
    .name = (key), .kind = YAML_KIND_NUMBER, YAML_MEMBER(type, member), .lowest = (low), .highest = (high)
#define YAML_HEX(key, type, member, high)                                                                              \
    .name = (key), .kind = YAML_KIND_HEX, YAML_MEMBER(type, member), .highest = (high)
#define YAML_ID(key, type, member, high)                                                                               \
    .name = (key), .kind = YAML_KIND_ID, YAML_MEMBER(type, member), .highest = (high)
#define YAML_TIME_IN(unit_, key, type, member, low, high)                                                              \
    .name = (key), .kind = YAML_KIND_TIME, .unit = (unit_), YAML_MEMBER(type, member), .lowest = (low),                \
    .highest = (high)
#define YAML_TIME(...) YAML_TIME_IN(DURATION_MS, __VA_ARGS__)
#define YAML_TIME_US(...) YAML_TIME_IN(DURATION_US, __VA_ARGS__)
#define YAML_WORD(key, type, member, list)                                                                             \
    .name = (key), .kind = YAML_KIND_WORD, YAML_MEMBER(type, member), .words = (list)
#define YAML_RANGE(key, type, member, low, high)                                                                       \
    .name = (key), .kind = YAML_KIND_RANGE, YAML_MEMBER(type, member), .lowest = (low), .highest = (high)
#define YAML_TIME_RANGE(key, type, member, low, high)                                                                  \
    .name = (key), .kind = YAML_KIND_TIME_RANGE, YAML_MEMBER(type, member), .lowest = (low), .highest = (high)
#define YAML_GIVEN(type, member) .given = offsetof(type, member)
/** @} */

/** Report what is wrong with a node. @return false */
bool yaml_reader_fail(const yaml_reader_t *reader, const yaml_node_t *node, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/**
 * Read a mapping: each key by its row of the table, all with one target, in the order of the table (so that a row
 * may go by what an earlier one has read).
 * @param what  names the mapping in messages
 * @param count at most YAML_READER_KEYS_MAX
 */
bool yaml_reader_map(const yaml_reader_t *reader, const yaml_node_t *node, const char *what, const yaml_key_t *keys,
                     size_t count, void *target);

/** The value of a key in a mapping that was read; NULL: it is not there. */
const yaml_node_t *yaml_reader_value(const yaml_reader_t *reader, const yaml_node_t *mapping, const char *key);

/** Read a sequence: each item with @p read. */
bool yaml_reader_list(const yaml_reader_t *reader, const yaml_node_t *node, const char *what, yaml_read_fn *read,
                      void *target);

/** The text of a scalar; NULL: not a scalar, or empty. Valid as long as the document. */
const char *yaml_reader_text(const yaml_reader_t *reader, const yaml_node_t *node, const char *what);

/** A whole decimal number, or a hexadecimal one (0x1F) that is not negative. */
bool yaml_reader_number(const yaml_reader_t *reader, const yaml_node_t *node, const char *what, int64_t lowest,
                        int64_t highest, int64_t *number);

/** A hexadecimal number as the protocol document writes it, "168h", or "0x168". */
bool yaml_reader_hex(const yaml_reader_t *reader, const yaml_node_t *node, const char *what, uint32_t highest,
                     uint32_t *number);

/** An identifier: also decimal, "360". */
bool yaml_reader_id(const yaml_reader_t *reader, const yaml_node_t *node, const char *what, uint32_t highest,
                    uint32_t *number);

/** A time (text/duration.h), in @p unit; a number alone is that, too. */
bool yaml_reader_time(const yaml_reader_t *reader, const yaml_node_t *node, const char *what, duration_unit_t unit,
                      int64_t lowest, int64_t highest, int64_t *number);

/** true, false. */
bool yaml_reader_bool(const yaml_reader_t *reader, const yaml_node_t *node, const char *what, bool *value);

/** One of the words; the message lists them. */
bool yaml_reader_word(const yaml_reader_t *reader, const yaml_node_t *node, const char *what, const yaml_word_t *words,
                      int *value);

/** A number, or a list of two: the lowest and the highest. */
bool yaml_reader_range(const yaml_reader_t *reader, const yaml_node_t *node, const char *what, int64_t lowest,
                       int64_t highest, int64_t range[2]);

/** The same with times in milliseconds. */
bool yaml_reader_time_range(const yaml_reader_t *reader, const yaml_node_t *node, const char *what, int64_t lowest,
                            int64_t highest, int64_t range[2]);

/**
 * Payload bytes, two hexadecimal digits each, with blanks between them: "08 00 FF".
 * @param mask FFh for a byte that stands there, 00h for one that is `..`; NULL: `..` is refused. Beyond the length both
 *             are 0.
 */
bool yaml_reader_bytes(const yaml_reader_t *reader, const yaml_node_t *node, const char *what, uint8_t value[8],
                       uint8_t *mask, uint8_t *length);

#endif
