/* Accuracy on demand: the cheapest settings and number of seeds that reach the accuracy of a campaign
 * (`accuracy: {quantity, within}`), from a study that `clast converge` has stored. */
#ifndef CLAST_CAMPAIGN_CONVERGE_ACCURACY_H
#define CLAST_CAMPAIGN_CONVERGE_ACCURACY_H

#include "analysis/statistics/convergence.h"
#include "campaign/document/campaign.h"
#include "db/store/store.h"

/* A way to run the campaign: one level of one knob, all other inputs as in the campaign's scene. */
struct accuracy_option {
  char knob[64], setting[64];
  bool own;          /* the scene's own settings */
  bool extrapolated; /* finer than any level that was run: error by the law, cost by the engine's measure of work */
  bool open;         /* the results show no limit, so that `error` may be too small: never chosen */
  double error;      /* change by finer settings of all knobs together, in the quantity's SI unit */
  int64_t seeds; /* number of seeds for which error and 95 % interval of the mean are within the accuracy; 0: no number
                    is enough */
  double run_s;  /* processor time of a run, s */
  double cpu_s;  /* processor time of one point (`seeds` runs), s; NaN when seeds is 0 */
};

struct accuracy {
  struct accuracy_option *options; /* owned; by cpu_s, then the options that do not reach the accuracy by error */
  size_t count;
  size_t chosen;    /* the cheapest option that reaches the accuracy; count: none does */
  size_t reference; /* the option with the smallest error; costs are relative to it */
};

/* Finds the options of a campaign with the key `accuracy`. Looks for a study of the campaign's scene, then of its
 * points: one study is used for all points. Levels of inputs that the campaign varies are no options. STATUS_CONTENT:
 * the store has no study; *error names the command that makes it, with `path`, the campaign's file. STATUS_MISSING:
 * there is no store. */
status accuracy_find(const struct campaign *campaign, const char *path, const char *store, struct accuracy *accuracy,
                     struct error *error);
void accuracy_clear(struct accuracy *accuracy); /* a zeroed one is fine */

/* Sets the chosen option's inputs and number of seeds in the campaign. STATUS_CONTENT when no option reaches the
 * accuracy. */
status accuracy_apply(const struct accuracy *accuracy, struct campaign *campaign, struct error *error);

enum accuracy_print { ACCURACY_SILENT, ACCURACY_TEXT, ACCURACY_JSON };

/* Calls accuracy_find and accuracy_apply if the campaign has the key `accuracy`. Before it applies the chosen option it
 * prints all of them, or makes *json of them, malloc'd. json: NULL, unless asked for. */
status accuracy_settle(struct campaign *campaign, const char *path, const char *store, enum accuracy_print print,
                       char **json, struct error *error);

/* Number of seeds whose interval's half width is at most `margin`, by Student's t; at least 3. 0: margin is not above
 * 0, the scatter is not known, or more than 10 000 seeds would be needed, where finer settings are better. */
int64_t accuracy_seeds(double deviation, double margin);

#endif
