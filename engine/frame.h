/* What the runs of all engines have in common: the state that says how a run goes, its loop of steps, the look at its
 * energy, and its end. The run of an engine begins with a struct frame, its state with a struct frame_state. */
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "engine/outcome.h"

struct frame_state {
  int finished, stop, outcome_state; /* stop: the engine's reason */
  char message[FIELD_TEXT_SIZE];
  double closed_start; /* the closed sum of the energy ledger at the start, J (in the plane: J/m) */
  double energy_input; /* energy put in at the start, J or J/m */
  uint64_t samples;    /* of the curve that the protocol records */
};

/* The ledger now. A drift counts relative to the energy put in. */
struct frame_energy {
  double closed, input; /* J or J/m */
  double bound;         /* largest drift over input; NaN: none */
};

/* What an engine's runs do; `run` is the engine's run. */
struct frame_kind {
  int fault;          /* the engine's reason of an end by a fault */
  uint64_t looks;     /* steps between two looks at the energy; a look costs about a step */
  const char *member; /* "grain", "particle" */
  /* One step, and what the protocol records of it. False: there is no step. Then the run has ended by a fault, or
   * memory is out. */
  bool (*step)(void *run);
  void (*stop)(void *run); /* the rules of the end, after every step */
  void (*look)(void *run); /* what else to check when the energy is looked at; NULL: nothing */
  struct frame_energy (*energy)(void *run);
  size_t (*fastest)(void *run, double *speed);    /* the fastest member, or the first that is not finite; m/s */
  const char *(*remedy)(void *run, double drift); /* against a drift (J or J/m); NaN: against what is not finite */
};

struct frame {
  const struct frame_kind *kind;
  struct frame_state *state; /* the first member of the engine's state, which is a plain value of state_size bytes */
  size_t state_size;
  const void *inputs;
  uint64_t seed;
  const double *time; /* s simulated */
  const uint64_t *steps;
  const char *failure; /* why there was no step, when memory is out */
  double end_time;     /* s: the hard end, for the progress */
  void *sample;        /* the curve: sample_capacity samples; NULL: the protocol records none */
  size_t sample_size, sample_capacity;
};

/* Ends the run. The first reason stays, but a fault replaces any other. An outcome beyond OUTCOME_END_TIME is a fault.
 */
void frame_end(struct frame_state *state, int stop, int outcome_state, const char *format, ...)
    __attribute__((format(printf, 4, 5)));
/* The same for a quantity that is no longer finite. */
void frame_end_not_finite(struct frame *frame, const char *quantity);

/* At most max_steps; the result does not depend on how steps are split over calls. STATUS_MEMORY: the run has no result
 * and cannot go on. */
status frame_advance(struct frame *frame, uint64_t max_steps);
/* The calls of struct engine_kind that all runs with a frame have in common. */
status frame_step(void *run, uint64_t max_steps, bool *finished, struct error *error);
double frame_time(const void *run);
double frame_progress(const void *run);
/* Ends the run when its energy has drifted too far. frame_advance calls it every kind->looks steps and at the end. */
void frame_look(struct frame *frame);

/* The outcome as far as it follows from the state; a run that is not finished gives results of a snapshot. */
struct outcome frame_outcome(const struct frame *frame, double time_step);
