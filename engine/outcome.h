/* The results of a finished run that every engine reports: columns of table `run`. */
#pragma once

#include "engine/fragments.h"
#include "schemas/field.h"

/* How a run ended. This is a deterministic result; it is not the failure of an attempt. */
enum outcome_state {
  OUTCOME_COMPLETED,  /* fracture had ceased by the scene's declared rule */
  OUTCOME_END_TIME,   /* the hard end came first: fragments may still be breaking */
  OUTCOME_NOT_FINITE, /* NaN or infinity appeared */
  OUTCOME_TIME_STEP,  /* the stable time step collapsed */
  OUTCOME_ENERGY,     /* the energy ledger drifted out of its declared bound */
  OUTCOME_INVALID,    /* the inputs cannot be run together (the message says why) */
  OUTCOME_STATES
};

struct outcome {
  int state;                      /* enum outcome_state, a FIELD_CHOICE */
  char message[FIELD_TEXT_SIZE];  /* diagnostics for a person; empty when all is well */
  char warnings[FIELD_TEXT_SIZE]; /* words of warnings; empty when there are none */
  int64_t steps;
  double time;                    /* s simulated */
  double time_step;               /* s, the smallest used */
  double total_mass;              /* kg or kg/m */
  double energy_error;            /* ledger: |closed sum - initial| / energy put in */
  double momentum_error;          /* |sum p - initial - external impulse| / sum |p| */
  int64_t fragment_count;         /* all, single grains (dust) included */
  int64_t single_count;           /* fragments of one grain: unresolved */
  double dust_fraction;           /* mass share of fragments lighter than dust (outcome_small) */
  double complete_mass;           /* kg or kg/m: the fragment spectrum is complete above this mass */
  double largest_fraction;        /* M_1 / M */
  double second_fraction;         /* M_2 / M */
  double mean_fragment_mass;      /* second moment over first of all fragment masses, kg */
  double mean_fragment_mass_rest; /* the same without the largest fragment */
  double kinetic_energy_share;    /* fragments' translation energy over the energy put in */
};

extern const struct field_table outcome_table;
#define OUTCOME_DEFAULT "largest_fraction" /* the default quantity of commands and campaigns */

/* The index-th main result by field.main_rank, NULL past the last one. The store's views, index and checks follow from
 * these rows. */
const struct field *outcome_main(size_t index);

/* The name of a member's row, which is its column in the store: OUTCOME_NAME(total_mass). */
const char *outcome_name(size_t offset);
#define OUTCOME_NAME(member) outcome_name(offsetof(struct outcome, member))

/* True if a run of this state gives results: completed, or stopped at its end time. */
bool outcome_is_usable(int state);
/* Does a run count in statistics? Its state is usable and every main result is a number. (A surplus run does not count
 * whatever its results.) */
bool outcome_counts(const struct outcome *outcome);

/* An engine's mass limits of small fragments. */
struct outcome_small {
  double dust;     /* kg or kg/m: lighter fragments are dust; NaN: single grains are dust */
  double complete; /* kg or kg/m: complete_mass */
};

/* Fill the rows that follow from the fragments alone (by descending mass): total mass, counts, fractions, moments. */
void outcome_fragments(struct outcome *outcome, size_t count, const struct fragment *fragments,
                       const struct outcome_small *small);
