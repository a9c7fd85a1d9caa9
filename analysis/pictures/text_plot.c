/* Spectra and histograms as text. */
#include <math.h>
#include <string.h>

#include "analysis/pictures/picture.h"

enum { LEAST_COLUMNS = 72, FRONT = 38, MOST_PLOT = 200 };

enum mark { BLANK, GRID, FIT, ERROR_BAR, ERROR_LEFT, ERROR_RIGHT, POINT, INCOMPLETE };

static const char *glyph(enum mark mark, bool unicode) {
  static const char *const fancy[] =
      {" ", "\xe2\x94\x8a", "\xc2\xb7", "\xe2\x94\x80", "\xe2\x94\x9c", "\xe2\x94\xa4", "\xe2\x97\x8f", "\xe2\x97\x8b"};
  static const char *const plain[] = {" ", ".", ":", "-", "[", "]", "*", "o"};
  return (unicode ? fancy : plain)[mark];
}

struct scale {
  double low, high; /* log10 of the values */
  int columns;
};

static int place(const struct scale *scale, double log_value) {
  double share = (log_value - scale->low) / (scale->high - scale->low);
  int at = (int)lround(share * (scale->columns - 1));
  if (at < 0)
    return 0;
  return at < scale->columns ? at : scale->columns - 1;
}

/* The place on the axis below which fragments are missing. */
static double complete_from(const struct pooled_form *form, const struct picture_series *series) {
  return spectrum_size_of(&form->size, series->complete_mass);
}

typedef unsigned char plot_line[MOST_PLOT]; /* values of enum mark */

static void mark_error(const struct scale *scale, const struct pooled_bin *bin, plot_line line) {
  const double below = bin->value - bin->half_width;
  const int left = below > 0 ? place(scale, log10(below)) : 0;
  const int right = place(scale, log10(bin->value + bin->half_width));
  for (int i = left; i <= right; i++)
    line[i] = ERROR_BAR;
  if (below > 0)
    line[left] = ERROR_LEFT;
  line[right] = ERROR_RIGHT;
}

/* Later marks hide earlier ones. */
static void row(FILE *out, const struct scale *scale, bool unicode, const struct pooled_form *form,
                const struct pooled_bin *bin, const struct picture_series *series) {
  plot_line line = {0};
  for (int decade = (int)ceil(scale->low); decade <= scale->high; decade++)
    line[place(scale, decade)] = GRID;
  if (bin->half_width > 0)
    mark_error(scale, bin, line);
  if (series->fits) {
    const double middle = form->cumulative ? bin->lower : sqrt(bin->lower * bin->upper);
    const double fitted = log10(picture_spectrum_fit(&series->fit[0], form, middle));
    if (fitted >= scale->low && fitted <= scale->high)
      line[place(scale, fitted)] = FIT;
  }
  line[place(scale, log10(bin->value))] = bin->lower < complete_from(form, series) ? INCOMPLETE : POINT;

  char percent[24] = "", count[24] = "";
  if (bin->count)
    snprintf(count, sizeof count, "%lld", (long long)bin->count);
  fprintf(out, "%10.3g %7s %11.3g", bin->lower, count, bin->value);
  text_append_fixed(percent, sizeof percent, 100 * bin->half_width / bin->value, 0);
  if (isfinite(bin->half_width))
    fprintf(out, " %4s%%  ", percent);
  else
    fprintf(out, " %5s  ", "-");
  int columns = scale->columns;
  while (columns > 0 && line[columns - 1] == BLANK) /* no trailing blanks */
    columns--;
  for (int i = 0; i < columns; i++)
    fputs(glyph((enum mark)line[i], unicode), out);
  fputc('\n', out);
}

/* Writes the decades above the grid lines, as many as fit. */
static void heading(FILE *out, const struct scale *scale, bool counted, const char *axis, const char *axis_unit,
                    const char *value) {
  char unit[32], line[MOST_PLOT + 16];
  snprintf(unit, sizeof unit, "%s [%s]", axis, axis_unit);
  memset(line, ' ', sizeof line);
  int free_from = 0;
  for (int decade = (int)ceil(scale->low); decade <= scale->high; decade++) {
    char text[16];
    snprintf(text, sizeof text, "10^%d", decade);
    const int length = (int)strlen(text), column = place(scale, decade), most = scale->columns - length;
    const int at = column < most ? column : most; /* the last one ends with the lines */
    if (at < free_from)
      continue;
    memcpy(line + at, text, (size_t)length);
    free_from = at + length + 1;
  }
  size_t end = sizeof line - 1;
  while (end > 0 && line[end - 1] == ' ')
    end--;
  line[end] = 0;
  fprintf(out, "%10s %7s %11s %5s  %s\n", unit, counted ? "count" : "", value, "+-95%", line);
}

/* Without unicode, beta and plus-minus are spelt out, and other characters beyond ASCII are left out. */
static void write_label(FILE *out, const char *label, bool unicode) {
  static const struct { const char *character, *spelt; } known[] = {{"\xce\xb2", "beta"}, {"\xc2\xb1", "+-"}};
  if (unicode) {
    fputs(label, out);
    return;
  }
  for (const char *c = label; *c; c++) {
    if ((unsigned char)*c < 0x80)
      fputc(*c, out);
    for (size_t k = 0; k < sizeof known / sizeof known[0]; k++)
      if (strncmp(c, known[k].character, 2) == 0)
        fputs(known[k].spelt, out);
  }
}

void text_plot_spectrum(FILE *out, int columns, bool unicode, const char *axis, const char *unit, const char *value,
                        const struct pooled_form *form, const struct picture_series *series) {
  struct scale scale = {HUGE_VAL, -HUGE_VAL, 0};
  for (size_t b = 0; b < series->count; b++) {
    if (!(series->bins[b].value > 0))
      continue;
    scale.low = fmin(scale.low, log10(series->bins[b].value));
    scale.high = fmax(scale.high, log10(series->bins[b].value));
  }
  if (!(scale.high >= scale.low))
    return;
  scale.low -= 0.3; /* space for an error bar of a factor two */
  scale.high += 0.1;
  if (columns < LEAST_COLUMNS)
    columns = LEAST_COLUMNS;
  scale.columns = columns - FRONT < MOST_PLOT ? columns - FRONT : MOST_PLOT;
  heading(out, &scale, series->bins[0].count > 0, axis, unit, value);
  for (size_t b = 0; b < series->count; b++)
    if (series->bins[b].value > 0)
      row(out, &scale, unicode, form, &series->bins[b], series);
  if (series->count && series->bins[0].lower < complete_from(form, series))
    fprintf(out, "%s below %.3g %s fragments are missing: too few particles or grains\n", glyph(INCOMPLETE, unicode),
            complete_from(form, series), unit);
  if (!series->fits || !series->fit[0].label)
    return;
  fprintf(out, "%s ", glyph(FIT, unicode));
  write_label(out, series->fit[0].label, unicode);
  fputc('\n', out);
}

void text_plot_histogram(FILE *out, int columns, bool unicode, const struct scatter_histogram *histogram) {
  enum { BEFORE = 20, LEAST = 40 }; /* columns: before the bar; least width */
  size_t most = 1;
  for (size_t b = 0; b < histogram->bins; b++)
    if (histogram->count[b] > most)
      most = histogram->count[b];
  const size_t room = (size_t)(columns > LEAST ? columns : LEAST) - BEFORE;
  if (histogram->bins)
    fprintf(out, "%10s %8s\n", "from", "runs");
  for (size_t b = 0; b < histogram->bins; b++) {
    const size_t bar = histogram->count[b] ? 1 + (room - 1) * histogram->count[b] / most : 0;
    fprintf(out, "%10.4g %8zu%s", histogram->from + (double)b * histogram->width, histogram->count[b], bar ? " " : "");
    for (size_t i = 0; i < bar; i++)
      fputs(unicode ? "\xe2\x96\x88" : "#", out);
    fputc('\n', out);
  }
}
