/* Means over an input, with their intervals: one line for each value of a second input. */
#include <math.h>

#include "analysis/pictures/chart.h"

static const double none = NAN;
static const double LOG_FROM = 20; /* x is logarithmic if its ends differ by at least this factor */

/* Smallest and largest x of the means that have a value. False: there are none. */
static bool range_of(size_t count, const struct picture_curve *curve, double range[2]) {
  range[0] = HUGE_VAL;
  range[1] = -HUGE_VAL;
  for (size_t c = 0; c < count; c++)
    for (size_t i = 0; i < curve[c].count; i++)
      if (isfinite(curve[c].mean[i].x) && isfinite(curve[c].mean[i].y)) {
        range[0] = fmin(range[0], curve[c].mean[i].x);
        range[1] = fmax(range[1], curve[c].mean[i].x);
      }
  return range[1] >= range[0];
}

/* Writes a mean, its interval, and the interval plus the resolution error. */
static void write_mean(struct chart *chart, const struct picture_mean *m) {
  const bool bar = isfinite(m->low) && isfinite(m->high) && m->low < m->high;
  const double low = bar ? m->low : m->y, high = bar ? m->high : m->y;
  double row[6] = {m->x, m->y, none, none, none, none};
  if (bar) {
    row[2] = low;
    row[3] = high;
  }
  if (m->resolution > 0) {
    row[4] = low - m->resolution;
    row[5] = high + m->resolution;
  }
  chart_row(chart, 6, row);
}

static void write_curve(struct chart *chart, const struct picture_curve *curve) {
  chart_columns(chart, "x mean low high thin_low thin_high");
  for (size_t i = 0; i < curve->count; i++)
    write_mean(chart, &curve->mean[i]);
  if (curve->count == 0)
    chart_row(chart, 6, (double[]){NAN, NAN, NAN, NAN, NAN, NAN});
  chart_block_end(chart);
}

/* Writes the range of the axis, with some space at both ends. */
static void write_range(struct chart *chart, const double range[2]) {
  const bool logarithmic = range[0] > 0 && range[1] >= LOG_FROM * range[0];
  double margin = 0.05 * (range[1] - range[0]);
  if (!(margin > 0))
    margin = range[1] != 0 ? 0.05 * fabs(range[1]) : 1;
  const double factor = pow(range[1] / range[0], 0.05);
  chart_number(chart, "log_x", logarithmic);
  chart_number(chart, "x_low", logarithmic ? range[0] / factor : range[0] - margin);
  chart_number(chart, "x_high", logarithmic ? range[1] * factor : range[1] + margin);
}

status picture_curves(const struct picture_page *page, const struct picture_words *words, size_t count,
                      const struct picture_curve *curve, struct error *error) {
  double range[2];
  const char *labels[PICTURE_SERIES];
  if (count > PICTURE_SERIES)
    return status_fail(error, STATUS_USAGE, "%s: %zu curves are too many for one chart; at most %d", page->path, count,
                       PICTURE_SERIES);
  if (!range_of(count, curve, range))
    return status_fail(error, STATUS_USAGE, "%s: there is nothing to draw", page->path);
  struct chart *chart = chart_new("lines");
  if (!chart)
    return status_fail(error, STATUS_MEMORY, "%s: no memory for the chart", page->path);
  chart_words(chart, page, words);
  chart_number(chart, "series", (double)count);
  write_range(chart, range);
  for (size_t c = 0; c < count; c++) {
    labels[c] = curve[c].label;
    write_curve(chart, &curve[c]);
  }
  chart_texts(chart, "label", count, labels);
  const double legend = chart_legend(chart, page, count, labels);
  return chart_draw(chart, page, 0.62 * page->width + legend, error);
}
