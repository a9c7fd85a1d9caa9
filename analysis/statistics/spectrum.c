/* Mass bins with exact edges. */
#include "analysis/statistics/statistics.h"

#include <math.h>
#include <string.h>

/* 10^(j/10), and the powers of ten that a double represents exactly. A quotient of two exact numbers is correctly
 * rounded. */
static const double tenth[SPECTRUM_BINS_PER_DECADE] = {
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

double spectrum_edge(int bin) {
  int decade = bin / SPECTRUM_BINS_PER_DECADE, part = bin % SPECTRUM_BINS_PER_DECADE;
  if (part < 0) {
    part += SPECTRUM_BINS_PER_DECADE;
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

int spectrum_bin(double mass) {
  if (!(mass > 0) || !isfinite(mass))
    return SPECTRUM_NO_BIN;
  /* The logarithm is accurate to a few units in the last place, so the guess is at most one bin off, and only next to
   * an edge. */
  int bin = (int)floor(log10(mass) * SPECTRUM_BINS_PER_DECADE);
  while (mass < spectrum_edge(bin))
    bin--;
  while (mass >= spectrum_edge(bin + 1))
    bin++;
  return bin;
}

double spectrum_size_of(const struct spectrum_size *size, double mass) {
  if (!(size->density > 0))
    return mass;
  return size->dimensions == 2 ? sqrt(4 * mass / (M_PI * size->density)) : cbrt(6 * mass / (M_PI * size->density));
}

double spectrum_size_mass(const struct spectrum_size *size, double place) {
  if (!(size->density > 0))
    return place;
  return M_PI * size->density * (size->dimensions == 2 ? place * place / 4 : place * place * place / 6);
}

/* Counts the non-empty bins by stepping from bin to bin: slow, used only when the caller's rows are too few. */
static size_t count_bins(size_t n, const double *masses) {
  size_t count = 0;
  for (int last = SPECTRUM_NO_BIN, next;; last = next, count++) {
    next = INT32_MAX;
    for (size_t i = 0; i < n; i++) {
      int bin = spectrum_bin(masses[i]);
      if (bin > last && bin < next)
        next = bin;
    }
    if (next == INT32_MAX)
      return count;
  }
}

/* Rows stay sorted while they fill. Fragments arrive in descending order of mass, so a fragment nearly always belongs
 * to the row of the last one or to a new row below it. */
size_t spectrum_fill(size_t n, const double *masses, struct spectrum_bin_row *rows, size_t capacity) {
  size_t count = 0, at = 0;
  int bin = SPECTRUM_NO_BIN;
  double lower = HUGE_VAL, upper = 0; /* edges of the last mass's bin */
  for (size_t i = 0; i < n; i++) {
    if (!(masses[i] >= lower && masses[i] < upper)) {
      bin = spectrum_bin(masses[i]);
      lower = spectrum_edge(bin);
      upper = spectrum_edge(bin + 1);
    }
    if (bin == SPECTRUM_NO_BIN)
      continue;
    while (at < count && rows[at].bin < bin)
      at++;
    while (at > 0 && rows[at - 1].bin >= bin)
      at--;
    if (at == count || rows[at].bin != bin) {
      if (count == capacity)
        return count_bins(n, masses);
      memmove(rows + at + 1, rows + at, (count - at) * sizeof *rows);
      rows[at] = (struct spectrum_bin_row){.bin = bin};
      count++;
    }
    rows[at].count++;
    rows[at].mass += masses[i];
  }
  return count;
}
