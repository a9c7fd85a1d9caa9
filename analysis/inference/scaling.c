/* Finite-size scaling by polynomials in the scaled control. */
#include "analysis/inference/scaling.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "analysis/inference/inference.h"
#include "analysis/statistics/statistics.h"
#include "engine/random.h"
#include "schemas/memory.h"

enum { DEGREE = 3, TERMS = DEGREE + 1, MOST = TERMS + 2, DRAWS = 200 };
static const double CLEAR = 2;             /* standard errors by which curves differ on both sides of a crossing */
static const double WINDOWS[] = {2, 3, 4}; /* half widths in ln r, about the crossing */
enum { REGULAR_SIZES = 4 };                /* with fewer sizes S has no regular part */
enum { IN_WINDOW = 4 };                    /* cells of a size that are enough */
static const double TOLD = 0.9;            /* share of the draws that have a value */
static const double PRIOR = 4;             /* runs that the common scatter counts as, beside those of a cell */
static const double LEAST_SPREAD = 1e-12;  /* variance of equal runs: they have equal weights */
static const double NOT_ONE = 4, NOT_ONE_SHARE = 0.1; /* chi-square and distance of curves that are not one */

const char *const scaling_kind_names[] = {"found", "jump", "too-few", "no-crossing", "not-one-curve", "not-told", NULL};

enum { RATIO, ORDER, SECOND, CUTOFF, CURVES };
enum { SUM_ORDER, SUM_SHARE, SUM_SECOND, SUM_THIRD, SUMS };

struct cell { /* the runs of one size and control */
  size_t level;
  double control, runs;
  double y[CURVES];      /* ln r, ln P, ln S, ln T/S */
  double spread[CURVES]; /* variance of one run in them */
  bool used;
};

struct study {
  int dimensions;
  size_t runs, cells, levels;
  struct scaling_run *run; /* by size, seed and control */
  size_t *of;              /* cell of each run */
  struct cell *cell;       /* by size and control */
  double size[SCALING_SIZES], seeds[SCALING_SIZES];
  size_t first[SCALING_SIZES + 1]; /* cells of each size */
  double centre, width;            /* of the control: t = (x - centre)/width */
  double longest;                  /* ln L of the largest size */
  size_t terms;                    /* of the polynomials */
  double regular;                  /* part of S, of the last slope that was fitted; 0: none */
  double left;                     /* multiple of a shift, set_left() */
};

struct curve { /* of ln r: a polynomial in (t - at) (L/longest)^power */
  double at, power, a[TERMS];
};

static int by_size_and_seed(const void *a, const void *b) {
  const struct scaling_run *p = a, *q = b;
  if (p->size != q->size)
    return p->size < q->size ? -1 : 1;
  if (p->seed != q->seed)
    return p->seed < q->seed ? -1 : 1;
  return p->control < q->control ? -1 : p->control > q->control;
}

static int by_size_and_control(const void *a, const void *b) {
  const struct cell *p = a, *q = b;
  if (p->level != q->level)
    return p->level < q->level ? -1 : 1;
  return p->control < q->control ? -1 : p->control > q->control;
}

static bool is_usable(const struct scaling_run *run) {
  return isfinite(run->control) && run->size > 0 && run->largest > 0 && run->second >= 0 && run->third >= 0 &&
         isfinite(run->second + run->third);
}

/* ---- the cells ---- */

static void write_sums(const struct scaling_run *run, double elements, double sum[SUMS]) {
  sum[SUM_ORDER] = isnan(run->order) ? 0 : run->order;
  const double square = run->largest * run->largest * elements;
  sum[SUM_SHARE] = square / (run->second + square);
  sum[SUM_SECOND] = run->second;
  sum[SUM_THIRD] = run->third;
}

/* Means of each cell with a weight for each seed of a size; draw 0: all weights are 1. */
static void fill_cells(struct study *s, uint64_t draw, double (*sum)[SUMS], double (*weight)[2]) {
  double w = 1;
  size_t level = 0;
  double elements = pow(s->size[0], s->dimensions);
  memset(sum, 0, s->cells * sizeof *sum);
  memset(weight, 0, s->cells * sizeof *weight);
  for (size_t r = 0; r < s->runs; r++) {
    const struct scaling_run *run = &s->run[r];
    double add[SUMS];
    if (s->size[level] < run->size)
      elements = pow(s->size[++level], s->dimensions);
    if (draw && (r == 0 || run->seed != run[-1].seed || run->size != run[-1].size))
      w = -log1p(-random_draw(draw, RANDOM_RESAMPLE, run->seed, level));
    write_sums(run, elements, add);
    for (int k = 0; k < SUMS; k++)
      sum[s->of[r]][k] += w * add[k];
    weight[s->of[r]][0] += w;
    weight[s->of[r]][1] += isnan(run->order) ? 0 : w;
  }
  for (size_t c = 0; c < s->cells; c++) {
    struct cell *cell = &s->cell[c];
    cell->y[RATIO] = log(weight[c][0] / sum[c][SUM_SHARE] - 1);
    cell->y[ORDER] = log(sum[c][SUM_ORDER] / weight[c][1]);
    cell->y[SECOND] = log(sum[c][SUM_SECOND] / weight[c][0]);
    cell->y[CUTOFF] = log(sum[c][SUM_THIRD] / sum[c][SUM_SECOND]);
  }
}

/* Variance of one run in the four logarithms, to first order in its distance from the means; of an order that some runs
 * lack, that of the mean of the others times all runs. */
static void fill_spread(struct study *s, double (*sum)[SUMS], double (*weight)[2]) {
  for (size_t r = 0; r < s->runs; r++) {
    struct cell *cell = &s->cell[s->of[r]];
    const double *mean = sum[s->of[r]], n = cell->runs, have = weight[s->of[r]][1];
    double at[SUMS];
    write_sums(&s->run[r], pow(s->run[r].size, s->dimensions), at);
    for (int k = 0; k < SUMS; k++)
      at[k] = n * at[k] / mean[k] - 1;
    at[SUM_ORDER] = isnan(s->run[r].order) ? 0
                                           : (have * s->run[r].order / mean[SUM_ORDER] - 1) *
                                                 sqrt(n / have * fmax(n - 1, 1) / fmax(have - 1, 1));
    const double off[CURVES] = {-at[SUM_SHARE] * (1 + exp(-cell->y[RATIO])), at[SUM_ORDER], at[SUM_SECOND],
                                at[SUM_THIRD] - at[SUM_SECOND]};
    for (int k = 0; k < CURVES; k++)
      cell->spread[k] += off[k] * off[k] / fmax(n - 1, 1);
  }
}

/* Few runs tell their scatter badly: that of all used cells helps. */
static void mix_spread(struct study *s) {
  double common[CURVES] = {0}, n = 0;
  for (size_t c = 0; c < s->cells; c++)
    if (s->cell[c].used) {
      n++;
      for (int k = 0; k < CURVES; k++)
        common[k] += s->cell[c].spread[k];
    }
  for (size_t c = 0; c < s->cells; c++)
    for (int k = 0; k < CURVES; k++)
      s->cell[c].spread[k] = fmax(LEAST_SPREAD, ((s->cell[c].runs - 1) * s->cell[c].spread[k] + PRIOR * common[k] / n) /
                                                    (s->cell[c].runs - 1 + PRIOR));
}

static status gather(struct study *s, size_t n, const struct scaling_run *runs, struct error *error) {
  static const char what[] = "the runs of several sizes";
  TRY(memory_array(&s->run, n, sizeof *s->run, what, error));
  TRY(memory_array(&s->of, n, sizeof *s->of, what, error));
  TRY(memory_array(&s->cell, n, sizeof *s->cell, what, error));
  for (size_t i = 0; i < n; i++)
    if (is_usable(&runs[i]))
      s->run[s->runs++] = runs[i];
  qsort(s->run, s->runs, sizeof *s->run, by_size_and_seed);
  for (size_t r = 0; r < s->runs; r++) {
    const struct scaling_run *run = &s->run[r];
    if (r == 0 || run->size != run[-1].size) {
      if (s->levels == SCALING_SIZES)
        return status_fail(error, STATUS_USAGE, "at most %d sizes are compared", SCALING_SIZES);
      s->size[s->levels++] = run->size;
    }
    if (r == 0 || run->size != run[-1].size || run->seed != run[-1].seed)
      s->seeds[s->levels - 1]++;
    s->cell[r] = (struct cell){.level = s->levels - 1, .control = run->control};
  }
  qsort(s->cell, s->runs, sizeof *s->cell, by_size_and_control);
  for (size_t r = 0; r < s->runs; r++) {
    if (s->cells == 0 || by_size_and_control(&s->cell[s->cells - 1], &s->cell[r]) != 0)
      s->cell[s->cells++] = s->cell[r];
    s->cell[s->cells - 1].runs++;
  }
  size_t level = 0;
  for (size_t r = 0; r < s->runs; r++) {
    while (s->size[level] < s->run[r].size)
      level++;
    const struct cell key = {.level = level, .control = s->run[r].control};
    const struct cell *found = bsearch(&key, s->cell, s->cells, sizeof key, by_size_and_control);
    s->of[r] = (size_t)(found - s->cell);
  }
  for (size_t c = s->cells; c-- > 0;)
    s->first[s->cell[c].level] = c;
  s->first[s->levels] = s->cells;
  return STATUS_OK;
}

/* ---- the crossing ---- */

/* ln r of a size at x, between its cells, and its variance. NaN outside. */
static double interpolate(const struct study *s, size_t level, double x, double *variance) {
  for (size_t c = s->first[level]; c + 1 < s->first[level + 1]; c++) {
    const struct cell *a = &s->cell[c], *b = a + 1;
    if (x < a->control || x > b->control)
      continue;
    const double u = (x - a->control) / (b->control - a->control);
    *variance = (1 - u) * (1 - u) * a->spread[RATIO] / a->runs + u * u * b->spread[RATIO] / b->runs;
    return (1 - u) * a->y[RATIO] + u * b->y[RATIO];
  }
  return NAN;
}

/* Where the curves of two sizes cross, and ln r there: on the side of large P the curve of the larger size is lower, on
 * the other side it is higher, by CLEAR standard errors. False: they do not cross so, and *out has where they are
 * nearest. */
static bool cross(const struct study *s, size_t small, size_t large, double *at, double *ratio, struct scaling *out) {
  const size_t end[2] = {s->first[small + 1], s->first[large + 1]};
  const struct cell *low = &s->cell[s->first[large]], *high = &s->cell[end[1] - 1];
  const double rising = high->y[ORDER] > low->y[ORDER] ? 1 : -1;
  double least = NAN;              /* difference */
  double last_x = NAN, last = NAN; /* the last place where the curves clearly differ */
  for (size_t i = s->first[small], j = s->first[large]; i < end[0] || j < end[1];) {
    const bool first = j == end[1] || (i < end[0] && s->cell[i].control <= s->cell[j].control);
    const double x = s->cell[first ? i++ : j++].control;
    double variance[2] = {0, 0};
    const double y[2] = {interpolate(s, small, x, &variance[0]), interpolate(s, large, x, &variance[1])};
    const double difference = rising * (y[1] - y[0]);
    if (isnan(difference))
      continue;
    out->range[0] = isnan(out->range[0]) ? x : out->range[0];
    out->range[1] = x;
    const bool clear = fabs(difference) > CLEAR * sqrt(variance[0] + variance[1]);
    if (!(fabs(difference) >= least)) {
      least = fabs(difference);
      out->nearest = x;
      out->touch = !clear;
      for (int k = 0; k < 2; k++)
        out->nearest_q[k] = 1 / (1 + exp(y[k]));
    }
    if (!clear)
      continue;
    out->differ = true;
    if (last > 0 && difference < 0) {
      *at = last_x + (x - last_x) * last / (last - difference);
      *ratio = interpolate(s, large, *at, variance);
      return true;
    }
    last = difference;
    last_x = x;
  }
  return false;
}

/* The second value of the control on each side of x, or the last one there. */
static void look_about(const struct study *s, double x, double about[2]) {
  for (int side = 0; side < 2; side++) {
    double nearest[2] = {NAN, NAN};
    const double sign = side ? 1 : -1;
    for (size_t c = 0; c < s->cells; c++) {
      const double far = sign * (s->cell[c].control - x);
      if (far < 0 || far == nearest[0] || far == nearest[1])
        continue;
      if (!(far >= nearest[0])) {
        nearest[1] = nearest[0];
        nearest[0] = far;
      } else if (!(far >= nearest[1]))
        nearest[1] = far;
    }
    about[side] = x + sign * (isnan(nearest[1]) ? nearest[0] : nearest[1]);
  }
}

/* Does the cell tell all means and their scatter? */
static bool is_whole(const struct cell *cell) {
  bool finite = cell->runs >= SCALING_LEAST_RUNS;
  for (int k = 0; k < CURVES; k++)
    finite = finite && isfinite(cell->y[k]) && isfinite(cell->spread[k]);
  return finite;
}

/* Chooses the cells about the crossing. False: a size has fewer than two. */
static bool choose(struct study *s, double ratio) {
  size_t least = 0;
  for (size_t w = 0; w <= sizeof WINDOWS / sizeof *WINDOWS && least < IN_WINDOW; w++) {
    const double half = w < sizeof WINDOWS / sizeof *WINDOWS ? WINDOWS[w] : HUGE_VAL;
    least = SIZE_MAX;
    for (size_t level = 0; level < s->levels; level++) {
      size_t in = 0;
      for (size_t c = s->first[level]; c < s->first[level + 1]; c++)
        in += s->cell[c].used = is_whole(&s->cell[c]) && fabs(s->cell[c].y[RATIO] - ratio) <= half;
      least = in < least ? in : least;
    }
  }
  s->width = 0;
  for (size_t c = 0; c < s->cells; c++)
    if (s->cell[c].used)
      s->width = fmax(s->width, fabs(s->cell[c].control - s->centre));
  return least >= 2 && s->width > 0;
}

/* ---- the fits ---- */

/* Adds a row of a linear least-squares problem to its normal equations. */
static void add_row(size_t n, const double *row, double y, double weight, double *matrix, double *side) {
  for (size_t i = 0; i < n; i++) {
    side[i] += weight * row[i] * y;
    for (size_t j = 0; j < n; j++)
      matrix[i * n + j] += weight * row[i] * row[j];
  }
}

static double place(const struct study *s, const struct curve *curve, const struct cell *cell) {
  return ((cell->control - s->centre) / s->width - curve->at) *
         exp(curve->power * (log(s->size[cell->level]) - s->longest));
}

/* The sum of squares of ln r about the curve, and the normal equations of its change. */
static double linearise(const struct study *s, size_t from, const struct curve *curve, double *matrix, double *side) {
  const size_t n = s->terms + 2;
  double sum = 0;
  memset(matrix, 0, n * n * sizeof *matrix);
  memset(side, 0, n * sizeof *side);
  for (size_t c = s->first[from]; c < s->cells; c++) {
    const struct cell *cell = &s->cell[c];
    if (!cell->used)
      continue;
    const double l = log(s->size[cell->level]) - s->longest, z = place(s, curve, cell);
    double row[MOST], value = 0, slope = 0, power = 1;
    for (size_t k = 0; k < s->terms; k++) {
      row[2 + k] = power;
      value += curve->a[k] * power;
      slope += k + 1 < s->terms ? (double)(k + 1) * curve->a[k + 1] * power : 0;
      power *= z;
    }
    row[0] = -slope * exp(curve->power * l);
    row[1] = slope * z * l;
    const double off = cell->y[RATIO] - value, weight = cell->runs / cell->spread[RATIO];
    add_row(n, row, off, weight, matrix, side);
    sum += weight * off * off;
  }
  return sum;
}

/* Fits the curve of ln r from a first guess (Levenberg 1944, Marquardt 1963). Returns the sum of squares; NaN: no
 * minimum was found. */
static double fit_ratio(const struct study *s, size_t from, struct curve *curve) {
  const size_t n = s->terms + 2;
  double matrix[MOST * MOST], side[MOST], damped[MOST * MOST], step[MOST], damping = 1e-3;
  double sum = linearise(s, from, curve, matrix, side);
  for (int i = 0; i < 60; i++) {
    memcpy(damped, matrix, sizeof damped);
    for (size_t k = 0; k < n; k++)
      damped[k * n + k] *= 1 + damping;
    if (!covariance_factor(n, damped))
      return NAN;
    covariance_solve(n, damped, side, step);
    struct curve next = *curve;
    next.at += step[0];
    next.power += step[1];
    for (size_t k = 0; k < s->terms; k++)
      next.a[k] += step[2 + k];
    double next_matrix[MOST * MOST], next_side[MOST];
    const double next_sum = linearise(s, from, &next, next_matrix, next_side);
    if (!(next_sum <= sum)) {
      damping *= 10;
      if (damping > 1e12)
        break;
      continue;
    }
    const bool settled = sum - next_sum <= 1e-10 * sum;
    *curve = next;
    sum = next_sum;
    memcpy(matrix, next_matrix, sizeof matrix);
    memcpy(side, next_side, sizeof side);
    damping /= 10;
    if (settled)
      break;
  }
  return fabs(curve->at) <= 1 && curve->power > 0 ? sum : (double)NAN;
}

/* Slope of a logarithm against ln L at equal z. NaN: none. */
static double fit_slope(struct study *s, size_t from, const struct curve *curve, int which) {
  const bool regular = which != ORDER && s->levels >= REGULAR_SIZES;
  const size_t n = s->terms + 1 + regular;
  double matrix[MOST * MOST] = {0}, side[MOST] = {0}, solution[MOST];
  for (size_t c = s->first[from]; c < s->cells; c++) {
    const struct cell *cell = &s->cell[c];
    double row[MOST] = {log(s->size[cell->level]) - s->longest, 1};
    if (!cell->used)
      continue;
    for (size_t k = 2; k < s->terms + 1; k++)
      row[k] = row[k - 1] * place(s, curve, cell);
    if (regular) /* ln(S - b) = ln S - b/S */
      row[n - 1] = exp(-cell->y[SECOND]);
    add_row(n, row, cell->y[which], cell->runs / cell->spread[which], matrix, side);
  }
  s->regular = 0;
  if (!covariance_factor(n, matrix))
    return NAN;
  covariance_solve(n, matrix, side, solution);
  if (regular)
    s->regular = solution[n - 1];
  return solution[0];
}

/* All values of the sizes from.. at a curve of ln r. */
static void tell_values(struct study *s, size_t from, const struct curve *curve, double value[SCALING_VALUES]) {
  value[SCALING_CRITICAL] = s->centre + s->width * curve->at;
  value[SCALING_NU] = 1 / curve->power;
  value[SCALING_BETA] = -fit_slope(s, from, curve, ORDER);
  value[SCALING_GAMMA] = fit_slope(s, from, curve, SECOND);
  value[SCALING_CUTOFF] = fit_slope(s, from, curve, CUTOFF);
  value[SCALING_TAU] = 3 - value[SCALING_GAMMA] / value[SCALING_CUTOFF];
}

/* Of a slope against ln L whose corrections fall as 1/L: what is left of them without the smallest size, over the
 * change when that size is dropped. */
static void set_left(struct study *s) {
  double slope[2];
  for (size_t from = 0; from < 2; from++) {
    double n = 0, x = 0, xx = 0, y = 0, xy = 0;
    for (size_t c = s->first[from]; c < s->cells; c++) {
      const double w = s->cell[c].used ? s->cell[c].runs : 0, l = log(s->size[s->cell[c].level]) - s->longest;
      n += w;
      x += w * l;
      xx += w * l * l;
      y += w * exp(-l);
      xy += w * l * exp(-l);
    }
    slope[from] = (n * xy - x * y) / (n * xx - x * x);
  }
  s->left = slope[1] / (slope[0] - slope[1]);
}

enum { WITHOUT, OWN, CURVE, PARTS };
struct fitted {
  double part[PARTS][SCALING_VALUES]; /* without the smallest size; two half distances (scaling.h) */
  double shift[SCALING_VALUES];
};

/* Fits ln r without and with the smallest size, beginning at the two curves, and leaves the curves there. */
static struct fitted fit_all(struct study *s, struct curve curve[2]) {
  struct fitted fitted;
  double with[2][SCALING_VALUES], other[SCALING_VALUES];
  for (int v = 0; v < SCALING_VALUES; v++)
    fitted.shift[v] = fitted.part[WITHOUT][v] = fitted.part[OWN][v] = fitted.part[CURVE][v] = NAN;
  if (isnan(fit_ratio(s, 1, &curve[0])))
    return fitted;
  tell_values(s, 1, &curve[0], fitted.part[WITHOUT]);
  if (isnan(fit_ratio(s, 0, &curve[1])))
    return fitted;
  tell_values(s, 1, &curve[1], other);
  for (int k = 0; k < 2; k++)
    tell_values(s, 0, &curve[k], with[k]);
  for (int v = 0; v < SCALING_VALUES; v++) {
    const double value = fitted.part[WITHOUT][v];
    const double at[2] = {value - with[0][v], other[v] - with[1][v]}; /* shifts at a curve: 0 of x_c and nu */
    fitted.part[OWN][v] = s->left / 2 * (at[0] + s->left / 2 * (at[0] - at[1]));
    fitted.part[CURVE][v] = s->left / 2 * (value - other[v]);
    fitted.shift[v] = value - with[1][v];
  }
  return fitted;
}

/* The best fit from several guesses. */
static struct curve first_fit(const struct study *s, size_t from, double ratio) {
  static const double powers[] = {0.3, 0.6, 1, 1.5, 2, 3};
  struct curve best = {.power = NAN};
  double least = HUGE_VAL;
  for (size_t p = 0; p < sizeof powers / sizeof *powers; p++) {
    struct curve curve = {.power = powers[p], .a = {ratio, -1}};
    const double sum = fit_ratio(s, from, &curve);
    if (sum < least) {
      least = sum;
      best = curve;
    }
  }
  return best;
}

/* ---- the collapse ---- */

struct scaled {
  double z, y, variance;
};

static struct scaled scale(const struct study *s, const struct curve *curve, const struct cell *cell, int which,
                           double slope) {
  const double all = exp(cell->y[which]), part = which == SECOND ? s->regular : 0;
  const double factor = exp(-slope * (log(s->size[cell->level]) - s->longest)), y = factor * all;
  return (struct scaled){place(s, curve, cell), y - factor * part, y * y * cell->spread[which] / cell->runs};
}

/* The master curve at z by the cells of the other sizes: a straight line through the two neighbours of z in each size
 * (Houdayer & Hartmann 2004, eqs A2 to A5). False: no size has cells on both sides. */
static bool master(const struct study *s, const struct curve *curve, int which, double slope, size_t level, double z,
                   double *y, double *variance) {
  double k = 0, kx = 0, ky = 0, kxx = 0, kxy = 0;
  for (size_t other = 1; other < s->levels; other++)
    for (size_t c = s->first[other]; other != level && c + 1 < s->first[other + 1]; c++) {
      const struct scaled pair[2] = {scale(s, curve, &s->cell[c], which, slope),
                                     scale(s, curve, &s->cell[c + 1], which, slope)};
      if (!s->cell[c].used || !s->cell[c + 1].used || pair[0].z > z || pair[1].z < z)
        continue;
      for (int i = 0; i < 2; i++) {
        const double w = 1 / pair[i].variance, x = pair[i].z - z;
        k += w;
        kx += w * x;
        ky += w * pair[i].y;
        kxx += w * x * x;
        kxy += w * x * pair[i].y;
      }
      break;
    }
  const double determinant = k * kxx - kx * kx;
  if (!(determinant > 0))
    return false;
  *y = (kxx * ky - kx * kxy) / determinant;
  *variance = kxx / determinant;
  return true;
}

static void collapse(const struct study *s, const struct curve *curve, int which, double slope, double *chi_square,
                     double *distance) {
  double sum = 0, squares = 0, n = 0;
  for (size_t c = s->first[1]; c < s->cells; c++) {
    double y, variance;
    const struct scaled here = scale(s, curve, &s->cell[c], which, slope);
    if (!s->cell[c].used || !master(s, curve, which, slope, s->cell[c].level, here.z, &y, &variance))
      continue;
    n++;
    sum += (here.y - y) * (here.y - y) / (here.variance + variance);
    squares += (here.y / y - 1) * (here.y / y - 1);
  }
  *chi_square = sum / n; /* NaN without cells that can be compared */
  *distance = sqrt(squares / n);
}

/* ---- the answer ---- */

/* Standard deviation over the draws of a sum of shares of the parts. *n: the draws that have it. */
static double scatter(const struct fitted *drawn, int v, const double share[PARTS], size_t *n) {
  struct sample_moments moments = {0};
  for (int draw = 0; draw < DRAWS; draw++)
    sample_add(&moments, share[WITHOUT] * drawn[draw].part[WITHOUT][v] + share[OWN] * drawn[draw].part[OWN][v] +
                             share[CURVE] * drawn[draw].part[CURVE][v]);
  *n = moments.n;
  return sample_summarise_moments(&moments, 0.95).standard_deviation;
}

/* Draws weights of whole runs, fits again, and sets values and intervals. */
static status resample(struct study *s, const struct curve best[2], const struct fitted *fitted, struct scaling *out,
                       struct error *error) {
  struct fitted drawn[DRAWS];
  double least = HUGE_VAL;
  OWNED double(*sum)[SUMS] = NULL;
  OWNED double(*weight)[2] = NULL;
  TRY(memory_array(&sum, s->cells, sizeof *sum, "resampled runs", error));
  TRY(memory_array(&weight, s->cells, sizeof *weight, "resampled runs", error));
  for (size_t level = 0; level < s->levels; level++)
    least = fmin(least, s->seeds[level]);
  for (int draw = 0; draw < DRAWS; draw++) {
    struct curve curve[2] = {best[0], best[1]};
    fill_cells(s, 1 + (uint64_t)draw, sum, weight);
    drawn[draw] = fit_all(s, curve);
  }
  fill_cells(s, 0, sum, weight);
  /* These weights scatter by (n - 1)/(n + 1) of the variance of a mean of n runs. */
  const double times = sqrt((least + 1) / (least - 1)), student = sample_student((size_t)least, 0.95);
  for (int v = 0; v < SCALING_VALUES; v++) {
    struct scaling_estimate told = {.estimate = fitted->part[WITHOUT][v], .shift = fitted->shift[v]};
    double share[PARTS] = {1, 0, 0}, halves = 0;
    size_t n = 0;
    for (int k = OWN; k <= CURVE; k++) {
      const double half = fitted->part[k][v];
      const double noise = times * scatter(drawn, v, (const double[PARTS]){0, k == OWN, k == CURVE}, &n);
      share[k] = half != 0 ? half * half / (half * half + noise * noise) : 0;
      told.estimate += share[k] * half;
      halves += fabs(half);
    }
    told.half_width = hypot(student * times * scatter(drawn, v, share, &n), halves);
    if (n < TOLD * DRAWS || !isfinite(told.half_width)) /* most resampled runs have no such value */
      told = (struct scaling_estimate){NAN, NAN, NAN};
    out->value[v] = told;
  }
  return STATUS_OK;
}

static bool within(const struct scaling_estimate *value, double target) {
  return fabs(value->estimate - target) <= value->half_width;
}

/* Is x between controls that were used? */
static bool is_inside(const struct study *s, double x) {
  bool below = false, above = false;
  for (size_t c = 0; c < s->cells; c++) {
    below = below || (s->cell[c].used && s->cell[c].control <= x);
    above = above || (s->cell[c].used && s->cell[c].control >= x);
  }
  return below && above;
}

static status answer(struct study *s, struct scaling *out, struct error *error) {
  double ratio;
  if (s->levels < SCALING_LEAST_SIZES)
    return STATUS_OK;
  out->kind = SCALING_NO_CROSSING;
  if (!cross(s, 0, s->levels - 1, &s->centre, &ratio, out))
    return STATUS_OK;
  out->crossing = s->centre;
  look_about(s, s->centre, out->about);
  out->kind = SCALING_TOO_FEW;
  if (!choose(s, ratio))
    return STATUS_OK;
  size_t used = 0;
  for (size_t c = s->first[1]; c < s->cells; c++)
    used += s->cell[c].used;
  s->terms = used >= 10 ? TERMS : used >= 7 ? 3 : 2;
  mix_spread(s);
  out->kind = SCALING_NOT_TOLD;
  struct curve best = first_fit(s, 1, ratio), curve[2] = {best, best};
  set_left(s);
  const struct fitted fitted = fit_all(s, curve);
  collapse(s, &curve[0], ORDER, -fitted.part[WITHOUT][SCALING_BETA], &out->chi_square[0], &out->distance[0]);
  fit_slope(s, 1, &curve[0], SECOND); /* its regular part */
  collapse(s, &curve[0], SECOND, fitted.part[WITHOUT][SCALING_GAMMA], &out->chi_square[1], &out->distance[1]);
  if (isnan(out->chi_square[0] + out->chi_square[1]) || !is_inside(s, fitted.part[WITHOUT][SCALING_CRITICAL])) {
    for (int k = 0; k < 2; k++)
      out->chi_square[k] = out->distance[k] = NAN;
    return STATUS_OK;
  }
  out->kind = SCALING_NOT_ONE;
  for (int k = 0; k < 2; k++)
    if (!(out->chi_square[k] < NOT_ONE || out->distance[k] < NOT_ONE_SHARE))
      return STATUS_OK;
  TRY(resample(s, curve, &fitted, out, error));
  const struct scaling_estimate *nu = &out->value[SCALING_NU];
  out->may_jump = within(&out->value[SCALING_BETA], 0) && nu->estimate - nu->half_width <= 1.0 / s->dimensions;
  const bool jump = out->may_jump && nu->estimate + nu->half_width < 2.0 / s->dimensions;
  out->kind = isnan(out->value[SCALING_CRITICAL].estimate) ? SCALING_NOT_TOLD : jump ? SCALING_JUMP : SCALING_FOUND;
  return STATUS_OK;
}

/* The means of P, S and Q, for a picture. */
static status tell_cells(const struct study *s, struct scaling *out, struct error *error) {
  static const int which[] = {ORDER, SECOND};
  TRY(memory_array(&out->cell, s->cells, sizeof *out->cell, "the means of several sizes", error));
  for (; out->cells < s->cells; out->cells++) {
    const struct cell *cell = &s->cell[out->cells];
    struct scaling_cell *told = &out->cell[out->cells];
    *told = (struct scaling_cell){.size = s->size[cell->level], .control = cell->control, .used = cell->used};
    for (int k = 0; k < 2; k++) {
      told->mean[k] = exp(cell->y[which[k]]);
      told->half_width[k] = told->mean[k] * sample_student((size_t)cell->runs, 0.95) *
                            sqrt(cell->spread[which[k]] / cell->runs);
    }
    told->mean[2] = 1 / (1 + exp(cell->y[RATIO]));
    told->half_width[2] = told->mean[2] * (1 - told->mean[2]) * sample_student((size_t)cell->runs, 0.95) *
                          sqrt(cell->spread[RATIO] / cell->runs);
  }
  return STATUS_OK;
}

void scaling_release(struct scaling *scaling) {
  free(scaling->cell);
  *scaling = (struct scaling){0};
}

static void release(struct study *s) {
  free(s->run);
  free(s->of);
  free(s->cell);
}

status scaling_find(size_t n, const struct scaling_run *runs, int dimensions, struct scaling *out,
                    struct error *error) {
  __attribute__((cleanup(release))) struct study s = {.dimensions = dimensions};
  OWNED double(*sum)[SUMS] = NULL;
  OWNED double(*weight)[2] = NULL;
  *out = (struct scaling){.kind = SCALING_TOO_FEW,
                          .crossing = NAN,
                          .about = {NAN, NAN},
                          .nearest = NAN,
                          .nearest_q = {NAN, NAN},
                          .range = {NAN, NAN},
                          .chi_square = {NAN, NAN},
                          .distance = {NAN, NAN}};
  for (int v = 0; v < SCALING_VALUES; v++)
    out->value[v] = (struct scaling_estimate){NAN, NAN, NAN};
  TRY(gather(&s, n, runs, error));
  out->sizes = s.levels;
  out->runs = s.runs;
  if (s.levels == 0)
    return STATUS_OK;
  s.longest = log(s.size[s.levels - 1]);
  TRY(memory_array(&sum, s.cells, sizeof *sum, "the runs of several sizes", error));
  TRY(memory_array(&weight, s.cells, sizeof *weight, "the runs of several sizes", error));
  fill_cells(&s, 0, sum, weight);
  fill_spread(&s, sum, weight);
  TRY(answer(&s, out, error));
  return tell_cells(&s, out, error);
}
