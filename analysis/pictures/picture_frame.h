/* A box with axes, ticks and a label on its side: what pictures of quantities along a line have in common. For the
 * picture_*.c files only. */
#ifndef CLAST_ANALYSIS_PICTURES_PICTURE_FRAME_H
#define CLAST_ANALYSIS_PICTURES_PICTURE_FRAME_H

#include <cairo.h>
#include <stdbool.h>
#include <stddef.h>

struct picture_frame {
  cairo_t *cairo;
  double left, top, wide, tall, font; /* of the page */
  double x[2], y[2];                  /* ranges; of a logarithmic x its log10 */
  bool log_x;
};

/* The range of what is finite; HUGE_VAL, -HUGE_VAL when nothing is. */
void picture_frame_range(size_t n, const double *values, double range[2]);
/* More room by this share of the range at both ends; some also where the range is a point. */
void picture_frame_widen(double range[2], double share);
/* Places on the page. */
double picture_frame_across(const struct picture_frame *f, double x);
double picture_frame_up(const struct picture_frame *f, double y);
/* The box, its ticks with numbers (those of x only if `below`), and its label on the left. */
void picture_frame_draw(const struct picture_frame *f, bool below, const char *y_label);

#endif
