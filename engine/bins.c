/* Logarithmic bins with exact edges. */
#include "engine/bins.h"

#include <math.h>

/* 10^(j/10), and the powers of ten that a double represents exactly. A quotient of two exact numbers is correctly
 * rounded. */
static const double tenth[BINS_PER_DECADE] = {
    1.0,
    1.2589254117941673,
    1.5848931924611136,
    1.9952623149688797,
    2.5118864315095801,
    3.1622776601683795,
    3.9810717055349727,
    5.0118723362727229,
    6.3095734448019324,
    7.9432823472428150,
};
static const double exact_power[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
                                     1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
enum { LARGEST_EXACT_POWER = 22, LARGEST_DECADE = 330 };

double bins_edge(int bin) {
  int decade = bin / BINS_PER_DECADE, part = bin % BINS_PER_DECADE;
  if (part < 0) {
    part += BINS_PER_DECADE;
    decade--;
  }
  if (decade > LARGEST_DECADE)
    return HUGE_VAL;
  if (decade < -LARGEST_DECADE)
    return 0;
  double edge = tenth[part];
  for (; decade > LARGEST_EXACT_POWER; decade -= LARGEST_EXACT_POWER)
    edge *= exact_power[LARGEST_EXACT_POWER];
  for (; decade < -LARGEST_EXACT_POWER; decade += LARGEST_EXACT_POWER)
    edge /= exact_power[LARGEST_EXACT_POWER];
  return decade < 0 ? edge / exact_power[-decade] : edge * exact_power[decade];
}

int bins_of(double value) {
  if (!(value > 0) || !isfinite(value))
    return BINS_NONE;
  /* The logarithm is accurate to a few units in the last place, so the guess is at most one bin off, and only next to
   * an edge. */
  int bin = (int)floor(log10(value) * BINS_PER_DECADE);
  while (value < bins_edge(bin))
    bin--;
  while (value >= bins_edge(bin + 1))
    bin++;
  return bin;
}
