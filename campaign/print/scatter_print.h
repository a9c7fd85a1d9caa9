/* How the runs of pools scatter, as rows, text and a picture, and the split of a variance. */
#ifndef CLAST_CAMPAIGN_PRINT_SCATTER_PRINT_H
#define CLAST_CAMPAIGN_PRINT_SCATTER_PRINT_H

#include "analysis/pictures/picture.h"
#include "campaign/terminal/table.h"
#include "db/ask/pool.h"

struct scatter_choice {
  struct ask_pool_choice pool;
  const char *quantity;
  double half_width; /* wanted half width of the mean's interval, in the quantity's unit; NaN: none */
};

/* Prints a row per statistic of each pool. */
status scatter_print_rows(struct store *store, const struct scatter_choice *choice, enum table_format format,
                          struct error *error);
/* Prints a text histogram of each pool. */
status scatter_print_plots(struct store *store, const struct scatter_choice *choice, bool ascii, struct error *error);
/* Draws histograms and distribution functions of the first eight pools. */
status scatter_print_picture(struct store *store, const struct scatter_choice *choice, const struct picture_page *page,
                             struct error *error);
/* Prints a row per part of the variance over all points. */
status scatter_print_split(struct store *store, const struct scatter_choice *choice, enum table_format format,
                           struct error *error);

#endif
