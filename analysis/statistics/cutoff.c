#include "analysis/statistics/cutoff.h"

#include <math.h>
#include <plfit.h>
#include <stdlib.h>
#include <string.h>

#include "engine/random.h"

static status options_make(plfit_continuous_options_t *options, struct error *error) {
  if (plfit_continuous_options_init(options) != 0)
    return status_fail(error, STATUS_INTERNAL, "exponent: plfit refused its own defaults");
  options->finite_size_correction = 0;
  options->p_value_method = PLFIT_P_VALUE_SKIP;
  return STATUS_OK;
}

double cutoff_lower(size_t n, const double *masses) {
  plfit_continuous_options_t options;
  plfit_result_t result;
  double *copy = NULL, lower = NAN; /* plfit takes a pointer to mutable masses */
  if (n < EXPONENT_LEAST_FRAGMENTS || options_make(&options, NULL))
    return NAN;
  copy = malloc(n * sizeof *copy);
  if (!copy)
    return NAN;
  memcpy(copy, masses, n * sizeof *copy);
  if (plfit_continuous(copy, n, &options, &result) == 0 && isfinite(result.alpha))
    lower = result.xmin;
  free(copy);
  return lower;
}

/* Mean and standard deviation one value at a time (Welford). */
struct moments {
  double count, mean, squares;
};
static void moments_add(struct moments *moments, double value) {
  moments->count++;
  double delta = value - moments->mean;
  moments->mean += delta / moments->count;
  moments->squares += delta * (value - moments->mean);
}

status cutoff_bootstrap(size_t n, const double *masses, struct exponent_window window, size_t resamples, uint64_t seed,
                        struct cutoff_error *out, struct error *error) {
  *out = (struct cutoff_error){NAN, NAN, 0};
  double *drawn = malloc((n ? n : 1) * sizeof *drawn);
  if (!drawn)
    return status_fail(error, STATUS_MEMORY, "exponent: no memory for %zu masses", n);
  struct moments beta = {0}, lower = {0};
  status code = STATUS_OK;
  for (size_t b = 0; b < resamples && n > 0; b++) {
    for (size_t i = 0; i < n; i++)
      drawn[i] = masses[(size_t)(random_draw(seed, RANDOM_RESAMPLE, b, i) * (double)n)];
    struct exponent fit;
    code = exponent_fit(EXPONENT_KS, n, drawn, window, &fit, error);
    if (code)
      break;
    if (!isfinite(fit.beta))
      continue;
    moments_add(&beta, fit.beta);
    moments_add(&lower, fit.lower);
  }
  free(drawn);
  out->resamples = (size_t)beta.count;
  if (beta.count > 1) {
    out->beta_error = sqrt(beta.squares / (beta.count - 1));
    out->lower_error = sqrt(lower.squares / (lower.count - 1));
  }
  return code;
}

status cutoff_p_value(size_t n, const double *masses, double lower, double precision, uint64_t seed, double *p,
                      struct error *error) {
  *p = NAN;
  if (!(precision >= 0.001 && precision <= 0.2))
    return status_fail(error, STATUS_USAGE, "exponent: p-value to within %g: expected 0.001 to 0.2", precision);
  plfit_continuous_options_t options;
  status code = options_make(&options, error);
  if (code)
    return code;
  options.p_value_method = PLFIT_P_VALUE_EXACT;
  options.p_value_precision = precision;
  plfit_mt_rng_t seeder = {0}, rng;
  for (uint64_t i = 0; i < PLFIT_MT_LEN; i++) {
    uint64_t bits[4];
    random_bits(seed, RANDOM_RESAMPLE, UINT64_MAX, i, bits);
    seeder.mt_buffer[i] = (uint32_t)bits[0];
  }
  seeder.mt_index = 0;
  plfit_mt_init_from_rng(&rng, &seeder);
  options.rng = &rng;

  double *inside = malloc((n ? n : 1) * sizeof *inside);
  if (!inside)
    return status_fail(error, STATUS_MEMORY, "exponent: no memory for %zu masses", n);
  size_t count = 0;
  for (size_t i = 0; i < n; i++)
    if (masses[i] >= lower && isfinite(masses[i]))
      inside[count++] = masses[i];
  plfit_result_t result;
  if (count >= EXPONENT_LEAST_FRAGMENTS && plfit_continuous(inside, count, &options, &result) == 0)
    *p = result.p;
  free(inside);
  return STATUS_OK;
}
