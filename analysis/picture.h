/* Pictures by cairo, PNG or SVG by the file's ending: fragmented bodies, spectra, maps of a quantity over two axes. White
 * background, no program and no display needed. A file appears under its name only when it is whole.
 *
 * Errors of all of them: STATUS_USAGE for another ending than .png or .svg (or nothing to draw), STATUS_IO when the file
 * cannot be written, STATUS_MEMORY. */
#ifndef CLAST_ANALYSIS_PICTURE_H
#define CLAST_ANALYSIS_PICTURE_H

#include <stdbool.h>

#include "analysis/pooled.h"

/* A body in pieces, whatever engine made it: convex cells with the number of the fragment each belongs to, 0 the heaviest.
 * All arrays borrowed. */
struct picture_body {
  size_t cells;
  const uint32_t *first_vertex;  /* cells + 1 */
  const double (*vertex)[2];     /* m */
  const uint32_t *fragment;      /* per cell */
  size_t cracks;                 /* broken links between cells of one fragment are drawn as cracks; others are gaps anyway */
  const uint32_t (*crack)[2];    /* pairs of cells; NULL for none */
};
struct picture_panel {
  struct picture_body body;
  const char *caption;           /* under the panel, may be NULL */
  double view[4];                /* x0, y0, x1, y1 in m; all zero: everything, but for far-flung dust */
};
/* One to three panels side by side on one scale each, with a scale bar. title and subtitle may be NULL. width: pixels
 * (PNG) or points (SVG), 200 to 8000. */
status picture_fragments(const char *path, double width, const char *title, const char *subtitle, size_t panels,
                         const struct picture_panel *panel, struct error *error);

/* What a body's picture should say below its title: "1100 grains in 259 fragments, 180 of them single; largest 12.1 % of the
 * area". `cells`: what its cells are called ("grains"). Empty when there is nothing or the labels are wrong. */
void picture_fragments_numbers(const struct picture_body *body, const char *cells, char *text, size_t size);

/* A fitted power law: drawn so that it holds as many fragments per run in [lower, upper) as the fit was made from. */
struct picture_fit {
  const char *label; /* "beta 2.03 +- 0.05" */
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

struct picture_axis {
  const char *label;
  size_t count;
  const double *values; /* ascending, distinct */
  bool log;             /* all positive, ticks at the values in any case */
};
/* Heat map: value[j * x.count + i] at (x.values[i], y.values[j]); NaN is left white and crossed. */
status picture_map(const char *path, double width, const char *title, const char *quantity, const struct picture_axis *x,
                   const struct picture_axis *y, const double *value, struct error *error);

/* The same from loose points (x, y, value) in any order: every distinct x is a column, every distinct y a line, what is not
 * there stays blank. Of two values in one place the later counts. At most 10 000 tiles (STATUS_USAGE). */
status picture_map_points(const char *path, double width, const char *title, const char *quantity, const char *x_label,
                          const char *y_label, size_t count, const double (*points)[3], struct error *error);

#endif
