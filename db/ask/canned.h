/* Ready queries, by name. */
#ifndef CLAST_DB_ASK_CANNED_H
#define CLAST_DB_ASK_CANNED_H

#include <stddef.h>

#include "schemas/status.h"

/* Canned queries: a name, its question in a sentence, its SQL, the names of its parameters. */
struct query_canned {
  const char *name, *doc, *sql;
  const char *parameters; /* comma-separated, "" for none */
};
size_t ask_canned_count(void);
const struct query_canned *ask_canned_at(size_t index);
/* Finds a canned query by name. NULL: *error lists the known names. */
const struct query_canned *ask_canned_find(const char *name, struct error *error);

#endif
