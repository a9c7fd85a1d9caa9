/* Log-log spectra with error bars and fitted lines. */
#include <math.h>

#include "analysis/pictures/chart.h"

enum { MOST_FITS = 3, LABELS = PICTURE_SERIES * (1 + MOST_FITS) };

/* Block: the bins of one series. A bar that reaches down to zero has no lower end on a logarithmic axis. */
static void write_bins(struct chart *chart, const struct picture_series *series) {
  chart_columns(chart, "mass density low high complete(1)");
  for (size_t b = 0; b < series->count; b++) {
    const struct pooled_bin *bin = &series->bins[b];
    if (!(bin->density > 0) || !(bin->lower > 0))
      continue;
    double low = bin->density - bin->half_width; /* NaN: one run */
    if (low <= 0)
      low = bin->density / 1e3; /* below the frame, or nearly */
    chart_row(chart, 5,
              (double[]){sqrt(bin->lower) * sqrt(bin->upper), bin->density, low, bin->density + bin->half_width,
                         !(bin->lower < series->complete_mass)});
  }
  chart_row(chart, 5, (double[]){NAN, NAN, NAN, NAN, NAN}); /* a block is never empty */
  chart_block_end(chart);
}

/* Amplitude A of A m^-beta with as many fragments in [lower, upper) as the fit was made from. */
static double amplitude(const struct picture_fit *fit, double upper) {
  const double k = fit->beta - 1, a = fit->lower, span = log(upper / a);
  const double integral = fabs(k * span) < 1e-9 ? span : -expm1(-k * span) / k;
  return fit->fragments_per_run / (pow(a, 1 - fit->beta) * integral);
}

/* Block: both ends of a fit's line. most: the greatest mass of the chart. */
static void write_fit(struct chart *chart, const struct picture_fit *fit, double most) {
  const double upper = isinf(fit->upper) ? most : fit->upper;
  chart_columns(chart, "mass density");
  if (isfinite(fit->beta) && fit->lower > 0 && upper > fit->lower && fit->fragments_per_run > 0) {
    const double level = amplitude(fit, isinf(fit->upper) && fit->beta > 1 ? 1e300 : upper);
    chart_row(chart, 2, (double[]){fit->lower, level * pow(fit->lower, -fit->beta)});
    chart_row(chart, 2, (double[]){upper, level * pow(upper, -fit->beta)});
  } else {
    chart_row(chart, 2, (double[]){NAN, NAN});
  }
  chart_block_end(chart);
}

/* Least and greatest mass and density of all bins. False: there is none. */
static bool range_of(size_t count, const struct picture_series *series, double x[2], double y[2]) {
  x[0] = y[0] = HUGE_VAL;
  x[1] = y[1] = -HUGE_VAL;
  for (size_t s = 0; s < count; s++)
    for (size_t b = 0; b < series[s].count; b++) {
      const struct pooled_bin *bin = &series[s].bins[b];
      if (!(bin->density > 0) || !(bin->lower > 0))
        continue;
      x[0] = fmin(x[0], bin->lower);
      x[1] = fmax(x[1], bin->upper);
      y[0] = fmin(y[0], bin->density);
      y[1] = fmax(y[1], bin->density);
    }
  return x[1] > x[0];
}

static void write_range(struct chart *chart, const double x[2], const double y[2]) {
  const double wide = pow(x[1] / x[0], 0.04), tall = 1.3 * pow(y[1] / y[0], 0.08);
  chart_number(chart, "x_low", x[0] / wide);
  chart_number(chart, "x_high", x[1] * wide);
  chart_number(chart, "y_low", y[0] / tall);
  chart_number(chart, "y_high", y[1] * tall);
}

status picture_spectrum(const struct picture_page *page, const struct picture_words *words, size_t count,
                        const struct picture_series *series, struct error *error) {
  double x[2], y[2];
  const char *labels[LABELS];
  double of[LABELS], dashes[LABELS];
  size_t lines = 0;
  if (count < 1 || count > PICTURE_SERIES)
    return status_fail(error, STATUS_USAGE, "%s: one to %d spectra in a picture, not %zu", page->path, PICTURE_SERIES,
                       count);
  if (!range_of(count, series, x, y))
    return status_fail(error, STATUS_USAGE, "%s: there is no fragment to draw", page->path);
  struct chart *chart = chart_new("spectrum");
  if (!chart)
    return status_fail(error, STATUS_MEMORY, "%s: no memory for the chart", page->path);
  chart_words(chart, page, words);
  write_range(chart, x, y);
  chart_number(chart, "series", (double)count);
  for (; lines < count; lines++) {
    labels[lines] = series[lines].label;
    write_bins(chart, &series[lines]);
  }
  for (size_t s = 0; s < count; s++)
    for (size_t i = 0; i < series[s].fits && i < MOST_FITS; i++) {
      of[lines - count] = (double)s + 1;
      dashes[lines - count] = (double)i + 1;
      labels[lines++] = series[s].fit[i].label;
      write_fit(chart, &series[s].fit[i], x[1]);
    }
  chart_number(chart, "fits", (double)(lines - count));
  chart_numbers(chart, "fit_of", lines - count, of);
  chart_numbers(chart, "fit_dash", lines - count, dashes);
  chart_texts(chart, "label", lines, labels);
  const double legend = chart_legend(chart, page, lines, labels);
  return chart_draw(chart, page, 0.68 * page->width + legend, error);
}
