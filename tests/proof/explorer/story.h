/*
 * A counterexample as a scenario file of host_sim: its steps say what the stage did, its expectations what was seen
 * before the rule was broken, and what the rule asked for. So it fails with the supervisor that broke the rule, and holds
 * with one that does not.
 */
#ifndef STORY_H
#define STORY_H

#include <stdio.h>

/* From now on all that is done to the stage is noted, from its root on. */
void story_begin(void);

/* The name of the symbol that comes now; or another comment. */
void story_says(const char *comment);

/* Something that no comparison of stages shows, done in the next millisecond. */
__attribute__((format(printf, 1, 2))) void story_step(const char *format, ...);

/* It is told. Writes the file; the rule that was broken is stage_broken(). */
void story_write(FILE *file);

/* Whether something is told now. */
extern int story_told;

#endif
