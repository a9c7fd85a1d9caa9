/* Which values of inputs are safe: a row of tiles per input, each tile divided by the shares of safe, warned and
 * refused runs. */
#include <math.h>

#include "analysis/pictures/picture.h"
#include "analysis/pictures/picture_canvas.h"

static const double font = 11, row_height = 19, head_height = 26, margin = 14, indent = 12;

enum { SAFE, WARNED, REFUSED, CLASSES };
static const char *const names[CLASSES] = {"safe", "warned", "refused"};

/* The colours also differ in lightness, for colour-blind readers and in grey. */
static void set_colour(cairo_t *cairo, int class) {
  static const double lightness[CLASSES] = {0.94, 0.82, 0.64}, chroma[CLASSES] = {0.05, 0.14, 0.17},
                      hue[CLASSES] = {160, 80, 25};
  picture_canvas_colour(cairo, lightness[class], chroma[class], hue[class], 1);
}

static void draw_tile(cairo_t *cairo, double x, double y, double width, const struct picture_margin_tile *tile) {
  double sum = 0, from = x;
  for (int c = 0; c < CLASSES; c++)
    sum += tile->runs[c];
  for (int c = 0; c < CLASSES && sum > 0; c++) {
    const double part = width * tile->runs[c] / sum;
    set_colour(cairo, c);
    cairo_rectangle(cairo, from, y, part, row_height - 3);
    cairo_fill(cairo);
    from += part;
  }
  cairo_set_source_rgb(cairo, 0, 0, 0);
  picture_canvas_text(cairo, x + width / 2, y + row_height - 7, 0.85 * font, PICTURE_CENTRE, false, tile->text);
}

static void draw_legend(cairo_t *cairo, double width, double y) {
  double x = width - margin;
  for (int c = CLASSES; c-- > 0;) {
    const double text = picture_canvas_text_width(cairo, font, false, names[c]);
    cairo_set_source_rgb(cairo, 0, 0, 0);
    picture_canvas_text(cairo, x, y, font, PICTURE_RIGHT, false, names[c]);
    set_colour(cairo, c);
    cairo_rectangle(cairo, x - text - 18, y - 10, 13, 12);
    cairo_fill(cairo);
    x -= text + 32;
  }
}

/* Where the tiles begin: right of the widest label. */
static double left_of_tiles(cairo_t *cairo, size_t count, const struct picture_margin *row) {
  double widest = 0;
  for (size_t k = 0; k < count; k++)
    widest = fmax(widest, picture_canvas_text_width(cairo, font, false, row[k].label));
  return margin + indent + widest + font;
}

static void draw_row(cairo_t *cairo, double left, double width, double y, const struct picture_margin *row) {
  cairo_set_source_rgb(cairo, 0, 0, 0);
  picture_canvas_text(cairo, margin + indent, y + row_height - 7, font, PICTURE_LEFT, false, row->label);
  const double each = (width - left - margin) / (double)row->count;
  for (size_t t = 0; t < row->count; t++)
    draw_tile(cairo, left + each * (double)t, y, each - 2, &row->tile[t]);
}

status picture_margins(const char *path, double width, const char *title, size_t count,
                       const struct picture_margin *row, struct error *error) {
  double height = 2 * margin + 2 * font;
  if (count == 0)
    return status_fail(error, STATUS_USAGE, "there is nothing to draw: no input was varied");
  for (size_t k = 0; k < count; k++)
    height += row_height + (row[k].heading ? head_height : 0);
  struct picture_canvas canvas;
  TRY(picture_canvas_open(&canvas, path, width, height, error));
  cairo_set_source_rgb(canvas.cairo, 0, 0, 0);
  picture_canvas_text(canvas.cairo, margin, margin + font, 1.2 * font, PICTURE_LEFT, true, title);
  draw_legend(canvas.cairo, width, margin + font);
  const double left = left_of_tiles(canvas.cairo, count, row);
  double y = margin + 2 * font;
  for (size_t k = 0; k < count; k++) {
    if (row[k].heading) {
      cairo_set_source_rgb(canvas.cairo, 0, 0, 0);
      picture_canvas_text(canvas.cairo, margin, y + head_height - 8, font, PICTURE_LEFT, true, row[k].heading);
      y += head_height;
    }
    draw_row(canvas.cairo, left, width, y, &row[k]);
    y += row_height;
  }
  return picture_canvas_close(&canvas, STATUS_OK, error);
}
