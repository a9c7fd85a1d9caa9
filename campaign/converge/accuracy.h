/* Accuracy on demand: the cheapest settings and number of seeds that reach the accuracy of a campaign
 * (`accuracy: {quantity, within}`), from a study that `clast converge` has stored. */
#ifndef CLAST_CAMPAIGN_CONVERGE_ACCURACY_H
#define CLAST_CAMPAIGN_CONVERGE_ACCURACY_H

#include "analysis/statistics/convergence.h"
#include "campaign/document/campaign.h"
#include "db/store/store.h"

/* A way to run the campaign: one level of one knob, all else as the campaign's scene has it. */
struct accuracy_option {
  char knob[64], setting[64];
  bool own;      /* the scene's own settings */
  bool open;     /* no limit is in sight, so that `error` may be too small: never chosen */
  double error;  /* what finer settings would change, all knobs together */
  int64_t seeds; /* the number of seeds with which error and 95 % interval of the mean are within the accuracy; 0: no
                    number is enough */
  double run_s;  /* processor time of a run */
  double cpu_s;  /* of one point: seeds runs; NaN when seeds is 0 */
};

struct accuracy {
  struct accuracy_option *options; /* owned; by cpu_s, those that do not reach it last, by error */
  size_t count;
  size_t chosen;    /* the cheapest that reaches it; count: none does */
  size_t reference; /* the smallest error; costs are relative to it */
};

/* The options of a campaign that asks for an accuracy. Looks for a study of the campaign's scene, then of its points:
 * one serves all points. Levels of inputs that the campaign varies are no options. STATUS_CONTENT: the store has no
 * study; *error names the command that makes it. `path`: the campaign's file, for that. STATUS_MISSING: there is no
 * store. */
status accuracy_find(const struct campaign *campaign, const char *path, const char *store, struct accuracy *accuracy,
                     struct error *error);
void accuracy_clear(struct accuracy *accuracy); /* a zeroed one is fine */

/* Sets the chosen option's inputs and number of seeds in the campaign. STATUS_CONTENT when nothing reaches it. */
status accuracy_apply(const struct accuracy *accuracy, struct campaign *campaign, struct error *error);

/* accuracy_find and accuracy_apply, when the campaign asks for an accuracy; else nothing. */
status accuracy_settle(struct campaign *campaign, const char *path, const char *store, struct error *error);

/* Number of seeds whose interval's half width is at most `margin`, by Student's t; at least 3. 0: margin is not above
 * 0, the scatter is not known, or more than 10 000 would be needed: finer settings are the better way then. */
int64_t accuracy_seeds(double deviation, double margin);

#endif
