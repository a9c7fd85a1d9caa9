/* A log-log spectrum as text, for a terminal: one row per bin, density along the row. */
#ifndef CLAST_ANALYSIS_PICTURES_TEXT_PLOT_H
#define CLAST_ANALYSIS_PICTURES_TEXT_PLOT_H

#include <stdbool.h>
#include <stdio.h>

#include "analysis/pictures/picture.h"

/* Writes the series' bins as rows
 *     lower edge   count   F(m)   error in %      ├──●──┤  ·
 * with the point, one standard error to both sides and (·) its first fit. columns: of the terminal, at least 72 is
 * used. unicode: false for ASCII only. Writes nothing else (no colour); no rows when there is no fragment. */
void text_plot_spectrum(FILE *out, int columns, bool unicode, const char *mass_unit,
                        const struct picture_series *series);

/* A row of eighths ▁▂▃▅▇ over values (NaN leaves a blank), low and high set the scale; for progress and tables. `text`
 * needs 3 * n + 1 bytes (n + 1 without unicode: then digits 0-7). */
void text_plot_sparkline(size_t n, const double *values, double low, double high, bool unicode, char *text);

#endif
