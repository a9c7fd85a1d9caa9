/* First-order indices from any points: an additive fit in the ranks of the inputs, and what its residuals still have in
 * common along an input. */
#include <gsl/gsl_cdf.h>
#include <gsl/gsl_linalg.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "analysis/statistics/statistics.h"
#include "schemas/memory.h"

enum {
  MOST_DEGREE = 6, /* of the polynomial of an input */
  PER_COLUMN = 3,  /* least number of points for each column of the fit */
  LEAST_POINTS = 12,
  LAG_SHARE = 8, /* lags go up to the n-th part of the points, and to the root of their number */
  LEAST_LAGS = 4,
};
#define MOVES          0.5 /* share of an input's columns that the other inputs explain: beyond it they move together */
#define LEAST_VARIANCE 1e-20 /* of the values, over the square of their mean: rounding */

struct place {
  double x;
  uint64_t tie; /* in no order that a grid could have */
  size_t point;
};

static int by_place(const void *a, const void *b) {
  const struct place *p = a, *q = b;
  return p->x != q->x ? (p->x > q->x) - (p->x < q->x) : (p->tie > q->tie) - (p->tie < q->tie);
}

struct fit {
  const struct sensitivity_points *given;
  size_t n, k, p;                 /* points, inputs, columns */
  size_t *levels, *degree, *from; /* of each input: different values, columns, first column */
  struct place *order;            /* order[i * n + j]: points along input i */
  double *rank;                   /* rank[point * k + i], -1 to 1; equal values have the middle one */
  double *column;                 /* column[point * p + c]: orthonormal polynomials of the ranks, after a constant */
  double *inverse;                /* of the columns' covariances */
  double *lever;                  /* lever[point * p + c]: influence of the point's residual on a coefficient */
  double *weight;                 /* diagonal of the hat matrix */
  double *y, *rest, *coefficient;
  double *influence; /* influence[i * n + point]: of the point on a term; k terms, seeds, the whole */
  double noise;      /* variance of the residuals */
  double alike;      /* variance of the estimate of the seeds' variance, from seeds that all points share */
};

static void release(struct fit *f) {
  void *const all[] = {f->levels, f->order,  f->rank,        f->column,   f->inverse,
                       f->lever,  f->weight, f->coefficient, f->influence};
  for (size_t i = 0; i < sizeof all / sizeof *all; i++)
    free(all[i]);
}

static status rank_inputs(struct fit *f, struct error *error) {
  TRY(memory_array(&f->levels, 3 * f->k, sizeof *f->levels, "the points", error));
  TRY(memory_array(&f->order, f->n * f->k, sizeof *f->order, "the points", error));
  TRY(memory_array(&f->rank, f->n * f->k, sizeof *f->rank, "the points", error));
  f->degree = f->levels + f->k;
  f->from = f->degree + f->k;
  for (size_t i = 0; i < f->k; i++) {
    struct place *order = f->order + i * f->n;
    for (size_t j = 0; j < f->n; j++)
      order[j] = (struct place){f->given->x[j * f->k + i], (j + 1) * 0x9E3779B97F4A7C15u, j};
    qsort(order, f->n, sizeof *order, by_place);
    f->levels[i] = 0;
    for (size_t from = 0, to = 0; from < f->n; from = to, f->levels[i]++) {
      while (to < f->n && !(order[to].x > order[from].x))
        to++;
      for (size_t j = from; j < to; j++)
        f->rank[order[j].point * f->k + i] = (double)(from + to) / (double)f->n - 1;
    }
  }
  return STATUS_OK;
}

/* Columns of the fit with polynomials of up to this degree. Values without an order get a column each, as far as they
 * are few. */
static size_t columns_of(struct fit *f, size_t degree) {
  f->p = 1;
  for (size_t i = 0; i < f->k; i++) {
    const size_t most = f->levels[i] - 1;
    f->from[i] = f->p;
    f->degree[i] = most < degree || f->given->named[i] ? most : degree;
    f->p += f->degree[i];
  }
  return f->p;
}

static void fill_columns(struct fit *f) {
  const double n = (double)f->n;
  for (size_t j = 0; j < f->n; j++)
    f->column[j * f->p] = 1;
  for (size_t i = 0; i < f->k; i++)
    for (size_t c = f->from[i]; c < f->from[i] + f->degree[i]; c++) {
      double square = 0;
      for (size_t j = 0; j < f->n; j++)
        f->column[j * f->p + c] = f->rank[j * f->k + i] * (c > f->from[i] ? f->column[j * f->p + c - 1] : 1);
      for (size_t twice = 0; twice < 2; twice++) /* Gram and Schmidt; the second time takes off rounding errors */
        for (size_t b = f->from[i]; b <= c; b++) {
          const size_t other = b > f->from[i] ? b - 1 : 0;
          double sum = 0;
          for (size_t j = 0; j < f->n; j++)
            sum += f->column[j * f->p + c] * f->column[j * f->p + other] / n;
          for (size_t j = 0; j < f->n; j++)
            f->column[j * f->p + c] -= sum * f->column[j * f->p + other];
        }
      for (size_t j = 0; j < f->n; j++)
        square += f->column[j * f->p + c] * f->column[j * f->p + c] / n;
      for (size_t j = 0; j < f->n; j++)
        f->column[j * f->p + c] /= sqrt(square);
    }
}

/* Inputs that move together: marks them, with the other one that has most in common with each. */
static bool find_moving(const struct fit *f, const double *covariance, struct sensitivity_point *index) {
  const double scale = (double)(f->n - 1) / (double)(f->n - f->p);
  bool any = false;
  for (size_t i = 0; i < f->k; i++) {
    double inflation = 1, most = -1;
    for (size_t c = f->from[i]; c < f->from[i] + f->degree[i]; c++)
      inflation = fmax(inflation, f->inverse[c * f->p + c]);
    if (1 - scale / inflation <= MOVES)
      continue;
    any = true;
    index[i].verdict = SENSITIVITY_MOVES;
    for (size_t other = 0; other < f->k; other++) {
      double sum = 0;
      for (size_t c = f->from[i]; other != i && c < f->from[i] + f->degree[i]; c++)
        for (size_t d = f->from[other]; d < f->from[other] + f->degree[other]; d++)
          sum += covariance[c * f->p + d] * covariance[c * f->p + d];
      if (other != i && sum > most) {
        most = sum;
        index[i].with = other;
      }
    }
  }
  return any;
}

static status fit_columns(struct fit *f, struct sensitivity_point *index, bool *moving, struct error *error) {
  const size_t n = f->n, p = f->p;
  OWNED double *covariance = NULL;
  TRY(memory_array(&f->column, n * p, sizeof(double), "the points", error));
  TRY(memory_array(&f->lever, n * p, sizeof(double), "the points", error));
  TRY(memory_array(&f->inverse, p * p, sizeof(double), "the points", error));
  TRY(memory_array(&covariance, p * p, sizeof(double), "the points", error));
  TRY(memory_array(&f->coefficient, p, sizeof(double), "the points", error));
  fill_columns(f);
  memset(covariance, 0, p * p * sizeof(double));
  for (size_t j = 0; j < n; j++)
    for (size_t a = 0; a < p; a++)
      for (size_t b = 0; b < p; b++)
        covariance[a * p + b] += f->column[j * p + a] * f->column[j * p + b] / (double)n;
  memcpy(f->inverse, covariance, p * p * sizeof(double));
  for (size_t a = 0; a < p; a++)
    f->inverse[a * p + a] += 1e-10; /* inputs that are functions of each other */
  gsl_matrix_view view = gsl_matrix_view_array(f->inverse, p, p);
  if (gsl_linalg_cholesky_decomp1(&view.matrix) != GSL_SUCCESS)
    return status_fail(error, STATUS_INTERNAL, "the fit of the points has no solution");
  gsl_linalg_cholesky_invert(&view.matrix);
  *moving = find_moving(f, covariance, index);
  memset(f->coefficient, 0, p * sizeof(double));
  for (size_t j = 0; j < n; j++) {
    f->weight[j] = 0;
    for (size_t a = 0; a < p; a++) {
      double sum = 0;
      for (size_t b = 0; b < p; b++)
        sum += f->inverse[a * p + b] * f->column[j * p + b];
      f->lever[j * p + a] = sum;
      f->weight[j] += sum * f->column[j * p + a] / (double)n;
      f->coefficient[a] += sum * f->y[j] / (double)n;
    }
    f->weight[j] = fmin(f->weight[j], 0.95);
  }
  for (size_t j = 0; j < n; j++) {
    f->rest[j] = f->y[j];
    for (size_t a = 0; a < p; a++)
      f->rest[j] -= f->column[j * p + a] * f->coefficient[a];
    f->noise += f->rest[j] * f->rest[j] / (double)(n - p);
  }
  return STATUS_OK;
}

/* A variance that is to be a share of the whole. Its estimate T varies as a gamma law that begins at -shift, with the
 * variance `slope` T + `floor`. */
struct term {
  double value;
  double raw;     /* before its bias is taken off */
  double floor;   /* variance of the estimate when the true value is 0 */
  double freedom; /* degrees of freedom of that */
  bool scales;
};

/* Of the polynomial: the squares of its coefficients, less the variances of these. */
static struct term polynomial(struct fit *f, size_t i) {
  const size_t p = f->p, from = f->from[i], to = from + f->degree[i];
  const double n = (double)f->n;
  struct term term = {.freedom = (double)f->degree[i]};
  for (size_t c = from; c < to; c++)
    term.raw += f->coefficient[c] * f->coefficient[c];
  term.value = term.raw;
  for (size_t c = from; c < to; c++)
    for (size_t d = from; d < to; d++) { /* by the residuals as if each point were left out */
      double covariance = 0;
      for (size_t j = 0; j < f->n; j++) {
        const double off = f->rest[j] / (1 - f->weight[j]) / n;
        covariance += f->lever[j * p + c] * f->lever[j * p + d] * off * off;
      }
      term.floor += 2 * covariance * covariance;
      term.value -= c == d ? covariance : 0;
    }
  for (size_t j = 0; j < f->n; j++) {
    double own = 0, turn = 0;
    for (size_t c = from; c < to; c++) {
      own += f->column[j * p + c] * f->coefficient[c];
      turn += f->lever[j * p + c] * f->coefficient[c];
    }
    f->influence[i * f->n + j] = own * own - term.raw + 2 * turn * f->rest[j] / (1 - f->weight[j]);
  }
  return term;
}

/* What the polynomial leaves of the input: products of residuals that are 1, 2, 3... places apart along it, as a
 * straight line of this distance that is continued to 0. */
static void add_rest(const struct fit *f, size_t i, struct term *term) {
  size_t lags = f->n / LAG_SHARE;
  const size_t root = (size_t)sqrt((double)f->n) + 2;
  lags = lags < LEAST_LAGS ? LEAST_LAGS : lags > root ? root : lags;
  const double most = (double)lags;
  const struct place *order = f->order + i * f->n;
  if (f->degree[i] + 1 >= f->levels[i])
    return; /* nothing is left */
  for (size_t lag = 1; lag <= lags; lag++) {
    const double w = (4 * most + 2 - 6 * (double)lag) / (most * (most - 1)) / (double)(f->n - lag);
    for (size_t j = 0; j + lag < f->n; j++) {
      const size_t a = order[j].point, b = order[j + lag].point;
      double hat = 0; /* the fit makes residuals of neighbours opposite by this share of their variance */
      for (size_t c = 0; c < f->p; c++)
        hat += f->column[a * f->p + c] * f->lever[b * f->p + c] / (double)f->n;
      const double product = f->rest[a] * f->rest[b], spread = w * product;
      term->value += w * (product + hat * f->noise);
      term->floor += spread * spread / ((1 - f->weight[a]) * (1 - f->weight[b]));
    }
  }
  term->freedom += (double)f->n * (2 * most + 1) / (most * (most - 1));
}

/* scales: the variance grows as the square of the true value, as that of a variance of few values does. */
static double bound(double estimate, double slope, double floor, double freedom, double tail, bool scales, bool upper) {
  const double shift = sqrt(floor * freedom / 2);
  double low = 0, high = 1;
  for (int step = 0; step < 50; step++) {
    const double truth = (low + high) / 2, mean = truth + shift,
                 variance = slope * truth * (scales ? truth / estimate : 1) + floor;
    const double scale = variance / mean, at = fmax(estimate + shift, 0);
    bool beyond; /* the truth may be no farther out than this */
    if (!(scale > 1e-15))
      beyond = upper ? at < mean : at <= mean;
    else
      beyond = (upper ? gsl_cdf_gamma_P(at, mean / scale, scale) < tail
                      : gsl_cdf_gamma_Q(at, mean / scale, scale) > tail);
    *(beyond ? &high : &low) = truth;
  }
  return low < 1e-9 ? 0 : high > 1 - 1e-9 ? 1 : (low + high) / 2;
}

/* influence: of the points on the term, `of_whole`: on the whole variance. pull: how much an error of the seeds'
 * variance moves the term, less its share of the whole. */
static struct sensitivity_share share_of(const struct fit *f, const struct term *term, const double *influence,
                                         const double *of_whole, double whole, double pull) {
  const double estimate = term->value / whole, degrees = (double)(f->n - f->p);
  const double tail = gsl_cdf_ugaussian_Q(gsl_cdf_tdist_Pinv(0.975, degrees));
  double variance = 0;
  for (size_t j = 0; j < f->n; j++) {
    const double d = (influence[j] - estimate * of_whole[j]) / whole / (double)f->n;
    variance += d * d;
  }
  variance = variance * (double)f->n / (double)(f->n - f->p) + pull * pull * f->alike / whole / whole;
  const double slope = term->raw > 1e-12 * whole ? variance / (term->raw / whole) : 0;
  const double floor = term->floor / whole / whole;
  const double low = bound(estimate, slope, floor, term->freedom, tail, term->scales, false);
  const double high = bound(estimate, slope, floor, term->freedom, tail, term->scales, true);
  return (struct sensitivity_share){fmin(fmax(estimate, low), high), low, high};
}

/* Means of the points, the variance over seeds (`seeds`) and that of the means by seeds (`of_means`): seeds that all
 * points share move all means together, which is no difference between points. */
static status read_values(struct fit *f, struct term *seeds, double *of_means, struct error *error) {
  const struct sensitivity_points *g = f->given;
  OWNED double *common = NULL;
  double freedom = 0, own = 0, inverse = 0, *influence = f->influence + f->k * f->n;
  TRY(memory_array(&common, g->most, sizeof(double), "the points", error));
  for (size_t r = 0; r < g->most; r++)
    common[r] = 0;
  for (size_t j = 0; j < f->n; j++) {
    f->y[j] = 0;
    for (size_t r = 0; r < g->runs[j]; r++)
      f->y[j] += g->value[j * g->most + r] / (double)g->runs[j];
    for (size_t r = 0; g->same_seeds && r < g->runs[j]; r++)
      common[r] += (g->value[j * g->most + r] - f->y[j]) / (double)f->n;
  }
  for (size_t j = 0; j < f->n; j++) {
    influence[j] = 0;
    for (size_t r = 0; r < g->runs[j]; r++) {
      const double d = g->value[j * g->most + r] - f->y[j];
      influence[j] += d * d;
      own += (d - common[r]) * (d - common[r]);
    }
    seeds->value += influence[j];
    freedom += (double)(g->runs[j] - 1);
    inverse += 1 / (double)g->runs[j] / (double)f->n;
  }
  *of_means = NAN;
  if (!(freedom > 0))
    return STATUS_OK;
  seeds->value /= freedom;
  seeds->raw = seeds->value;
  seeds->scales = g->same_seeds;
  if (g->same_seeds) { /* their mean effect is known from a few seeds, however many points there are */
    double alike = 0;
    for (size_t r = 0; r < g->most; r++)
      alike += common[r] * common[r] / (double)(g->most - 1);
    const double student = sample_student(g->most, 0.95) / gsl_cdf_ugaussian_Pinv(0.975);
    f->alike = 2 * alike * alike / (double)(g->most - 1) * student * student;
  }
  *of_means = own / freedom * (g->same_seeds ? (double)f->n / (double)(f->n - 1) : 1) * inverse;
  for (size_t j = 0; j < f->n; j++)
    influence[j] = (influence[j] - (double)(g->runs[j] - 1) * seeds->value) * (double)f->n / freedom;
  return STATUS_OK;
}

/* Both shares have the same order. That of the means is free of the share of the seeds, whose interval may be wide. */
static struct sensitivity_share ranked(const struct sensitivity_point *index) {
  return isfinite(index->of_means.estimate) ? index->of_means : index->of_runs;
}

static void rank_indices(size_t inputs, struct sensitivity_point *index) {
  for (size_t i = 0; i < inputs; i++) {
    if (index[i].verdict != SENSITIVITY_TOLD)
      continue;
    index[i].first_rank = index[i].last_rank = 1;
    for (size_t j = 0; j < inputs; j++) {
      const bool other = j != i && index[j].verdict == SENSITIVITY_TOLD;
      index[i].first_rank += other && ranked(&index[j]).low > ranked(&index[i]).high;
      index[i].last_rank += other && ranked(&index[j]).high >= ranked(&index[i]).low;
    }
  }
}

/* The shares, of the whole variance of a run or of the means of the points. */
static void shares(const struct fit *f, const struct term *terms, double whole, bool of_means,
                   struct sensitivity_point *index) {
  const double *of_whole = f->influence + (f->k + 1) * f->n;
  double error = 0;
  for (size_t j = 0; j < f->n; j++)
    error += of_whole[j] * of_whole[j] / (double)f->n / (double)f->n;
  for (size_t i = 0; i <= f->k; i++) {
    struct sensitivity_share *share = of_means ? &index[i].of_means : &index[i].of_runs;
    const double pull = of_means ? 0 : (double)(i == f->k) - terms[i].value / whole;
    *share = (struct sensitivity_share){NAN, NAN, NAN};
    if (index[i].verdict != SENSITIVITY_TOLD || (i == f->k && (of_means || !(terms[i].value > 0))))
      continue;
    if (!of_means || whole > 2 * sqrt(error)) /* else noise may be all of it */
      *share = share_of(f, &terms[i], f->influence + i * f->n, of_whole, whole, pull);
  }
}

static status make(struct fit *f, struct sensitivity_point *index, struct error *error) {
  const size_t n = f->n, k = f->k;
  struct term terms[LIMITS_AXES_OF_POOL + 1] = {{0}};
  double of_means = 0, variance = 0, mean = 0, whole = 0, *of_whole = f->influence + (k + 1) * n;
  bool moving = false;
  TRY(read_values(f, &terms[k], &of_means, error));
  TRY(sample_squares_fit(n, f->y, error));
  for (size_t j = 0; j < n; j++)
    mean += f->y[j] / (double)n;
  for (size_t j = 0; j < n; j++)
    variance += (f->y[j] - mean) * (f->y[j] - mean) / (double)(n - 1);
  if (!(variance > LEAST_VARIANCE * mean * mean))
    return status_fail(error, STATUS_USAGE, "all points have the same mean: there is no variance to explain");
  TRY(fit_columns(f, index, &moving, error));
  for (size_t j = 0; j < n; j++)
    of_whole[j] = moving ? (f->y[j] - mean) * (f->y[j] - mean) - variance
                         : f->rest[j] * f->rest[j] * (double)n / (double)(n - f->p) - f->noise;
  whole = f->noise;
  for (size_t i = 0; i < k; i++) {
    terms[i] = polynomial(f, i);
    whole += terms[i].value;
    for (size_t j = 0; !moving && j < n; j++)
      of_whole[j] += f->influence[i * n + j];
    add_rest(f, i, &terms[i]);
  }
  /* Inputs are independent, so their covariances over these points are chance and no part of the whole. */
  whole = moving ? variance : fmax(whole, variance / 10);
  const bool seeds = terms[k].value > 0 && isfinite(of_means);
  const double scale = seeds ? of_means / terms[k].value : 0; /* variance of the means by seeds over that of a run */
  for (int means = 0; means < 2; means++) {
    const double change = seeds ? (means ? -scale : 1 - scale) : 0;
    for (size_t j = 0; j < n; j++)
      of_whole[j] += change * f->influence[k * n + j];
    shares(f, terms, whole + change * terms[k].value, means, index);
    for (size_t j = 0; j < n; j++)
      of_whole[j] -= change * f->influence[k * n + j];
    if (!seeds)
      for (size_t i = 0; means && i <= k; i++)
        index[i].of_means = (struct sensitivity_share){NAN, NAN, NAN};
  }
  /* Shares of one variance: two seeds alone may leave the seeds' share open up to 1, but no input's. */
  struct sensitivity_share *seed = &index[k].of_runs;
  for (size_t i = 0; i < k && isfinite(seed->high); i++)
    seed->high = fmin(seed->high, 1 - index[i].of_runs.low); /* NaN is no bound */
  if (isfinite(seed->high))
    *seed = (struct sensitivity_share){fmin(seed->estimate, seed->high), fmin(seed->low, seed->high), seed->high};
  rank_indices(k, index);
  return STATUS_OK;
}

/* Inputs whose ranks are those of an earlier one, or reversed: linked axes. They are no inputs of their own. */
static void find_same(struct fit *f, struct sensitivity_point *index) {
  for (size_t b = 1; b < f->k; b++)
    for (size_t a = 0; a < b && index[b].verdict == SENSITIVITY_TOLD; a++) {
      size_t up = 0, down = 0;
      for (size_t j = 0; j < f->n; j++) {
        up += fabs(f->rank[j * f->k + a] - f->rank[j * f->k + b]) < 1e-9;
        down += fabs(f->rank[j * f->k + a] + f->rank[j * f->k + b]) < 1e-9;
      }
      if (index[a].verdict != SENSITIVITY_TOLD || (up < f->n && down < f->n))
        continue;
      index[b].verdict = SENSITIVITY_SAME;
      index[b].with = a;
      f->levels[b] = 1;
    }
}

/* Do more pairs of points differ in one input alone than independent values would have? Not in a grid. */
static bool has_steps(const struct fit *f) {
  enum { LOOKED_AT = 500 };
  const size_t looked = f->n < LOOKED_AT ? f->n : LOOKED_AT;
  double all = 1, same[LIMITS_AXES_OF_POOL], pairs = 0, chance = 0;
  for (size_t i = 0; i < f->k; i++) {
    const struct place *order = f->order + i * f->n;
    all *= (double)f->levels[i];
    same[i] = 0;
    for (size_t from = 0, to = 0; from < f->n; from = to) {
      while (to < f->n && !(order[to].x > order[from].x))
        to++;
      same[i] += (double)((to - from) * (to - from - 1)) / (double)f->n / (double)(f->n - 1);
    }
  }
  for (size_t a = 0; a < looked; a++)
    for (size_t b = 0; b < f->n; b++) {
      size_t changed = 0;
      for (size_t i = 0; i < f->k && changed < 2; i++)
        changed += f->rank[a * f->k + i] != f->rank[b * f->k + i];
      pairs += changed == 1;
    }
  for (size_t i = 0; i < f->k; i++) {
    double others = (double)looked * (double)f->n * (1 - same[i]);
    for (size_t j = 0; j < f->k; j++)
      others *= j == i ? 1 : same[j];
    chance += others;
  }
  return f->k > 1 && (double)f->n < all / 2 && pairs > 3 * chance + (double)looked / 2;
}

status sensitivity_points(const struct sensitivity_points *given, struct sensitivity_point *index, size_t *needed,
                          struct error *error) {
  __attribute__((cleanup(release))) struct fit f = {.given = given, .n = given->points, .k = given->inputs};
  size_t degree = MOST_DEGREE;
  for (size_t i = 0; i <= f.k; i++)
    index[i] = (struct sensitivity_point){.verdict = SENSITIVITY_TOLD};
  TRY(rank_inputs(&f, error));
  for (size_t i = 0; i < f.k; i++)
    if (f.levels[i] < 2)
      index[i].verdict = SENSITIVITY_ONE_VALUE;
  find_same(&f, index);
  if (has_steps(&f)) {
    for (size_t i = 0; i < f.k; i++)
      index[i].verdict = SENSITIVITY_STEPS;
    *needed = 0;
    return STATUS_OK;
  }
  *needed = PER_COLUMN * columns_of(&f, 1);
  *needed = *needed < LEAST_POINTS ? LEAST_POINTS : *needed;
  if (f.n < *needed)
    return STATUS_OK;
  while (PER_COLUMN * columns_of(&f, degree) > f.n)
    degree--;
  TRY(memory_array(&f.weight, 3 * f.n, sizeof(double), "the points", error));
  f.y = f.weight + f.n;
  f.rest = f.y + f.n;
  TRY(memory_array(&f.influence, (f.k + 2) * f.n, sizeof(double), "the points", error));
  return make(&f, index, error);
}
