/* The pooled spectrum: densities with intervals from the scatter between runs. */
#include <math.h>
#include <stdlib.h>

#include "analysis/statistics/pooled.h"

double pooled_spectrum_count_hw95(size_t runs, double count, double squares) {
  if (runs < 2)
    return NAN;
  double n = (double)runs;
  return sample_student(runs, 0.95) * sqrt(fmax(0, squares - count * count / n) / (n - 1) / n);
}

/* Lowest and highest bin that holds a fragment; SPECTRUM_NO_BIN and lower when there is none. */
static size_t span_of(const struct pooled_runs *runs, int *low) {
  size_t fragments = runs->count ? runs->first[runs->count] : 0;
  int high = SPECTRUM_NO_BIN;
  *low = INT32_MAX;
  for (size_t i = 0; i < fragments; i++) {
    int bin = spectrum_bin(runs->masses[i]);
    if (bin == SPECTRUM_NO_BIN)
      continue;
    if (bin < *low)
      *low = bin;
    if (bin > high)
      high = bin;
  }
  return *low <= high ? (size_t)(high - *low) + 1 : 0;
}

/* Adds run r to the counts of the bins from `low` on and to the sums of their squares; `own` is scratch. */
static void add_run(const struct pooled_runs *runs, size_t r, bool with_largest, int low, size_t span, int64_t *own,
                    struct pooled_bin *bins, double *squares) {
  for (size_t j = 0; j < span; j++)
    own[j] = 0;
  for (size_t i = runs->first[r] + (with_largest ? 0 : 1); i < runs->first[r + 1]; i++) {
    int bin = spectrum_bin(runs->masses[i]);
    if (bin != SPECTRUM_NO_BIN)
      own[bin - low]++;
  }
  for (size_t j = 0; j < span; j++) {
    bins[j].count += own[j];
    squares[j] += (double)own[j] * (double)own[j];
  }
}

status pooled_spectrum(const struct pooled_runs *runs, bool with_largest, double unit_mass, struct pooled_bin **bins,
                       size_t *count, struct error *error) {
  *bins = NULL;
  *count = 0;
  int low;
  size_t span = span_of(runs, &low);
  struct pooled_bin *found = calloc(span + 1, sizeof *found);
  int64_t *own = calloc(span + 1, sizeof *own);
  double *squares = calloc(span + 1, sizeof *squares); /* of counts: exact integers far below 2^53 */
  status code = STATUS_OK;
  if (!found || !own || !squares) {
    free(found);
    code = status_fail(error, STATUS_MEMORY, "spectrum: no memory for %zu bins", span);
    goto cleanup;
  }

  for (size_t r = 0; r < runs->count; r++)
    add_run(runs, r, with_largest, low, span, own, found, squares);
  for (size_t j = 0; j < span; j++) {
    if (!found[j].count)
      continue;
    struct pooled_bin bin = {.bin = low + (int)j, .count = found[j].count};
    bin.lower = spectrum_edge(bin.bin);
    bin.upper = spectrum_edge(bin.bin + 1);
    double width = (bin.upper - bin.lower) / unit_mass, total = (double)bin.count;
    bin.density = total / ((double)runs->count * width);
    bin.half_width = pooled_spectrum_count_hw95(runs->count, total, squares[j]) / width;
    found[(*count)++] = bin;
  }
  *bins = found;
cleanup:
  free(own);
  free(squares);
  return code;
}
