/* Fragment mass spectra of the points, from the bins of single runs. */
#ifndef CLAST_DB_ASK_SPECTRUM_H
#define CLAST_DB_ASK_SPECTRUM_H

#include "db/ask/query.h"

/* One row per point and mass bin: point_id, lower, upper (kg), runs, fragments, density (fragments per kg and run),
 * density_hw95, mass_share. Runs that count, of each point's newest results_version. density_hw95 is the half
 * width of the 95 % interval, from the scatter between runs, because fragments of one run are not independent.
 *
 * point_id: 0 is all points. where: NULL, or an SQL condition on the view runs that the runs must meet.
 * STATUS_USAGE: the condition is no SQL. */
status ask_spectrum(struct store *store, int64_t point_id, const char *where, const struct query_sink *sink,
                    struct error *error);

#endif
