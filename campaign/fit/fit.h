/* A fit finds the inputs of a campaign that reproduce the measurements. The campaign's laws are the priors, and its
 * sampled points are the first ensemble. Each point has seeds of its own, unless the campaign says that they are not
 * independent: what a seed does at all points alike would else be the scatter of a few specimens. Rounds of runs move
 * the ensemble towards the data (analysis/inference). Surfaces are fitted to the means of all runs and give the
 * posterior.
 *
 *     fit_rounds_launch(line, &options, &error);   // documents, farm, rounds, report
 *
 * The rounds depend only on the documents and the rule, so that a repeated command finds all its runs in the store. */
#pragma once

#include "analysis/inference/inference.h"
#include "campaign/charts/charts.h"
#include "campaign/document/observed.h"
#include "campaign/launch/launch.h"

enum { FIT_FEWEST_MEMBERS = 8, FIT_MOST_ROUNDS = 10 };

struct fit_rule {
  int64_t rounds; /* most rounds of the ensemble, including the last round at its end and one from the posterior */
  uint64_t seed;  /* seed of the algebra's random numbers; the runs' seeds are the campaign's */
  void (*note)(void *context, const char *text); /* a line after each round; may be NULL */
  void *note_context;
};

enum fit_phase {
  FIT_ENSEMBLE, /* members move towards the data */
  FIT_ARRIVED,  /* one round at their last places */
  FIT_REFINED,  /* one round at places drawn from the posterior */
  FIT_DONE,
};

struct fit {
  const struct campaign *campaign; /* borrowed */
  const struct observed *observed; /* borrowed */
  const char *scene_reference;     /* from the current folder; borrowed */
  char words[1000];                /* the campaign's file and --store, for a command */
  struct fit_rule rule;

  size_t inputs, axis[INFERENCE_INPUTS]; /* axis of the campaign of each unknown input */
  bool bounded[INFERENCE_INPUTS], counts[OBSERVED_DATA];
  struct ask_doubts doubts[OBSERVED_DATA];         /* of the runs that were read for each datum */
  struct ask_doubts all_doubts;                    /* of the runs of all data, each once */
  struct posterior_datum data[OBSERVED_DATA];      /* a count N is compared as ln(1 + N) */
  struct ask_resolution resolution[OBSERVED_DATA]; /* from a study in the store, for data without `resolution` */
  bool exact[OBSERVED_DATA];                       /* a count without an error that no seed changes: see fit_errors() */

  /* All points so far, and the values of their runs: point x datum x replicate. Owned. */
  size_t points, capacity, members, replicates;
  double *z, *values;

  enum fit_phase phase;
  size_t shot; /* shot that runs next in this round */
  struct ensemble_kalman ensemble;
  double *place; /* owned: members x inputs, of the current round */
  double gamma[OBSERVED_DATA * OBSERVED_DATA];
  size_t rounds; /* rounds of the ensemble that were run, all phases */

  /* What was found. */
  struct surfaces surfaces;
  struct posterior posterior;
  struct identify found;
};

/* STATUS_CONTENT: the campaign's design is not sampled, an input has no law, too few points or seeds. *out owns what it
 * allocates and borrows the rest. Free it also after an error. */
status fit_create(const struct campaign *campaign, const struct observed *observed, const struct fit_rule *rule,
                  const char *scene_reference, struct fit **out, struct error *error);
void fit_free(struct fit *fit); /* NULL is fine */

/* Value of an unknown input at a normal coordinate, rounded to six digits. */
void fit_value(const struct fit *fit, size_t input, double z, struct field_value *value);
/* The same as a number for tables. */
double fit_number(const struct fit *fit, size_t input, double z);
/* Transforms a run's value for the comparison in the fit, and back. */
double fit_transform(const struct observed_datum *datum, double value);
double fit_back(const struct observed_datum *datum, double transformed);

/* The runs in the order that the algebra takes them; `packed` has room for all values. */
struct surfaces_runs fit_runs(const struct fit *fit, double *packed);
/* Errors of the data for the points so far. A count without an error that no seed changes gets an error of 1; another
 * such number: STATUS_CONTENT. Without an error one run would decide all. */
status fit_errors(struct fit *fit, struct error *error);
/* Surfaces and posterior from all points so far. */
status fit_solve(struct fit *fit, struct error *error);
/* The same, and the information that the data give about the inputs. */
status fit_find(struct fit *fit, struct error *error);

/* ---- fit_rounds.c ---- */

struct fit_launch {
  struct launch_options launch;
  struct chart_options chart;
  const char *store, *picture;
  int64_t rounds, seed;
};

/* Reads both documents (line->arguments), runs the rounds, prints the report on rank 0. */
status fit_rounds_launch(const struct command_line *line, const struct fit_launch *options, struct error *error);

/* ---- fit_print.c ---- */

/* For people a table of the inputs, a table of the measurements, and conclusions in sentences. For programs one table:
 * rows of kind input, then of kind measured. */
status fit_print(const struct fit *fit, enum table_format format, struct error *error);

/* Draws the measurements beside the predictions for one more experiment. */
status fit_print_picture(const struct fit *fit, const char *path, const struct chart_options *chart,
                         struct error *error);
