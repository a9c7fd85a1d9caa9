/* The page, text and colours of pictures. */
#include "analysis/pictures/picture_canvas.h"

#include <cairo-pdf.h>
#include <cairo-svg.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "schemas/memory.h"
#include "schemas/text.h"

static status from_cairo(cairo_status_t code, const char *path, struct error *error) {
  if (code == CAIRO_STATUS_SUCCESS)
    return STATUS_OK;
  if (code == CAIRO_STATUS_NO_MEMORY)
    return status_fail(error, STATUS_MEMORY, "%s: no memory for the picture", path);
  return status_fail(error, STATUS_IO, "%s: cannot write the picture: %s. Is its folder there, writable and not full?",
                     path, cairo_status_to_string(code));
}

status picture_canvas_named(const char *path, struct error *error) {
  if (text_ends_in(path, ".png") || text_ends_in(path, ".svg") || text_ends_in(path, ".pdf"))
    return STATUS_OK;
  return status_fail(error, STATUS_USAGE, "%s: a picture's name ends in .png, .svg or .pdf", path);
}

static cairo_status_t write_bytes(void *out, const unsigned char *bytes, unsigned size) {
  return fwrite(bytes, 1, size, out) == size ? CAIRO_STATUS_SUCCESS : CAIRO_STATUS_WRITE_ERROR;
}

status picture_canvas_open(struct picture_canvas *canvas, const char *path, double width, double height,
                           struct error *error) {
  *canvas = (struct picture_canvas){.png = text_ends_in(path, ".png")};
  TRY(picture_canvas_named(path, error));
  if (!(width >= 200 && width <= 8000 && height >= 50 && height <= 16000))
    return status_fail(error, STATUS_USAGE, "%s: a picture is 200 to 8000 wide, not %g x %g", path, width, height);
  TRY(file_begin(&canvas->file, path, "picture", error));
  if (canvas->png)
    canvas->surface = cairo_image_surface_create(CAIRO_FORMAT_RGB24, (int)ceil(width), (int)ceil(height));
  else if (text_ends_in(path, ".pdf"))
    canvas->surface = cairo_pdf_surface_create_for_stream(write_bytes, canvas->file.out, width, height);
  else
    canvas->surface = cairo_svg_surface_create_for_stream(write_bytes, canvas->file.out, width, height);
  canvas->cairo = cairo_create(canvas->surface);
  const status code = from_cairo(cairo_status(canvas->cairo), path, error);
  if (code) {
    cairo_destroy(canvas->cairo);
    cairo_surface_destroy(canvas->surface);
    return file_end(&canvas->file, code, error);
  }
  cairo_set_source_rgb(canvas->cairo, 1, 1, 1);
  cairo_paint(canvas->cairo);
  cairo_set_line_join(canvas->cairo, CAIRO_LINE_JOIN_ROUND);
  return STATUS_OK;
}

status picture_canvas_close(struct picture_canvas *canvas, status code, struct error *error) {
  const char *path = canvas->file.path;
  FILE *out = canvas->file.out;
  if (!code)
    code = from_cairo(cairo_status(canvas->cairo), path, error);
  cairo_destroy(canvas->cairo);
  if (!code && canvas->png)
    code = from_cairo(cairo_surface_write_to_png_stream(canvas->surface, write_bytes, out), path, error);
  cairo_surface_finish(canvas->surface);
  if (!code)
    code = from_cairo(cairo_surface_status(canvas->surface), path, error);
  cairo_surface_destroy(canvas->surface);
  return file_end(&canvas->file, code, error);
}

double picture_canvas_text_width(cairo_t *cairo, double size, bool bold, const char *text) {
  cairo_text_extents_t extents;
  cairo_select_font_face(cairo, "sans-serif", CAIRO_FONT_SLANT_NORMAL,
                         bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(cairo, size);
  cairo_text_extents(cairo, text, &extents);
  return extents.x_advance;
}

void picture_canvas_text(cairo_t *cairo, double x, double y, double size, enum picture_align align, bool bold,
                         const char *text) {
  static const double share[] = {[PICTURE_LEFT] = 0, [PICTURE_CENTRE] = 0.5, [PICTURE_RIGHT] = 1};
  cairo_move_to(cairo, x - share[align] * picture_canvas_text_width(cairo, size, bold, text), y);
  cairo_show_text(cairo, text);
}

/* The font size, at most `size`, with which a text fits into the picture's width. */
static double fitting(cairo_t *cairo, double width, double size, bool bold, const char *text) {
  const double wide = picture_canvas_text_width(cairo, size, bold, text);
  return wide > width ? size * width / wide : size;
}

void picture_canvas_head(cairo_t *cairo, double x, double width, double font, const char *title, double small,
                         const char *subtitle) {
  double line = 1.9 * font;
  cairo_set_source_rgb(cairo, 0.1, 0.1, 0.1);
  if (title) {
    picture_canvas_text(cairo, x, line, fitting(cairo, width, 1.35 * font, true, title), PICTURE_LEFT, true, title);
    line += 1.6 * font;
  }
  cairo_set_source_rgb(cairo, 0.35, 0.35, 0.35);
  if (subtitle)
    picture_canvas_text(cairo, x, line, fitting(cairo, width, small, false, subtitle), PICTURE_LEFT, false, subtitle);
}

void picture_canvas_note(cairo_t *cairo, double x, double y, double width, double font, const char *text) {
  const size_t length = strlen(text);
  const char *second = text;
  cairo_set_source_rgb(cairo, 0.35, 0.35, 0.35);
  if (picture_canvas_text_width(cairo, font, false, text) > width)
    second = strchr(text + length / 2, ' ');
  if (second == text || !second) {
    picture_canvas_text(cairo, x, y, fitting(cairo, width, font, false, text), PICTURE_LEFT, false, text);
    return;
  }
  OWNED char *first = strndup(text, (size_t)(second - text));
  const char *line[2] = {first ? first : "", second + 1};
  for (int k = 0; k < 2; k++)
    picture_canvas_text(cairo, x, y + 1.3 * font * k, fitting(cairo, width, font, false, line[k]), PICTURE_LEFT, false,
                        line[k]);
}

double picture_canvas_place(cairo_t *cairo, const double view[4], double left, double top, double width,
                            double height) {
  const double scale = fmin(width / (view[2] - view[0]), height / (view[3] - view[1]));
  cairo_save(cairo);
  cairo_rectangle(cairo, left, top, width, height);
  cairo_clip(cairo);
  cairo_translate(cairo, left + width / 2, top + height / 2);
  cairo_scale(cairo, scale, -scale);
  cairo_translate(cairo, -(view[0] + view[2]) / 2, -(view[1] + view[3]) / 2);
  return scale;
}

static double companded(double linear) {
  double c = fmin(fmax(linear, 0), 1);
  return c <= 0.0031308 ? 12.92 * c : 1.055 * pow(c, 1 / 2.4) - 0.055;
}

/* Ottosson, "A perceptual color space for image processing" (2020). */
void picture_canvas_colour(cairo_t *cairo, double lightness, double chroma, double hue, double alpha) {
  double a = chroma * cos(hue * M_PI / 180), b = chroma * sin(hue * M_PI / 180);
  double l = lightness + 0.3963377774 * a + 0.2158037573 * b, m = lightness - 0.1055613458 * a - 0.0638541728 * b;
  double s = lightness - 0.0894841775 * a - 1.2914855480 * b;
  l *= l * l;
  m *= m * m;
  s *= s * s;
  cairo_set_source_rgba(cairo, companded(4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s),
                        companded(-1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s),
                        companded(-0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s), alpha);
}

/* The largest of 1, 2, 5 x 10^n that is at most `length`. */
static double round_length(double length) {
  double decade = pow(10, floor(log10(length)));
  double part = length / decade;
  if (part >= 5)
    return 5 * decade;
  return part >= 2 ? 2 * decade : decade;
}

/* "5 cm", "2 m", "500 µm". */
static void length_text(double metres, char *text, size_t size) {
  if (metres >= 1000)
    snprintf(text, size, "%g km", metres / 1000);
  else if (metres >= 1)
    snprintf(text, size, "%g m", metres);
  else if (metres >= 0.01)
    snprintf(text, size, "%g cm", metres * 100);
  else if (metres >= 0.001)
    snprintf(text, size, "%g mm", metres * 1000);
  else
    snprintf(text, size, "%g \xc2\xb5m", metres * 1e6);
}

void picture_canvas_ramp(cairo_t *cairo, enum picture_ramp ramp, double share) {
  double side = 2 * share - 1, far = fabs(side);
  switch (ramp) {
  case PICTURE_RAMP_RISING:
    picture_canvas_colour(cairo, 0.28 + 0.64 * share, 0.10 + 0.05 * sin(M_PI * share), 285 - 185 * share, 1);
    break;
  case PICTURE_RAMP_SIGNED:
    picture_canvas_colour(cairo, 0.95 - 0.55 * far, 0.17 * far * (1.25 - 0.4 * far), side < 0 ? 255 : 55, 1);
    break;
  case PICTURE_RAMP_DAMAGE:
    picture_canvas_colour(cairo, 0.91 - 0.66 * share, 0.02 + 0.45 * share * (1 - share) * (0.6 + 0.6 * share),
                          85 - 62 * share, 1);
    break;
  }
}

void picture_canvas_colour_bar(cairo_t *cairo, enum picture_ramp ramp, double x, double y, double width, double height,
                               double font, double low, double high, const char *quantity) {
  enum { STEPS = 128 };
  cairo_set_antialias(cairo, CAIRO_ANTIALIAS_NONE); /* no seams between the steps */
  for (int i = 0; i < STEPS; i++) {
    picture_canvas_ramp(cairo, ramp, (i + 0.5) / STEPS);
    cairo_rectangle(cairo, x, y + height * (STEPS - 1 - i) / STEPS, width, height / STEPS + 0.5);
    cairo_fill(cairo);
  }
  cairo_set_antialias(cairo, CAIRO_ANTIALIAS_DEFAULT);
  cairo_set_source_rgb(cairo, 0.2, 0.2, 0.2);
  cairo_set_line_width(cairo, 0.07 * font);
  cairo_rectangle(cairo, x, y, width, height);
  cairo_stroke(cairo);
  double step = high > low ? round_length((high - low) / 3) : 1;
  for (double tick = ceil(low / step) * step; tick <= high + 1e-9 * step; tick += step) {
    char text[32];
    double place = high > low ? y + height * (high - tick) / (high - low) : y + height / 2;
    snprintf(text, sizeof text, "%.4g", fabs(tick) < 1e-9 * step ? 0 : tick);
    cairo_move_to(cairo, x + width, place);
    cairo_rel_line_to(cairo, 0.4 * font, 0);
    cairo_stroke(cairo);
    picture_canvas_text(cairo, x + width + 0.6 * font, place + 0.35 * font, 0.9 * font, PICTURE_LEFT, false, text);
  }
  cairo_save(cairo);
  cairo_translate(cairo, x + width + 5 * font, y + height / 2);
  cairo_rotate(cairo, -M_PI / 2); /* the text runs upwards */
  picture_canvas_text(cairo, 0, 0, 1.05 * font, PICTURE_CENTRE, false, quantity);
  cairo_restore(cairo);
}

void picture_canvas_scale_bar(cairo_t *cairo, double x, double y, double points_per_metre, double available,
                              double font) {
  char text[32];
  double metres = round_length(0.24 * available / points_per_metre), length = metres * points_per_metre;
  length_text(metres, text, sizeof text);
  cairo_set_source_rgb(cairo, 0.15, 0.15, 0.15);
  cairo_rectangle(cairo, x, y - 0.28 * font, length, 0.28 * font);
  cairo_fill(cairo);
  picture_canvas_text(cairo, x + length / 2, y - 0.6 * font, 0.9 * font, PICTURE_CENTRE, false, text);
}
