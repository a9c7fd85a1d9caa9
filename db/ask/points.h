/* Lists of points: which of them have runs, their inputs and the statistics of their runs. db/ask/point.h reads the
 * fragments of one point. */
#ifndef CLAST_DB_ASK_POINTS_H
#define CLAST_DB_ASK_POINTS_H

#include "db/ask/answer.h"
#include "db/ask/resolution.h"

enum { ASK_POINTS_INPUTS = 16 };

/* A point's runs of one results_version. */
struct ask_points_row {
  int64_t point_id;
  int64_t results_version; /* 0: the point has no runs */
  int64_t n, failed;       /* runs that count; runs that failed */
  double mean, half_width; /* of the largest fraction, with the half width of the 95 % interval of its mean. NaN: too
                              few runs */
  double resolution;       /* error that the resolution leaves in it; NaN: not known */
  enum ask_resolution_verdict resolution_verdict;
  size_t input_count;
  struct query_value inputs[ASK_POINTS_INPUTS]; /* values of the requested inputs, in their order; texts are borrowed
                                                   until the next row */
};

/* Selects points; 0 means all. */
struct ask_points_choice {
  int64_t campaign, point;
};

/* The number of these points, with and without runs. */
status ask_points_count(struct store *store, const struct ask_points_choice *choice, int64_t *points,
                        struct error *error);

/* STATUS_USAGE, with the known numbers, when the store has no point of this number. 0 means every point. */
status ask_points_known(struct store *store, int64_t point, struct error *error);

/* These points with the named input columns (ask_columns_axes; at most ASK_POINTS_INPUTS), in the order of their
 * numbers. Each point comes with its newest results_version only (`newest`), or once for every results_version. */
struct answer ask_points_rows(struct store *store, const struct ask_points_choice *choice, bool newest,
                              size_t input_count, const char *const *inputs, struct error *error);
/* The next row. False at the end and after an error; then answer_end(). */
bool ask_points_next(struct answer *answer, struct ask_points_row *row);

/* The varied inputs of a point by the last words of their paths, last path first: "strain 3 %, angle 4 deg".
 * Inputs that do not fit are left out. "point 7" when nothing was varied. */
status ask_points_label(struct store *store, int64_t point_id, char *label, size_t size, struct error *error);

struct ask_points_version {
  int64_t point_id;
  int results_version;
};
/* The points of a campaign (0: of all) whose runs have no pooled estimates yet, in *list (the caller frees it). */
status ask_points_without_estimates(struct store *store, int64_t campaign, struct ask_points_version **list,
                                    size_t *count, struct error *error);

#endif
