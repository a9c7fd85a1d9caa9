/* Means over an input, with their intervals: one line for each value of a second input. */
#include <math.h>
#include <string.h>

#include "analysis/pictures/picture.h"
#include "analysis/pictures/picture_canvas.h"
#include "analysis/pictures/picture_frame.h"

enum { LOG_FROM = 20 }; /* x is logarithmic from this factor between its ends */

static bool is_finite(const struct picture_mean *m) {
  return isfinite(m->x) && isfinite(m->y);
}
static bool has_bar(const struct picture_mean *m) {
  return isfinite(m->low) && isfinite(m->high) && m->low < m->high;
}

static bool choose_ranges(size_t count, const struct picture_curve *curve, struct picture_frame *f) {
  f->x[0] = f->y[0] = HUGE_VAL;
  f->x[1] = f->y[1] = -HUGE_VAL;
  for (size_t c = 0; c < count; c++)
    for (size_t i = 0; i < curve[c].count; i++) {
      const struct picture_mean *m = &curve[c].mean[i];
      if (!is_finite(m))
        continue;
      picture_frame_extend(f->x, m->x);
      picture_frame_extend(f->y, m->y);
      if (has_bar(m)) {
        picture_frame_extend(f->y, m->low);
        picture_frame_extend(f->y, m->high);
      }
    }
  if (!(f->x[1] >= f->x[0]))
    return false;
  f->log_x = f->x[0] > 0 && f->x[1] >= LOG_FROM * f->x[0];
  for (int k = 0; k < 2 && f->log_x; k++)
    f->x[k] = log10(f->x[k]);
  picture_frame_widen(f->x, 0.05);
  picture_frame_widen(f->y, 0.06);
  return true;
}

static void draw_line(const struct picture_frame *f, const struct picture_curve *curve, size_t index) {
  bool begun = false;
  picture_canvas_series(f->cairo, index, 0.6);
  cairo_set_line_width(f->cairo, 0.12 * f->font);
  for (size_t i = 0; i < curve->count; i++) { /* a mean that is not finite leaves a gap */
    const struct picture_mean *m = &curve->mean[i];
    bool finite = is_finite(m);
    if (finite && begun)
      cairo_line_to(f->cairo, picture_frame_across(f, m->x), picture_frame_up(f, m->y));
    else if (finite)
      cairo_move_to(f->cairo, picture_frame_across(f, m->x), picture_frame_up(f, m->y));
    begun = finite;
  }
  cairo_stroke(f->cairo);
}

static void draw_dot(const struct picture_frame *f, const struct picture_mean *m, size_t index) {
  const double radius = 0.32 * f->font, x = picture_frame_across(f, m->x);
  const double ends[2] = {picture_frame_up(f, m->low), picture_frame_up(f, m->high)};
  picture_canvas_series(f->cairo, index, 1);
  cairo_set_line_width(f->cairo, 0.1 * f->font);
  for (int k = 0; k < 2 && has_bar(m); k++) {
    cairo_move_to(f->cairo, x, ends[0]);
    cairo_line_to(f->cairo, x, ends[1]);
    cairo_move_to(f->cairo, x - radius, ends[k]);
    cairo_rel_line_to(f->cairo, 2 * radius, 0);
  }
  cairo_stroke(f->cairo);
  cairo_arc(f->cairo, x, picture_frame_up(f, m->y), radius, 0, 2 * M_PI);
  cairo_fill(f->cairo);
}

static void draw(const struct picture_frame *f, const struct picture_curve *curve, size_t index) {
  draw_line(f, curve, index);
  for (size_t i = 0; i < curve->count; i++)
    if (is_finite(&curve->mean[i]))
      draw_dot(f, &curve->mean[i], index);
}

static double legend_width(cairo_t *cairo, double font, size_t count, const struct picture_curve *curve) {
  double widest = 0;
  for (size_t c = 0; c < count; c++)
    if (curve[c].label)
      widest = fmax(widest, picture_canvas_text_width(cairo, 0.95 * font, false, curve[c].label));
  return widest > 0 ? widest + 3 * font : 0;
}

static void legend(const struct picture_frame *f, size_t count, const struct picture_curve *curve) {
  double y = f->top + f->font, mark = f->left + f->wide + 1.2 * f->font;
  for (size_t c = 0; c < count; c++, y += 1.6 * f->font) {
    if (!curve[c].label)
      continue;
    picture_canvas_series(f->cairo, c, 1);
    cairo_arc(f->cairo, mark, y - 0.33 * f->font, 0.35 * f->font, 0, 2 * M_PI);
    cairo_fill(f->cairo);
    cairo_set_source_rgb(f->cairo, 0.15, 0.15, 0.15);
    picture_canvas_text(f->cairo, mark + 0.9 * f->font, y, 0.95 * f->font, PICTURE_LEFT, false, curve[c].label);
  }
}

/* The width of the legend, which must be known before the page exists: measured on a page that is thrown away. */
static double measure_legend(double font, size_t count, const struct picture_curve *curve) {
  cairo_surface_t *surface = cairo_image_surface_create(CAIRO_FORMAT_A8, 1, 1);
  cairo_t *cairo = cairo_create(surface);
  double width = legend_width(cairo, font, count, curve);
  cairo_destroy(cairo);
  cairo_surface_destroy(surface);
  return width;
}

status picture_curves(const char *path, double width, const char *title, const char *x_label, const char *y_label,
                      size_t count, const struct picture_curve *curve, struct error *error) {
  if (count > PICTURE_CANVAS_SERIES)
    return status_fail(error, STATUS_USAGE, "%s: %zu curves are too many to be told apart; at most %d", path, count,
                       PICTURE_CANVAS_SERIES);
  struct picture_frame f = {.font = width / 46};
  if (!choose_ranges(count, curve, &f))
    return status_fail(error, STATUS_USAGE, "%s: there is nothing to draw", path);
  const double height = 0.66 * width;
  struct picture_canvas canvas;
  status code = picture_canvas_open(&canvas, path, width + measure_legend(f.font, count, curve), height, error);
  if (code)
    return code;
  f.cairo = canvas.cairo;
  f.left = 7.5 * f.font;
  f.wide = width - f.left - f.font;
  f.top = (title ? 3 : 1) * f.font;
  f.tall = height - f.top - 4 * f.font;
  picture_frame_draw(&f, true, y_label);
  for (size_t c = 0; c < count; c++)
    draw(&f, &curve[c], c);
  legend(&f, count, curve);
  picture_canvas_title(f.cairo, f.left, f.font, title);
  picture_canvas_text(f.cairo, f.left + f.wide / 2, height - 0.9 * f.font, 1.05 * f.font, PICTURE_CENTRE, false,
                      x_label);
  return picture_canvas_close(&canvas, STATUS_OK, error);
}
