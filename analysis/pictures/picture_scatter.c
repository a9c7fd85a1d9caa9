/* Scatter of runs: histograms and distribution functions, one above the other. */
#include <math.h>

#include "analysis/pictures/chart.h"

enum { MOST_STEPS = 2000 }; /* steps of a distribution function; finer ones cannot be seen */

static void write_histogram(struct chart *chart, const struct picture_sample *s) {
  const struct scatter_histogram *h = &s->histogram;
  chart_columns(chart, "from share-of-runs");
  chart_row(chart, 2, (double[]){h->from, 0});
  for (size_t b = 0; b < h->bins; b++)
    for (int end = 0; end < 2; end++)
      chart_row(chart, 2,
                (double[]){h->from + (double)(b + (size_t)end) * h->width, (double)h->count[b] / (double)s->count});
  chart_row(chart, 2, (double[]){h->from + (double)h->bins * h->width, 0});
  chart_block_end(chart);
}

static void write_distribution(struct chart *chart, const struct picture_sample *s) {
  const size_t each = s->count / MOST_STEPS + 1;
  chart_columns(chart, "value share-at-most");
  chart_row(chart, 2, (double[]){s->value[0], 0});
  for (size_t i = 0; i < s->count; i++)
    if (i % each == each - 1 || i + 1 == s->count)
      chart_row(chart, 2, (double[]){s->value[i], (double)(i + 1) / (double)s->count});
  chart_block_end(chart);
}

status picture_scatter(const struct picture_page *page, const struct picture_words *words, size_t count,
                       const struct picture_sample *sample, struct error *error) {
  const char *labels[PICTURE_SERIES];
  double low = HUGE_VAL, high = -HUGE_VAL;
  if (count < 1 || count > PICTURE_SERIES)
    return status_fail(error, STATUS_USAGE, "%s: one to %d samples in a picture, not %zu", page->path, PICTURE_SERIES,
                       count);
  for (size_t s = 0; s < count; s++) {
    if (sample[s].count == 0)
      return status_fail(error, STATUS_USAGE, "%s: there is no value to draw", page->path);
    low = fmin(low, sample[s].histogram.from);
    high = fmax(high, sample[s].histogram.from + (double)sample[s].histogram.bins * sample[s].histogram.width);
    labels[s] = sample[s].label;
  }
  struct chart *chart = chart_new("scatter");
  if (!chart)
    return status_fail(error, STATUS_MEMORY, "%s: no memory for the chart", page->path);
  chart_words(chart, page, words);
  chart_number(chart, "series", (double)count);
  chart_number(chart, "x_low", low - 0.02 * (high - low));
  chart_number(chart, "x_high", high + 0.02 * (high - low));
  for (size_t s = 0; s < count; s++)
    write_histogram(chart, &sample[s]);
  for (size_t s = 0; s < count; s++)
    write_distribution(chart, &sample[s]);
  chart_texts(chart, "label", count, labels);
  const double legend = chart_legend(chart, page, count, labels);
  chart_number(chart, "legend_height", legend);
  return chart_draw(chart, page, 0.9 * page->width + legend, error);
}
