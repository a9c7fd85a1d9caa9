/* Shared parts of all pictures: the file, text, colours, round lengths. For the picture_*.c files only. */
#pragma once

#include <cairo.h>
#include <stdbool.h>

#include "schemas/file.h"

struct picture_canvas {
  cairo_t *cairo; /* white page, origin top left, units pixels or points */
  cairo_surface_t *surface;
  bool png;
  struct file_output file;
};
/* STATUS_USAGE unless the name ends in .png, .svg or .pdf. */
status picture_canvas_named(const char *path, struct error *error);
status picture_canvas_open(struct picture_canvas *canvas, const char *path, double width, double height,
                           struct error *error);
/* Puts the picture in place when `code` is STATUS_OK, else removes it. Returns code, or the error of writing. */
status picture_canvas_close(struct picture_canvas *canvas, status code, struct error *error);

enum picture_align { PICTURE_LEFT, PICTURE_CENTRE, PICTURE_RIGHT };
void picture_canvas_text(cairo_t *cairo, double x, double y, double size, enum picture_align align, bool bold,
                         const char *text);
/* Title and subtitle at the head of a picture of a body; NULL: none. */
void picture_canvas_head(cairo_t *cairo, double x, double width, double font, const char *title, double small,
                         const char *subtitle);
/* A sentence under a picture, on at most two lines that fit the width. */
void picture_canvas_note(cairo_t *cairo, double x, double y, double width, double font, const char *text);
/* Clips to a rectangle of the page and sets coordinates in which it shows the view (m, y upwards), until
 * cairo_restore(). Returns pixels per metre. */
double picture_canvas_place(cairo_t *cairo, const double view[4], double left, double top, double width, double height);

double picture_canvas_text_width(cairo_t *cairo, double size, bool bold, const char *text);
/* Perceptual colours (OKLCH, Ottosson 2020): lightness 0..1, chroma 0..0.2, hue in degrees. */
void picture_canvas_colour(cairo_t *cairo, double lightness, double chroma, double hue, double alpha);

/* Colour ramps that also work in grey and for colour-blind readers: lightness changes evenly from one end to the other,
 * or in a signed ramp from the middle to both ends. */
enum picture_ramp {
  PICTURE_RAMP_RISING, /* dark blue to pale yellow */
  PICTURE_RAMP_SIGNED, /* blue, nearly white in the middle, orange brown */
  PICTURE_RAMP_DAMAGE, /* pale stone to near-black red: unbroken rock is light, broken rock is dark */
};
void picture_canvas_ramp(cairo_t *cairo, enum picture_ramp ramp, double share); /* share 0..1 */

/* Draws an upright colour bar, with ticks on its right and `quantity` beside it. It needs 6.5 font to the right of x +
 * width. */
void picture_canvas_colour_bar(cairo_t *cairo, enum picture_ramp ramp, double x, double y, double width, double height,
                               double font, double low, double high, const char *quantity);
/* Draws a scale bar: a round length of about a quarter of `available`, with its text above. */
void picture_canvas_scale_bar(cairo_t *cairo, double x, double y, double points_per_metre, double available,
                              double font);

/* Pictures in rows on one page (picture_sheet.c). */
struct picture_sheet {
  struct picture_canvas canvas;
  size_t count, columns, drawn;
  double view[4], gap, top, wide, tall, font; /* top: of the first row; wide, tall: of one picture */
  double right, below;                        /* places of the legend, and of scale bar and note */
};
/* Begins the next picture: its caption, and the title before the first. Then as picture_canvas_place(). */
double picture_sheet_next(struct picture_sheet *sheet, const char *title, const char *caption);
