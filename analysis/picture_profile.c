/* Quantities along a line: one panel each, one above the other over the same axis. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "analysis/picture.h"
#include "analysis/picture_canvas.h"

struct frame {
  double left, top, wide, tall, font;
  double x[2], y[2]; /* ranges */
};

static void range_of(size_t n, const double *values, double range[2]) {
  range[0] = HUGE_VAL, range[1] = -HUGE_VAL;
  for (size_t i = 0; i < n; i++)
    if (isfinite(values[i])) range[0] = fmin(range[0], values[i]), range[1] = fmax(range[1], values[i]);
}

static void widen(double range[2], double share) {
  double room = share * (range[1] - range[0]);
  if (!(room > 0)) room = range[1] != 0 ? 0.05 * fabs(range[1]) : 1;
  range[0] -= room, range[1] += room;
}

static double across(const struct frame *f, double x) { return f->left + f->wide * (x - f->x[0]) / (f->x[1] - f->x[0]); }
static double up(const struct frame *f, double y) { return f->top + f->tall * (1 - (y - f->y[0]) / (f->y[1] - f->y[0])); }

static void ticks(cairo_t *cairo, const struct frame *f, bool below) {
  char text[32];
  for (int upright = 0; upright < 2; upright++) {
    const double *range = upright ? f->y : f->x, step = picture_canvas_round_length((range[1] - range[0]) / (upright ? 4 : 6));
    if (!upright && !below) continue;
    double first = ceil(range[0] / step) * step;
    for (int k = 0; k < 20 && first + k * step <= range[1]; k++) {
      double value = first + k * step;
      snprintf(text, sizeof text, "%.4g", fabs(value) < 1e-9 * step ? 0 : value);
      if (upright) picture_canvas_text(cairo, f->left - 0.5 * f->font, up(f, value) + 0.35 * f->font, 0.95 * f->font, PICTURE_RIGHT, false, text);
      else picture_canvas_text(cairo, across(f, value), f->top + f->tall + 1.4 * f->font, 0.95 * f->font, PICTURE_CENTRE, false, text);
      cairo_move_to(cairo, upright ? f->left : across(f, value), upright ? up(f, value) : f->top + f->tall);
      cairo_rel_line_to(cairo, upright ? 0.4 * f->font : 0, upright ? 0 : -0.4 * f->font);
      cairo_stroke(cairo);
    }
  }
}

/* A line through all points that are numbers, and a dot at each when they are few. */
static void line(cairo_t *cairo, const struct frame *f, size_t count, const double *x, const double *y, double hue) {
  enum { FEW = 120 };
  picture_canvas_colour(cairo, 0.5, 0.14, hue, 1);
  cairo_set_line_width(cairo, 0.14 * f->font);
  bool begun = false;
  for (size_t i = 0; i < count; i++) {
    bool there = isfinite(x[i]) && isfinite(y[i]);
    if (there && begun) cairo_line_to(cairo, across(f, x[i]), up(f, y[i]));
    else if (there) cairo_move_to(cairo, across(f, x[i]), up(f, y[i]));
    begun = there;
  }
  cairo_stroke(cairo);
  for (size_t i = 0; i < count && count <= FEW; i++) {
    if (!isfinite(x[i]) || !isfinite(y[i])) continue;
    cairo_arc(cairo, across(f, x[i]), up(f, y[i]), 0.25 * f->font, 0, 2 * M_PI);
    cairo_fill(cairo);
  }
}

status picture_profile(const char *path, double width, const char *title, const char *x_label, size_t count, const double *x,
                       size_t panels, const struct picture_profile *panel, struct error *error) {
  const double hues[] = {255, 40, 145};
  struct frame f = {.font = width / 46};
  range_of(count, x, f.x);
  if (!panels || !(f.x[1] > f.x[0])) return status_fail(error, STATUS_USAGE, "%s: there is nothing to draw", path);
  widen(f.x, 0.02);
  struct picture_canvas canvas;
  double head = (title ? 3 : 1) * f.font, gap = 1.2 * f.font;
  f.tall = panels > 1 ? 0.3 * width : 0.5 * width;
  status code = picture_canvas_open(&canvas, path, width, head + (double)panels * (f.tall + gap) + 2.8 * f.font, error);
  if (code) return code;
  f.left = 7.5 * f.font, f.wide = width - f.left - 1.5 * f.font;
  for (size_t k = 0; k < panels; k++) {
    f.top = head + (double)k * (f.tall + gap);
    range_of(count, panel[k].y, f.y);
    if (!(f.y[1] >= f.y[0])) f.y[0] = 0, f.y[1] = 1; /* no number at all: an empty frame */
    f.y[0] = fmin(f.y[0], panel[k].at_least[0]), f.y[1] = fmax(f.y[1], panel[k].at_least[1]);
    widen(f.y, 0.06);
    cairo_set_source_rgb(canvas.cairo, 0.2, 0.2, 0.2);
    cairo_set_line_width(canvas.cairo, 0.08 * f.font);
    cairo_rectangle(canvas.cairo, f.left, f.top, f.wide, f.tall);
    cairo_stroke(canvas.cairo);
    ticks(canvas.cairo, &f, k + 1 == panels);
    cairo_save(canvas.cairo);
    cairo_translate(canvas.cairo, 1.7 * f.font, f.top + f.tall / 2);
    cairo_rotate(canvas.cairo, -M_PI / 2);
    picture_canvas_text(canvas.cairo, 0, 0, 1.05 * f.font, PICTURE_CENTRE, false, panel[k].label);
    cairo_restore(canvas.cairo);
    line(canvas.cairo, &f, count, x, panel[k].y, hues[k % 3]);
  }
  cairo_set_source_rgb(canvas.cairo, 0.1, 0.1, 0.1);
  if (title) picture_canvas_text(canvas.cairo, f.left, 2 * f.font, 1.2 * f.font, PICTURE_LEFT, true, title);
  picture_canvas_text(canvas.cairo, f.left + f.wide / 2, f.top + f.tall + 3.1 * f.font, 1.05 * f.font, PICTURE_CENTRE, false, x_label);
  return picture_canvas_close(&canvas, STATUS_OK, error);
}
