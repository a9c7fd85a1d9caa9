/* Log-log spectra with error bars or bands, and fitted lines. */
#include <math.h>

#include "analysis/pictures/chart.h"

enum { MOST_FITS = 3, LABELS = PICTURE_SERIES * (1 + MOST_FITS), LINE_POINTS = 40 };

double picture_spectrum_fit(const struct picture_fit *fit, const struct pooled_form *form, double place) {
  const double mass = spectrum_size_mass(&form->size, place);
  if (!isfinite(fit->beta) || !(mass >= fit->lower) || !(mass < fit->upper) || !(fit->fragments_per_run > 0))
    return NAN;
  /* The integral of u^-beta from 1 to u = m/lower. Without an upper end a rising or flat law has none: 700 is about
   * the logarithm of the largest double. */
  const double k = fit->beta - 1, span = isinf(fit->upper) ? 700 : log(fit->upper / fit->lower);
  const double whole = fabs(k * span) < 1e-9 ? span : -expm1(-k * span) / k, u = log(mass / fit->lower);
  if (form->cumulative) {
    const double below = fabs(k * span) < 1e-9 ? u : -expm1(-k * u) / k;
    return fit->larger_per_run + fit->fragments_per_run * (whole - below) / whole;
  }
  const double density = fit->fragments_per_run / (fit->lower * whole) * exp(-fit->beta * u);
  /* m ~ L^d: dm/dL = d m/L */
  return form->size.density > 0 ? density * (form->size.dimensions == 2 ? 2 : 3) * mass / place : density;
}

static double middle(const struct pooled_form *form, const struct pooled_bin *bin) {
  return form->cumulative ? bin->lower : sqrt(bin->lower) * sqrt(bin->upper);
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
      low = bin->value / 1e3; /* a bar down to the frame's lower edge or beyond */
    chart_row(chart, 5,
              (double[]){middle(form, bin), bin->value, low, bin->value + bin->half_width, !(bin->lower < complete)});
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

struct ranges {
  double x[2], y[2];
};

static void cover(struct ranges *ranges, size_t count, const struct pooled_bin *bins) {
  for (size_t b = 0; b < count; b++) {
    if (!(bins[b].value > 0) || !(bins[b].lower > 0))
      continue;
    ranges->x[0] = fmin(ranges->x[0], bins[b].lower);
    ranges->x[1] = fmax(ranges->x[1], bins[b].upper);
    ranges->y[0] = fmin(ranges->y[0], bins[b].value);
    ranges->y[1] = fmax(ranges->y[1], bins[b].value);
  }
}

static void write_ranges(struct chart *chart, const struct ranges *r) {
  const double wide = pow(r->x[1] / r->x[0], 0.04), tall = 1.3 * pow(r->y[1] / r->y[0], 0.08);
  chart_number(chart, "x_low", r->x[0] / wide);
  chart_number(chart, "x_high", r->x[1] * wide);
  chart_number(chart, "y_low", r->y[0] / tall);
  chart_number(chart, "y_high", r->y[1] * tall);
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
  struct ranges ranges = {{HUGE_VAL, -HUGE_VAL}, {HUGE_VAL, -HUGE_VAL}};
  const char *labels[LABELS];
  size_t lines = 0;
  if (count < 1 || count > PICTURE_SERIES)
    return status_fail(error, STATUS_USAGE, "%s: one to %d spectra in a picture, not %zu", page->path, PICTURE_SERIES,
                       count);
  for (size_t s = 0; s < count; s++)
    cover(&ranges, series[s].count, series[s].bins);
  if (!(ranges.x[1] > ranges.x[0]))
    return status_fail(error, STATUS_USAGE, "%s: there is no fragment to draw", page->path);
  for (size_t s = 0; s < count; s++) { /* thin lines often have lower densities than the mean of many runs */
    for (size_t i = 0; i < series[s].thin_count; i++)
      cover(&ranges, series[s].thin[i].count, series[s].thin[i].bins);
  }
  struct chart *chart = chart_new("spectrum");
  if (!chart)
    return status_fail(error, STATUS_MEMORY, "%s: no memory for the chart", page->path);
  chart_words(chart, page, words);
  write_ranges(chart, &ranges);
  write_blocks(chart, form, count, series, ranges.x[1]);
  for (size_t s = 0; s < count; s++)
    labels[lines++] = series[s].label;
  for (size_t s = 0; s < count; s++)
    for (size_t i = 0; i < series[s].fits && i < MOST_FITS; i++)
      labels[lines++] = series[s].fit[i].label;
  chart_texts(chart, "label", lines, labels);
  const double legend = chart_legend(chart, page, lines, labels);
  return chart_draw(chart, page, 0.68 * page->width + legend, error);
}
