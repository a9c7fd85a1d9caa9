/* Colour ramps, the colour bar, the scale bar of lengths. For the picture_*.c files only. */
#ifndef CLAST_ANALYSIS_PICTURES_PICTURE_BARS_H
#define CLAST_ANALYSIS_PICTURES_PICTURE_BARS_H

#include <cairo.h>

/* Ramps that read in grey and for the colour-blind: lightness changes evenly from one end to the other, in a signed
 * ramp from the middle to both ends. */
enum picture_ramp {
  PICTURE_RAMP_RISING, /* dark blue to pale yellow */
  PICTURE_RAMP_SIGNED, /* blue, nearly white in the middle, orange brown */
  PICTURE_RAMP_DAMAGE, /* pale stone to near black red: unbroken rock is light, broken rock stands out */
};
void picture_bars_colour(cairo_t *cairo, enum picture_ramp ramp, double share); /* share 0..1 */

/* The colour bar: upright, with ticks on its right and `quantity` beside it. It needs 6.5 font to the right of
 * x + width. */
void picture_bars_colours(cairo_t *cairo, enum picture_ramp ramp, double x, double y, double width, double height,
                          double font, double low, double high, const char *quantity);
/* The scale bar: a round length of about a quarter of `available`, with its text above. */
void picture_bars_length(cairo_t *cairo, double x, double y, double points_per_metre, double available, double font);

#endif
