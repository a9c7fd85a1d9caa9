/* The lines of `clast plot`: means of a quantity over one input, a line for each value of another. */
#ifndef CLAST_CAMPAIGN_CHARTS_PLOT_LINES_H
#define CLAST_CAMPAIGN_CHARTS_PLOT_LINES_H

#include "campaign/charts/quantity.h"
#include "campaign/terminal/chart_option.h"

/* Reads the quantity over `x`, a line for each value of `by` (may be NULL), and draws it. STATUS_USAGE: x is not a
 * number, too many lines or points, unknown names. */
status plot_lines_draw(struct store *store, const char *x, const char *by, const char *quantity,
                       const struct picture_page *page, struct error *error);

#endif
