/* The error of a point's result that comes from its resolution: its number of particles or grains, its time step, its
 * precision. More seeds do not reduce it, and the interval over seeds does not include it. */
#ifndef CLAST_DB_ASK_RESOLUTION_H
#define CLAST_DB_ASK_RESOLUTION_H

#include "db/ask/answer.h"

enum ask_resolution_verdict {
  ASK_RESOLUTION_NOT_STUDIED, /* the store has no study of the point's scene */
  ASK_RESOLUTION_KNOWN,       /* half_width is a bound */
  ASK_RESOLUTION_AT_LEAST,    /* half_width is the known part; the error may be larger, because no limit is known yet */
  ASK_RESOLUTION_DIVERGES,    /* studied: the quantity does not converge. half_width is the known part */
};

struct ask_resolution {
  enum ask_resolution_verdict verdict;
  double half_width; /* 95 % bound on the change of the quantity with finer resolution, in its unit: the largest of the
                        points; NaN: not known */
  int64_t points, studied; /* requested points with runs, and how many of them were studied */
  char knobs[128];         /* settings studied: "particles, time_step"; other settings may also change the quantity */
  char scene[128];         /* the scene that was studied, or needs a study; "SCENE" when the store has several scenes */
};

/* "not-studied", "known", "at-least", "diverges": as in the views. */
extern const char *const ask_resolution_names[];
/* The verdict named in a column of the views or of ask_group; any other text, or NULL: not studied. */
enum ask_resolution_verdict ask_resolution_verdict(const char *verdict);

/* The row of the view resolution for the point's newest results_version: the result of `clast converge`, whether the
 * point is the scene studied or one of its levels. `quantity`: a result column of the view runs, beta, or
 * beta_METHOD_WINDOW. point_id 0: all points of the store, with the worst verdict of those studied. `store` NULL: a run
 * without a store, never studied. */
status ask_resolution(struct store *store, int64_t point_id, const char *quantity, struct ask_resolution *out,
                      struct error *error);

/* Does any point have a study of an exponent? */
status ask_resolution_of_exponents(struct store *store, bool *studied, struct error *error);

#endif
