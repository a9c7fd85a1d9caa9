/* Spectra of masses. */
#include "analysis/statistics/statistics.h"

#include <math.h>
#include <string.h>

double spectrum_edge(int bin) {
  return bins_edge(bin);
}

int spectrum_bin(double mass) {
  return bins_of(mass);
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
