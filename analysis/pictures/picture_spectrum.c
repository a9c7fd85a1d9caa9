/* Log-log spectra with error bars and fitted lines. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "analysis/pictures/picture.h"
#include "analysis/pictures/picture_canvas.h"

struct frame {
  cairo_t *cairo;
  double left, top, width, height, font;
  double x0, x1, y0, y1; /* log10 */
};

static double at_x(const struct frame *f, double log_mass) {
  return f->left + f->width * (log_mass - f->x0) / (f->x1 - f->x0);
}
static double at_y(const struct frame *f, double log_density) {
  return f->top + f->height * (f->y1 - log_density) / (f->y1 - f->y0);
}

static double middle(const struct pooled_bin *bin) {
  return (log10(bin->lower) + log10(bin->upper)) / 2;
}

/* Ranges that hold every point, with a margin. */
static bool choose_range(size_t count, const struct picture_series *series, struct frame *f) {
  f->x0 = f->y0 = HUGE_VAL;
  f->x1 = f->y1 = -HUGE_VAL;
  for (size_t s = 0; s < count; s++) {
    for (size_t b = 0; b < series[s].count; b++) {
      const struct pooled_bin *bin = &series[s].bins[b];
      if (!(bin->density > 0) || !(bin->lower > 0))
        continue;
      f->x0 = fmin(f->x0, log10(bin->lower));
      f->x1 = fmax(f->x1, log10(bin->upper));
      f->y0 = fmin(f->y0, log10(bin->density));
      f->y1 = fmax(f->y1, log10(bin->density));
    }
  }
  if (!(f->x1 > f->x0))
    return false;
  double margin_x = 0.04 * (f->x1 - f->x0), margin_y = 0.08 * (f->y1 - f->y0) + 0.1;
  f->x0 -= margin_x;
  f->x1 += margin_x;
  f->y0 -= margin_y;
  f->y1 += margin_y;
  return true;
}

static void stroke_line(cairo_t *cairo, double x, double y, double along_x, double along_y) {
  cairo_move_to(cairo, x, y);
  cairo_rel_line_to(cairo, along_x, along_y);
  cairo_stroke(cairo);
}

/* One tick at log10 `value`; with `grid` a line across the frame, too. */
static void tick(const struct frame *f, bool horizontal, double value, bool grid) {
  double length = (grid ? 0.55 : 0.28) * f->font, bottom = f->top + f->height;
  double place = horizontal ? at_x(f, value) : at_y(f, value);
  if (grid) {
    cairo_set_source_rgb(f->cairo, 0.91, 0.91, 0.91);
    cairo_set_line_width(f->cairo, 0.05 * f->font);
    if (horizontal) {
      cairo_move_to(f->cairo, place, f->top);
      cairo_line_to(f->cairo, place, bottom);
    } else {
      cairo_move_to(f->cairo, f->left, place);
      cairo_line_to(f->cairo, f->left + f->width, place);
    }
    cairo_stroke(f->cairo);
  }
  cairo_set_source_rgb(f->cairo, 0.2, 0.2, 0.2);
  cairo_set_line_width(f->cairo, 0.07 * f->font);
  if (horizontal)
    stroke_line(f->cairo, place, bottom, 0, -length);
  else
    stroke_line(f->cairo, f->left, place, length, 0);
}

static void tick_number(const struct frame *f, bool horizontal, int decade) {
  if (horizontal)
    picture_canvas_decade(f->cairo, at_x(f, decade), f->top + f->height + 1.5 * f->font, f->font, PICTURE_CENTRE,
                          decade);
  else
    picture_canvas_decade(f->cairo, f->left - 0.5 * f->font, at_y(f, decade) + 0.35 * f->font, f->font, PICTURE_RIGHT,
                          decade);
}

/* Ticks at 1 to 9 of every decade, numbers at as many powers of ten as fit. */
static void axis(const struct frame *f, bool horizontal) {
  double from = horizontal ? f->x0 : f->y0, to = horizontal ? f->x1 : f->y1;
  double length = horizontal ? f->width : f->height;
  int every = (int)fmax(ceil(3.2 * f->font * (to - from) / length), 1), digits = to - from > 12 ? 1 : 9;
  for (int decade = (int)floor(from); decade <= (int)ceil(to); decade++)
    for (int digit = 1; digit <= digits; digit++) {
      double value = decade + log10(digit);
      if (value < from || value > to)
        continue;
      tick(f, horizontal, value, digit == 1);
      if (digit == 1 && decade % every == 0)
        tick_number(f, horizontal, decade);
    }
}

/* The 95 % interval over runs. A bar that reaches down to zero is faint, so that it does not rule the picture. */
static void error_bar(const struct frame *f, const struct pooled_bin *bin, double x, double cap, size_t index) {
  cairo_t *cairo = f->cairo;
  double low = bin->density - bin->half_width, bottom = f->top + f->height;
  if (low > 0)
    bottom = fmin(at_y(f, log10(low)), bottom);
  double top = fmax(at_y(f, log10(bin->density + bin->half_width)), f->top);
  picture_canvas_series(cairo, index, low > 0 ? 0.75 : 0.3);
  cairo_move_to(cairo, x, bottom);
  cairo_line_to(cairo, x, top);
  cairo_move_to(cairo, x - cap, top);
  cairo_rel_line_to(cairo, 2 * cap, 0);
  if (low > 0) {
    cairo_move_to(cairo, x - cap, bottom);
    cairo_rel_line_to(cairo, 2 * cap, 0);
  }
  cairo_stroke(cairo);
}

static void points(const struct frame *f, const struct picture_series *series, size_t index) {
  cairo_t *cairo = f->cairo;
  double radius = 0.27 * f->font;
  for (size_t b = 0; b < series->count; b++) {
    const struct pooled_bin *bin = &series->bins[b];
    if (!(bin->density > 0))
      continue;
    double x = at_x(f, middle(bin));
    cairo_set_line_width(cairo, 0.09 * f->font);
    if (bin->half_width > 0)
      error_bar(f, bin, x, 0.7 * radius, index);
    cairo_arc(cairo, x, at_y(f, log10(bin->density)), radius, 0, 2 * M_PI);
    if (bin->lower < series->complete_mass)
      cairo_set_source_rgb(cairo, 0.72, 0.72, 0.72);
    else
      picture_canvas_series(cairo, index, 1);
    cairo_fill_preserve(cairo);
    cairo_set_source_rgb(cairo, 1, 1, 1);
    cairo_set_line_width(cairo, 0.06 * f->font);
    cairo_stroke(cairo);
  }
}

/* The dashes tell the fits of one series apart; the first is a full line. */
static void set_dash(const struct frame *f, size_t fit) {
  const double dashes[3][2] = {{1, 0}, {0.9, 0.5}, {0.25, 0.4}};
  double dash[2] = {dashes[fit % 3][0] * f->font, dashes[fit % 3][1] * f->font};
  if (fit % 3)
    cairo_set_dash(f->cairo, dash, 2, 0);
}

/* Amplitude A of A m^-beta with as many fragments in [lower, upper) as the fit was made from. */
static double amplitude(const struct picture_fit *fit, double upper) {
  double k = fit->beta - 1, a = fit->lower, span = log(upper / a);
  double integral = fabs(k * span) < 1e-9 ? span : -expm1(-k * span) / k;
  return fit->fragments_per_run / (pow(a, 1 - fit->beta) * integral);
}

static void fit_line(const struct frame *f, const struct picture_fit *fit, size_t index, size_t number) {
  cairo_t *cairo = f->cairo;
  double upper = isinf(fit->upper) ? pow(10, f->x1) : fit->upper;
  if (!isfinite(fit->beta) || !(fit->lower > 0) || !(upper > fit->lower) || !(fit->fragments_per_run > 0))
    return;
  double level = log10(amplitude(fit, isinf(fit->upper) && fit->beta > 1 ? 1e300 : upper));
  cairo_save(cairo);
  cairo_rectangle(cairo, f->left, f->top, f->width, f->height);
  cairo_clip(cairo);
  set_dash(f, number);
  picture_canvas_series(cairo, index, 0.95);
  cairo_set_line_width(cairo, 0.14 * f->font);
  cairo_move_to(cairo, at_x(f, log10(fit->lower)), at_y(f, level - fit->beta * log10(fit->lower)));
  cairo_line_to(cairo, at_x(f, log10(upper)), at_y(f, level - fit->beta * log10(upper)));
  cairo_stroke(cairo);
  cairo_restore(cairo);
}

/* Line 0 of a series' legend is its label, the others are those of its fits. NULL: no line. */
static const char *legend_text(const struct picture_series *series, size_t line) {
  return line == 0 ? series->label : series->fit[line - 1].label;
}

/* The legend stands beside the frame, because labels that name the inputs are long. Its width follows from the longest
 * text (0.58 em a letter, bold). */
static double legend_width(double font, size_t count, const struct picture_series *series) {
  size_t longest = 0;
  for (size_t s = 0; s < count; s++)
    for (size_t line = 0; line <= series[s].fits; line++) {
      const char *text = legend_text(&series[s], line);
      if (text && strlen(text) > longest)
        longest = strlen(text);
    }
  return longest ? (4 + 0.58 * (double)longest) * font : 0;
}

/* A dot for a series, a line for a fit. */
static void legend_mark(const struct frame *f, double x, double y, size_t line) {
  cairo_t *cairo = f->cairo;
  if (line == 0) {
    cairo_arc(cairo, x + f->font, y - 0.33 * f->font, 0.3 * f->font, 0, 2 * M_PI);
    cairo_fill(cairo);
    return;
  }
  set_dash(f, line - 1);
  cairo_set_line_width(cairo, 0.14 * f->font);
  cairo_move_to(cairo, x, y - 0.33 * f->font);
  cairo_rel_line_to(cairo, 2 * f->font, 0);
  cairo_stroke(cairo);
  cairo_set_dash(cairo, NULL, 0, 0);
}

static void legend(const struct frame *f, size_t count, const struct picture_series *series) {
  double y = f->top + f->font, x = f->left + f->width + f->font;
  for (size_t s = 0; s < count; s++) {
    for (size_t line = 0; line <= series[s].fits; line++) {
      const char *text = legend_text(&series[s], line);
      if (!text)
        continue;
      cairo_set_source_rgb(f->cairo, 0.15, 0.15, 0.15);
      picture_canvas_text(f->cairo, x + 2.6 * f->font, y, 0.95 * f->font, PICTURE_LEFT, line == 0, text);
      picture_canvas_series(f->cairo, s, 1);
      legend_mark(f, x, y, line);
      y += 1.45 * f->font;
    }
    y += 0.4 * f->font;
  }
}

status picture_spectrum(const char *path, double width, const char *title, const char *mass_unit, size_t count,
                        const struct picture_series *series, struct error *error) {
  if (count < 1 || count > PICTURE_CANVAS_SERIES)
    return status_fail(error, STATUS_USAGE, "%s: one to %d spectra in a picture, not %zu", path, PICTURE_CANVAS_SERIES,
                       count);
  double font = width / 46, height = 0.72 * width;
  struct frame f = {.left = 5.2 * font, .top = (title ? 3 : 1) * font, .font = font};
  f.width = width - f.left - font;
  f.height = height - f.top - 3.6 * font;
  if (!choose_range(count, series, &f))
    return status_fail(error, STATUS_USAGE, "%s: there is no fragment to draw", path);
  struct picture_canvas canvas;
  status code = picture_canvas_open(&canvas, path, width + legend_width(font, count, series), height, error);
  if (code)
    return code;
  cairo_t *cairo = f.cairo = canvas.cairo;
  axis(&f, true);
  axis(&f, false);
  cairo_set_source_rgb(cairo, 0.2, 0.2, 0.2);
  cairo_set_line_width(cairo, 0.08 * font);
  cairo_rectangle(cairo, f.left, f.top, f.width, f.height);
  cairo_stroke(cairo);
  for (size_t s = 0; s < count; s++)
    for (size_t i = 0; i < series[s].fits; i++)
      fit_line(&f, &series[s].fit[i], s, i);
  for (size_t s = 0; s < count; s++)
    points(&f, &series[s], s);
  legend(&f, count, series);
  picture_canvas_title(cairo, f.left, font, title);
  char text[128];
  snprintf(text, sizeof text, "fragment mass m (%s)", mass_unit);
  picture_canvas_text(cairo, f.left + f.width / 2, height - 0.7 * font, 1.05 * font, PICTURE_CENTRE, false, text);
  snprintf(text, sizeof text, "F(m), fragments per run and %s", mass_unit);
  picture_canvas_text_upright(cairo, 1.4 * font, f.top + f.height / 2, 1.05 * font, text);
  return picture_canvas_close(&canvas, STATUS_OK, error);
}
