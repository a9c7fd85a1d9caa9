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
  double half_width; /* 95 % bound on how far a finer resolution may move the quantity, in its unit; NaN: not known */
  char scene[128];   /* whose study answers, or is missing; "SCENE" when the store has several scenes */
};

/* What `clast converge` found with the results_version of the point's newest runs: the sum over the knobs of resolution
 * that were studied there, be the point the scene studied or one of its levels. quantity: a result column of the view
 * runs, beta, or beta_METHOD_WINDOW. point_id 0: all points of the store together. store NULL: a run without a store,
 * never studied. */
status ask_resolution(struct store *store, int64_t point_id, const char *quantity, struct ask_resolution *out,
                      struct error *error);

#endif
