/* The document of measurements that `clast fit` compares a campaign with. Plain keys are rows of tables; a shot's `set`
 * and its list of masses are read by hand.
 *
 *     name: basalt spheres
 *     source: who measured it, and where it is printed        # required: a number without a source is no datum
 *     shots:
 *       - name: shot 1
 *         set: {impact.speed: 3.2 km/s}                       # inputs of this shot
 *         specimens: 1                                        # that each value is the mean of
 *         measured:
 *           - {quantity: largest_fraction, value: 0.31, error: 0.005, resolution: 0.06}
 *           - {quantity: count_above, share: 0.01, value: 12} # fragments heavier than this share of the body
 *       - name: shot 2
 *         fragments: {total: 302 g, complete: 0.5 g, masses: [94 g, 31 g, 12 g]} */
#pragma once

#include "campaign/document/campaign.h"
#include "db/ask/ask.h"

enum { OBSERVED_DATA = 32, OBSERVED_SHOTS = 32 };

/* One number of one shot. */
struct observed_datum {
  char quantity[FIELD_TEXT_SIZE];    /* a result, an exponent (beta, beta_METHOD_WINDOW), count_above, share_above */
  double share;                      /* mass limit of count_above and share_above, as a share of the body's mass */
  double value, error;               /* SI; standard deviation of the measurement */
  double resolution;                 /* standard deviation of the change by a finer resolution; NaN: not given */
  struct ask_specimens_quantity ask; /* how a run's value is found */
  size_t shot;
};

struct observed_shot {
  char name[FIELD_TEXT_SIZE];
  int64_t specimens;
  struct scene *scene; /* owned: the campaign's scene with this shot's inputs */
  char set[1000];      /* these, as a command takes them: " --set charge.energy='1 kJ/m'" */
};

struct observed {
  char name[FIELD_TEXT_SIZE], source[FIELD_TEXT_SIZE];
  struct observed_shot shots[OBSERVED_SHOTS];
  struct observed_datum data[OBSERVED_DATA]; /* in order of shots */
  size_t shot_count, datum_count;
};

/* Reports all errors of the document together, each with its place. STATUS_MISSING, STATUS_IO, STATUS_CONTENT. Keeps no
 * pointer to the campaign. */
status observed_load(const char *path, const struct campaign *campaign, struct observed **out, struct error *error);
status observed_parse(const char *name, const char *text, size_t size, const struct campaign *campaign,
                      struct observed **out, struct error *error);
void observed_free(struct observed *observed); /* NULL is fine */

/* "shot 1: M1/M" for tables and pictures: the shot's name is left out when there is only one. */
void observed_label(const struct observed *observed, size_t datum, char *label, size_t size);
