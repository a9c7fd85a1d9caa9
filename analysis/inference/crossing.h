/* Where a response crosses a level along one input: the interval of the crossing from runs at any places, and the
 * places of the next runs.
 *
 * The only assumption is that the response keeps rising, or keeps falling, through its crossing: no form of the curve
 * and no equal noise. For every gap between neighbouring places the likelihood ratio compares the best monotone curve
 * with the best one that crosses in this gap (isotonic regression, Banerjee & Wellner 2001, doi
 * 10.1214/aos/1015345959). The gaps that it does not reject are the interval.
 *
 *     crossing_find(&data, &found, &error);
 *     crossing_next(&found, runs, places);      // until found.high - found.low is small enough */
#pragma once

#include <stdbool.h>
#include <stddef.h>

#include "schemas/status.h"

enum {
  CROSSING_FIRST = 5,  /* places of the first round, evenly spaced over the bracket, ends included */
  CROSSING_RUNS = 4,   /* runs at each of them */
  CROSSING_PLACES = 4, /* places of a later round */
  CROSSING_PARTS = 8,  /* most crossings that are told apart */
};

struct crossing_data {
  size_t n;
  const double *x; /* place of each run: 0 and 1 are the ends of the bracket */
  const double *y; /* its result; NaN: none, the run is left out */
  double level;
  double share; /* NaN: the mean crosses the level. Else the share of runs above the level crosses this share, 0..1 */
};

enum crossing_kind {
  CROSSING_FOUND, /* one crossing, between low and high */
  CROSSING_ABOVE, /* none: above the level in the whole bracket */
  CROSSING_BELOW,
  CROSSING_SEVERAL, /* two or more, in different directions: `part` */
  CROSSING_PLATEAU, /* within 3 % of the response's range of the level from low to high */
  CROSSING_OPEN,    /* the runs do not tell whether the crossing is in the bracket: low < 0 or high > 1 */
};
extern const char *const crossing_kind_names[]; /* "crossing", "above", ... */

struct crossing {
  enum crossing_kind kind;
  double at, low, high; /* median and 95 % interval; low -0.1 or high 1.1: beyond the bracket */
  bool rising;
  bool contradicted;    /* a place lies on the wrong side of the answer: the next runs are there */
  double contradiction; /* that place */
  size_t n;             /* runs with a result */
  double share;         /* share of runs above the level at the crossing, if only this share was used; else NaN */
  size_t parts;         /* of CROSSING_SEVERAL */
  struct crossing_part {
    double low, high;
  } part[CROSSING_PARTS];
  double next[CROSSING_PLACES];
};

/* If no result lies near the level (a gap of 0.3 of the range of the results is around it), the response may have two
 * modes, and means of few runs do not tell their scatter. Then the mean crosses the level where the share of the upper
 * mode crosses the share with which the two modes have this mean.
 * STATUS_CONTENT: fewer than two places have results. STATUS_MEMORY. */
status crossing_find(const struct crossing_data *data, struct crossing *out, struct error *error);

/* Places of the next round: shares of 1/8, 3/8, 5/8 and 7/8 of the likelihood of the crossing; or around a place that
 * contradicts the answer. Returns the number of runs at each place when `runs` were made so far, so that a round adds
 * about a sixth. */
size_t crossing_next(const struct crossing *found, size_t runs, double place[CROSSING_PLACES]);

/* Runs that an interval of this width needs, by the one that `runs` gave: widths fall as the root of their number, at
 * best. Two digits. */
size_t crossing_runs_for(size_t runs, double width, double within);

/* Is this an answer? A crossing is one if its interval is at most this wide. */
bool crossing_is_answer(const struct crossing *found, double within);
