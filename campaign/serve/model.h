/* A campaign as a model for a server: the varied inputs as numbers, results by name, levels of a knob. */
#ifndef CLAST_CAMPAIGN_SERVE_MODEL_H
#define CLAST_CAMPAIGN_SERVE_MODEL_H

#include "campaign/converge/ladder.h"
#include "campaign/document/campaign.h"

enum { SERVE_MODEL_RESULTS = 64 };
#define SERVE_MODEL_OWN_LEVEL ((size_t)-1) /* the scene as it is */

struct serve_result {
  const struct field *row;
  bool of_outcome;
};

struct serve_model {
  const struct campaign *campaign; /* borrowed */
  size_t *inputs;                  /* owned: indices of the axes that are not linked */
  size_t input_count;
  struct serve_result results[SERVE_MODEL_RESULTS]; /* default results of a request */
  size_t result_count;
  struct ladder ladder; /* count 0: no levels */
};

/* results: comma-separated names, NULL: the campaign's main quantity. knob: "NAME" or "NAME=VALUE,VALUE", NULL: none.
 * STATUS_CONTENT: nothing is varied, or an input is no number. STATUS_USAGE: an unknown result or knob. */
status serve_model_make(const struct campaign *campaign, const char *results, const char *knob,
                        struct serve_model *model, struct error *error);
void serve_model_clear(struct serve_model *model);

/* STATUS_USAGE: more than SERVE_MODEL_RESULTS results, or one that is not a number of a run. */
status serve_model_result(const struct serve_model *model, const char *name, struct serve_result *result,
                          struct error *error);

/* The scene of these inputs (input_count of them, SI) at a level. NULL with *error when it cannot be run. Owned by the
 * caller. */
struct scene *serve_model_scene(const struct serve_model *model, const double *inputs, size_t level,
                                struct error *error);

/* Names, units and ranges as JSON, for people and scripts; malloc'd. */
char *serve_model_describe(const struct serve_model *model);

#endif
