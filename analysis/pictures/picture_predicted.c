/* Measured numbers beside the intervals predicted by a fit, both divided by the measured value. */
#include <math.h>

#include "analysis/pictures/chart.h"

static const double LETTER = 8.3; /* pixels */

/* A row is divided by its measured value. */
static bool can_be_drawn(const struct picture_prediction *row) {
  return row->measured != 0 && isfinite(row->quantile[0]);
}

static void widen(const struct picture_prediction *row, double *low, double *high) {
  for (int q = 0; q < PICTURE_QUANTILES; q++) {
    *low = fmin(*low, row->quantile[q] / row->measured);
    *high = fmax(*high, row->quantile[q] / row->measured);
  }
  *low = fmin(*low, 1 - row->error / fabs(row->measured));
  *high = fmax(*high, 1 + row->error / fabs(row->measured));
}

status picture_predicted(const struct picture_page *page, const struct picture_words *words, size_t count,
                         const struct picture_prediction *row, struct error *error) {
  const char *legend[] = {"90 % of predicted experiments", "50 %", "measured, with its standard deviation", "median"};
  const char *labels[PICTURE_PREDICTIONS];
  double low = 1, high = 1;
  size_t rows = 0, letters = 0;
  for (size_t k = 0; k < count; k++) {
    if (!can_be_drawn(&row[k]) || rows == PICTURE_PREDICTIONS)
      continue;
    const size_t own = chart_letters(row[k].label);
    letters = own > letters ? own : letters;
    labels[rows++] = row[k].label;
    widen(&row[k], &low, &high);
  }
  if (rows == 0)
    return status_fail(error, STATUS_USAGE, "%s: there is nothing to draw", page->path);
  struct chart *chart = chart_new("predicted");
  if (!chart)
    return status_fail(error, STATUS_MEMORY, "%s: no memory for the chart", page->path);
  chart_words(chart, page, words);
  chart_number(chart, "rows", (double)rows);
  chart_number(chart, "left_margin", fmin(40 + LETTER * (double)letters, 0.6 * page->width));
  chart_number(chart, "x_low", low - 0.05 * (high - low + 0.1));
  chart_number(chart, "x_high", high + 0.05 * (high - low + 0.1));
  chart_texts(chart, "row_label", rows, labels);
  chart_texts(chart, "label", 4, legend);
  const double below = chart_legend(chart, page, 4, legend);
  chart_columns(chart, "row, measured, error, quantiles 5 25 50 75 95 %, over the measured value");
  for (size_t k = 0, at = rows; k < count && at > 0; k++) {
    const double m = row[k].measured, *q = row[k].quantile;
    if (!can_be_drawn(&row[k]))
      continue;
    at--;
    chart_row(chart, 8,
              (double[]){(double)at, 1, row[k].error / fabs(m), q[0] / m, q[1] / m, q[2] / m, q[3] / m, q[4] / m});
  }
  chart_block_end(chart);
  return chart_draw(chart, page, 46 * (double)rows + 150 + below, error);
}
