#include "text/suggest.h"

#include <ctype.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "text/words.h"

enum { LENGTH_MAX = 48, PREFIX_MIN = 3, LETTERS_OF_A_MISTAKE = 4 };

/** A character for comparison. */
static int fold_case(char character) {
    return (character == '_') ? '-' : tolower((unsigned char)character);
}

static size_t minimum(size_t a, size_t b) {
    return (a < b) ? a : b;
}

/** Skip dashes in front. */
static const char *skip_dashes(const char *text, size_t *length) {
    size_t dashes = 0;
    while ((dashes < *length) && (text[dashes] == '-')) {
        dashes++;
    }
    *length -= dashes;
    return &text[dashes];
}

/** Letters to add, leave out, replace or swap (optimal string alignment). Both lengths are at most LENGTH_MAX. */
static size_t distance_of(const char *a, size_t a_length, const char *b, size_t b_length) {
    size_t rows[3][LENGTH_MAX + 1];
    for (size_t j = 0; j <= b_length; j++) {
        rows[0][j] = j;
    }
    for (size_t i = 1; i <= a_length; i++) {
        size_t *row = rows[i % 3];
        const size_t *last = rows[(i + 2) % 3];
        row[0] = i;
        for (size_t j = 1; j <= b_length; j++) {
            const bool is_same = fold_case(a[i - 1]) == fold_case(b[j - 1]);
            row[j] = minimum(minimum(last[j], row[j - 1]) + 1, last[j - 1] + (is_same ? 0 : 1));
            if ((i > 1) && (j > 1) && (fold_case(a[i - 1]) == fold_case(b[j - 2])) &&
                (fold_case(a[i - 2]) == fold_case(b[j - 1]))) {
                row[j] = minimum(row[j], rows[(i + 1) % 3][j - 2] + 1);
            }
        }
    }
    return rows[a_length % 3][b_length];
}

/** Whether a word begins with what was written. */
static bool begins_with(const char *word, size_t length, const char *written, size_t written_length) {
    return (written_length >= PREFIX_MIN) && (written_length < length) &&
           (distance_of(word, written_length, written, written_length) == 0);
}

suggestion_t suggest_begin(const char *written, size_t length) {
    suggestion_t suggestion = {.written_length = length};
    suggestion.written = skip_dashes(written, &suggestion.written_length);
    return suggestion;
}

void suggest_offer(suggestion_t *suggestion, const char *word, size_t length) {
    size_t compared = length;
    const char *letters = skip_dashes(word, &compared);
    const size_t written_length = suggestion->written_length;
    if ((compared > LENGTH_MAX) || (written_length > LENGTH_MAX)) {
        return;
    }
    const size_t distance = begins_with(letters, compared, suggestion->written, written_length)
                                ? 1
                                : distance_of(letters, compared, suggestion->written, written_length);
    const size_t mistakes = (compared + (size_t)LETTERS_OF_A_MISTAKE - 1) / LETTERS_OF_A_MISTAKE;
    if ((distance <= mistakes) && (distance < written_length) &&
        ((suggestion->word == NULL) || (distance < suggestion->distance))) {
        suggestion->word = word;
        suggestion->length = length;
        suggestion->distance = distance;
    }
}

void suggest_offer_words(suggestion_t *suggestion, const char *words) {
    const char *word = NULL;
    size_t length = words_at(words, 0, &word);
    for (size_t i = 1; length > 0; i++) {
        suggest_offer(suggestion, word, length);
        length = words_at(words, i, &word);
    }
}

const char *suggest_text(const suggestion_t *suggestion, char text[SUGGEST_SIZE]) {
    text[0] = '\0';
    if (suggestion->word != NULL) {
        (void)snprintf(text, SUGGEST_SIZE, ": did you mean '%.*s'?", (int)suggestion->length, suggestion->word);
    }
    return text;
}

const char *suggest_from(const char *words, const char *written, char text[SUGGEST_SIZE]) {
    suggestion_t suggestion = suggest_begin(written, strlen(written));
    suggest_offer_words(&suggestion, words);
    return suggest_text(&suggestion, text);
}
