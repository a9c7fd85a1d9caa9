/* The error that the resolution leaves in a result of a point: its number of particles or grains, its time step, its
 * precision. More seeds do not make it smaller; the interval over seeds does not hold it. */
#ifndef CLAST_DB_ASK_RESOLUTION_H
#define CLAST_DB_ASK_RESOLUTION_H

#include "db/ask/query.h"

enum ask_resolution_verdict {
  ASK_RESOLUTION_NOT_STUDIED, /* no study of the point's scene is in the store */
  ASK_RESOLUTION_KNOWN,       /* half_width holds it */
  ASK_RESOLUTION_AT_LEAST,    /* half_width holds what is known; no limit is known yet, so that it may be larger */
  ASK_RESOLUTION_DIVERGES,    /* studied: the quantity does not converge. half_width holds what is known */
};

struct ask_resolution {
  enum ask_resolution_verdict verdict;
  double half_width; /* 95 % bound on how far a finer resolution may move the quantity, in its unit: the largest of the
                        points; NaN: not known */
  int64_t points, studied; /* requested points with runs, and how many of them were studied */
  char knobs[128];         /* what was studied: "particles, time_step"; other settings may move the quantity, too */
  char scene[128];         /* whose study answers, or is missing; "SCENE" when the store has several scenes */
};

/* "not-studied", "known", "at-least", "diverges": as in the views. */
extern const char *const ask_resolution_names[];
/* The verdict that a column of the views or of ask_group names; anything else (also NULL): not studied. */
enum ask_resolution_verdict ask_resolution_verdict(const char *verdict);

/* What the view resolution says of the point's newest results_version: what `clast converge` found, be the point the
 * scene studied or one of its levels. quantity: a result column of the view
 * runs, beta, or beta_METHOD_WINDOW. point_id 0: all points of the store, of which the verdict is the worst of those
 * studied. store NULL: a run without a store, never studied. */
status ask_resolution(struct store *store, int64_t point_id, const char *quantity, struct ask_resolution *out,
                      struct error *error);

/* Has any point a study of an exponent? */
status ask_resolution_of_exponents(struct store *store, bool *studied, struct error *error);

#endif
