/* The quantity of a study of convergence: a result of every run, or an exponent fitted to all runs of a point. */
#ifndef CLAST_CAMPAIGN_CONVERGE_STUDY_QUANTITY_H
#define CLAST_CAMPAIGN_CONVERGE_STUDY_QUANTITY_H

#include "analysis/statistics/estimates.h"
#include "engine/engine.h"

struct study_quantity {
  const struct field *row; /* result of a run; NULL: an exponent */
  bool of_outcome;
  enum exponent_method method;
  enum estimates_window window;
  char name[FIELD_TEXT_SIZE];   /* the path of the row, or "beta", "beta_METHOD_WINDOW" */
  char column[FIELD_TEXT_SIZE]; /* its name in the store's table convergence */
};

/* STATUS_CONTENT or STATUS_USAGE, with similar names: there is no such quantity. */
status study_quantity_find(const struct engine_kind *kind, const char *name, struct study_quantity *quantity,
                           struct error *error);

#endif
