/* Colour ramps and bars. */
#include "analysis/pictures/picture_bars.h"

#include <math.h>
#include <stdio.h>

#include "analysis/pictures/picture_canvas.h"

void picture_bars_colour(cairo_t *cairo, enum picture_ramp ramp, double share) {
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

void picture_bars_colours(cairo_t *cairo, enum picture_ramp ramp, double x, double y, double width, double height,
                          double font, double low, double high, const char *quantity) {
  enum { STEPS = 128 };
  cairo_set_antialias(cairo, CAIRO_ANTIALIAS_NONE); /* no seams between the steps */
  for (int i = 0; i < STEPS; i++) {
    picture_bars_colour(cairo, ramp, (i + 0.5) / STEPS);
    cairo_rectangle(cairo, x, y + height * (STEPS - 1 - i) / STEPS, width, height / STEPS + 0.5);
    cairo_fill(cairo);
  }
  cairo_set_antialias(cairo, CAIRO_ANTIALIAS_DEFAULT);
  cairo_set_source_rgb(cairo, 0.2, 0.2, 0.2);
  cairo_set_line_width(cairo, 0.07 * font);
  cairo_rectangle(cairo, x, y, width, height);
  cairo_stroke(cairo);
  double step = high > low ? picture_canvas_round_length((high - low) / 3) : 1;
  for (double tick = ceil(low / step) * step; tick <= high + 1e-9 * step; tick += step) {
    char text[32];
    double place = high > low ? y + height * (high - tick) / (high - low) : y + height / 2;
    snprintf(text, sizeof text, "%.4g", fabs(tick) < 1e-9 * step ? 0 : tick);
    cairo_move_to(cairo, x + width, place);
    cairo_rel_line_to(cairo, 0.4 * font, 0);
    cairo_stroke(cairo);
    picture_canvas_text(cairo, x + width + 0.6 * font, place + 0.35 * font, 0.9 * font, PICTURE_LEFT, false, text);
  }
  picture_canvas_text_upright(cairo, x + width + 5 * font, y + height / 2, 1.05 * font, quantity);
}

void picture_bars_length(cairo_t *cairo, double x, double y, double points_per_metre, double available, double font) {
  char text[32];
  double metres = picture_canvas_round_length(0.24 * available / points_per_metre), length = metres * points_per_metre;
  picture_canvas_length_text(metres, text, sizeof text);
  cairo_set_source_rgb(cairo, 0.15, 0.15, 0.15);
  cairo_rectangle(cairo, x, y - 0.28 * font, length, 0.28 * font);
  cairo_fill(cairo);
  picture_canvas_text(cairo, x + length / 2, y - 0.6 * font, 0.9 * font, PICTURE_CENTRE, false, text);
}
