/**
 * @file suggest.h
 * "did you mean": the known word that is nearest to one that is not known.
 */
#ifndef HOST_SIM_SUGGEST_H
#define HOST_SIM_SUGGEST_H

#include <stddef.h>

/** What was written, and the nearest word so far. Start from suggest_begin(). */
typedef struct {
    const char *written;
    size_t written_length;
    const char *word; /**< NULL: none is near */
    size_t length;
    size_t distance;
} suggestion_t;

/** Room for what suggest_text() writes. */
#define SUGGEST_SIZE 96u

/** @param length of the part that counts: without the value of "--name=value" */
suggestion_t suggest_begin(const char *written, size_t length);

/**
 * Offer a known word: it is kept if it is near, and nearer than those before. Case, `-` for `_`, and dashes in front are
 * no difference; two letters that changed places are one.
 */
void suggest_offer(suggestion_t *suggestion, const char *word, size_t length);

/** Offer each word of a list "a|b|c". */
void suggest_offer_words(suggestion_t *suggestion, const char *words);

/** Write the end of a message: ": did you mean 'replay'?", or "" if no word is near. @return text */
const char *suggest_text(const suggestion_t *suggestion, char text[SUGGEST_SIZE]);

/** All at once, for a list of words "a|b|c". */
const char *suggest_from(const char *words, const char *written, char text[SUGGEST_SIZE]);

#endif
