/* Fragment mass spectra: F(m), fragments per unit mass [K99 section 3.3], on logarithmic bins. The exponent of F is
 * differential (F ~ m^-beta); the cumulative number N(>m) has slope beta - 1. */
#ifndef CLAST_ANALYSIS_SPECTRUM_H
#define CLAST_ANALYSIS_SPECTRUM_H

#include <stddef.h>
#include <stdint.h>

/* Bin k covers [10^(k/n), 10^((k+1)/n)) kg with n = SPECTRUM_BINS_PER_DECADE: fixed edges for every scene, so that
 * bins of different runs, points and stores add up. */
enum { SPECTRUM_BINS_PER_DECADE = 10 };
int spectrum_bin(double mass);
double spectrum_edge(int bin); /* lower edge, kg */

struct spectrum_bin_row {
  int bin;
  int64_t count;
  double mass;
};
/* Non-empty bins in ascending order from masses (any order). rows has room for `capacity`; returns how many are needed. */
size_t spectrum_fill(size_t n, const double *masses, struct spectrum_bin_row *rows, size_t capacity);

#endif
