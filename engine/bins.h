/* Logarithmic bins of masses and speeds, the same for every scene, so that bins of different runs, points and stores
 * add up. Bin k covers [10^(k/n), 10^((k+1)/n)) with n = BINS_PER_DECADE, in kg or m/s. */
#pragma once

#include <stdint.h>

enum { BINS_PER_DECADE = 10, BINS_NONE = INT32_MIN };

/* Lower edge of a bin. Whole decades from 1e-22 to 1e22 are the doubles nearest to the powers of ten. */
double bins_edge(int bin);
/* The bin whose [edge, next edge) holds the value: exact against bins_edge() for every double (0.001 is in bin -30, the
 * double before it in bin -31). BINS_NONE for zero, negative, infinite and NaN values. */
int bins_of(double value);
