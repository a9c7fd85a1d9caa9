/* The dip of a sample, and its distribution by chance. */
#include "analysis/statistics/dip.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

#include "analysis/statistics/sample.h"
#include "engine/random.h"

/* The distribution function of n values, times n, jumps at value j from j to j + 1. Its greatest convex minorant runs
 * through points (value j, j), its least concave majorant through points (value j, j + 1). */
struct hull {
  const double *x;
  size_t *knot; /* work space of n */
  double *low;  /* for each value: the convex minorant on the current interval */
  double *high; /* the concave majorant */
  size_t *below,
      *above; /* for each value: the minorant's knot at it or to its left, the majorant's knot at it or to its right */
};

/* Finds the knots of the minorant (sign 1) or the majorant (sign -1) between the values `from` and `to`; returns their
 * number. Of equal values the first is a knot of the minorant, the last of the majorant. Both ends are always knots. */
static size_t find_knots(struct hull *h, size_t from, size_t to, int sign) {
  const double *x = h->x;
  size_t count = 0;
  for (size_t j = from; j <= to; j++) {
    while (count > 1) {
      const size_t a = h->knot[count - 2], b = h->knot[count - 1];
      const double turn = (x[b] - x[a]) * (double)(j - b) - (double)(b - a) * (x[j] - x[b]);
      if (sign * turn > 0)
        break;
      count--;
    }
    h->knot[count++] = j;
  }
  return count;
}

/* Computes the minorant or the majorant, and the knot next to each value. A step between equal values at an end costs
 * nothing, because the mode may contain it. */
static void fill(struct hull *h, size_t from, size_t to, int sign) {
  const size_t knots = find_knots(h, from, to, sign);
  const double *x = h->x, up = sign < 0;
  double *line = sign > 0 ? h->low : h->high;
  for (size_t k = 0; k + 1 < knots; k++) {
    const size_t a = h->knot[k], b = h->knot[k + 1];
    const bool step = !(x[b] > x[a]);
    for (size_t j = a; j <= b; j++) {
      line[j] = up + (step ? (double)j : (double)a + (double)(b - a) * (x[j] - x[a]) / (x[b] - x[a]));
      if (sign > 0)
        h->below[j] = j == b ? b : a;
      else if (j > a || k == 0)
        h->above[j] = j == a ? a : b;
    }
  }
}

/* Returns 2 n times the dip: narrows the interval of the mode until the distance between both hulls is smaller than the
 * cost of the parts outside. */
static double search(struct hull *h, size_t n) {
  size_t low = 0, high = n - 1;
  double dip = 1;
  while (low < high) {
    fill(h, low, high, 1);
    fill(h, low, high, -1);
    double most = 0;
    size_t at = low;
    for (size_t j = low; j <= high; j++)
      if (h->high[j] - h->low[j] > most) {
        most = h->high[j] - h->low[j];
        at = j;
      }
    if (most < dip)
      break;
    const size_t left = h->below[at], right = h->above[at];
    for (size_t j = low; j <= left; j++)
      dip = fmax(dip, (double)j + 1 - h->low[j]);
    for (size_t j = right; j <= high; j++)
      dip = fmax(dip, h->high[j] - (double)j);
    if (left == low && right == high)
      break;
    low = left;
    high = right;
  }
  return dip;
}

double dip_of(size_t n, const double *values) {
  if (n == 0)
    return NAN;
  struct hull h = {values,
                   malloc(n * sizeof *h.knot),
                   malloc(n * sizeof *h.low),
                   malloc(n * sizeof *h.high),
                   calloc(n, sizeof *h.below),
                   calloc(n, sizeof *h.above)};
  const double dip = h.knot && h.low && h.high && h.below && h.above ? search(&h, n) / (2 * (double)n) : (double)NAN;
  free(h.knot);
  free(h.low);
  free(h.high);
  free(h.below);
  free(h.above);
  return dip;
}

/* Sums of exponential steps are an ordered uniform sample up to a scale factor. */
static double drawn_dip(size_t size, uint64_t draw, double *sample) {
  double sum = 0;
  for (size_t i = 0; i < size; i++)
    sample[i] = sum -= log1p(-random_draw(size, RANDOM_RESAMPLE, draw, i));
  return dip_of(size, sample);
}

static size_t drawn_size(size_t n) {
  return n < DIP_MOST ? n : DIP_MOST;
}

double dip_share(size_t n, double dip) {
  enum { ENOUGH = 200 }; /* this many samples with a larger dip are enough: the share is then known to a tenth */
  if (n < 4 || !isfinite(dip))
    return NAN;
  const size_t size = drawn_size(n);
  const double limit = dip * sqrt((double)n / (double)size);
  double *sample = malloc(size * sizeof *sample);
  size_t larger = 0, drawn = 0;
  if (!sample)
    return NAN;
  for (; drawn < DIP_DRAWS && larger < ENOUGH; drawn++)
    larger += drawn_dip(size, drawn, sample) >= limit;
  free(sample);
  return ((double)larger + 1) / ((double)drawn + 1);
}

double dip_limit(size_t n) {
  /* dip_share() is below 0.05 while fewer than this many of the drawn dips are larger. */
  const size_t fewer = (size_t)(0.05 * (DIP_DRAWS + 1));
  if (n < 4)
    return NAN;
  const size_t size = drawn_size(n);
  double *sample = malloc(size * sizeof *sample), *dip = malloc(DIP_DRAWS * sizeof *dip), limit = NAN;
  for (size_t d = 0; sample && dip && d < DIP_DRAWS; d++)
    dip[d] = drawn_dip(size, d, sample);
  if (sample && dip) {
    qsort(dip, DIP_DRAWS, sizeof *dip, sample_descending);
    limit = dip[fewer - 1] * sqrt((double)size / (double)n);
  }
  free(sample);
  free(dip);
  return limit;
}
