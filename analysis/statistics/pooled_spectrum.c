/* The pooled spectrum: densities or cumulative numbers with intervals from the scatter between runs or points. */
#include <math.h>
#include <stdlib.h>

#include "analysis/statistics/pooled.h"

double pooled_spectrum_count_hw95(size_t runs, double count, double squares) {
  if (runs < 2)
    return NAN;
  double n = (double)runs;
  return sample_student(runs, 0.95) * sqrt(fmax(0, squares - count * count / n) / (n - 1) / n);
}

static int dimensions_of(const struct pooled_form *form) {
  if (!(form->size.density > 0))
    return 1;
  return form->size.dimensions == 2 ? 2 : 3;
}

double pooled_spectrum_exponent(const struct pooled_form *form, double beta) {
  return dimensions_of(form) * (beta - 1) + (form->cumulative ? 0 : 1);
}

double pooled_spectrum_half_width(const struct pooled_form *form, double half_width) {
  return dimensions_of(form) * half_width;
}

/* Sums that grow while the runs are read. */
struct sums {
  size_t span; /* number of bins */
  int low;     /* the first bin */
  double *own; /* fragments of the current unit, by bin */
  int64_t *count;
  double *mass, *mean, *square; /* by bin; mean and square: sums over the units of fragments per run */
};

/* Finds the lowest and highest non-empty bin. */
static void find_span(const struct pooled_runs *runs, struct sums *sums) {
  double least = HUGE_VAL, most = 0;
  for (size_t i = runs->count ? runs->first[0] : 0; runs->count && i < runs->first[runs->count]; i++) {
    const double mass = runs->masses[i];
    if (!(mass > 0) || isinf(mass))
      continue;
    least = fmin(least, mass);
    most = fmax(most, mass);
  }
  if (!(most > 0))
    return;
  sums->low = spectrum_bin(least);
  sums->span = (size_t)(spectrum_bin(most) - sums->low) + 1;
}

/* Masses are mostly in descending order, so the bin of the last fragment is a good guess for the next one. */
static void add_run(const struct pooled_runs *runs, size_t r, struct sums *sums) {
  int bin = SPECTRUM_NO_BIN;
  double from = HUGE_VAL, to = 0; /* edges of `bin` */
  for (size_t i = runs->first[r]; i < runs->first[r + 1]; i++) {
    const double mass = runs->masses[i];
    if (!(mass > 0) || isinf(mass))
      continue;
    if (!(mass >= from && mass < to)) {
      bin = spectrum_bin(mass);
      from = spectrum_edge(bin);
      to = spectrum_edge(bin + 1);
    }
    const size_t j = (size_t)(bin - sums->low);
    sums->own[j]++;
    sums->count[j]++;
    sums->mass[j] += mass;
  }
}

/* Adds the fragments per run of a unit with `runs` runs, and clears the unit's counts. */
static void end_unit(struct sums *sums, bool cumulative, double runs) {
  double above = 0;
  for (size_t j = sums->span; j-- > 0;) {
    above = (cumulative ? above : 0) + sums->own[j];
    sums->own[j] = 0;
    sums->mean[j] += above / runs;
    sums->square[j] += above / runs * (above / runs);
  }
}

static void write_bins(const struct sums *sums, const struct pooled_form *form, size_t units, struct pooled_bin *bins,
                       size_t *count) {
  struct pooled_bin above = {0};
  for (size_t j = 0; form->cumulative && j < sums->span; j++) {
    above.count += sums->count[j];
    above.mass += sums->mass[j];
  }
  for (size_t j = 0; j < sums->span; j++) {
    if (!sums->count[j] && !form->cumulative)
      continue;
    const int bin = sums->low + (int)j;
    struct pooled_bin *out = &bins[(*count)++];
    *out = (struct pooled_bin){.bin = bin,
                               .lower = spectrum_size_of(&form->size, spectrum_edge(bin)),
                               .upper = spectrum_size_of(&form->size, spectrum_edge(bin + 1)),
                               .count = sums->count[j],
                               .mass = sums->mass[j]};
    const double width = form->cumulative ? 1 : out->upper - out->lower;
    out->value = sums->mean[j] / (double)units / width;
    out->half_width = pooled_spectrum_count_hw95(units, sums->mean[j], sums->square[j]) / width;
    if (!form->cumulative)
      continue;
    out->count = above.count;
    out->mass = above.mass;
    above.count -= sums->count[j];
    above.mass -= sums->mass[j];
  }
}

static status sum_up(const struct pooled_runs *runs, const struct pooled_form *form, size_t units, struct sums *sums) {
  const size_t size = sums->span + 1;
  sums->own = calloc(size, sizeof *sums->own);
  sums->count = calloc(size, sizeof *sums->count);
  sums->mass = calloc(size, sizeof *sums->mass);
  sums->mean = calloc(size, sizeof *sums->mean);
  sums->square = calloc(size, sizeof *sums->square);
  if (!sums->own || !sums->count || !sums->mass || !sums->mean || !sums->square)
    return STATUS_MEMORY;
  for (size_t u = 0; u < units; u++) {
    const size_t from = form->first_run ? form->first_run[u] : u, to = form->first_run ? form->first_run[u + 1] : u + 1;
    for (size_t r = from; r < to; r++)
      add_run(runs, r, sums);
    end_unit(sums, form->cumulative, (double)(to - from));
  }
  return STATUS_OK;
}

status pooled_spectrum(const struct pooled_runs *runs, const struct pooled_form *form, struct pooled_bin **bins,
                       size_t *count, struct error *error) {
  const size_t units = form->first_run ? form->units : runs->count;
  struct sums sums = {0};
  *count = 0;
  find_span(runs, &sums);
  *bins = calloc(sums.span + 1, sizeof **bins);
  const status code = *bins ? sum_up(runs, form, units, &sums) : STATUS_MEMORY;
  if (code == STATUS_OK) {
    write_bins(&sums, form, units, *bins, count);
  } else {
    status_fail(error, code, "spectrum: no memory for %zu bins", sums.span);
    free(*bins);
    *bins = NULL;
  }
  free(sums.own);
  free(sums.count);
  free(sums.mass);
  free(sums.mean);
  free(sums.square);
  return code;
}
