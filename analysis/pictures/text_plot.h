/* A log-log spectrum as text, for a terminal: one row per bin, density along the row. */
#ifndef CLAST_ANALYSIS_PICTURES_TEXT_PLOT_H
#define CLAST_ANALYSIS_PICTURES_TEXT_PLOT_H

#include <stdbool.h>
#include <stdio.h>

#include "analysis/pictures/picture.h"

/* Writes one row per bin:
 *     lower edge   count   F(m)   error in %      ├──●──┤  ·
 * the point, one standard error to both sides, and (·) the series' first fit. columns: width of the terminal, at least
 * 72 are used. unicode: false for ASCII only. It writes no colour, and nothing when there is no fragment. */
void text_plot_spectrum(FILE *out, int columns, bool unicode, const char *mass_unit,
                        const struct picture_series *series);

#endif
