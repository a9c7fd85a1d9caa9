/* Draws of the noise, least squares for every order, and intervals by the profile over orders and dropped levels. */
#include "analysis/statistics/convergence.h"

#include <gsl/gsl_cdf.h>
#include <math.h>
#include <stdlib.h>

#include "engine/random.h"

enum {
  DRAWS = 64,    /* of the noise */
  BURN_IN = 100, /* sweeps before the first draw */
  THIN = 10,     /* sweeps between draws */
  ORDERS = 21,   /* values of p in a scan: 1/8 apart in the first one */
  SCANS = 6,     /* each scan is of the orders that the one before did not reject, with one more on each side */
  TERMS = 3,     /* limit, and one or two powers of the step */
  PAIRS = 4,     /* laws with two powers */
  FITS = ORDERS * LIMIT_LEVELS + PAIRS,
  HALVINGS = 25 /* of the bracket of a quantile */
};
#define NOTHING      ((double)NAN)
#define SPREAD_PRIOR 0.5 /* standard deviation of ln(deviation of a level) about that of the ladder */
#define SPREAD_LEAST                                                                                                   \
  0.05                  /* a level that scatters less has this share of the ladder's variance: few runs cannot tell    \
                         */
#define LAW_ERROR 0.002 /* deviation of a level's mean from any law, as a share of the range of means */
#define REJECTED  0.05  /* a law does not fit if fewer samples of it are as far from it as the levels */

static const struct limit_range nothing = {NOTHING, NOTHING, NOTHING};

/* The levels without the seeds that lack a run of some level. */
struct data {
  size_t levels, seeds;
  double step[LIMIT_LEVELS], mean[LIMIT_LEVELS];
  double squares[LIMIT_LEVELS][LIMIT_LEVELS]; /* sums over seeds of products of deviations from the means */
  double range;                               /* of the means */
};

struct noise {
  double sigma[LIMIT_LEVELS], rho;
};

/* A law of the means: the limit, and one or two powers of step/finest step. */
struct fit {
  double power[TERMS]; /* of the terms; that of the limit is 0 */
  size_t terms, dropped;
  double deviance; /* -2 ln(likelihood) and costs, less that of the best fit */
  double cost;     /* of the limit alone, cost_of_range(): at a finite step the law still says where the levels lead */
  double tail;     /* share of samples of the law that are farther from it than the levels */
  double found[DRAWS][TERMS], covariance[DRAWS][TERMS][TERMS], weight[DRAWS];
};

struct work {
  struct data data;
  struct noise noise[DRAWS];
  size_t count;
  struct fit fits[FITS];
};

/* ---- the data ---- */

static bool is_complete(const struct limit_ladder *ladder, size_t s) {
  for (size_t l = 0; l < ladder->levels; l++)
    if (!isfinite(ladder->values[l][s]))
      return false;
  return true;
}

static void read_data(const struct limit_ladder *ladder, struct data *data) {
  *data = (struct data){.levels = ladder->levels};
  double least = HUGE_VAL, most = -HUGE_VAL;
  for (size_t s = 0; s < ladder->seeds; s++) {
    if (!is_complete(ladder, s))
      continue;
    double off[LIMIT_LEVELS];
    data->seeds++;
    const double n = (double)data->seeds;
    for (size_t l = 0; l < ladder->levels; l++) {
      off[l] = ladder->values[l][s] - data->mean[l];
      data->mean[l] += off[l] / n;
    }
    for (size_t l = 0; l < ladder->levels; l++)
      for (size_t k = 0; k < ladder->levels; k++)
        data->squares[l][k] += off[l] * off[k] * (n - 1) / n;
  }
  for (size_t l = 0; l < ladder->levels; l++) {
    data->step[l] = ladder->step[l];
    least = fmin(least, data->mean[l]);
    most = fmax(most, data->mean[l]);
  }
  data->range = most - least;
}

/* ---- the noise: a Markov chain for its deviations and its correlation, given the scatter about the means ---- */

struct chain {
  const struct data *data;
  double spread[LIMIT_LEVELS]; /* ln of the deviations */
  double centre, logit;        /* of the spreads; ln(rho/(1 - rho)) */
  uint64_t calls;
};

static double uniform(struct chain *chain) {
  return random_draw(0, RANDOM_INFERENCE, 33, chain->calls++) + 0x1p-54;
}

static double normal(struct chain *chain) {
  return gsl_cdf_ugaussian_Pinv(uniform(chain));
}

/* ln of the posterior. The inverse of a matrix with 1 on and rho off its diagonal is known. */
static double posterior(const struct chain *chain) {
  const size_t levels = chain->data->levels;
  const double freedom = (double)(chain->data->seeds - 1), rho = 1 / (1 + exp(-chain->logit));
  const double rest = 1 - rho, all = 1 + (double)(levels - 1) * rho;
  double diagonal = 0, total = 0, sum = 0, prior = 0, inverse[LIMIT_LEVELS];
  for (size_t l = 0; l < levels; l++) {
    inverse[l] = exp(-chain->spread[l]);
    sum += chain->spread[l];
    prior += pow((chain->spread[l] - chain->centre) / SPREAD_PRIOR, 2);
  }
  for (size_t l = 0; l < levels; l++)
    for (size_t k = 0; k < levels; k++) {
      const double product = chain->data->squares[l][k] * inverse[l] * inverse[k];
      total += product;
      diagonal += l == k ? product : 0;
    }
  const double trace = (diagonal - rho / all * total) / rest;
  const double ln_det = (double)(levels - 1) * log(rest) + log(all);
  return -freedom * (sum + ln_det / 2) - trace / 2 - prior / 2 + log(rho) + log(rest);
}

static void move(struct chain *chain, double *parameter, double width, double *now) {
  const double before = *parameter;
  *parameter += width * normal(chain);
  const double then = fabs(*parameter - before) < 50 && fabs(chain->logit) < 12 ? posterior(chain) : -HUGE_VAL;
  if (log(uniform(chain)) < then - *now)
    *now = then;
  else
    *parameter = before;
}

static void draw_noise(struct data *data, struct noise noise[DRAWS]) {
  struct chain chain = {.data = data};
  double mean = 0;
  for (size_t l = 0; l < data->levels; l++)
    mean += data->squares[l][l] / (double)data->levels;
  for (size_t l = 0; l < data->levels; l++)
    data->squares[l][l] = fmax(data->squares[l][l], SPREAD_LEAST * mean);
  if (mean == 0) { /* runs of equal seeds are equal: only the law's own error is left */
    for (size_t d = 0; d < DRAWS; d++)
      noise[d] = (struct noise){.rho = 0};
    return;
  }
  chain.centre = log(mean / (double)(data->seeds - 1)) / 2;
  for (size_t l = 0; l < data->levels; l++)
    chain.spread[l] = chain.centre;
  double now = posterior(&chain);
  for (size_t sweep = 0; sweep < BURN_IN + DRAWS * THIN; sweep++) {
    double centre = 0;
    for (size_t l = 0; l < data->levels; l++) {
      move(&chain, &chain.spread[l], 0.6, &now);
      centre += chain.spread[l] / (double)data->levels;
    }
    move(&chain, &chain.logit, 1.5, &now);
    chain.centre = centre + SPREAD_PRIOR / sqrt((double)data->levels) * normal(&chain);
    now = posterior(&chain);
    if (sweep < BURN_IN || (sweep - BURN_IN) % THIN != 0)
      continue;
    struct noise *draw = &noise[(sweep - BURN_IN) / THIN];
    draw->rho = 1 / (1 + exp(-chain.logit));
    for (size_t l = 0; l < data->levels; l++)
      draw->sigma[l] = exp(chain.spread[l]);
  }
}

/* ---- generalised least squares ---- */

/* Inverse of the covariance of the means of levels `from` and finer, for one draw. */
struct precision {
  double of[LIMIT_LEVELS][LIMIT_LEVELS], ln_det; /* ln of the determinant of the covariance */
};

/* Of the positive matrix m, in place, by exchanges of one row after another. Returns ln of its determinant. */
static double invert(size_t n, double m[LIMIT_LEVELS][LIMIT_LEVELS]) {
  double ln_det = 0;
  for (size_t k = 0; k < n; k++) {
    const double pivot = m[k][k];
    ln_det += log(pivot);
    m[k][k] = 1;
    for (size_t j = 0; j < n; j++)
      m[k][j] /= pivot;
    for (size_t i = 0; i < n; i++) {
      const double factor = m[i][k];
      if (i == k)
        continue;
      m[i][k] = 0;
      for (size_t j = 0; j < n; j++)
        m[i][j] -= factor * m[k][j];
    }
  }
  return ln_det;
}

static void find_precision(const struct data *data, const struct noise *noise, size_t from, struct precision *out) {
  const double n = (double)data->seeds, own = pow(LAW_ERROR * data->range, 2);
  for (size_t i = 0; i + from < data->levels; i++)
    for (size_t j = 0; j + from < data->levels; j++)
      out->of[i][j] = noise->sigma[i + from] * noise->sigma[j + from] * (i == j ? 1 : noise->rho) / n +
                      (i == j ? own : 0);
  out->ln_det = invert(data->levels - from, out->of);
}

static double product(size_t n, const double m[LIMIT_LEVELS][LIMIT_LEVELS], const double *x, const double *y) {
  double sum = 0;
  for (size_t i = 0; i < n; i++)
    for (size_t j = 0; j < n; j++)
      sum += x[i] * m[i][j] * y[j];
  return sum;
}

/* Solves one fit for one draw. Returns the squared distance of the levels from the law; *ln_weight: of the draw. */
static double solve(const struct work *work, const struct precision *precision, struct fit *fit, size_t d,
                    const double column[TERMS][LIMIT_LEVELS], const double *value, double *ln_weight) {
  const struct data *data = &work->data;
  const size_t n = data->levels - fit->dropped;
  double normal_matrix[LIMIT_LEVELS][LIMIT_LEVELS], right[TERMS], found[TERMS] = {0};
  for (size_t i = 0; i < fit->terms; i++) {
    for (size_t j = 0; j < fit->terms; j++)
      normal_matrix[i][j] = product(n, precision->of, column[i], column[j]);
    right[i] = product(n, precision->of, column[i], value);
  }
  const double ln_det = invert(fit->terms, normal_matrix);
  double square = product(n, precision->of, value, value);
  for (size_t i = 0; i < fit->terms; i++) {
    for (size_t j = 0; j < fit->terms; j++) {
      found[i] += normal_matrix[i][j] * right[j];
      fit->covariance[d][i][j] = normal_matrix[i][j];
    }
    square -= found[i] * right[i];
    fit->found[d][i] = found[i];
  }
  fit->found[d][0] += data->mean[data->levels - 1];
  square = fmax(square, 0);
  *ln_weight = -(precision->ln_det + ln_det + square) / 2;
  return square;
}

static void make_fit(const struct work *work, const struct precision *precision, struct fit *fit) {
  const struct data *data = &work->data;
  const size_t n = data->levels - fit->dropped, finest = data->levels - 1;
  double ln_weight[DRAWS], square[DRAWS], column[TERMS][LIMIT_LEVELS], value[LIMIT_LEVELS];
  double most = -HUGE_VAL, least = HUGE_VAL, sum = 0, likelihood = 0;
  for (size_t i = 0; i < n; i++) {
    value[i] = data->mean[i + fit->dropped] - data->mean[finest];
    for (size_t t = 0; t < fit->terms; t++)
      column[t][i] = pow(data->step[i + fit->dropped] / data->step[finest], fit->power[t]);
  }
  fit->tail = 0;
  for (size_t d = 0; d < DRAWS; d++) {
    square[d] = solve(work, &precision[d], fit, d, column, value, &ln_weight[d]);
    if (n > fit->terms)
      fit->tail += gsl_cdf_chisq_Q(square[d], (double)(n - fit->terms)) / DRAWS;
    most = fmax(most, ln_weight[d]);
    least = fmin(least, square[d]);
  }
  for (size_t d = 0; d < DRAWS; d++) {
    fit->weight[d] = exp(ln_weight[d] - most);
    sum += fit->weight[d];
    likelihood += exp((least - square[d]) / 2) / DRAWS;
  }
  for (size_t d = 0; d < DRAWS; d++)
    fit->weight[d] /= sum;
  fit->deviance = least - 2 * log(likelihood) + LIMIT_COST_OF_LEVEL * (double)fit->dropped +
                  (fit->terms == TERMS ? LIMIT_COST_OF_TERM : 0);
}

/* Makes the fits of ORDERS orders. Finds the range of those that are not rejected, with a neighbour on each side.
 * Returns how many there are without the neighbours. */
static size_t scan_orders(const struct work *work, const struct precision *precision, struct fit *fits, size_t dropped,
                          double rejected, double *low, double *high) {
  const double first = *low, width = (*high - *low) / (ORDERS - 1);
  double best = HUGE_VAL;
  for (size_t i = 0; i < ORDERS; i++) {
    fits[i].power[0] = 0;
    fits[i].power[1] = first + width * (double)i;
    fits[i].terms = 2;
    fits[i].dropped = dropped;
    make_fit(work, precision, &fits[i]);
    best = fmin(best, fits[i].deviance);
  }
  size_t from = ORDERS, to = 0;
  for (size_t i = 0; i < ORDERS; i++)
    if (fits[i].deviance <= best + rejected) {
      from = i < from ? i : from;
      to = i;
    }
  *low = fits[from > 0 ? from - 1 : 0].power[1];
  *high = fits[to + 1 < ORDERS ? to + 1 : to].power[1];
  return to - from + 1;
}

/* Adds the laws that leave out `dropped` levels: orders in a range that is narrowed where the levels tell the order,
 * and pairs of orders. */
static void add_fits(struct work *work, size_t dropped, double low, double high, double rejected) {
  static const double pairs[PAIRS][2] = {{0.5, 1}, {0.5, 1.5}, {1, 1.5}, {1, 2}};
  struct precision precision[DRAWS];
  for (size_t d = 0; d < DRAWS; d++)
    find_precision(&work->data, &work->noise[d], dropped, &precision[d]);
  const bool known = low == high;
  for (int scan = 0; scan < SCANS; scan++)
    if (scan_orders(work, precision, &work->fits[work->count], dropped, rejected, &low, &high) >= ORDERS / 3)
      break;
  work->count += ORDERS;
  for (size_t i = 0; dropped == 0 && !known && i < PAIRS; i++) {
    struct fit *fit = &work->fits[work->count++];
    *fit = (struct fit){.power = {0, pairs[i][0], pairs[i][1]}, .terms = TERMS};
    make_fit(work, precision, fit);
  }
}

/* ---- intervals ---- */

/* What an interval is of: the law at a step (0: the limit alone), with the limit or without it, plus noise. */
struct quantity {
  double limit, step;  /* limit: 1, or 0 for the distance from it */
  double noise;        /* added share of the finest level's variance */
  const size_t *level; /* the level with this step; NULL: none */
  size_t dropped;      /* laws describe no level before this one */
};

/* The distance of a level that the law leaves out: measured as far as the finest level, from there by the law. The law
 * at the coarse step is no value of this level. The scatter that both levels share cancels. */
static void measure(const struct work *work, const struct fit *fit, size_t level, double mean[DRAWS],
                    double deviation[DRAWS]) {
  const struct data *data = &work->data;
  const size_t finest = data->levels - 1;
  for (size_t d = 0; d < DRAWS; d++) {
    const struct noise *noise = &work->noise[d];
    const double coarse = noise->sigma[level], fine = noise->sigma[finest];
    double variance = 0;
    mean[d] = data->mean[level] - data->mean[finest];
    for (size_t i = 1; i < fit->terms; i++) {
      mean[d] += fit->found[d][i];
      for (size_t j = 1; j < fit->terms; j++)
        variance += fit->covariance[d][i][j];
    }
    /* The errors of both parts may be of one sign, as both rest on the finest level. */
    deviation[d] = sqrt(fmax(variance, 0)) +
                   sqrt(fmax(coarse * coarse + fine * fine - 2 * noise->rho * coarse * fine, 0) / (double)data->seeds);
  }
}

/* The values and deviations of a quantity under one fit, for all draws. */
static void evaluate(const struct work *work, const struct fit *fit, const struct quantity *q, double mean[DRAWS],
                     double deviation[DRAWS]) {
  const size_t finest = work->data.levels - 1;
  const double ratio = q->step / work->data.step[finest];
  double share[TERMS] = {q->limit};
  for (size_t t = 1; t < fit->terms && ratio > 0; t++)
    share[t] = pow(ratio, fit->power[t]);
  for (size_t d = 0; d < DRAWS; d++) {
    double variance = q->noise * pow(work->noise[d].sigma[finest], 2);
    mean[d] = 0;
    for (size_t i = 0; i < fit->terms; i++) {
      mean[d] += share[i] * fit->found[d][i];
      for (size_t j = 0; j < fit->terms; j++)
        variance += share[i] * share[j] * fit->covariance[d][i][j];
    }
    deviation[d] = sqrt(fmax(variance, 0));
  }
}

/* Extends an end of an interval to the quantile of a mixture of normal laws, which lies between those of the laws: the
 * lower end for a share below one half, else the upper one. */
static void extend(const double *mean, const double *deviation, const double *weight, double share, double *end) {
  const double z = gsl_cdf_ugaussian_Pinv(share);
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (size_t d = 0; d < DRAWS; d++) {
    low = fmin(low, mean[d] + z * deviation[d]);
    high = fmax(high, mean[d] + z * deviation[d]);
  }
  if (share < 0.5 ? low >= *end : high <= *end)
    return;
  for (int i = 0; i < HALVINGS; i++) {
    const double middle = (low + high) / 2;
    double below = 0;
    for (size_t d = 0; d < DRAWS; d++)
      below += weight[d] *
               (deviation[d] > 0 ? erfc((mean[d] - middle) / deviation[d] / M_SQRT2) / 2 : mean[d] <= middle);
    if (below < share)
      low = middle;
    else
      high = middle;
  }
  const double found = (low + high) / 2;
  *end = share < 0.5 ? fmin(*end, found) : fmax(*end, found);
}

/* terms: of the laws that count, at most. An empty range (low above high): none of them. */
static struct limit_range range_of(const struct work *work, size_t terms, const struct quantity *q, double rejected) {
  struct limit_range range = {0, HUGE_VAL, -HUGE_VAL};
  double sum = 0;
  for (size_t i = 0; i < work->count; i++) {
    const struct fit *fit = &work->fits[i];
    double mean[DRAWS], deviation[DRAWS];
    const double deviance = fit->deviance + (q->limit != 0 && !(q->step > 0) ? fit->cost : 0);
    if (deviance >= rejected || fit->terms > terms)
      continue;
    if (q->level && (*q->level < fit->dropped || *q->level < q->dropped))
      measure(work, fit, *q->level, mean, deviation);
    else
      evaluate(work, fit, q, mean, deviation);
    const double tail = gsl_cdf_ugaussian_Q(sqrt(rejected - deviance)), likelihood = exp(-deviance / 2);
    extend(mean, deviation, fit->weight, tail, &range.low);
    extend(mean, deviation, fit->weight, 1 - tail, &range.high);
    for (size_t d = 0; d < DRAWS; d++)
      range.value += likelihood * fit->weight[d] * mean[d];
    sum += likelihood;
  }
  range.value /= sum;
  return range;
}

static void cut(double least, double most, struct limit_range *range) {
  range->value = fmin(fmax(range->value, least), most);
  range->low = fmin(fmax(range->low, least), most);
  range->high = fmin(fmax(range->high, least), most);
}

/* A mean is no farther from the limit than the limit can be. Where the range of the result cuts the interval of the
 * limit, that interval bounds the distance, too: the distance rests on laws whose limit is impossible as well. */
static void cut_distance(const struct limit_ladder *ladder, const struct limit_range *limit, double mean,
                         struct limit_range *distance) {
  const bool at_end = limit->low <= ladder->least || limit->high >= ladder->most;
  cut(mean - (at_end ? limit->high : ladder->most), mean - (at_end ? limit->low : ladder->least), distance);
}

/* ---- the law ---- */

static double best_tail(const struct work *work, size_t dropped) {
  double best = 0;
  for (size_t i = 0; i < work->count; i++)
    if (work->fits[i].dropped == dropped && work->fits[i].terms < TERMS)
      best = fmax(best, work->fits[i].tail);
  return best;
}

/* -2 ln of the likelihood that the limit of a law is a value that the result can have: 0 if it is one. */
static double cost_of_range(const struct limit_ladder *ladder, const struct work *work, const struct fit *fit) {
  double mean[DRAWS], deviation[DRAWS], centre = 0, square = 0;
  evaluate(work, fit, &(struct quantity){.limit = 1}, mean, deviation);
  for (size_t d = 0; d < DRAWS; d++) {
    centre += fit->weight[d] * mean[d];
    square += fit->weight[d] * (mean[d] * mean[d] + deviation[d] * deviation[d]);
  }
  const double outside = fmax(fmax(ladder->least - centre, centre - ladder->most), 0);
  return outside > 0 ? outside * outside / fmax(square - centre * centre, 0) : 0;
}

/* Is the last change smaller than the one before, at least by as much as the slowest law asks? */
static bool falls(const struct data *data, double order) {
  const size_t f = data->levels - 1;
  const double coarse = pow(data->step[f - 2], order), fine = pow(data->step[f - 1], order);
  const double share = (fine - pow(data->step[f], order)) / (coarse - fine);
  return fabs(data->mean[f] - data->mean[f - 1]) <= share * fabs(data->mean[f - 1] - data->mean[f - 2]);
}

/* Makes all fits, and finds how many levels must be dropped. No limit is seen, too, where the laws that agree with the
 * levels have no possible one. */
static void find_law(const struct limit_ladder *ladder, struct work *work, double rejected, struct limit_law *law) {
  const double low = ladder->order_least > 0 ? ladder->order_least : LIMIT_ORDER_LEAST;
  const double high = ladder->order_most > 0 ? ladder->order_most : LIMIT_ORDER_MOST;
  const size_t most = low == high ? 0 : work->data.levels - LIMIT_FEWEST_LEVELS;
  draw_noise(&work->data, work->noise);
  work->count = 0;
  for (size_t dropped = 0; dropped <= most; dropped++)
    add_fits(work, dropped, low, high, rejected);
  double best = HUGE_VAL, possible = HUGE_VAL;
  for (size_t i = 0; i < work->count; i++) {
    struct fit *fit = &work->fits[i];
    fit->cost = cost_of_range(ladder, work, fit);
    best = fmin(best, fit->deviance);
    possible = fmin(possible, fit->deviance + fit->cost);
  }
  for (size_t i = 0; i < work->count; i++)
    work->fits[i].deviance -= possible;
  for (law->dropped = 0; law->dropped < most && best_tail(work, law->dropped) < REJECTED; law->dropped++)
    ;
  law->fit = best_tail(work, law->dropped);
  if (law->dropped > 0)
    law->fit_with = best_tail(work, law->dropped - 1);
  const bool fits = law->fit >= REJECTED || low == high;
  law->verdict = fits && possible - best < rejected ? LIMIT_SEEN
                 : !fits && falls(&work->data, low) ? LIMIT_FALLING
                                                    : LIMIT_NOT_SEEN;
}

static void find_change(const struct data *data, const struct noise *noise, double confidence, struct limit_law *law) {
  const size_t f = data->levels - 1;
  double mean[DRAWS], deviation[DRAWS], weight[DRAWS];
  for (size_t d = 0; d < DRAWS; d++) {
    const double s = noise[d].sigma[f], t = noise[d].sigma[f - 1];
    mean[d] = data->mean[f] - data->mean[f - 1];
    deviation[d] = sqrt((s * s + t * t - 2 * noise[d].rho * s * t) / (double)data->seeds);
    weight[d] = 1.0 / DRAWS;
  }
  law->change = (struct limit_range){mean[0], HUGE_VAL, -HUGE_VAL};
  extend(mean, deviation, weight, 0.5 - confidence / 2, &law->change.low);
  extend(mean, deviation, weight, 0.5 + confidence / 2, &law->change.high);
}

static void find_orders(const struct work *work, double rejected, struct limit_range *order) {
  double best = HUGE_VAL;
  *order = (struct limit_range){0, HUGE_VAL, -HUGE_VAL};
  for (size_t i = 0; i < work->count; i++) {
    const struct fit *fit = &work->fits[i];
    if (fit->terms == TERMS)
      continue;
    if (fit->deviance < best) {
      best = fit->deviance;
      order->value = fit->power[1];
    }
    if (fit->deviance <= rejected) {
      order->low = fmin(order->low, fit->power[1]);
      order->high = fmax(order->high, fit->power[1]);
    }
  }
}

static bool is_constant(const struct data *data) {
  double squares = 0;
  for (size_t l = 0; l < data->levels; l++)
    squares += data->squares[l][l];
  return squares == 0 && data->range == 0;
}

/* Intervals of the limit, and of the distances of the levels and the points. */
static void find_ranges(const struct limit_ladder *ladder, const struct work *work, double rejected,
                        struct limit_law *law, size_t count, struct limit_point *points) {
  const struct data *data = &work->data;
  find_orders(work, rejected, &law->order);
  law->limit = range_of(work, TERMS, &(struct quantity){.limit = 1}, rejected);
  law->one_power = range_of(work, TERMS - 1, &(struct quantity){.limit = 1}, rejected);
  cut(ladder->least, ladder->most, &law->limit);
  cut(ladder->least, ladder->most, &law->one_power);
  if (law->one_power.low > law->one_power.high)
    law->one_power = nothing;
  for (size_t l = 0; l < data->levels; l++) {
    const struct quantity distance = {.step = data->step[l], .level = &l, .dropped = law->dropped};
    law->distance[l] = range_of(work, TERMS, &distance, rejected);
    cut_distance(ladder, &law->limit, data->mean[l], &law->distance[l]);
  }
  for (size_t i = 0; i < count; i++) {
    const double step = points[i].step, own = 1 / (double)data->seeds;
    points[i].mean = range_of(work, TERMS, &(struct quantity){.limit = 1, .step = step}, rejected);
    points[i].sample = range_of(work, TERMS, &(struct quantity){.limit = 1, .step = step, .noise = own}, rejected);
    size_t coarser = 0; /* the level before the point: where a law leaves it out, its distance is that of the point */
    while (coarser + 1 < data->levels && data->step[coarser + 1] >= step)
      coarser++;
    const struct quantity distance = {.step = step,
                                      .level = data->step[coarser] >= step ? &coarser : NULL,
                                      .dropped = law->dropped};
    points[i].distance = range_of(work, TERMS, &distance, rejected);
    cut(ladder->least, ladder->most, &points[i].mean);
    cut(ladder->least, ladder->most, &points[i].sample);
    cut_distance(ladder, &law->limit, points[i].mean.value, &points[i].distance);
  }
}

static bool has_steps(const struct data *data) {
  bool has = data->levels >= LIMIT_FEWEST_LEVELS;
  for (size_t l = 0; l < data->levels; l++)
    has = has && data->step[l] > 0;
  return has;
}

bool limit_infer(const struct limit_ladder *ladder, double confidence, struct limit_law *law, size_t count,
                 struct limit_point *points) {
  const double rejected = pow(gsl_cdf_ugaussian_Pinv(0.5 + confidence / 2), 2);
  *law = (struct limit_law){LIMIT_TOO_FEW, 0, NOTHING, NOTHING, nothing, nothing, nothing, {nothing}, nothing};
  for (size_t l = 0; l < LIMIT_LEVELS; l++)
    law->distance[l] = nothing;
  for (size_t i = 0; i < count; i++)
    points[i].mean = points[i].sample = points[i].distance = nothing;
  struct work *work = malloc(sizeof *work);
  if (!work)
    return false;
  struct data *data = &work->data;
  read_data(ladder, data);
  if (data->seeds >= LIMIT_FEWEST_SEEDS && data->levels > 1 && is_constant(data))
    law->verdict = LIMIT_CONSTANT;
  else if (data->seeds >= LIMIT_FEWEST_SEEDS && has_steps(data)) {
    find_law(ladder, work, rejected, law);
    find_change(data, work->noise, confidence, law);
  }
  if (law->verdict == LIMIT_SEEN)
    find_ranges(ladder, work, rejected, law, count, points);
  free(work);
  return true;
}
