/* The limit of a result as a knob gets finer, from all levels and seeds at once:
 *
 *     value of a run at step s = limit + a s^p + noise,   LIMIT_ORDER_LEAST <= p <= LIMIT_ORDER_MOST
 *
 * The noise of a level has a standard deviation of its own; runs of one seed have a common part, of the correlation rho
 * between any two levels. Deviations and rho are drawn from their posterior given the scatter of the runs about the
 * means of their levels, so that few seeds make wide intervals, as with Student's t. For each law, generalised least
 * squares find limit and a for every draw. A law is a p, a number of coarse levels that it leaves out (each costs
 * LIMIT_COST_OF_LEVEL in -2 ln likelihood), or two terms a s^p + b s^q of all levels (LIMIT_COST_OF_TERM).
 *
 * An interval is that of the profile likelihood over the laws: it holds every value that some law does not reject. So
 * its coverage holds for every p of the range, also where the levels cannot tell p; there it is wide. A prior over p
 * would make it shorter and miss the limit of the p at the ends of the range.
 *
 * Only a law that the levels contradict is told from a right one. Two errors that cancel within the noise on all
 * levels, or a law that changes beyond the finest level, look like a limit that is reached
 * (tests/verification/limits.md). */
#ifndef CLAST_ANALYSIS_STATISTICS_LIMIT_H
#define CLAST_ANALYSIS_STATISTICS_LIMIT_H

#include <stdbool.h>
#include <stddef.h>

#define LIMIT_ORDER_LEAST   0.5
#define LIMIT_ORDER_MOST    2.0
#define LIMIT_COST_OF_LEVEL 3.0
#define LIMIT_COST_OF_TERM  4.0
enum { LIMIT_LEVELS = 12, LIMIT_FEWEST_LEVELS = 3, LIMIT_FEWEST_SEEDS = 3 };

struct limit_ladder {
  size_t levels;                      /* coarse to fine; at most LIMIT_LEVELS */
  double step[LIMIT_LEVELS];          /* decreasing, above 0; NaN: none, so that no law applies */
  const double *values[LIMIT_LEVELS]; /* by seed, the same seed at the same index; NaN: no usable run */
  size_t seeds;
  double least, most;             /* range of the result; -HUGE_VAL, HUGE_VAL: none */
  double order_least, order_most; /* 0: LIMIT_ORDER_LEAST and LIMIT_ORDER_MOST. Equal: the order is known */
};

enum limit_verdict {
  LIMIT_TOO_FEW,  /* fewer than three levels or three seeds */
  LIMIT_CONSTANT, /* all runs of all levels are equal: nothing tells how far other runs may be */
  LIMIT_SEEN,     /* a law of the range agrees with the three finest levels at least */
  LIMIT_NOT_SEEN, /* none does */
  LIMIT_VERDICTS
};

/* A number with its interval. */
struct limit_range {
  double value, low, high;
};

struct limit_law {
  enum limit_verdict verdict;
  size_t dropped;           /* coarse levels that the law does not describe */
  double fit;               /* share of the samples of the best law of one p that lie farther from it than the levels;
                               LIMIT_NOT_SEEN: below 0.05 with any number of dropped levels */
  double fit_with;          /* the same with one of the dropped levels; NaN: none is dropped */
  struct limit_range order; /* the range that the levels do not reject */
  struct limit_range limit; /* with the interval of the given confidence, as all others */
  struct limit_range
      distance[LIMIT_LEVELS]; /* mean of the level less the limit, by the law; a dropped level: measured */
  struct limit_range change;  /* of the mean from the next to finest level to the finest one */
};

/* The value of the law at a step that need not be a level. */
struct limit_point {
  double step;
  struct limit_range mean;     /* mean over all seeds */
  struct limit_range sample;   /* mean over as many other runs of this step as the levels have seeds */
  struct limit_range distance; /* mean less the limit */
};

/* Pure: the same values give the same bits. `points`: steps to evaluate, filled when the verdict is LIMIT_SEEN; may be
 * NULL. False: memory ran out. */
bool limit_infer(const struct limit_ladder *ladder, double confidence, struct limit_law *law, size_t count,
                 struct limit_point *points);

#endif
