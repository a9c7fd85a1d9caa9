/* Spectra as rows, and their distances from a measured spectrum. */
#ifndef CLAST_CAMPAIGN_PRINT_SPECTRUM_TABLE_H
#define CLAST_CAMPAIGN_PRINT_SPECTRUM_TABLE_H

#include "campaign/charts/spectrum_curves.h"

/* Prints one row per bin of each pool (or of each run). */
status spectrum_table_print(struct store *store, const struct spectrum_choice *choice, enum table_format format,
                            struct error *error);
/* Prints one row per pool: its distance from the measured spectrum. */
status spectrum_table_match(struct store *store, const struct spectrum_choice *choice, enum table_format format,
                            struct error *error);

#endif
