/* What `clast converge` prints and draws. */
#ifndef CLAST_CAMPAIGN_CONVERGE_STUDY_PRINT_H
#define CLAST_CAMPAIGN_CONVERGE_STUDY_PRINT_H

#include "campaign/converge/study.h"
#include "campaign/terminal/table.h"

/* Prints all knobs of all engines. */
status study_print_knobs(enum table_format format, struct error *error);

/* For people a table per scene and quantity, with a sentence per knob and, unless `quiet`, a legend on stderr. For
 * programs the rows of convergence_table. */
status study_print(const struct study *study, enum table_format format, bool quiet, struct error *error);

/* Draws the mean with its interval over the processor time of a run, or (`of_errors`) the error of each level and the
 * frontier: one curve per knob of the first scene and quantity. */
status study_picture(const struct study *study, bool of_errors, const char *path, struct error *error);

#endif
