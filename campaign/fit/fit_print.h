/* What `clast fit` prints and draws. */
#ifndef CLAST_CAMPAIGN_FIT_FIT_PRINT_H
#define CLAST_CAMPAIGN_FIT_FIT_PRINT_H

#include "campaign/charts/charts.h"
#include "campaign/fit/fit.h"
#include "campaign/terminal/table.h"

/* For people a table of the inputs, a table of the measurements, and conclusions in sentences. For programs one table:
 * rows of kind input, then of kind measured, then of kind check. */
status fit_print(const struct fit *fit, enum table_format format, struct error *error);

/* Draws the measurements beside the predictions for one more experiment. */
status fit_print_picture(const struct fit *fit, const char *path, const struct chart_options *chart,
                         struct error *error);

#endif
