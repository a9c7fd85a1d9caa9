/* A quantity over two axes: one tile for each pair of values, with the value as text where it fits. */
#include <math.h>
#include <stdlib.h>

#include "analysis/pictures/chart.h"
#include "analysis/statistics/sample.h"

enum { MOST_TILES = 10000 };

struct axis {
  size_t count;
  double *values; /* ascending, distinct */
};

static void distinct(size_t count, const double (*points)[3], int coordinate, struct axis *axis) {
  axis->count = 0;
  for (size_t i = 0; i < count; i++)
    axis->values[i] = points[i][coordinate];
  qsort(axis->values, count, sizeof *axis->values, sample_ascending);
  for (size_t i = 0; i < count; i++)
    if (i == 0 || axis->values[i] != axis->values[axis->count - 1])
      axis->values[axis->count++] = axis->values[i];
}

static size_t place(const struct axis *axis, double value) {
  const double *found = bsearch(&value, axis->values, axis->count, sizeof value, sample_ascending);
  return (size_t)(found - axis->values); /* always found: the axis was made from these values */
}

/* Blocks: the tiles (number of column and row from 0, value), the columns' values, the rows' values. */
static void write_tiles(struct chart *chart, const struct axis *x, const struct axis *y, const double *value) {
  chart_columns(chart, "column row value");
  for (size_t j = 0; j < y->count; j++)
    for (size_t i = 0; i < x->count; i++)
      chart_row(chart, 3, (double[]){(double)i, (double)j, value[j * x->count + i]});
  chart_block_end(chart);
  const struct axis *axes[2] = {x, y};
  for (int a = 0; a < 2; a++) {
    chart_columns(chart, a ? "row its-value" : "column its-value");
    for (size_t i = 0; i < axes[a]->count; i++)
      chart_row(chart, 2, (double[]){(double)i, axes[a]->values[i]});
    chart_block_end(chart);
  }
}

static status no_memory(const struct picture_page *page, struct error *error) {
  return status_fail(error, STATUS_MEMORY, "%s: no memory for the map", page->path);
}

static status draw(const struct picture_page *page, const struct picture_words *words, const char *quantity,
                   const struct axis *x, const struct axis *y, const double *value, struct error *error) {
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (size_t i = 0; i < x->count * y->count; i++)
    if (isfinite(value[i])) {
      low = fmin(low, value[i]);
      high = fmax(high, value[i]);
    }
  if (!(high >= low))
    return status_fail(error, STATUS_USAGE, "%s: there is no value to draw", page->path);
  struct chart *chart = chart_new("map");
  if (!chart)
    return no_memory(page, error);
  chart_words(chart, page, words);
  chart_text(chart, "quantity", quantity);
  chart_number(chart, "columns", (double)x->count);
  chart_number(chart, "rows", (double)y->count);
  chart_number(chart, "low", low);
  chart_number(chart, "high", high > low ? high : low + fmax(fabs(low), 1) * 1e-6);
  write_tiles(chart, x, y, value);
  return chart_draw(chart, page, 0.72 * page->width, error);
}

/* Sorts the points into tiles, a row for each value of y. */
static status draw_points(const struct picture_page *page, const struct picture_words *words, const char *quantity,
                          size_t count, const double (*points)[3], struct axis *x, struct axis *y,
                          struct error *error) {
  distinct(count, points, 0, x);
  distinct(count, points, 1, y);
  const size_t tiles = x->count * y->count;
  if (tiles > MOST_TILES)
    return status_fail(error, STATUS_USAGE, "%s: %zu x %zu tiles are too many for a map; choose axes with fewer values",
                       page->path, x->count, y->count);
  double *value = malloc(tiles * sizeof *value);
  if (!value)
    return no_memory(page, error);
  for (size_t i = 0; i < tiles; i++)
    value[i] = NAN;
  for (size_t i = 0; i < count; i++)
    value[place(y, points[i][1]) * x->count + place(x, points[i][0])] = points[i][2];
  const status code = draw(page, words, quantity, x, y, value, error);
  free(value);
  return code;
}

status picture_map(const struct picture_page *page, const struct picture_words *words, const char *quantity,
                   size_t count, const double (*points)[3], struct error *error) {
  if (count == 0)
    return status_fail(error, STATUS_USAGE, "%s: an axis of the map is empty or not finite", page->path);
  for (size_t i = 0; i < count; i++)
    if (!isfinite(points[i][0]) || !isfinite(points[i][1]))
      return status_fail(error, STATUS_USAGE, "%s: a point of the map is not on its axes", page->path);
  struct axis x = {.values = malloc(count * sizeof *x.values)}, y = {.values = malloc(count * sizeof *y.values)};
  const status code = x.values && y.values ? draw_points(page, words, quantity, count, points, &x, &y, error)
                                           : no_memory(page, error);
  free(x.values);
  free(y.values);
  return code;
}
