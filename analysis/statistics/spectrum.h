/* The mass spectrum of one run on fixed logarithmic bins. Estimates and the store use the same edges.
 *
 * Bin k covers [10^(k/n), 10^((k+1)/n)) kg with n = SPECTRUM_BINS_PER_DECADE: the same edges for every scene, so that
 * bins of different runs, points and stores add up. */
#ifndef CLAST_ANALYSIS_STATISTICS_SPECTRUM_H
#define CLAST_ANALYSIS_STATISTICS_SPECTRUM_H

#include <stddef.h>
#include <stdint.h>

enum { SPECTRUM_BINS_PER_DECADE = 10, SPECTRUM_NO_BIN = INT32_MIN };

/* The bin whose [edge, next edge) holds the mass: exact against spectrum_edge() for every double (1e-3 kg is in bin
 * -30, the double before it in bin -31). SPECTRUM_NO_BIN for zero, negative, infinite and NaN masses. */
int spectrum_bin(double mass);

/* Lower edge of a bin, kg. Whole decades from 1e-22 to 1e22 are the doubles nearest to the powers of ten. */
double spectrum_edge(int bin);

/* The size of a fragment: diameter of the sphere, or in two dimensions of the disc, of its mass and this density. */
struct spectrum_size {
  double density; /* kg/m^3; 0: no sizes, an axis of masses */
  int dimensions; /* 2: masses are kg per metre of thickness; else 3 */
};
/* Position of a mass on the axis: kg, or m. spectrum_size_mass() is the inverse. */
double spectrum_size_of(const struct spectrum_size *size, double mass);
double spectrum_size_mass(const struct spectrum_size *size, double place);

struct spectrum_bin_row {
  int bin;
  int64_t count;
  double mass; /* sum, kg */
};

/* Fills the non-empty bins in ascending order. Masses are in any order (descending is fastest); those without a bin are
 * left out. Returns the number of bins. When that is more than `capacity`, the rows are not filled: call again with
 * that many rows. The order of summation is the order of `masses`. */
size_t spectrum_fill(size_t n, const double *masses, struct spectrum_bin_row *rows, size_t capacity);

#endif
