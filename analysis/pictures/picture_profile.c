/* Quantities along a line: one panel each, one above the other over the same axis. */
#include <math.h>

#include "analysis/pictures/chart.h"

enum { MOST_PANELS = 3 };

static void extend(double range[2], double value) {
  if (!isfinite(value))
    return;
  range[0] = fmin(range[0], value);
  range[1] = fmax(range[1], value);
}

/* The range of a panel, with some space above and below. A panel without a finite value shows 0 to 1. */
static void range_of(size_t count, const struct picture_profile *panel, double range[2]) {
  range[0] = panel->at_least[0];
  range[1] = panel->at_least[1];
  for (size_t i = 0; i < count; i++)
    extend(range, panel->y[i]);
  if (!(range[1] >= range[0])) {
    range[0] = 0;
    range[1] = 1;
  }
  const double margin = range[1] > range[0] ? 0.06 * (range[1] - range[0]) : fmax(0.05 * fabs(range[1]), 1e-300);
  range[0] -= margin > 1e-300 ? margin : 1;
  range[1] += margin > 1e-300 ? margin : 1;
}

status picture_profile(const struct picture_page *page, const struct picture_words *words, size_t count,
                       const double *x, size_t panels, const struct picture_profile *panel, struct error *error) {
  double along[2] = {HUGE_VAL, -HUGE_VAL};
  const char *labels[MOST_PANELS];
  double low[MOST_PANELS], high[MOST_PANELS];
  for (size_t i = 0; i < count; i++)
    extend(along, x[i]);
  if (panels < 1 || panels > MOST_PANELS || !(along[1] > along[0]))
    return status_fail(error, STATUS_USAGE, "%s: there is nothing to draw", page->path);
  struct chart *chart = chart_new("profile");
  if (!chart)
    return status_fail(error, STATUS_MEMORY, "%s: no memory for the chart", page->path);
  chart_words(chart, page, words);
  chart_number(chart, "panels", (double)panels);
  chart_number(chart, "x_low", along[0] - 0.02 * (along[1] - along[0]));
  chart_number(chart, "x_high", along[1] + 0.02 * (along[1] - along[0]));
  chart_number(chart, "points", (double)count);
  for (size_t k = 0; k < panels; k++) {
    double range[2];
    range_of(count, &panel[k], range);
    low[k] = range[0];
    high[k] = range[1];
    labels[k] = panel[k].label;
  }
  chart_numbers(chart, "low", panels, low);
  chart_numbers(chart, "high", panels, high);
  chart_texts(chart, "label", panels, labels);
  chart_columns(chart, "x and the value of each panel");
  for (size_t i = 0; i < count; i++) {
    double row[1 + MOST_PANELS] = {x[i]};
    for (size_t k = 0; k < panels; k++)
      row[k + 1] = panel[k].y[i];
    chart_row(chart, panels + 1, row);
  }
  chart_block_end(chart);
  return chart_draw(chart, page, (panels > 1 ? 0.32 * (double)panels : 0.5) * page->width + 90, error);
}
