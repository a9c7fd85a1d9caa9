/* A frame with axes, ticks and a label on its side, for pictures of quantities along a line. For the picture_*.c files
 * only. */
#ifndef CLAST_ANALYSIS_PICTURES_PICTURE_FRAME_H
#define CLAST_ANALYSIS_PICTURES_PICTURE_FRAME_H

#include <cairo.h>
#include <stdbool.h>
#include <stddef.h>

struct picture_frame {
  cairo_t *cairo;
  double left, top, wide, tall, font; /* on the page; font: size of the text */
  double x[2], y[2];                  /* ranges; log10 of a logarithmic x */
  bool log_x;
};

/* The range of the finite values; HUGE_VAL, -HUGE_VAL when there is none. */
void picture_frame_range(size_t n, const double *values, double range[2]);
/* Extends a range to a value, if it is finite. */
void picture_frame_extend(double range[2], double value);
/* Extends a range at both ends by a share of it; a range of one value gets some extent, too. */
void picture_frame_widen(double range[2], double share);
/* Places on the page. */
double picture_frame_across(const struct picture_frame *f, double x);
double picture_frame_up(const struct picture_frame *f, double y);
/* The frame, its ticks with numbers (those of x only if `below`), and its label on the left. */
void picture_frame_draw(const struct picture_frame *f, bool below, const char *y_label);

#endif
