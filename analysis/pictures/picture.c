/* Charts: each gathers its numbers, sets the variables of its template (templates/NAME.gp) and has gnuplot draw it. The
 * tiles of margins alone are drawn with cairo. */
#include "analysis/pictures/picture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "analysis/pictures/picture_canvas.h"
#include "schemas/memory.h"

static const double none[2] = {HUGE_VAL, -HUGE_VAL}; /* a range without a value */

static void extend(double range[2], double value) {
  if (!isfinite(value))
    return;
  range[0] = fmin(range[0], value);
  range[1] = fmax(range[1], value);
}

static status nothing_to_draw(const struct picture_page *page, struct error *error) {
  return status_fail(error, STATUS_USAGE, "%s: there is nothing to draw", page->path);
}

/* ---- means over an input, with their intervals: one line for each value of a second input ---- */

static const double LOG_FROM = 20; /* an axis is logarithmic if its ends differ by at least this factor, and if the
                                    * median of its values is nearer to the middle of such an axis */

static const double none_of_seven[7] = {NAN, NAN, NAN, NAN, NAN, NAN, NAN};

static void write_curve(struct chart *chart, const struct picture_curve *curve) {
  const struct sample_range any = sample_range(NULL), *range = curve->range ? curve->range : &any;
  chart_columns(chart, "x mean low high thin_low thin_high doubtful");
  for (size_t i = 0; i < curve->count; i++) {
    const struct picture_mean *m = &curve->mean[i];
    const bool bar = isfinite(m->low) && isfinite(m->high) && m->low < m->high;
    const double low = bar ? m->low : m->y, high = bar ? m->high : m->y;
    double row[7] = {m->x, m->y, NAN, NAN, NAN, NAN, m->doubtful};
    if (bar) {
      row[2] = fmax(low, range->least);
      row[3] = fmin(high, range->most);
    }
    if (m->resolution > 0) {
      row[4] = fmax(low - m->resolution, range->least);
      row[5] = fmin(high + m->resolution, range->most);
    }
    chart_row(chart, 7, row);
    if (curve->scattered)
      chart_row(chart, 7, none_of_seven); /* ends the line */
  }
  if (curve->count == 0)
    chart_row(chart, 7, none_of_seven);
  chart_block_end(chart);
}

/* Writes the range of the axis 'x' or 'y', with some space at both ends. `median`: of its values; NaN: not known. */
static void write_range(struct chart *chart, char axis, const double range[2], double median) {
  const double even = fabs((median - range[0]) / (range[1] - range[0]) - 0.5);
  const double by_factors = fabs(log(median / range[0]) / log(range[1] / range[0]) - 0.5);
  const bool logarithmic = range[0] > 0 && range[1] >= LOG_FROM * range[0] && !(even < by_factors);
  double margin = 0.05 * (range[1] - range[0]);
  if (!(margin > 0))
    margin = range[1] != 0 ? 0.05 * fabs(range[1]) : 1;
  const double factor = pow(range[1] / range[0], 0.05);
  chart_number(chart, axis == 'x' ? "log_x" : "log_y", logarithmic);
  chart_number(chart, axis == 'x' ? "x_low" : "y_low", logarithmic ? range[0] / factor : range[0] - margin);
  chart_number(chart, axis == 'x' ? "x_high" : "y_high", logarithmic ? range[1] * factor : range[1] + margin);
}

status picture_curves(const struct picture_page *page, const struct picture_words *words, size_t count,
                      const struct picture_curve *curve, struct error *error) {
  double range[2] = {none[0], none[1]};
  const char *labels[PICTURE_SERIES];
  double band[PICTURE_SERIES];
  if (count > PICTURE_SERIES)
    return status_fail(error, STATUS_USAGE, "%s: %zu curves are too many for one chart; at most %d", page->path, count,
                       PICTURE_SERIES);
  for (size_t c = 0; c < count; c++)
    for (size_t i = 0; i < curve[c].count; i++)
      if (isfinite(curve[c].mean[i].y))
        extend(range, curve[c].mean[i].x);
  if (!(range[1] >= range[0]))
    return nothing_to_draw(page, error);
  struct chart *chart = chart_new("lines", page, words);
  chart_number(chart, "series", (double)count);
  const size_t places = curve[0].places;
  write_range(chart, 'x', places > 0 ? (double[2]){0.5, (double)places + 0.5} : range, NAN);
  chart_number(chart, "places", (double)places);
  const double names = chart_places(chart, places, curve[0].place);
  for (size_t c = 0; c < count; c++) {
    labels[c] = curve[c].label;
    band[c] = curve[c].band;
    write_curve(chart, &curve[c]);
  }
  chart_numbers(chart, "band", count, band);
  const double legend = chart_legend(chart, count, labels);
  return chart_draw(chart, 0.62 * page->width + names + legend, error);
}

/* ---- scatter of runs: histograms and distribution functions, one above the other ---- */

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
  double range[2] = {none[0], none[1]};
  if (count < 1 || count > PICTURE_SERIES)
    return status_fail(error, STATUS_USAGE, "%s: one to %d samples in a picture, not %zu", page->path, PICTURE_SERIES,
                       count);
  for (size_t s = 0; s < count; s++) {
    if (sample[s].count == 0)
      return status_fail(error, STATUS_USAGE, "%s: there is no value to draw", page->path);
    const struct scatter_histogram *h = &sample[s].histogram;
    extend(range, h->from);
    extend(range, h->from + (double)h->bins * h->width);
    labels[s] = sample[s].label;
  }
  struct chart *chart = chart_new("scatter", page, words);
  chart_number(chart, "series", (double)count);
  chart_number(chart, "x_low", range[0] - 0.02 * (range[1] - range[0]));
  chart_number(chart, "x_high", range[1] + 0.02 * (range[1] - range[0]));
  for (size_t s = 0; s < count; s++)
    write_histogram(chart, &sample[s]);
  for (size_t s = 0; s < count; s++)
    write_distribution(chart, &sample[s]);
  const double legend = chart_legend(chart, count, labels);
  chart_number(chart, "legend_height", legend);
  return chart_draw(chart, 0.9 * page->width + legend, error);
}

/* ---- quantities along a line: one panel each, one above the other over the same axis ---- */

enum { MOST_PANELS = 3 };

/* The range of a panel, with some space above and below. A panel without a finite value shows 0 to 1. */
static void range_of_panel(size_t count, const struct picture_profile *panel, double range[2]) {
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
  double along[2] = {none[0], none[1]};
  const char *labels[MOST_PANELS];
  double low[MOST_PANELS], high[MOST_PANELS];
  for (size_t i = 0; i < count; i++)
    extend(along, x[i]);
  if (panels < 1 || panels > MOST_PANELS || !(along[1] > along[0]))
    return nothing_to_draw(page, error);
  struct chart *chart = chart_new("profile", page, words);
  chart_number(chart, "panels", (double)panels);
  chart_number(chart, "x_low", along[0] - 0.02 * (along[1] - along[0]));
  chart_number(chart, "x_high", along[1] + 0.02 * (along[1] - along[0]));
  chart_number(chart, "points", (double)count);
  for (size_t k = 0; k < panels; k++) {
    double range[2];
    range_of_panel(count, &panel[k], range);
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
  return chart_draw(chart, (panels > 1 ? 0.32 * (double)panels : 0.5) * page->width + 90, error);
}

/* ---- measured numbers beside the intervals predicted by a fit, both divided by the measured value ---- */

/* A row is divided by its measured value. */
static bool can_be_drawn(const struct picture_prediction *row) {
  return row->measured != 0 && isfinite(row->quantile[0]);
}

status picture_predicted(const struct picture_page *page, const struct picture_words *words, size_t count,
                         const struct picture_prediction *row, struct error *error) {
  const char *legend[] = {"90 % of predicted experiments", "50 %", "measured, with its standard deviation", "median"};
  const char *labels[PICTURE_PREDICTIONS];
  double range[2] = {1, 1};
  size_t rows = 0, letters = 0;
  for (size_t k = 0; k < count; k++) {
    if (!can_be_drawn(&row[k]) || rows == PICTURE_PREDICTIONS)
      continue;
    const size_t own = chart_letters(row[k].label);
    letters = own > letters ? own : letters;
    labels[rows++] = row[k].label;
    for (int q = 0; q < PICTURE_QUANTILES; q++)
      extend(range, row[k].quantile[q] / row[k].measured);
    extend(range, 1 - row[k].error / fabs(row[k].measured));
    extend(range, 1 + row[k].error / fabs(row[k].measured));
  }
  if (rows == 0)
    return nothing_to_draw(page, error);
  struct chart *chart = chart_new("predicted", page, words);
  chart_number(chart, "rows", (double)rows);
  chart_number(chart, "left_margin", fmin(40 + 8.3 * (double)letters, 0.6 * page->width));
  const double margin = 0.05 * (range[1] - range[0] + 0.1);
  chart_number(chart, "x_low", range[0] - margin);
  chart_number(chart, "x_high", range[1] + margin);
  chart_texts(chart, "row_label", rows, labels);
  (void)chart_legend(chart, 4, legend);
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
  return chart_draw(chart, 46 * (double)rows + 240, error); /* a long row_label leaves the legend one column */
}

/* ---- a quantity over two axes: one tile for each pair of values, with the value as text where it fits ---- */

enum { MOST_TILES = 10000 };

struct axis {
  size_t count;
  double *values; /* ascending, distinct */
};

static void distinct(size_t count, const struct picture_tile *tiles, bool of_y, struct axis *axis) {
  axis->count = 0;
  for (size_t i = 0; i < count; i++)
    axis->values[i] = of_y ? tiles[i].y : tiles[i].x;
  qsort(axis->values, count, sizeof *axis->values, sample_ascending);
  for (size_t i = 0; i < count; i++)
    if (i == 0 || axis->values[i] != axis->values[axis->count - 1])
      axis->values[axis->count++] = axis->values[i];
}

static size_t place(const struct axis *axis, double value) {
  const double *found = bsearch(&value, axis->values, axis->count, sizeof value, sample_ascending);
  return (size_t)(found - axis->values); /* always found: the axis was made from these values */
}

struct map {
  struct axis x, y;
  size_t panels, columns;           /* columns: of all panels, and one between two panels */
  const struct picture_tile **tile; /* row by row. Owned; NULL: nothing there */
};

enum {
  VALUE,
  NONE,
  BETWEEN
}; /* kinds of places of a map, for its template: gnuplot cannot ask whether a value is NaN */

/* Tiles that share no value of an axis, as a Latin hypercube has them: their places are those of their values. */
static void write_points(struct chart *chart, const struct map *map, size_t count, const struct picture_tile *tiles) {
  for (int a = 0; a < 2; a++) {
    const struct axis *axis = a ? &map->y : &map->x;
    write_range(chart, a ? 'y' : 'x', (const double[2]){axis->values[0], axis->values[axis->count - 1]},
                axis->values[axis->count / 2]);
  }
  chart_columns(chart, "x y value doubtful decimals kind weak");
  for (size_t i = 0; i < count; i++)
    chart_row(chart, 7,
              (double[]){tiles[i].x, tiles[i].y, tiles[i].value, tiles[i].doubtful, tiles[i].decimals,
                         isfinite(tiles[i].value) ? VALUE : NONE, tiles[i].weak});
  chart_block_end(chart);
}

/* Blocks: the tiles (number of column and row from 0, value, doubtful, decimals, kind, weak), the columns' values, the
 * rows' values. */
static void write_tiles(struct chart *chart, const struct map *map) {
  const size_t wide = map->x.count + 1;
  chart_columns(chart, "column row value doubtful decimals kind weak");
  for (size_t j = 0; j < map->y.count; j++)
    for (size_t i = 0; i < map->columns; i++) {
      const struct picture_tile *tile = map->tile[j * map->columns + i];
      const bool has = tile && isfinite(tile->value);
      chart_row(chart, 7,
                (double[]){(double)i, (double)j, has ? tile->value : (double)NAN, has && tile->doubtful,
                           has ? tile->decimals : -1,
                           has                        ? VALUE
                           : i % wide == map->x.count ? BETWEEN
                                                      : NONE,
                           has && tile->weak});
    }
  chart_block_end(chart);
  chart_columns(chart, "column its-value");
  for (size_t i = 0; i < map->columns; i++)
    if (i % wide < map->x.count)
      chart_row(chart, 2, (double[]){(double)i, map->x.values[i % wide]});
  chart_block_end(chart);
  chart_columns(chart, "row its-value");
  for (size_t j = 0; j < map->y.count; j++)
    chart_row(chart, 2, (double[]){(double)j, map->y.values[j]});
  chart_block_end(chart);
}

static status draw_map(const struct picture_page *page, const struct picture_words *words, const char *quantity,
                       const struct map *map, size_t count, const struct picture_tile *tiles, const char *const *panel,
                       struct error *error) {
  double range[2] = {none[0], none[1]};
  for (size_t i = 0; i < count; i++)
    extend(range, tiles[i].value);
  if (!(range[1] >= range[0]))
    return status_fail(error, STATUS_USAGE, "%s: there is no value to draw", page->path);
  struct chart *chart = chart_new("map", page, words);
  chart_text(chart, "quantity", quantity);
  chart_number(chart, "columns", (double)map->columns);
  chart_number(chart, "rows", (double)map->y.count);
  chart_number(chart, "panel_columns", (double)map->x.count);
  chart_number(chart, "panels", panel ? (double)map->panels : 0);
  chart_texts(chart, "panel_label", panel ? map->panels : 0, panel);
  chart_number(chart, "low", range[0]);
  chart_number(chart, "high", range[1] > range[0] ? range[1] : range[0] + (range[0] != 0 ? 0.1 * fabs(range[0]) : 1));
  chart_number(chart, "scattered", !map->tile);
  if (map->tile)
    write_tiles(chart, map);
  else
    write_points(chart, map, count, tiles);
  return chart_draw(chart, (map->panels > 1 ? 0.5 : 0.72) * page->width, error);
}

status picture_map(const struct picture_page *page, const struct picture_words *words, const char *quantity,
                   size_t count, const struct picture_tile *tiles, size_t panels, const char *const *panel,
                   struct error *error) {
  if (count == 0)
    return status_fail(
        error, STATUS_USAGE,
        "%s: no point has a number on both axes of the map: take two inputs that the same points have (-x, -y)",
        page->path);
  for (size_t i = 0; i < count; i++)
    if (!isfinite(tiles[i].x) || !isfinite(tiles[i].y))
      return status_fail(error, STATUS_USAGE, "%s: a point of the map is not on its axes", page->path);
  OWNED double *along = NULL;
  TRY(memory_array(&along, 2 * count, sizeof *along, "the map", error));
  struct map map = {.x = {.values = along}, .y = {.values = along + count}, .panels = panel ? panels : 1};
  distinct(count, tiles, false, &map.x);
  distinct(count, tiles, true, &map.y);
  if (map.panels == 1 && count > 2 && map.x.count == count && map.y.count == count)
    return draw_map(page, words, quantity, &map, count, tiles, panel, error);
  map.columns = map.panels * (map.x.count + 1) - 1;
  if (map.columns * map.y.count > MOST_TILES)
    return status_fail(error, STATUS_USAGE, "%s: %zu x %zu tiles are too many for a map; choose axes with fewer values",
                       page->path, map.columns, map.y.count);
  OWNED const struct picture_tile **places = NULL;
  TRY(memory_array(&places, MOST_TILES, sizeof *places, "the map", error));
  map.tile = places;
  size_t told = 0;
  for (size_t i = 0; i < count; i++) {
    told += isfinite(tiles[i].value);
    map.tile[place(&map.y, tiles[i].y) * map.columns + tiles[i].panel * (map.x.count + 1) +
             place(&map.x, tiles[i].x)] = &tiles[i];
  }
  OWNED char *caption = NULL;
  struct picture_words all = *words;
  if (words->caption && told < map.panels * map.x.count * map.y.count &&
      !strstr(words->caption, "\xc3\x97:")) { /* exponents have their reasons */
    if (asprintf(&caption, "\xc3\x97: no usable run. %s", words->caption) < 0)
      return status_fail(error, STATUS_MEMORY, "no memory for the map");
    all.caption = caption;
  }
  return draw_map(page, &all, quantity, &map, count, tiles, panel, error);
}

/* ---- log-log spectra with error bars or bands, and fitted lines ---- */

enum { MOST_FITS = 3, LABELS = PICTURE_SERIES * (1 + MOST_FITS), LINE_POINTS = 40 };

/* The integral of u^-beta from 1 to `mass` over the lower end of the window. Without an upper end a rising or flat law
 * has none: 700 is about the logarithm of the largest double. */
static double integral(const struct picture_fit *fit, double mass) {
  const double k = fit->beta - 1, span = isinf(mass) ? 700 : log(mass / fit->lower);
  return fabs(k * span) < 1e-9 ? span : -expm1(-k * span) / k;
}

/* N(>= mass) of the law below `upper`, which has n fragments. */
static double law_above(const struct picture_fit *fit, double n, double upper, double mass) {
  return n > 0 ? n * (1 - integral(fit, mass) / integral(fit, upper)) : 0;
}

double picture_spectrum_fit(const struct picture_fit *fit, const struct pooled_form *form, double place) {
  const double mass = spectrum_size_mass(&form->size, place);
  if (!isfinite(fit->beta) || !(mass >= fit->lower) || !(mass < fit->upper) || !(fit->fragments_per_run > 0))
    return NAN;
  if (form->cumulative && !fit->run)
    return law_above(fit, fit->fragments_per_run, fit->upper, mass);
  if (form->cumulative) {
    double sum = 0;
    for (size_t r = 0; r < fit->runs; r++)
      if (fit->run[r].largest >= mass)
        sum += (double)fit->run[r].equal + law_above(fit, (double)fit->run[r].below, fit->run[r].largest, mass);
    return sum / (double)fit->runs;
  }
  const double density = fit->fragments_per_run / (fit->lower * integral(fit, fit->upper)) *
                         pow(mass / fit->lower, -fit->beta);
  /* m ~ L^d: dm/dL = d m/L */
  return form->size.density > 0 ? density * (form->size.dimensions == 2 ? 2 : 3) * mass / place : density;
}

/* Writes a block: the bins of one series. A bar that ends at or below zero has no lower end on a logarithmic axis. */
static void write_bins(struct chart *chart, const struct pooled_form *form, size_t count, const struct pooled_bin *bins,
                       double complete) {
  chart_columns(chart, form->cumulative ? "place N low high complete(1)" : "place density low high complete(1)");
  for (size_t b = 0; b < count; b++) {
    const struct pooled_bin *bin = &bins[b];
    if (!(bin->value > 0) || !(bin->lower > 0))
      continue;
    double low = bin->value - bin->half_width; /* NaN: one run */
    if (low <= 0)
      low = bin->value * 1e-30; /* beyond the frame: no cap is drawn at an end that has no place on the axis */
    const double middle = form->cumulative ? bin->lower : sqrt(bin->lower) * sqrt(bin->upper);
    chart_row(chart, 5, (double[]){middle, bin->value, low, bin->value + bin->half_width, !(bin->lower < complete)});
  }
  chart_row(chart, 5, (double[]){NAN, NAN, NAN, NAN, NAN}); /* a block is never empty */
  chart_block_end(chart);
}

/* Writes a block: the line of a fit. most: the largest place of the chart. */
static void write_fit(struct chart *chart, const struct pooled_form *form, const struct picture_fit *fit, double most) {
  const double from = spectrum_size_of(&form->size, fit->lower);
  const double to = isinf(fit->upper) ? most : spectrum_size_of(&form->size, fit->upper);
  chart_columns(chart, "place value");
  if (from > 0 && to > from)
    for (int i = 0; i < LINE_POINTS; i++) {
      const double place = from * pow(to / from, 0.002 + 0.996 * i / (LINE_POINTS - 1)); /* just inside the window */
      chart_row(chart, 2, (double[]){place, picture_spectrum_fit(fit, form, place)});
    }
  chart_row(chart, 2, (double[]){NAN, NAN});
  chart_block_end(chart);
}

/* Extends the ranges of both axes to the bins and to the upper ends of their bars. */
static void cover(double x[2], double y[2], size_t count, const struct pooled_bin *bins) {
  for (size_t b = 0; b < count; b++) {
    if (!(bins[b].value > 0) || !(bins[b].lower > 0))
      continue;
    extend(x, bins[b].lower);
    extend(x, bins[b].upper);
    extend(y, bins[b].value);
    extend(y, bins[b].value + bins[b].half_width); /* NaN: one run */
  }
}

/* Writes the series, then the thin lines, then the fits. */
static void write_blocks(struct chart *chart, const struct pooled_form *form, size_t count,
                         const struct picture_series *series, double most) {
  enum { MOST_THIN = 1000 };
  double of[LABELS], dashes[LABELS], thin_of[MOST_THIN], measured[PICTURE_SERIES];
  size_t fits = 0, thin = 0;
  for (size_t s = 0; s < count; s++) {
    write_bins(chart, form, series[s].count, series[s].bins, spectrum_size_of(&form->size, series[s].complete_mass));
    measured[s] = series[s].measured;
  }
  for (size_t s = 0; s < count; s++)
    for (size_t i = 0; i < series[s].thin_count && thin < MOST_THIN; i++) {
      thin_of[thin++] = (double)s + 1;
      write_bins(chart, form, series[s].thin[i].count, series[s].thin[i].bins, 0);
    }
  for (size_t s = 0; s < count; s++)
    for (size_t i = 0; i < series[s].fits && i < MOST_FITS; i++) {
      of[fits] = (double)s + 1;
      dashes[fits++] = (double)i + 1;
      write_fit(chart, form, &series[s].fit[i], most);
    }
  chart_number(chart, "series", (double)count);
  chart_number(chart, "thin", (double)thin);
  chart_number(chart, "fits", (double)fits);
  chart_number(chart, "cumulative", form->cumulative);
  chart_numbers(chart, "measured", count, measured);
  chart_numbers(chart, "thin_of", thin, thin_of);
  chart_numbers(chart, "fit_of", fits, of);
  chart_numbers(chart, "fit_dash", fits, dashes);
}

status picture_spectrum(const struct picture_page *page, const struct picture_words *words,
                        const struct pooled_form *form, size_t count, const struct picture_series *series,
                        struct error *error) {
  double x[2] = {none[0], none[1]}, y[2] = {none[0], none[1]};
  const char *labels[LABELS];
  size_t lines = 0;
  if (count < 1 || count > PICTURE_SERIES)
    return status_fail(error, STATUS_USAGE, "%s: one to %d spectra in a picture, not %zu", page->path, PICTURE_SERIES,
                       count);
  for (size_t s = 0; s < count; s++)
    cover(x, y, series[s].count, series[s].bins);
  if (!(x[1] > x[0]))
    return status_fail(error, STATUS_USAGE, "%s: there is no fragment to draw", page->path);
  for (size_t s = 0; s < count; s++) { /* thin lines often have lower densities than the mean of many runs */
    for (size_t i = 0; i < series[s].thin_count; i++)
      cover(x, y, series[s].thin[i].count, series[s].thin[i].bins);
  }
  struct chart *chart = chart_new("spectrum", page, words);
  const double wide = pow(x[1] / x[0], 0.04), tall = 1.3 * pow(y[1] / y[0], 0.08);
  chart_number(chart, "x_low", x[0] / wide);
  chart_number(chart, "x_high", x[1] * wide);
  chart_number(chart, "y_low", y[0] / tall);
  chart_number(chart, "y_high", y[1] * tall);
  write_blocks(chart, form, count, series, x[1]);
  for (size_t s = 0; s < count; s++)
    labels[lines++] = series[s].label;
  for (size_t s = 0; s < count; s++)
    for (size_t i = 0; i < series[s].fits && i < MOST_FITS; i++)
      labels[lines++] = series[s].fit[i].label;
  const double legend = chart_legend(chart, lines, labels);
  return chart_draw(chart, 0.68 * page->width + legend, error);
}

status picture_movie(const struct picture_page *page, double height, size_t count, const char *const *frame,
                     struct error *error) {
  struct chart *chart = chart_new("movie", page, &(struct picture_words){0});
  chart_number(chart, "frames", (double)count);
  chart_texts(chart, "frame", count, frame);
  return chart_draw(chart, height, error);
}

status picture_collapse(const struct picture_page *page, const struct picture_words *words, const char *const panel[2],
                        size_t count, const struct picture_size *size, struct error *error) {
  double x[2] = {none[0], none[1]}, y[2][2] = {{none[0], none[1]}, {none[0], none[1]}}, low[2], high[2];
  const char *labels[PICTURE_SERIES];
  if (count > PICTURE_SERIES)
    return status_fail(error, STATUS_USAGE, "%s: at most %d sizes in a picture, not %zu", page->path, PICTURE_SERIES,
                       count);
  for (size_t s = 0; s < count; s++) {
    labels[s] = size[s].label;
    for (size_t i = 0; i < size[s].count; i++) {
      extend(x, size[s].x[i]);
      for (int k = 0; k < 2; k++)
        extend(y[k], size[s].y[i][k][0] > 0 ? size[s].y[i][k][0] : (double)NAN);
    }
  }
  if (!(x[1] > x[0] && y[0][1] > 0 && y[1][1] > 0))
    return nothing_to_draw(page, error);
  struct chart *chart = chart_new("collapse", page, words);
  chart_number(chart, "series", (double)count);
  chart_number(chart, "x_low", x[0] - 0.02 * (x[1] - x[0]));
  chart_number(chart, "x_high", x[1] + 0.02 * (x[1] - x[0]));
  for (int k = 0; k < 2; k++) {
    low[k] = y[k][0] / 1.5;
    high[k] = y[k][1] * 1.5;
  }
  chart_numbers(chart, "y_low", 2, low);
  chart_numbers(chart, "y_high", 2, high);
  chart_texts(chart, "panel", 2, panel);
  for (size_t s = 0; s < count; s++) {
    for (size_t i = 0; i < size[s].count; i++) {
      double row[7] = {size[s].x[i]};
      for (int k = 0; k < 6; k++)
        row[1 + k] = size[s].y[i][k / 3][0] > 0 ? size[s].y[i][k / 3][k % 3] : (double)NAN;
      for (int k = 0; k < 2; k++) /* a bar that reaches 0 ends at the lower side of the panel */
        row[2 + 3 * k] = fmax(row[2 + 3 * k], low[k]);
      chart_row(chart, 7, row);
    }
    chart_block_end(chart);
  }
  const double legend = chart_legend(chart, count, labels);
  chart_number(chart, "legend_height", legend);
  return chart_draw(chart, 0.9 * page->width + legend, error);
}
