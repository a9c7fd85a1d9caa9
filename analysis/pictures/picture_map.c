/* A quantity over two axes: one tile per point, the value in the tile where it fits, and a colour bar. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "analysis/pictures/picture.h"
#include "analysis/pictures/picture_canvas.h"
#include "analysis/pictures/picture_frame.h"
#include "analysis/statistics/sample.h"

struct axis {
  const char *label;
  size_t count;
  const double *values; /* ascending, distinct */
};

/* Where things stand on the page. */
struct layout {
  cairo_t *cairo;
  double font, left, top, wide, tall; /* of the frame */
  double tile_x, tile_y;
  double low, high; /* range of the values */
};

static void tick_text(double value, char text[64]) {
  snprintf(text, 64, "%.4g", value);
}

/* The widest of an axis' numbers. */
static double tick_width(cairo_t *cairo, double font, const struct axis *axis) {
  double widest = 0;
  for (size_t j = 0; j < axis->count; j++) {
    char text[64];
    tick_text(axis->values[j], text);
    widest = fmax(widest, picture_canvas_text_width(cairo, 0.95 * font, false, text));
  }
  return widest;
}

/* A tile without a value is crossed. */
static void draw_cross(const struct layout *l, double x, double y) {
  cairo_set_source_rgb(l->cairo, 0.75, 0.75, 0.75);
  cairo_set_line_width(l->cairo, 0.06 * l->font);
  cairo_move_to(l->cairo, x, y);
  cairo_rel_line_to(l->cairo, l->tile_x, l->tile_y);
  cairo_move_to(l->cairo, x + l->tile_x, y);
  cairo_rel_line_to(l->cairo, -l->tile_x, l->tile_y);
  cairo_stroke(l->cairo);
}

static void draw_tile(const struct layout *l, double x, double y, double value) {
  if (!isfinite(value)) {
    draw_cross(l, x, y);
    return;
  }
  double share = l->high > l->low ? (value - l->low) / (l->high - l->low) : 0.5;
  picture_canvas_ramp(l->cairo, PICTURE_RAMP_RISING, share);
  cairo_rectangle(l->cairo, x, y, l->tile_x + 0.4, l->tile_y + 0.4);
  cairo_fill(l->cairo);

  double digits = fmin(0.85 * l->font, 0.24 * l->tile_x);
  if (digits < 0.4 * l->font || l->tile_y < 1.3 * digits)
    return;
  char text[64];
  snprintf(text, sizeof text, "%.3g", value);
  if (share > 0.55)
    cairo_set_source_rgb(l->cairo, 0.1, 0.1, 0.1);
  else
    cairo_set_source_rgb(l->cairo, 1, 1, 1);
  picture_canvas_text(l->cairo, x + l->tile_x / 2, y + l->tile_y / 2 + 0.35 * digits, digits, PICTURE_CENTRE, false,
                      text);
}

/* The frame and as many numbers beside it as fit. */
static void draw_axes(const struct layout *l, const struct axis *x, const struct axis *y) {
  cairo_set_source_rgb(l->cairo, 0.2, 0.2, 0.2);
  cairo_set_line_width(l->cairo, 0.08 * l->font);
  cairo_rectangle(l->cairo, l->left, l->top, l->wide, l->tall);
  cairo_stroke(l->cairo);
  char text[64];
  size_t every_x = (size_t)fmax(ceil(3.4 * l->font / l->tile_x), 1);
  size_t every_y = (size_t)fmax(ceil(1.3 * l->font / l->tile_y), 1);
  for (size_t i = 0; i < x->count; i += every_x) {
    tick_text(x->values[i], text);
    picture_canvas_text(l->cairo, l->left + l->tile_x * ((double)i + 0.5), l->top + l->tall + 1.4 * l->font,
                        0.95 * l->font, PICTURE_CENTRE, false, text);
  }
  for (size_t j = 0; j < y->count; j += every_y) {
    tick_text(y->values[j], text);
    picture_canvas_text(l->cairo, l->left - 0.5 * l->font,
                        l->top + l->tall - l->tile_y * ((double)j + 0.5) + 0.35 * l->font, 0.95 * l->font,
                        PICTURE_RIGHT, false, text);
  }
}

/* value[j * x->count + i] belongs to (x->values[i], y->values[j]). */
static status draw(const char *path, double width, const char *title, const char *quantity, const struct axis *x,
                   const struct axis *y, const double *value, struct error *error) {
  double range[2];
  picture_frame_range(x->count * y->count, value, range);
  if (!(range[1] >= range[0]))
    return status_fail(error, STATUS_USAGE, "%s: there is no value to draw", path);

  double font = width / 46, height = 0.72 * width;
  struct picture_canvas canvas;
  status code = picture_canvas_open(&canvas, path, width, height, error);
  if (code)
    return code;
  struct layout l = {.cairo = canvas.cairo, .font = font, .low = range[0], .high = range[1]};
  l.left = tick_width(canvas.cairo, font, y) + 3 * font;
  l.top = (title ? 3 : 1) * font;
  l.wide = width - l.left - 8 * font;
  l.tall = height - l.top - 3.8 * font;
  l.tile_x = l.wide / (double)x->count;
  l.tile_y = l.tall / (double)y->count;

  for (size_t j = 0; j < y->count; j++)
    for (size_t i = 0; i < x->count; i++)
      draw_tile(&l, l.left + l.tile_x * (double)i, l.top + l.tall - l.tile_y * (double)(j + 1),
                value[j * x->count + i]);
  draw_axes(&l, x, y);
  picture_canvas_colour_bar(l.cairo, PICTURE_RAMP_RISING, l.left + l.wide + 1.2 * font, l.top, 1.1 * font, l.tall, font,
                            l.low, l.high, quantity);
  picture_canvas_title(l.cairo, l.left, font, title);
  picture_canvas_text(l.cairo, l.left + l.wide / 2, height - 0.8 * font, 1.05 * font, PICTURE_CENTRE, false, x->label);
  picture_canvas_text_upright(l.cairo, 1.5 * font, l.top + l.tall / 2, 1.05 * font, y->label);
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
  return (size_t)(found - values); /* every value is on the axis, which was made from them */
}

status picture_map(const char *path, double width, const char *title, const char *quantity, const char *x_label,
                   const char *y_label, size_t count, const double (*points)[3], struct error *error) {
  enum { MOST_TILES = 10000 };
  if (count == 0)
    return status_fail(error, STATUS_USAGE, "%s: an axis of the map is empty or not finite", path);
  double *xs = malloc((count + 1) * sizeof *xs), *ys = malloc((count + 1) * sizeof *ys), *value = NULL;
  status code = xs && ys ? STATUS_OK : status_fail(error, STATUS_MEMORY, "%s: no memory for the map", path);
  for (size_t i = 0; i < count && !code; i++)
    if (!isfinite(points[i][0]) || !isfinite(points[i][1]))
      code = status_fail(error, STATUS_USAGE, "%s: a point of the map has no place on its axes", path);
  if (code)
    goto cleanup;
  struct axis x = {x_label, distinct(count, points, 0, xs), xs}, y = {y_label, distinct(count, points, 1, ys), ys};
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
  code = draw(path, width, title, quantity, &x, &y, value, error);
cleanup:
  free(xs);
  free(ys);
  free(value);
  return code;
}
