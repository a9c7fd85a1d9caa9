/* Explains words that are not paths: words of messages, tables and columns. */
#ifndef CLAST_CAMPAIGN_TERMINAL_EXPLAIN_WORDS_H
#define CLAST_CAMPAIGN_TERMINAL_EXPLAIN_WORDS_H

#include <stdbool.h>

#include "schemas/text.h"

/* Prints the meaning of a word of clast or a column of the store. False: it is neither. */
bool explain_words(const char *word);
enum { EXPLAIN_WORD = 128 };
/* Offers all words to the search for the nearest name. `name` keeps the one that is the nearest. */
void explain_words_guess(struct text_guess *guess, char name[EXPLAIN_WORD]);

/* The path of a result by one of its names in tables: "energy_kinetic" of "result_dem_energy_kinetic", and of
 * "energy_kinetic_mean". *said: meaning of the rest of the name, or NULL. The result points into `name` or `plain`. */
const char *explain_words_result(const char *name, char plain[256], const char **said);

#endif
