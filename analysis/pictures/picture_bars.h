/* Colour ramps, the bar that explains one, the bar that tells lengths. For the picture_*.c files only. */
#ifndef CLAST_ANALYSIS_PICTURES_PICTURE_BARS_H
#define CLAST_ANALYSIS_PICTURES_PICTURE_BARS_H

#include <cairo.h>

/* Lightness rises evenly in the one, and evenly towards both ends from the middle in the other, so that both read in
 * grey and for the colour-blind. */
enum picture_ramp {
  PICTURE_RAMP_RISING, /* dark blue to pale yellow */
  PICTURE_RAMP_SIGNED, /* blue, nearly white in the middle, orange brown */
  PICTURE_RAMP_DAMAGE, /* pale stone to near black red: whole rock is light, what is broken stands out */
};
void picture_bars_colour(cairo_t *cairo, enum picture_ramp ramp, double share); /* share 0..1 */

/* Upright, ticks on its right, `quantity` turned beside it: wants 6.5 font of room on the right of x + width. */
void picture_bars_colours(cairo_t *cairo, enum picture_ramp ramp, double x, double y, double width, double height,
                          double font, double low, double high, const char *quantity);
/* A round length of about a quarter of `room`, its text above. */
void picture_bars_length(cairo_t *cairo, double x, double y, double points_per_metre, double room, double font);

#endif
