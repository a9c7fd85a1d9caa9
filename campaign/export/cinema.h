/* A Cinema database: a folder with pictures and a table of them (data.csv, Cinema specification D), which the Cinema
 * viewers open: the validator cinema_lib 1.2.1 finds it valid, also with empty cells, and Cinema:View 1.1 shows every
 * row. */
#ifndef CLAST_CAMPAIGN_EXPORT_CINEMA_H
#define CLAST_CAMPAIGN_EXPORT_CINEMA_H

#include "db/store/store.h"

/* One row per run whose fields are kept: its inputs and main results, FILE (its broken body) and FILE_spectrum
 * (spectrum of its point). data.csv is written last. Reports how many runs have no picture because their fields cannot
 * be read. STATUS_USAGE: the store has no run with fields. STATUS_MISSING: no gnuplot. STATUS_IO. */
status cinema_write(struct store *store, const char *folder, struct error *error);

#endif
