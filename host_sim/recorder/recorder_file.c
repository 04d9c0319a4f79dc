#include "recorder/recorder_file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "agv/faults.h"
#include "agv/state.h"
#include "common/report.h"
#include "hal_sim/sim_store.h"
#include "io/store_file.h"
#include "text/hex.h"

/* A dump of flash has some 100 KB; a whole RAM fits, too. */
#define FILE_MAX 16777216u
#define EVENT_WORD "agv-event "
#define VERSION_WORD "agv-version "

static bool add(recorder_events_t *events, const agv_event_t *event) {
    if (events->count == events->room) {
        const size_t room = (events->room == 0) ? 256 : 2 * events->room;
        agv_event_t *larger = realloc(events->events, room * sizeof *larger);
        if (larger == NULL) {
            return report("out of memory");
        }
        events->events = larger;
        events->room = room;
    }
    events->events[events->count] = *event;
    events->count++;
    return true;
}

/** Whether bytes are an event: the checksum has 16 bits only, so its fields have to make sense, too. */
static bool is_event(const agv_event_t *event) {
    const bool kind = (event->kind >= AGV_EVENT_STATE) && (event->kind <= AGV_EVENT_CRASH);
    const bool state = agv_state_is_latched((agv_state_t)event->state)
                           ? (event->state == AGV_STATE_TRIPPED) || (event->state == AGV_STATE_SAFE)
                           : true;
    return kind && state && (event->reserved == 0) && (event->first_reason <= AGV_FAULT_COUNT) &&
           (event->seen < agv_message_bit(AGV_MSG_COUNT)) && agv_event_is_valid(event);
}

/** Find the events in bytes, wherever they lie. @return false: no memory; was reported */
static bool take_bytes(recorder_events_t *events, const uint8_t *bytes, size_t size) {
    size_t at = 0;
    while (at + sizeof(agv_event_t) <= size) {
        agv_event_t event;
        memcpy(&event, &bytes[at], sizeof event);
        if (is_event(&event)) {
            if (!add(events, &event)) {
                return false;
            }
            at += sizeof event;
        } else {
            at++;
        }
    }
    return true;
}

static size_t hex_length(const char *text, size_t length) {
    size_t count = 0;
    while ((count < length) && (hex_digit(text[count]) < HEX_NO_DIGIT)) {
        count++;
    }
    return count;
}

/** What follows a word in a line; NULL: it is not there. */
static const char *text_after(const char *word, const char *line, size_t length) {
    const size_t size = strlen(word);
    for (size_t at = 0; at + size <= length; at++) {
        if (memcmp(&line[at], word, size) == 0) {
            return &line[at + size];
        }
    }
    return NULL;
}

/** Take what names the device: printable characters, as many as fit. */
static void take_version(recorder_events_t *events, const char *text, size_t length) {
    size_t used = 0;
    while ((used < length) && (used < sizeof events->device - 1) && (text[used] >= ' ') && (text[used] <= '~')) {
        events->device[used] = text[used];
        used++;
    }
    events->device[used] = '\0';
}

/** Take a line: an event behind EVENT_WORD, or nothing but an event. @return false: no memory; was reported */
static bool take_line(recorder_events_t *events, const char *line, size_t length) {
    agv_event_t event;
    const char *word = text_after(EVENT_WORD, line, length);
    const char *version = text_after(VERSION_WORD, line, length);
    if (version != NULL) {
        take_version(events, version, length - (size_t)(version - line));
    }
    const char *digits = (word != NULL) ? word : line;
    const size_t count = hex_length(digits, length - (size_t)(digits - line));
    if ((hex_bytes(digits, count, (uint8_t *)&event, sizeof event) == sizeof event) && is_event(&event)) {
        return add(events, &event);
    }
    events->damaged += ((word != NULL) || (count > sizeof event)) ? 1 : 0;
    return true;
}

static bool take_lines(recorder_events_t *events, const char *text, size_t size) {
    const char *line = text;
    while (line < &text[size]) {
        const size_t left = (size_t)(&text[size] - line);
        const char *end = memchr(line, '\n', left);
        if (!take_line(events, line, (end != NULL) ? (size_t)(end - line) : left)) {
            return false;
        }
        line = (end != NULL) ? &end[1] : &text[size];
    }
    return true;
}

/** The file of --store: its records, and the recorder in RAM. */
static bool take_store(recorder_events_t *events, const char *text, size_t size) {
    sim_store_t *store = calloc(1, sizeof *store);
    agv_recorder_t *recorder = calloc(1, sizeof *recorder);
    bool good = (store != NULL) && (recorder != NULL);
    if (!good) {
        (void)report("out of memory");
    }
    if (good) {
        store_file_take(text, size, store, recorder);
    }
    for (uint32_t i = 0; good && (i < store->count); i++) {
        uint8_t record[SIM_STORE_RECORD_SIZE_MAX];
        good = take_bytes(events, record, sim_store_read_record(store, i, record, sizeof record));
    }
    good = good && take_bytes(events, (const uint8_t *)recorder, sizeof *recorder);
    free(store);
    free(recorder);
    return good;
}

/** Read a file whole. @return its size; -1: reported */
static ssize_t read_all(const char *path, const char *name, char **text) {
    const int fd = (strcmp(path, "-") == 0) ? STDIN_FILENO : open(path, O_RDONLY | O_CLOEXEC);
    size_t size = 0;
    ssize_t count = -1;
    *text = (fd >= 0) ? malloc(FILE_MAX + 1) : NULL;
    if (fd >= 0) {
        count = (*text != NULL) ? 1 : -1;
        while ((count > 0) && (size <= FILE_MAX)) {
            count = read(fd, &(*text)[size], FILE_MAX + 1 - size);
            size += (count > 0) ? (size_t)count : 0;
        }
    }
    if (count < 0) {
        (void)report("%s: %s", name, strerror(errno));
    } else if (size > FILE_MAX) {
        (void)report("%s: larger than 16 MiB: not a flight recorder", name);
        count = -1;
    } else {
        /* read to its end */
    }
    if (fd > STDIN_FILENO) {
        (void)close(fd);
    }
    return (count < 0) ? -1 : (ssize_t)size;
}

static int by_sequence(const void *one, const void *other) {
    const uint32_t a = ((const agv_event_t *)one)->sequence;
    const uint32_t b = ((const agv_event_t *)other)->sequence;
    return (a > b) - (a < b);
}

static void shift_sequences(recorder_events_t *events, uint32_t by) {
    for (size_t i = 0; i < events->count; i++) {
        events->events[i].sequence += by;
    }
}

/** Sequence numbers wrap: they are sorted by their distance from one of them. */
static void sort(recorder_events_t *events) {
    const uint32_t shift = (events->count > 0) ? ((UINT32_MAX / 2) - events->events[0].sequence) : 0;
    size_t kept = 0;
    shift_sequences(events, shift);
    qsort(events->events, events->count, sizeof events->events[0], by_sequence);
    shift_sequences(events, 0 - shift);
    for (size_t i = 0; i < events->count; i++) {
        if ((kept == 0) || (events->events[kept - 1].sequence != events->events[i].sequence)) {
            events->events[kept] = events->events[i];
            kept++;
        }
    }
    events->count = kept;
}

static bool take_file(recorder_events_t *events, const char *text, size_t size) {
    if (store_file_is(text, size)) {
        return take_store(events, text, size);
    }
    if (!take_lines(events, text, size)) {
        return false;
    }
    return (events->count > 0) || take_bytes(events, (const uint8_t *)text, size);
}

bool recorder_file_read(const char *path, recorder_events_t *events) {
    const char *name = report_input_name(path);
    char *text = NULL;
    const ssize_t size = read_all(path, name, &text);
    bool good = (size >= 0) && take_file(events, text, (size_t)size);
    free(text);
    if (good && (events->count == 0)) {
        good = report(
            "%s: contains no flight recorder event (lines 'agv-event' of 'agv dump', a memory dump, or a --store "
            "file)",
            name);
    }
    if (good) {
        sort(events);
    }
    return good;
}

void recorder_events_free(recorder_events_t *events) {
    free(events->events);
    *events = (recorder_events_t){.count = 0};
}
