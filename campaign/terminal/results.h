/* Results of one run on stdout: for people one quantity per line with unit and meaning, for programs one row. */
#ifndef CLAST_CAMPAIGN_TERMINAL_RESULTS_H
#define CLAST_CAMPAIGN_TERMINAL_RESULTS_H

#include "campaign/driver/run.h"
#include "campaign/terminal/table.h"

/* Path, value (off and NaN are missing), unit and first sentence of a row of the object: four cells. */
void results_row(struct table *table, const struct field *row, const void *object);

status results_print(const struct scene *scene, int64_t seed, const struct run_result *result, enum table_format format,
                     struct error *error);

#endif
