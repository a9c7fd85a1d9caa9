/* The pooled spectrum itself: densities with errors from the scatter between runs. */
#include <math.h>
#include <stdlib.h>

#include "analysis/statistics/pooled.h"

status pooled_spectrum(const struct pooled_runs *runs, bool with_largest, double unit_mass, struct pooled_bin **bins,
                       size_t *count, struct error *error) {
  *bins = NULL;
  *count = 0;
  int low = INT32_MAX, high = SPECTRUM_NO_BIN;
  size_t fragments = runs->count ? runs->first[runs->count] : 0;
  for (size_t i = 0; i < fragments; i++) {
    int bin = spectrum_bin(runs->masses[i]);
    if (bin == SPECTRUM_NO_BIN)
      continue;
    if (bin < low)
      low = bin;
    if (bin > high)
      high = bin;
  }
  size_t span = low <= high ? (size_t)(high - low) + 1 : 0;
  struct pooled_bin *found = calloc(span + 1, sizeof *found);
  int64_t *mine = calloc(span + 1, sizeof *mine);
  double *squares = calloc(span + 1, sizeof *squares); /* of counts: exact integers far below 2^53 */
  if (!found || !mine || !squares) {
    free(found);
    free(mine);
    free(squares);
    return status_fail(error, STATUS_MEMORY, "spectrum: no memory for %zu bins", span);
  }
  for (size_t r = 0; r < runs->count; r++) {
    for (size_t j = 0; j < span; j++)
      mine[j] = 0;
    for (size_t i = runs->first[r] + (with_largest ? 0 : 1); i < runs->first[r + 1]; i++) {
      int bin = spectrum_bin(runs->masses[i]);
      if (bin != SPECTRUM_NO_BIN)
        mine[bin - low]++;
    }
    for (size_t j = 0; j < span; j++) {
      found[j].count += mine[j];
      squares[j] += (double)mine[j] * (double)mine[j];
    }
  }
  double n = (double)runs->count;
  for (size_t j = 0; j < span; j++) {
    if (!found[j].count)
      continue;
    struct pooled_bin bin = {.bin = low + (int)j, .count = found[j].count};
    bin.lower = spectrum_edge(bin.bin);
    bin.upper = spectrum_edge(bin.bin + 1);
    double width = (bin.upper - bin.lower) / unit_mass, total = (double)bin.count;
    bin.density = total / (n * width);
    /* variance of the mean count: (sum c^2 - (sum c)^2/n) / (n (n-1)) */
    bin.standard_error = NAN;
    if (runs->count > 1)
      bin.standard_error = sqrt(fmax(squares[j] - total * total / n, 0) / (n * (n - 1))) / width;
    found[(*count)++] = bin;
  }
  *bins = found;
  free(mine);
  free(squares);
  return STATUS_OK;
}
