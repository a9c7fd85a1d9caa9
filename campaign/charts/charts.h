/* Charts and pictures of a store: the options and the names that all charts share, quantities over varied inputs, and
 * what each command draws. */
#pragma once

#include "analysis/pictures/picture.h"
#include "analysis/statistics/statistics.h"
#include "campaign/terminal/option.h"
#include "db/ask/ask.h"
#include "engine/outcome.h"

struct chart_options {
  bool keep_script;
};
/* clang-format off */
#define CHART_OPTIONS(type_, member_)                                                                                  \
  OPTION_ROW_FLAG("keep-script", 0, type_, member_.keep_script,                                                        \
                  .doc = "Leave NAME.gp and NAME.dat beside the chart NAME.png: change them, and gnuplot "     \
                         "draws it again.")
/* clang-format on */

/* A page of the usual width. */
struct picture_page charts_page(const char *path, const struct chart_options *options);

/* The name of a column of the views by its row: "mass share of the largest fragment M₁/M"; of an exponent
 * "exponent β of F(m)". Without a row: the words of the column. */
enum { CHARTS_LABEL = 300 };
void charts_label(const char *column, char label[CHARTS_LABEL]);
/* The same with the unit in the store: "impact speed (m/s)". */
status charts_axis(struct store *store, const char *column, char label[CHARTS_LABEL], struct error *error);
/* The paths of inputs, separated by ", ", as their names: "impact speed, weibull m". */
void charts_labels(const char *paths, char *labels, size_t size);
/* ", disc-explosion" for a title where all points have one scene, else "". */
status charts_scene(struct store *store, char scene[CHARTS_LABEL], struct error *error);
/* "95 % intervals over seeds", or over points that differ in the pooled inputs, or of some marks each. */
void charts_intervals(const struct ask_group_pooled *pooled, char *text, size_t size);
/* Describes the known error of the resolution of a quantity at the points of the store, before `adds` if there is
 * one. */
void charts_resolution(struct store *store, const char *quantity, const char *adds, char *text, size_t size);

/* Appends "; only campaign 2; 1 run excluded; 2 of 22 runs gave no result; withheld, 1 of 20 runs: box; ! in doubt, 3
 * of 19 runs drawn: coarse, early" to a caption, if there are such runs. store: whose chosen runs are drawn
 * (ask_run_missing()); NULL: others. */
void charts_doubts(struct store *store, const struct ask_doubts *doubts, char *text, size_t size);

/* ---- a quantity over one or two varied inputs: the mean of a result over the runs that share the inputs, or an
 * exponent fitted to the runs of each point ---- */

/* Options of both commands: the input on the horizontal axis, and the quantity. */
#define QUANTITY_AXIS_OPTION(type_, member_)                                                                           \
  OPTION_ROW_TEXT("x", 'x', "AXIS", type_, member_, NULL,                                                              \
                  .doc = "Varied input on the horizontal axis: a path or its unique ending. Without it the command "   \
                         "takes the first varied inputs that all points have.")
#define QUANTITY_OPTION(type_, member_)                                                                                \
  OPTION_ROW_TEXT(                                                                                                     \
      "quantity", 'Q', "NAME", type_, member_, NULL,                                                                   \
      .doc = "Quantity to draw: a result (a column of the view runs), or an exponent fitted to the runs of a "         \
             "point: beta, or beta_METHOD_WINDOW (beta_masses_from_2). Default: the main quantity of the newest "      \
             "campaign.")

/* Prints a line on stderr for each condition that the runs behind these quantities (ask_doubts_results()) break. */
status quantity_tell_doubts(struct store *store, const char *quantities, struct error *error);
/* Fails with STATUS_USAGE: no run has a value of the quantity; says in how many it is withheld, and by which words. */
status quantity_no_values(struct store *store, const char *quantity, struct error *error);
/* Prints a line on stderr that names the varied inputs without effect (ask_group_idle()); none: prints nothing. */
status quantity_tell_idle(struct store *store, struct error *error);
/* Prints a line on stderr if pooled points share seeds; none do: prints nothing. */
void quantity_tell_shared(struct store *store, const struct ask_group_pooled *pooled);
/* Prints a line on stderr: the meaning of the intervals, and the error of the resolution. pooled: of ask_group(); NULL:
 * nothing. */
void quantity_tell_resolution(struct store *store, const char *name, const struct ask_group_pooled *pooled);
/* Prints a line for each of several comma-separated names; "main": the default quantity. */
void quantity_tell_resolutions(struct store *store, const char *names, const struct ask_group_pooled *pooled);
/* Prints a sentence on stderr: how many of the chosen points have an error of at most `within`, in the quantity's SI
 * unit or (of_value) as a share of the mean, and the largest error. The error of a point is the half width of the
 * interval over its seeds plus what finer settings may change. Points of fewer than two runs do not count. */
status quantity_tell_accuracy(struct store *store, const char *name, const char *unit, double within, bool of_value,
                              struct error *error);

/* Draws the quantity over `x`, a line for each value of `by` (may be NULL). STATUS_USAGE: x is not a number, too many
 * lines or points, unknown names. */
status quantity_plot(struct store *store, const char *x, const char *by, const char *name,
                     const struct picture_page *page, struct error *error);

/* Draws the quantity over x and y as tiles, a panel for each value of `by` (NULL: one panel). STATUS_USAGE: too many
 * tiles or panels, unknown names. */
status quantity_map(struct store *store, const char *x, const char *y, const char *by, const char *name,
                    const struct picture_page *page, struct error *error);

/* ---- spectra ---- */

struct spectrum_choice {
  struct ask_pool_choice pool;
  bool cumulative, runs;           /* runs: also every single run */
  double density;                  /* kg/m^3: sizes are shown instead of masses; 0: masses */
  const struct measured *measured; /* NULL: none */
};

/* Reads a measured spectrum for the choice. The choice's density and the store's dimensions relate sizes and masses. */
status spectrum_curves_measured(struct store *store, const char *path, struct spectrum_choice *choice,
                                struct measured *measured, struct error *error);

/* The first eight pools, with the measured spectrum. */
status spectrum_curves_draw(struct store *store, const struct spectrum_choice *choice, const struct picture_page *page,
                            struct error *error);

/* ---- bodies ---- */

/* The options of the command; NULL: not given. */
struct picture_choice {
  const char *caption, *what, *view, *axis, *at;
  struct chart_options chart; /* options of a profile's chart */
  double width;               /* width of a body's picture, pixels; 0: default */
  bool quiet;                 /* does not print what the marks mean */
};

/* "812 µs", "10 ms"; "" of a time that is not finite. */
void picture_draw_time(double seconds, char text[32]);

/* STATUS_USAGE: options that do not suit the file; also the statuses of analysis/pictures/picture.h. */
status picture_draw(const char *fields, const char *picture, const struct picture_choice *options, struct error *error);
