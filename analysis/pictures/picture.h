/* Pictures: broken bodies with cairo, and charts (spectra, curves, maps, profiles) with gnuplot from templates
 * (chart.h). PNG, SVG or PDF by the file's ending, on white, without a display. A file appears under its name only when
 * it is complete.
 *
 * Errors of all functions: STATUS_USAGE for another ending and when there is nothing to draw, STATUS_IO when the file
 * cannot be written, STATUS_MEMORY; for charts also STATUS_MISSING when gnuplot is not installed. Arrays are borrowed.
 * width: pixels (PNG) or points (SVG, PDF), 200 to 8000. title: NULL for none. */
#pragma once

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "analysis/pictures/chart.h"
#include "analysis/statistics/statistics.h"

enum { PICTURE_SERIES = 8 }; /* more series in one chart are hard to tell apart */

/* A broken body of convex polygons (DEM's grains), and the fragment of each polygon. */
struct picture_body {
  size_t cells;
  uint32_t *first_vertex; /* cells + 1: cell i has the vertices first_vertex[i] .. first_vertex[i + 1] - 1 */
  double (*vertex)[2];    /* m */
  uint32_t *fragment;     /* for each cell: number of its fragment, 0 the heaviest */
  size_t cracks;          /* broken links inside one fragment, drawn as lines; between fragments there is a gap */
  uint32_t (*crack)[2];   /* pairs of cells; NULL for none */
};

/* Reads the body of a fields file of any engine whose cells are polygons. The file may come from an untrusted source:
 * every size and index is checked. *body owns its arrays; free them with picture_fragments_clear(). STATUS_MISSING:
 * there is no such file. STATUS_CONTENT: the file is no fields file, or it is damaged. STATUS_MEMORY. After an error
 * *body is all zero. */
status picture_fragments_read(const char *path, struct picture_body *body, struct error *error);
void picture_fragments_clear(struct picture_body *body);

/* One frame for several pictures of a run: those of a movie or a sheet. Begin with PICTURE_NO_FRAME. */
struct picture_frame {
  double view[4];   /* m: x0, y0, x1, y1 */
  double low, high; /* of the values */
  double plane;     /* m: of cuts; NaN: not known yet */
  /* Of each grain or particle, its fragment in the last picture: a fragment has the colour of the heaviest one that it
   * becomes. */
  size_t members;
  int64_t *last; /* NULL: a fragment has the colour of its own number */
};
#define PICTURE_NO_FRAME                                                                                               \
  { .view = {HUGE_VAL, HUGE_VAL, -HUGE_VAL, -HUGE_VAL}, .low = HUGE_VAL, .high = -HUGE_VAL, .plane = NAN }

/* A sheet: pictures of one run in rows, in one frame, with a caption under each and one legend. Each call of
 * picture_particles() with look->sheet, or of picture_fragments_on_sheet(), draws the next of `count` pictures. The
 * frame is that of all of them. */
struct picture_sheet; /* opaque */
status picture_sheet_open(const char *path, size_t count, const struct picture_frame *frame,
                          struct picture_sheet **sheet, struct error *error);
/* Frees the sheet. The file appears when `code` is STATUS_OK. Returns code, or the error of writing. */
status picture_sheet_close(struct picture_sheet *sheet, status code, struct error *error);

struct picture_panel {
  struct picture_body body;
  const char *caption;               /* under the body; NULL: none */
  const struct picture_frame *frame; /* NULL: the whole body without distant dust */
};
/* Draws a body with its scale bar. subtitle may be NULL. */
status picture_fragments(const char *path, double width, const char *title, const char *subtitle,
                         const struct picture_panel *panel, struct error *error);

/* title: of the sheet; caption: of this picture. panel->caption is the note under the last one. */
status picture_fragments_on_sheet(struct picture_sheet *sheet, const char *title, const char *caption,
                                  const struct picture_panel *panel, struct error *error);

/* The view that a body's panel would get: all of it without distant dust. STATUS_MEMORY. */
status picture_fragments_view(const struct picture_body *body, double view[4]);

/* A line of numbers for a body's subtitle: "1100 grains in 259 fragments, 180 of them single; largest 12.1 % of the
 * area". cells: what the cells are ("grains"). Empty without cells or with wrong fragment numbers. */
void picture_fragments_numbers(const struct picture_body *body, const char *cells, char *text, size_t size);

/* ---- particles in space ----
 *
 * A fields file may come from an untrusted source, so the reader checks every size, number and index. */

/* A particle's role: unbroken, in the damaged layer at its fragment's surface, a single broken particle, or in a body
 * that has no fragments (a projectile). The numbers are those of the file. */
enum picture_part { PICTURE_CORE, PICTURE_LAYER, PICTURE_DUST, PICTURE_LEFT_OUT, PICTURE_PARTS };

struct picture_cloud {
  size_t n;
  double (*position)[3]; /* m, finite */
  double *size;          /* m, cube root of a particle's volume: above 0; in thin matter of a smaller one */
  double *mass;          /* kg, above 0 */
  int64_t *fragment;     /* number of its fragment by descending mass, below n; negative: none */
  int64_t *part;         /* enum picture_part */
  double *value;         /* values that colour the particles; NULL: coloured by fragment */
  char engine[32];       /* name of the engine that wrote the file */
  long long seed;
  double time; /* s; NaN: the file does not say */
};

/* True for a file of particles. False also for a file that cannot be read. */
bool picture_cloud_in_file(const char *path);

/* Reads all members except `value`. *cloud owns its arrays; free them with picture_cloud_clear(). STATUS_MISSING: there
 * is no such file. STATUS_CONTENT: the file is no fields file of particles, or it is damaged. STATUS_MEMORY. After an
 * error *cloud is empty. */
status picture_cloud_read(const char *path, struct picture_cloud *cloud, struct error *error);

/* Reads one more column ("damage", "pressure", ...): n values in *values (malloc'd), and the unit as the file gives it,
 * cut to its size. STATUS_CONTENT when the file has no such column: the message lists the columns that it has. */
status picture_cloud_read_column(const char *path, const struct picture_cloud *cloud, const char *name, double **values,
                                 char unit[32], struct error *error);

/* Why a particle or a layer has no value; only the pressure lacks some. */
#define PICTURE_BROKEN "broken matter, which bears no tension"

/* Reads one column of the profile along the axis ("depth", "distention", "damage", "pressure", "velocity"): *rows
 * values in *values (malloc'd), and their unit. STATUS_CONTENT when the file has no such column. */
status picture_cloud_read_axis(const char *path, const char *name, double **values, size_t *rows, char unit[32],
                               struct error *error);
void picture_cloud_clear(struct picture_cloud *cloud);

enum picture_view {
  PICTURE_CUT,     /* a cut: every particle that the plane meets, drawn as the disc of its section */
  PICTURE_OUTSIDE, /* all particles from outside, near ones before far ones */
  PICTURE_APART,   /* from outside, fragments side by side, so that none hides another; without dust */
};
struct picture_look {
  enum picture_view view;
  int axis;     /* line of sight: 0: x (y to the right, z up), 1: y (x right, z up), 2: z (x right, y up) */
  double plane; /* m, place of the cut along the axis; NaN: the centre of mass of the heaviest fragment, or of all
                   particles */
  const char *title, *subtitle; /* NULL: none */
  const char *doubts;           /* stands in the note under the picture; NULL: none */
  const char *quantity, *unit;  /* of the values: "damage", "1"; "pressure", "Pa" */
  struct picture_frame *frame;  /* NULL: the picture's own */
  struct picture_sheet *sheet;  /* NULL: a picture of its own; else title is the sheet's, and subtitle the caption */
};
/* Draws particles as discs of their size. The colour range is 0..1 for values of unit 1 within 0..1. Otherwise it is
 * the range of the drawn particles, without the outermost percent at both ends and without bodies that have no
 * fragments; it is symmetric about zero when both signs occur. STATUS_USAGE also when the plane meets no particle.
 * path NULL: draws nothing and widens look->frame to what the picture would show. */
status picture_particles(const char *path, double width, const struct picture_cloud *cloud,
                         const struct picture_look *look, struct error *error);
/* "95210 particles: 143 fragments of two and more (largest 34.6 %, second 3.1 % of the mass), 41.2 % in single
 * particles". */
void picture_particles_numbers(const struct picture_cloud *cloud, char *text, size_t size);

/* A fitted power law F(m) ~ m^-beta. Its line is normalised to the fit's number of fragments per run in [lower, upper).
 * A cumulative line with `run` is the mean of the runs' N(>m), as the marks are: the law below the largest fragment of
 * each run, and this fragment itself. */
struct picture_run {
  double largest;      /* kg */
  size_t equal, below; /* fragments of this mass; fragments in [lower, largest) */
};
struct picture_fit {
  const char *label;                            /* "beta 2.03 +- 0.05" */
  double beta, lower, upper, fragments_per_run; /* upper may be HUGE_VAL */
  size_t runs;
  const struct picture_run *run; /* NULL: all have the window [lower, upper) */
};
/* The fit's value in a form at a place of the axis; NaN outside [lower, upper). */
double picture_spectrum_fit(const struct picture_fit *fit, const struct pooled_form *form, double place);

struct picture_thin { /* a thin line behind a series: one of its runs */
  size_t count;
  const struct pooled_bin *bins;
};
struct picture_series {
  const char *label;
  size_t count;
  const struct pooled_bin *bins; /* of pooled_spectrum() */
  size_t fits;
  const struct picture_fit *fit;
  double complete_mass; /* kg: bins that begin below are grey, because fragments are missing there; 0 or NaN: no grey
                           bins */
  size_t thin_count;
  const struct picture_thin *thin;
  bool measured; /* measured data: drawn in black, as marks joined by a thin line */
};
/* Draws log-log spectra of one form, and lines of the fits. The 95 % intervals over runs are bars or, for cumulative
 * spectra, bands. One to eight series. */
status picture_spectrum(const struct picture_page *page, const struct picture_words *words,
                        const struct pooled_form *form, size_t count, const struct picture_series *series,
                        struct error *error);

/* Quantities along a line (such as depth below a crater), in panels one above the other. A value that is not finite
 * leaves a gap. */
struct picture_profile {
  const char *label; /* "damage", "pressure (Pa)" */
  const double *y;
  double at_least[2]; /* the panel shows at least this range; HUGE_VAL, -HUGE_VAL: the range of y */
};
/* Draws one to three panels of `count` points, x ascending. STATUS_USAGE also when x has no range. */
status picture_profile(const struct picture_page *page, const struct picture_words *words, size_t count,
                       const double *x, size_t panels, const struct picture_profile *panel, struct error *error);

/* Two quantities of several sizes over a scaled input, one panel above the other, on logarithmic axes: a data collapse.
 * Values that are not above 0 are left out. One to eight sizes. */
struct picture_size {
  const char *label;
  size_t count;
  const double *x;
  const double (*y)[2][3]; /* of each x and panel: value and its interval's ends */
};
status picture_collapse(const struct picture_page *page, const struct picture_words *words, const char *const panel[2],
                        size_t count, const struct picture_size *size, struct error *error);

/* A mean with its interval at a value of an input. */
struct picture_mean {
  double x, y, low, high; /* low, high: ends of the interval; NaN: none is drawn */
  double resolution;      /* a thin bar extends both ends by this; NaN: none is drawn */
  bool doubtful;          /* has a "!" beside it */
};
struct picture_curve {
  const char *label; /* may be NULL */
  size_t count;
  const struct picture_mean *mean;  /* x ascending */
  bool scattered;                   /* marks without a line: between them other inputs change, too */
  bool band;                        /* a smooth line in a band from low to high, without marks */
  const struct sample_range *range; /* of the values: bars and bands end there; NULL: any values */
  size_t places;                    /* of the first curve, > 0: bars; the x axis has these words at 1, 2, ... */
  const char *const *place;
};
/* Draws one to eight curves: marks with error bars joined by lines, or lines in bands. x is logarithmic when all its
 * values are positive and span a factor of 20 or more. */
status picture_curves(const struct picture_page *page, const struct picture_words *words, size_t count,
                      const struct picture_curve *curve, struct error *error);

/* The values of a point's runs. */
struct picture_sample {
  const char *label;
  size_t count;
  const double *value; /* ascending */
  struct scatter_histogram histogram;
};
/* Draws histograms and, below them, distribution functions. One to eight samples. words->x is the name of both x
 * axes. */
status picture_scatter(const struct picture_page *page, const struct picture_words *words, size_t count,
                       const struct picture_sample *sample, struct error *error);

struct picture_tile {
  double x, y, value;
  bool doubtful; /* a "!" behind the value */
  bool weak;     /* a "~" behind the value */
  int decimals;  /* of the value; -1: three digits */
  size_t panel;
};
/* Draws a heat map from tiles in any order: every distinct x is a column, every distinct y a row. A tile with NaN, or
 * without an entry, is crossed. If two tiles have the same place, the later one counts. At most 10 000 tiles
 * (STATUS_USAGE). Three and more tiles that share no x and no y are marks at their places on scales instead. quantity:
 * label of the colour bar. panel: labels of the panels side by side, one for each value of a third input; NULL: there
 * is one, without a label. */
status picture_map(const struct picture_page *page, const struct picture_words *words, const char *quantity,
                   size_t count, const struct picture_tile *tiles, size_t panels, const char *const *panel,
                   struct error *error);

/* Joins pictures of one size into a movie, by gnuplot. page->path ends in .gif. frame: names relative to the folder of
 * page->path. */
status picture_movie(const struct picture_page *page, double height, size_t count, const char *const *frame,
                     struct error *error);

/* One measured number, and the fit's prediction for one more such experiment. */
enum { PICTURE_QUANTILES = 5, PICTURE_PREDICTIONS = 32 };
struct picture_prediction {
  const char *label;
  double measured, error;             /* standard deviation */
  double quantile[PICTURE_QUANTILES]; /* 5, 25, 50, 75, 95 % */
};
/* Draws all numbers divided by their measured values, one row each. A measured value of 0 is left out. */
status picture_predicted(const struct picture_page *page, const struct picture_words *words, size_t count,
                         const struct picture_prediction *row, struct error *error);
