/* Paired and independent differences of means. */
#include "analysis/statistics/difference.h"

#include <gsl/gsl_cdf.h>
#include <math.h>

#include "analysis/statistics/sample.h"

/* Student's t with the degrees of freedom of Welch and Satterthwaite. */
static double welch(const struct sample_moments side[2], double level) {
  double share[2], degrees = 0;
  for (int k = 0; k < 2; k++) {
    if (side[k].n < 2)
      return NAN;
    const double freedom = (double)side[k].n - 1;
    share[k] = side[k].squares / freedom / (double)side[k].n;
    degrees += share[k] * share[k] / freedom;
  }
  const double variance = share[0] + share[1];
  if (!(degrees > 0)) /* neither sample varies */
    return 0;
  return gsl_cdf_tdist_Pinv(0.5 + level / 2, variance * variance / degrees) * sqrt(variance);
}

/* Moments of the first and second values with seeds that both sides have, and of their differences; in order of
 * seeds. */
static void add_pairs(size_t first_count, const struct difference_value *first, size_t second_count,
                      const struct difference_value *second, struct sample_moments paired[2],
                      struct sample_moments *differences) {
  for (size_t i = 0, j = 0; i < first_count && j < second_count;) {
    const int64_t a = first[i].seed, b = second[j].seed;
    if (a == b) {
      sample_add(&paired[0], first[i].value);
      sample_add(&paired[1], second[j].value);
      sample_add(differences, second[j].value - first[i].value);
    }
    i += a <= b;
    j += b <= a;
  }
}

static struct sample_moments moments_of(size_t count, const struct difference_value *values) {
  struct sample_moments moments = {0};
  for (size_t i = 0; i < count; i++)
    sample_add(&moments, values[i].value);
  return moments;
}

static double mean_of(const struct sample_moments *moments) {
  return moments->n ? moments->mean : (double)NAN;
}

struct difference difference_between(size_t first_count, const struct difference_value *first, size_t second_count,
                                     const struct difference_value *second, double level) {
  struct sample_moments paired[2] = {{0}, {0}}, differences = {0};
  add_pairs(first_count, first, second_count, second, paired, &differences);
  const size_t most = first_count > second_count ? first_count : second_count;
  struct difference out = {.n = {first_count, second_count}};
  if (differences.n >= 2 && 2 * differences.n >= most) {
    out.pairs = differences.n;
    out.mean[0] = mean_of(&paired[0]);
    out.mean[1] = mean_of(&paired[1]);
    out.difference = differences.mean;
    out.half_width = sample_summarise_moments(&differences, level).half_width;
    return out;
  }
  const struct sample_moments all[2] = {moments_of(first_count, first), moments_of(second_count, second)};
  out.mean[0] = mean_of(&all[0]);
  out.mean[1] = mean_of(&all[1]);
  out.difference = out.mean[1] - out.mean[0];
  out.half_width = welch(all, level);
  return out;
}
