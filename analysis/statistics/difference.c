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
  if (!(degrees > 0)) /* neither side varies */
    return 0;
  return gsl_cdf_tdist_Pinv(0.5 + level / 2, variance * variance / degrees) * sqrt(variance);
}

struct difference difference_between(size_t first_count, const struct difference_value *first, size_t second_count,
                                     const struct difference_value *second, double level) {
  struct sample_moments all[2] = {{0}, {0}}, paired[2] = {{0}, {0}}, differences = {0};
  const size_t most = first_count > second_count ? first_count : second_count;
  for (size_t i = 0; i < first_count; i++)
    sample_add(&all[0], first[i].value);
  for (size_t j = 0; j < second_count; j++)
    sample_add(&all[1], second[j].value);
  for (size_t i = 0, j = 0; i < first_count && j < second_count;) {
    if (first[i].seed == second[j].seed) {
      sample_add(&paired[0], first[i].value);
      sample_add(&paired[1], second[j].value);
      sample_add(&differences, second[j++].value - first[i++].value);
    } else if (first[i].seed < second[j].seed) {
      i++;
    } else {
      j++;
    }
  }
  const bool pairs = differences.n >= 2 && 2 * differences.n >= most;
  const struct sample_moments *of = pairs ? paired : all;
  struct difference out = {.n = {first_count, second_count},
                           .pairs = pairs ? differences.n : 0,
                           .mean = {of[0].n ? of[0].mean : (double)NAN, of[1].n ? of[1].mean : (double)NAN}};
  out.difference = pairs ? differences.mean : out.mean[1] - out.mean[0];
  out.half_width = pairs ? sample_summarise_moments(&differences, level).half_width : welch(all, level);
  return out;
}
