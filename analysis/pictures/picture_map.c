/* A quantity over two axes of a sweep: one tile per point, a colour bar, the number in the tile where it fits. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "analysis/pictures/picture.h"
#include "analysis/pictures/picture_bars.h"
#include "analysis/pictures/picture_canvas.h"
#include "analysis/statistics/sample.h"

static bool bad_axis(const struct picture_axis *axis) {
  if (axis->count == 0)
    return true;
  for (size_t i = 0; i < axis->count; i++)
    if (!isfinite(axis->values[i]) || (axis->log && axis->values[i] <= 0))
      return true;
  return false;
}

status picture_map(const char *path, double width, const char *title, const char *quantity,
                   const struct picture_axis *x, const struct picture_axis *y, const double *value,
                   struct error *error) {
  if (bad_axis(x) || bad_axis(y))
    return status_fail(error, STATUS_USAGE, "%s: an axis of the map is empty or not finite", path);
  double font = width / 46, height = 0.72 * width, low = HUGE_VAL, high = -HUGE_VAL;
  double top = (title ? 3 : 1) * font, tall = height - top - 3.8 * font;
  size_t columns = x->count, lines = y->count;
  for (size_t i = 0; i < columns * lines; i++) {
    if (!isfinite(value[i]))
      continue;
    low = fmin(low, value[i]);
    high = fmax(high, value[i]);
  }
  if (!(high >= low))
    return status_fail(error, STATUS_USAGE, "%s: there is no value to draw", path);
  struct picture_canvas canvas;
  status code = picture_canvas_open(&canvas, path, width, height, error);
  if (code)
    return code;
  cairo_t *cairo = canvas.cairo;
  char text[64];
  double labels = 0; /* the widest of the tick labels on the left */
  for (size_t j = 0; j < lines; j++) {
    snprintf(text, sizeof text, "%.4g", y->values[j]);
    labels = fmax(labels, picture_canvas_text_width(cairo, 0.95 * font, false, text));
  }
  double left = labels + 3 * font, wide = width - left - 8 * font;
  double tile_x = wide / (double)columns, tile_y = tall / (double)lines, digits = fmin(0.85 * font, 0.24 * tile_x);
  for (size_t j = 0; j < lines; j++) {
    for (size_t i = 0; i < columns; i++) {
      double v = value[j * columns + i], at_x = left + tile_x * (double)i, at_y = top + tall - tile_y * (double)(j + 1);
      if (!isfinite(v)) {
        cairo_set_source_rgb(cairo, 0.75, 0.75, 0.75);
        cairo_set_line_width(cairo, 0.06 * font);
        cairo_move_to(cairo, at_x, at_y);
        cairo_rel_line_to(cairo, tile_x, tile_y);
        cairo_move_to(cairo, at_x + tile_x, at_y);
        cairo_rel_line_to(cairo, -tile_x, tile_y);
        cairo_stroke(cairo);
        continue;
      }
      double share = high > low ? (v - low) / (high - low) : 0.5;
      picture_bars_colour(cairo, PICTURE_RAMP_RISING, share);
      cairo_rectangle(cairo, at_x, at_y, tile_x + 0.4, tile_y + 0.4);
      cairo_fill(cairo);
      if (digits < 0.4 * font || tile_y < 1.3 * digits)
        continue;
      snprintf(text, sizeof text, "%.3g", v);
      if (share > 0.55)
        cairo_set_source_rgb(cairo, 0.1, 0.1, 0.1);
      else
        cairo_set_source_rgb(cairo, 1, 1, 1);
      picture_canvas_text(cairo, at_x + tile_x / 2, at_y + tile_y / 2 + 0.35 * digits, digits, PICTURE_CENTRE, false,
                          text);
    }
  }
  cairo_set_source_rgb(cairo, 0.2, 0.2, 0.2);
  cairo_set_line_width(cairo, 0.08 * font);
  cairo_rectangle(cairo, left, top, wide, tall);
  cairo_stroke(cairo);
  size_t every_x = (size_t)fmax(ceil(3.4 * font / tile_x), 1), every_y = (size_t)fmax(ceil(1.3 * font / tile_y), 1);
  for (size_t i = 0; i < columns; i += every_x) {
    snprintf(text, sizeof text, "%.4g", x->values[i]);
    picture_canvas_text(cairo, left + tile_x * ((double)i + 0.5), top + tall + 1.4 * font, 0.95 * font, PICTURE_CENTRE,
                        false, text);
  }
  for (size_t j = 0; j < lines; j += every_y) {
    snprintf(text, sizeof text, "%.4g", y->values[j]);
    picture_canvas_text(cairo, left - 0.5 * font, top + tall - tile_y * ((double)j + 0.5) + 0.35 * font, 0.95 * font,
                        PICTURE_RIGHT, false, text);
  }
  picture_bars_colours(cairo, PICTURE_RAMP_RISING, left + wide + 1.2 * font, top, 1.1 * font, tall, font, low, high,
                       quantity);
  cairo_set_source_rgb(cairo, 0.1, 0.1, 0.1);
  if (title)
    picture_canvas_text(cairo, left, 2 * font, 1.2 * font, PICTURE_LEFT, true, title);
  picture_canvas_text(cairo, left + wide / 2, height - 0.8 * font, 1.05 * font, PICTURE_CENTRE, false, x->label);
  cairo_save(cairo);
  cairo_translate(cairo, 1.5 * font, top + tall / 2);
  cairo_rotate(cairo, -M_PI / 2);
  picture_canvas_text(cairo, 0, 0, 1.05 * font, PICTURE_CENTRE, false, y->label);
  cairo_restore(cairo);
  return picture_canvas_close(&canvas, STATUS_OK, error);
}

static size_t distinct(size_t count, const double (*points)[3], int coordinate, double *values) {
  size_t n = 0;
  for (size_t i = 0; i < count; i++)
    values[i] = points[i][coordinate];
  qsort(values, count, sizeof *values, sample_ascending);
  for (size_t i = 0; i < count; i++)
    if (i == 0 || values[i] != values[n - 1])
      values[n++] = values[i];
  return n;
}

static size_t place(size_t count, const double *values, double value) {
  const double *found = bsearch(&value, values, count, sizeof *values, sample_ascending);
  return (size_t)(found - values); /* every value is there: the axis was made from them */
}

status picture_map_points(const char *path, double width, const char *title, const char *quantity, const char *x_label,
                          const char *y_label, size_t count, const double (*points)[3], struct error *error) {
  enum { MOST_TILES = 10000 };
  double *xs = malloc((count + 1) * sizeof *xs), *ys = malloc((count + 1) * sizeof *ys), *value = NULL;
  status code = xs && ys ? STATUS_OK : status_fail(error, STATUS_MEMORY, "%s: no memory for the map", path);
  for (size_t i = 0; i < count && !code; i++)
    if (!isfinite(points[i][0]) || !isfinite(points[i][1]))
      code = status_fail(error, STATUS_USAGE, "%s: a point of the map has no place on its axes", path);
  if (code)
    goto cleanup;
  struct picture_axis x = {x_label, distinct(count, points, 0, xs), xs, false},
                      y = {y_label, distinct(count, points, 1, ys), ys, false};
  if (x.count * y.count > MOST_TILES) {
    code = status_fail(error, STATUS_USAGE, "%s: %zu x %zu tiles are too many for a map; choose axes with fewer values",
                       path, x.count, y.count);
    goto cleanup;
  }
  value = malloc((x.count * y.count + 1) * sizeof *value);
  if (!value) {
    code = status_fail(error, STATUS_MEMORY, "%s: no memory for the map", path);
    goto cleanup;
  }
  for (size_t i = 0; i < x.count * y.count; i++)
    value[i] = NAN;
  for (size_t i = 0; i < count; i++)
    value[place(y.count, ys, points[i][1]) * x.count + place(x.count, xs, points[i][0])] = points[i][2];
  code = picture_map(path, width, title, quantity, &x, &y, value, error);
cleanup:
  free(xs);
  free(ys);
  free(value);
  return code;
}
