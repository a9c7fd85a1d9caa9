/* A frame with axes. */
#include "analysis/pictures/picture_frame.h"

#include <math.h>
#include <stdio.h>

#include "analysis/pictures/picture_canvas.h"

void picture_frame_range(size_t n, const double *values, double range[2]) {
  range[0] = HUGE_VAL;
  range[1] = -HUGE_VAL;
  for (size_t i = 0; i < n; i++)
    picture_frame_extend(range, values[i]);
}

void picture_frame_extend(double range[2], double value) {
  if (!isfinite(value))
    return;
  range[0] = fmin(range[0], value);
  range[1] = fmax(range[1], value);
}

void picture_frame_widen(double range[2], double share) {
  double margin = share * (range[1] - range[0]);
  if (!(margin > 0))
    margin = range[1] != 0 ? 0.05 * fabs(range[1]) : 1;
  range[0] -= margin;
  range[1] += margin;
}

double picture_frame_across(const struct picture_frame *f, double x) {
  return f->left + f->wide * ((f->log_x ? log10(x) : x) - f->x[0]) / (f->x[1] - f->x[0]);
}

double picture_frame_up(const struct picture_frame *f, double y) {
  return f->top + f->tall * (1 - (y - f->y[0]) / (f->y[1] - f->y[0]));
}

static void tick_below(const struct picture_frame *f, double x, double length) {
  cairo_move_to(f->cairo, picture_frame_across(f, x), f->top + f->tall);
  cairo_rel_line_to(f->cairo, 0, -length * f->font);
  cairo_stroke(f->cairo);
}

static void number_below(const struct picture_frame *f, double x, const char *text) {
  picture_canvas_text(f->cairo, picture_frame_across(f, x), f->top + f->tall + 1.4 * f->font, 0.95 * f->font,
                      PICTURE_CENTRE, false, text);
}

/* Ticks at multiples of 1, 2 or 5 x 10^n. */
static void linear_ticks(const struct picture_frame *f, bool upright) {
  const double *range = upright ? f->y : f->x,
               step = picture_canvas_round_length((range[1] - range[0]) / (upright ? 4 : 6));
  double first = ceil(range[0] / step) * step;
  for (int k = 0; k < 20 && first + k * step <= range[1]; k++) {
    char text[32];
    double value = first + k * step;
    snprintf(text, sizeof text, "%.4g", fabs(value) < 1e-9 * step ? 0 : value);
    if (!upright) {
      number_below(f, value, text);
      tick_below(f, value, 0.4);
      continue;
    }
    picture_canvas_text(f->cairo, f->left - 0.5 * f->font, picture_frame_up(f, value) + 0.35 * f->font, 0.95 * f->font,
                        PICTURE_RIGHT, false, text);
    cairo_move_to(f->cairo, f->left, picture_frame_up(f, value));
    cairo_rel_line_to(f->cairo, 0.4 * f->font, 0);
    cairo_stroke(f->cairo);
  }
}

/* A tick at 1 to 9 of every decade. Numbers stand at 1, 2, 5 when there are few decades, else at as many powers of ten
 * as fit. */
static void decade_ticks(const struct picture_frame *f) {
  double span = f->x[1] - f->x[0];
  int every = (int)fmax(ceil(3.2 * f->font * span / f->wide), 1);
  for (int decade = (int)floor(f->x[0]); decade <= (int)floor(f->x[1]); decade++)
    for (int digit = 1; digit < 10; digit++) {
      double value = digit * pow(10, decade), place = decade + log10(digit);
      char text[32];
      if (place < f->x[0] || place > f->x[1] || (digit > 1 && span > 12))
        continue;
      tick_below(f, value, digit == 1 ? 0.5 : 0.28);
      snprintf(text, sizeof text, "%.4g", value);
      if (span < 2.5 && (digit == 1 || digit == 2 || digit == 5))
        number_below(f, value, text);
      else if (span >= 2.5 && digit == 1 && decade % every == 0)
        picture_canvas_decade(f->cairo, picture_frame_across(f, value), f->top + f->tall + 1.5 * f->font, f->font,
                              PICTURE_CENTRE, decade);
    }
}

void picture_frame_draw(const struct picture_frame *f, bool below, const char *y_label) {
  cairo_set_source_rgb(f->cairo, 0.2, 0.2, 0.2);
  cairo_set_line_width(f->cairo, 0.08 * f->font);
  cairo_rectangle(f->cairo, f->left, f->top, f->wide, f->tall);
  cairo_stroke(f->cairo);
  linear_ticks(f, true);
  if (below && f->log_x)
    decade_ticks(f);
  else if (below)
    linear_ticks(f, false);
  picture_canvas_text_upright(f->cairo, 1.7 * f->font, f->top + f->tall / 2, 1.05 * f->font, y_label);
}
