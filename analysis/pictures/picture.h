/* Pictures by cairo, PNG or SVG by the file's ending: fragmented bodies, spectra, maps of a quantity over two axes.
 * White background, no program and no display needed. A file appears under its name only when it is whole.
 *
 * Errors of all of them: STATUS_USAGE for another ending than .png or .svg (or nothing to draw), STATUS_IO when the
 * file cannot be written, STATUS_MEMORY. */
#ifndef CLAST_ANALYSIS_PICTURES_PICTURE_H
#define CLAST_ANALYSIS_PICTURES_PICTURE_H

#include <stdbool.h>
#include <stdint.h>

#include "analysis/pictures/picture_body.h"
#include "analysis/pictures/picture_cloud.h"
#include "analysis/statistics/pooled.h"

struct picture_panel {
  struct picture_body body;
  const char *caption; /* under the panel, may be NULL */
  double view[4];      /* x0, y0, x1, y1 in m; all zero: everything, but for far-flung dust */
};
/* One to three panels side by side on one scale each, with a scale bar. title and subtitle may be NULL. width: pixels
 * (PNG) or points (SVG), 200 to 8000. */
status picture_fragments(const char *path, double width, const char *title, const char *subtitle, size_t panels,
                         const struct picture_panel *panel, struct error *error);

/* What a body's picture should say below its title: "1100 grains in 259 fragments, 180 of them single; largest 12.1 %
 * of the area". `cells`: what its cells are called ("grains"). Empty when there is nothing or the labels are wrong. */
void picture_fragments_numbers(const struct picture_body *body, const char *cells, char *text, size_t size);

enum picture_view {
  PICTURE_CUT,     /* through a plane: every particle that the plane meets, as it meets it */
  PICTURE_OUTSIDE, /* from outside, all of it, near before far */
  PICTURE_APART,   /* from outside, fragments moved away from each other; dust is left out */
};
struct picture_look {
  enum picture_view view;
  int axis;     /* looked along: 0 x (y to the right, z up), 1 y (x right, z up), 2 z (x right, y up) */
  double plane; /* m, place of the cut along the axis; NaN: through the centre of mass of the heaviest fragment, or of
                   all */
  const char *title, *subtitle; /* may be NULL */
  const char *quantity, *unit;  /* of the values: "damage", "1"; "pressure", "Pa" */
};
/* Values between 0 and 1 in unit 1 keep that range; others span what is drawn of the bodies searched for fragments,
 * but for its outermost percent, evenly about zero when both signs occur. Beside STATUS_IO and so on: STATUS_USAGE when
 * the plane meets no particle. */
status picture_particles(const char *path, double width, const struct picture_cloud *cloud,
                         const struct picture_look *look, struct error *error);
/* "95210 particles: 143 fragments of two and more (largest 34.6 %, second 3.1 % of the mass), 41.2 % dust". */
void picture_particles_numbers(const struct picture_cloud *cloud, char *text, size_t size);

/* A fitted power law: drawn so that it holds as many fragments per run in [lower, upper) as the fit was made from. */
struct picture_fit {
  const char *label;                            /* "beta 2.03 +- 0.05" */
  double beta, lower, upper, fragments_per_run; /* upper may be HUGE_VAL */
};
struct picture_series {
  const char *label;
  size_t count;
  const struct pooled_bin *bins; /* of pooled_spectrum() with unit_mass 1 */
  size_t fits;
  const struct picture_fit *fit;
};
/* Log-log F(m) with error bars (one standard error over runs) and fit lines. One to eight series. */
/* The legend stands beside the frame, so the picture is wider than `width` by it. */
status picture_spectrum(const char *path, double width, const char *title, const char *mass_unit, size_t count,
                        const struct picture_series *series, struct error *error);

/* Quantities along a line (depth below a crater, say), one panel each, one above the other; values that are no numbers
 * are gaps. */
struct picture_profile {
  const char *label; /* "damage", "pressure (Pa)" */
  const double *y;
  double at_least[2]; /* the panel shows this range at least; HUGE_VAL, -HUGE_VAL: what there is */
};
/* x ascending, `count` of them for every panel; one to three panels. STATUS_USAGE when there is no range to draw over.
 */
status picture_profile(const char *path, double width, const char *title, const char *x_label, size_t count,
                       const double *x, size_t panels, const struct picture_profile *panel, struct error *error);

/* A mean with its interval over an input's value. */
struct picture_mean {
  double x, y, low, high; /* ends of the interval; NaN: none is drawn */
};
struct picture_curve {
  const char *label; /* may be NULL */
  size_t count;
  const struct picture_mean *mean; /* x ascending */
};
/* One to eight curves: dots with error bars, joined by lines. x is logarithmic when all of it is positive and spans a
 * factor of 20 and more. The legend stands beside the frame, so the picture is wider than `width` by it. STATUS_USAGE
 * when there is no dot to draw. */
status picture_curves(const char *path, double width, const char *title, const char *x_label, const char *y_label,
                      size_t count, const struct picture_curve *curve, struct error *error);

struct picture_axis {
  const char *label;
  size_t count;
  const double *values; /* ascending, distinct */
  bool log;             /* all positive, ticks at the values in any case */
};
/* Heat map: value[j * x.count + i] at (x.values[i], y.values[j]); NaN is left white and crossed. */
status picture_map(const char *path, double width, const char *title, const char *quantity,
                   const struct picture_axis *x, const struct picture_axis *y, const double *value,
                   struct error *error);

/* The same from loose points (x, y, value) in any order: every distinct x is a column, every distinct y a line, what is
 * not there stays blank. Of two values in one place the later counts. At most 10 000 tiles (STATUS_USAGE). */
status picture_map_points(const char *path, double width, const char *title, const char *quantity, const char *x_label,
                          const char *y_label, size_t count, const double (*points)[3], struct error *error);

#endif
