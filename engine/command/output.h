/* Reads what a program wrote. */
#ifndef CLAST_ENGINE_COMMAND_OUTPUT_H
#define CLAST_ENGINE_COMMAND_OUTPUT_H

#include "engine/command/definition.h"
#include "engine/fragments.h"

/* Reads results (into `values`, one for each result row) and masses from the files in `folder`. *fragments: by
 * descending mass, malloc'd, owned by the caller, also after an error. *not_finite is the name of the first result or
 * mass that is NaN or infinite; "": there is none. STATUS_CONTENT: what is wrong in which file and line;
 * STATUS_MEMORY. */
status output_read(const struct definition *definition, const char *folder, double *values, struct fragment **fragments,
                   size_t *count, const char **not_finite, struct error *error);

/* The last words of a text file, in one line; empty: none. */
void output_last_words(const char *folder, const char *name, char *words, size_t size);

#endif
