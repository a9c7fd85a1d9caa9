/* Variance over seeds, and the covariance of means with shared seeds. */
#include "analysis/inference/inference.h"

#include <math.h>
#include <string.h>

#include "analysis/statistics/statistics.h"

static struct sample_moments moments_of(const struct seed_scatter_runs *runs, size_t point) {
  const double *v = runs->values + point * runs->replicates;
  struct sample_moments m = {0};
  for (size_t r = 0; r < runs->replicates; r++)
    if (isfinite(v[r]))
      sample_add(&m, v[r]);
  return m;
}

/* A step of Fisher's scoring towards the greatest likelihood of the s^2 of all points under chi-square, from the line
 * in `out`: a weighted least squares of ln(found) + (s^2 - found) / found on 1 and x, with a prior on the slopes. Runs
 * that are equal, by chance or since nothing breaks there, show that the variance is small; the logarithm of s^2 would
 * take them for certain and draw the line to 0. Each point lends LENT degrees of freedom
 * to the mean variance: without them, many points of equal runs at one end turn the line without end. */
static void improve_line(const struct seed_scatter_runs *runs, double pooled, struct seed_scatter *out) {
  enum { MOST = INFERENCE_INPUTS + 1 };
  /* 64 points of four runs, scatter 1 in one half and 0 in the other: 2.7 at the far end of the scatter (1600 without
   * LENT; 1.4 with 1). A true slope of 1.2 becomes 1.15 (0.73 with 1). */
  static const double LENT = 0.05;
  static const double SHARE = 0.5; /* of a step of the scoring, which may overshoot */
  const size_t n = runs->inputs + 1;
  double normal[MOST * MOST] = {0}, right[MOST] = {0}, change[MOST] = {0}, row[MOST], most = 1;
  for (size_t i = 0; i < runs->points; i++) {
    const struct sample_moments m = moments_of(runs, i);
    if (m.n < 2)
      continue;
    const double half = ((double)(m.n - 1) + LENT) / 2; /* the weight, too */
    const double found = seed_scatter_variance(out, runs->x + i * runs->inputs);
    const double y = log(found / pooled) + (m.squares + LENT * pooled) / (2 * half) / found - 1;
    row[0] = 1;
    memcpy(row + 1, runs->x + i * runs->inputs, runs->inputs * sizeof *row);
    for (size_t a = 0; a < n; a++) {
      right[a] += half * row[a] * y;
      for (size_t b = 0; b < n; b++)
        normal[a * n + b] += half * row[a] * row[b];
    }
  }
  for (size_t a = 1; a < n; a++)
    normal[a * n + a] += 1;
  if (!covariance_factor(n, normal))
    return; /* the line stays */
  covariance_solve(n, normal, right, right);
  for (size_t a = 0; a < n; a++) {
    change[a] = right[a] - (a == 0 ? out->constant - log(pooled) : out->slope[a - 1]);
    most = fmax(most, fabs(change[a]));
  }
  out->constant += SHARE * change[0] / most;
  for (size_t a = 1; a < n; a++)
    out->slope[a - 1] += SHARE * change[a] / most;
}

/* Correlation from sums over points, seed by seed: their variance over seeds shows how strongly a seed moves all points
 * together. */
static double shared_correlation(const struct seed_scatter_runs *runs, const struct seed_scatter *fit) {
  double together = 0, alone = 0, pairs = 0;
  for (size_t r = 0; r < runs->replicates; r++) {
    double sum = 0, squares = 0, n = 0;
    for (size_t i = 0; i < runs->points; i++) {
      const double value = runs->values[i * runs->replicates + r];
      if (!isfinite(value))
        continue;
      const double e = (value - moments_of(runs, i).mean) /
                       sqrt(seed_scatter_variance(fit, runs->x + i * runs->inputs));
      sum += e;
      squares += e * e;
      n++;
    }
    together += sum * sum - squares;
    alone += squares;
    pairs += n * (n - 1);
  }
  const double points = pairs > 0 ? pairs / (double)runs->replicates : 0; /* mean n (n - 1) per seed */
  const double n = (1 + sqrt(1 + 4 * points)) / 2;
  return points > 0 && alone > 0 ? fmin(fmax(together / (n - 1) / alone, 0), 0.99) : 0;
}

static void find_shape(const struct seed_scatter_runs *runs, struct seed_scatter *out) {
  double second = 0, third = 0, fourth = 0, count = 0;
  for (size_t i = 0; i < runs->points; i++) {
    const struct sample_moments m = moments_of(runs, i);
    const double *v = runs->values + i * runs->replicates;
    for (size_t r = 0; m.n > 1 && r < runs->replicates; r++) {
      const double e = isfinite(v[r]) ? (v[r] - m.mean) / sqrt(seed_scatter_variance(out, runs->x + i * runs->inputs))
                                      : 0;
      second += e * e;
      third += e * e * e;
      fourth += e * e * e * e;
      count += isfinite(v[r]);
    }
  }
  out->skewness = second > 0 ? third / count / pow(second / count, 1.5) : 0;
  out->excess = second > 0 ? fourth / count / (second / count * second / count) - 3 : 0;
}

enum { PASSES = 40 }; /* of the scoring */

status seed_scatter_fit(const struct seed_scatter_runs *runs, int shared_seeds, struct seed_scatter *out,
                        struct error *error) {
  *out = (struct seed_scatter){.inputs = runs->inputs};
  double pooled = 0; /* mean variance over all points */
  for (size_t i = 0; i < runs->points; i++) {
    const struct sample_moments m = moments_of(runs, i);
    if (m.n < 2)
      continue;
    pooled += m.squares;
    out->freedom += m.n - 1;
  }
  if (out->freedom == 0)
    return status_fail(error, STATUS_CONTENT,
                       "no point has two runs with a value of this output, so its scatter over seeds is not known: "
                       "give more seeds (seeds.per_point), or another quantity");
  pooled /= (double)out->freedom;
  out->constant = pooled > 0 ? log(pooled) : -700; /* no seed changes this output */
  for (int pass = 0; pooled > 0 && pass < PASSES; pass++)
    improve_line(runs, pooled, out);
  if (pooled > 0 && shared_seeds)
    out->shared = shared_correlation(runs, out);
  if (pooled > 0)
    find_shape(runs, out);
  return STATUS_OK;
}

double seed_scatter_variance(const struct seed_scatter *scatter, const double *x) {
  double sum = scatter->constant;
  for (size_t a = 0; a < scatter->inputs; a++)
    sum += scatter->slope[a] * x[a];
  return exp(sum);
}

void seed_scatter_of_means(const struct seed_scatter_runs *runs, const struct seed_scatter *scatter, double *noise) {
  const size_t n = runs->points;
  for (size_t i = 0; i < n; i++) {
    const double *a = runs->values + i * runs->replicates;
    const double sigma_i = sqrt(seed_scatter_variance(scatter, runs->x + i * runs->inputs));
    for (size_t j = 0; j <= i; j++) {
      const double *b = runs->values + j * runs->replicates;
      const double sigma_j = sqrt(seed_scatter_variance(scatter, runs->x + j * runs->inputs));
      double n_i = 0, n_j = 0, both = 0;
      for (size_t r = 0; r < runs->replicates; r++) {
        n_i += isfinite(a[r]);
        n_j += isfinite(b[r]);
        both += isfinite(a[r]) && isfinite(b[r]);
      }
      const double together = i == j ? 1 : scatter->shared;
      noise[i * n + j] = noise[j * n + i] = n_i > 0 && n_j > 0 ? together * sigma_i * sigma_j * both / (n_i * n_j) : 0;
    }
  }
}

double seed_scatter_correlation(const struct seed_scatter_runs *a, const struct seed_scatter_runs *b) {
  double cross = 0, first = 0, second = 0;
  for (size_t i = 0; i < a->points; i++) {
    const struct sample_moments m = moments_of(a, i), n = moments_of(b, i);
    for (size_t r = 0; r < a->replicates && m.n > 1 && n.n > 1; r++) {
      const double u = a->values[i * a->replicates + r] - m.mean, v = b->values[i * b->replicates + r] - n.mean;
      if (!isfinite(u) || !isfinite(v))
        continue;
      cross += u * v;
      first += u * u;
      second += v * v;
    }
  }
  return first > 0 && second > 0 ? cross / sqrt(first * second) : 0;
}
