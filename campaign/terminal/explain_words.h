/* Words that a user meets and that are no path: those of messages, tables and columns. */
#ifndef CLAST_CAMPAIGN_TERMINAL_EXPLAIN_WORDS_H
#define CLAST_CAMPAIGN_TERMINAL_EXPLAIN_WORDS_H

#include <stdbool.h>

#include "schemas/text.h"

/* Prints what the word means: a word of clast, or a column of the store. Returns whether it is one. */
bool explain_words(const char *word);
/* Offers all of them as what may have been meant. */
void explain_words_guess(struct text_guess *guess);

/* The path of a result by one of its names in tables: "energy_kinetic" of "result_dem_energy_kinetic", and of
 * "energy_kinetic_mean". *said tells what the rest of the name means; NULL: nothing. Within `name`, or `plain`. */
const char *explain_words_result(const char *name, char plain[256], const char **said);

#endif
