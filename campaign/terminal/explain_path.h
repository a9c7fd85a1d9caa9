/* Explains the path of an input, a result or a key of a campaign. */
#ifndef CLAST_CAMPAIGN_TERMINAL_EXPLAIN_PATH_H
#define CLAST_CAMPAIGN_TERMINAL_EXPLAIN_PATH_H

#include "campaign/terminal/table.h"

/* Explains on stdout all rows that a path, its unique ending, a section or a key names. STATUS_CONTENT: there is none;
 * *error has the nearest known path. */
status explain_path(const char *path, struct error *error);
/* A table of all paths, on stdout. */
status explain_path_list(enum table_format format, struct error *error);

#endif
