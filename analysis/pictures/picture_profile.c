/* Quantities along a line: one panel each, one above the other over the same axis. */
#include <math.h>

#include "analysis/pictures/picture.h"
#include "analysis/pictures/picture_canvas.h"
#include "analysis/pictures/picture_frame.h"

/* A line through the finite points, and a dot at each when they are few. */
static void line(const struct picture_frame *f, size_t count, const double *x, const double *y, double hue) {
  enum { FEW = 120 };
  cairo_t *cairo = f->cairo;
  picture_canvas_colour(cairo, 0.5, 0.14, hue, 1);
  cairo_set_line_width(cairo, 0.14 * f->font);
  bool begun = false;
  for (size_t i = 0; i < count; i++) {
    bool there = isfinite(x[i]) && isfinite(y[i]);
    if (there && begun)
      cairo_line_to(cairo, picture_frame_across(f, x[i]), picture_frame_up(f, y[i]));
    else if (there)
      cairo_move_to(cairo, picture_frame_across(f, x[i]), picture_frame_up(f, y[i]));
    begun = there;
  }
  cairo_stroke(cairo);
  for (size_t i = 0; i < count && count <= FEW; i++) {
    if (!isfinite(x[i]) || !isfinite(y[i]))
      continue;
    cairo_arc(cairo, picture_frame_across(f, x[i]), picture_frame_up(f, y[i]), 0.25 * f->font, 0, 2 * M_PI);
    cairo_fill(cairo);
  }
}

status picture_profile(const char *path, double width, const char *title, const char *x_label, size_t count,
                       const double *x, size_t panels, const struct picture_profile *panel, struct error *error) {
  const double hues[] = {255, 40, 145};
  struct picture_frame f = {.font = width / 46};
  picture_frame_range(count, x, f.x);
  if (!panels || !(f.x[1] > f.x[0]))
    return status_fail(error, STATUS_USAGE, "%s: there is nothing to draw", path);
  picture_frame_widen(f.x, 0.02);
  struct picture_canvas canvas;
  double head = (title ? 3 : 1) * f.font, gap = 1.2 * f.font;
  f.tall = panels > 1 ? 0.3 * width : 0.5 * width;
  status code = picture_canvas_open(&canvas, path, width, head + (double)panels * (f.tall + gap) + 2.8 * f.font, error);
  if (code)
    return code;
  f.cairo = canvas.cairo;
  f.left = 7.5 * f.font;
  f.wide = width - f.left - 1.5 * f.font;
  for (size_t k = 0; k < panels; k++) {
    f.top = head + (double)k * (f.tall + gap);
    picture_frame_range(count, panel[k].y, f.y);
    if (!(f.y[1] >= f.y[0])) { /* no finite value: an empty frame */
      f.y[0] = 0;
      f.y[1] = 1;
    }
    f.y[0] = fmin(f.y[0], panel[k].at_least[0]);
    f.y[1] = fmax(f.y[1], panel[k].at_least[1]);
    picture_frame_widen(f.y, 0.06);
    picture_frame_draw(&f, k + 1 == panels, panel[k].label);
    line(&f, count, x, panel[k].y, hues[k % 3]);
  }
  picture_canvas_title(canvas.cairo, f.left, f.font, title);
  picture_canvas_text(canvas.cairo, f.left + f.wide / 2, f.top + f.tall + 3.1 * f.font, 1.05 * f.font, PICTURE_CENTRE,
                      false, x_label);
  return picture_canvas_close(&canvas, STATUS_OK, error);
}
