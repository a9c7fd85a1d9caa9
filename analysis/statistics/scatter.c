/* Moments, quantiles, modes and a histogram of a sample; the dip. */
#include "analysis/statistics/statistics.h"

#include <gsl/gsl_cdf.h>
#include <math.h>
#include <stdlib.h>

#include "engine/random.h"
#include "schemas/memory.h"

const double scatter_shares[SCATTER_QUANTILES] = {0.05, 0.25, 0.5, 0.75, 0.95};

/* The interval is from the low-th to the high-th value, counted from 1. The probability that at most low - 1 values are
 * below the quantile is at most 0.025, and likewise above. */
static struct scatter_quantile quantile(size_t n, const double *sorted, double share) {
  struct scatter_quantile q = {NAN, NAN, NAN};
  if (n == 0)
    return q;
  const double place = share * (double)(n - 1);
  const size_t below = (size_t)place;
  q.value = sorted[below];
  if (below + 1 < n)
    q.value += (place - (double)below) * (sorted[below + 1] - sorted[below]);
  size_t low = 0, high = n;
  if (n > 1000000)
    return q;
  while (low < n && gsl_cdf_binomial_P((unsigned)low, share, (unsigned)n) <= 0.025)
    low++;
  while (high > 0 && gsl_cdf_binomial_Q((unsigned)(high - 1), share, (unsigned)n) <= 0.025)
    high--;
  if (low > 0)
    q.low = sorted[low - 1];
  if (high < n)
    q.high = sorted[high];
  return q;
}

/* In a bell-shaped sample of whole numbers, the largest step contains a share of 0.4 / deviation of the values, which
 * adds half of that to the dip. Chance alone reaches 0.47 / sqrt(n). The bound leaves a factor of five between both. */
bool scatter_in_steps(size_t n, const double *sorted) {
  struct sample_moments moments = {0};
  for (size_t i = 0; i < n; i++) {
    if (floor(sorted[i]) < sorted[i])
      return false;
    sample_add(&moments, sorted[i]);
  }
  return n > 1 && moments.scale >= 1 && moments.squares / (double)(n - 1) < 4 * (double)n;
}

/* Splits the ascending values into two classes with the smallest sum of squares within them. */
void scatter_find_modes(struct scatter *s) {
  double sum = 0, whole = 0, best = -1;
  size_t lower = 0;
  for (size_t i = 0; i < s->n; i++)
    whole += s->sorted[i] - s->sorted[0]; /* relative to the smallest value: no cancellation */
  for (size_t i = 1; i < s->n; i++) {
    sum += s->sorted[i - 1] - s->sorted[0];
    const double a = sum / (double)i, b = (whole - sum) / (double)(s->n - i);
    const double between = (double)i * (double)(s->n - i) * (b - a) * (b - a);
    if (between <= best)
      continue;
    best = between;
    lower = i;
    s->lower_mode = s->sorted[0] + a;
    s->upper_mode = s->sorted[0] + b;
  }
  s->between = (s->sorted[lower - 1] + s->sorted[lower]) / 2;
  const double n = (double)s->n, p = (n - (double)lower) / n, z = gsl_cdf_ugaussian_Pinv(0.975);
  const double centre = (p + z * z / (2 * n)) / (1 + z * z / n);
  const double half = z / (1 + z * z / n) * sqrt(p * (1 - p) / n + z * z / (4 * n * n));
  s->upper_share = p;
  s->upper_low = centre - half;
  s->upper_high = centre + half;
}

status scatter_make(size_t n, const double *values, struct scatter *out, struct error *error) {
  *out = (struct scatter){.skewness = NAN,
                          .lower_mode = NAN,
                          .upper_mode = NAN,
                          .between = NAN,
                          .upper_share = NAN,
                          .upper_low = NAN,
                          .upper_high = NAN};
  TRY(memory_array(&out->sorted, n, sizeof *out->sorted, "the values of runs", error));
  double largest = 0, two = 0, three = 0; /* moments */
  for (size_t i = 0; i < n; i++)
    if (isfinite(values[i])) {
      out->sorted[out->n++] = values[i];
      largest = fmax(largest, fabs(values[i]));
    }
  out->mean = sample_summarise(out->n, out->sorted, 0.95);
  const double scale = sample_scale(largest); /* 1, but for values near the ends of double */
  for (size_t i = 0; i < out->n; i++) {
    out->sorted[i] *= scale;
    const double d = out->sorted[i] - out->mean.mean * scale;
    two += d * d / (double)out->n;
    three += d * d * d / (double)out->n;
  }
  if (out->n >= SCATTER_SHAPE_RUNS && isfinite(out->mean.half_width)) /* else all values are equal */
    out->skewness = three / pow(two, 1.5);
  qsort(out->sorted, out->n, sizeof *out->sorted, sample_ascending);
  for (int q = 0; q < SCATTER_QUANTILES; q++)
    out->quantile[q] = quantile(out->n, out->sorted, scatter_shares[q]);
  out->dip = scatter_dip(out->n, out->sorted);
  const bool known = out->n >= SCATTER_SHAPE_RUNS && !scatter_in_steps(out->n, out->sorted);
  out->dip_share = known ? scatter_dip_share(out->n, out->dip) : (double)NAN;
  if (out->dip_share < 0.05)
    scatter_find_modes(out);
  for (size_t i = 0; i < out->n; i++)
    out->sorted[i] /= scale;
  for (int q = 0; q < SCATTER_QUANTILES; q++)
    out->quantile[q] = (struct scatter_quantile){out->quantile[q].value / scale, out->quantile[q].low / scale,
                                                 out->quantile[q].high / scale};
  out->lower_mode /= scale;
  out->upper_mode /= scale;
  out->between /= scale;
  return STATUS_OK;
}

void scatter_release(struct scatter *scatter) {
  free(scatter->sorted);
  *scatter = (struct scatter){0};
}

/* ---- How many runs an interval needs ---- */

/* Is the interval of the mean of n runs with this standard deviation narrow enough? */
struct wanted {
  double mean, deviation, half_width;
  bool (*is_narrow)(const struct wanted *wanted, size_t n);
};

static bool student_is_narrow(const struct wanted *wanted, size_t n) {
  return !(sample_student(n, 0.95) * wanted->deviation / wanted->half_width > sqrt((double)n));
}

static bool share_is_narrow(const struct wanted *wanted, size_t n) {
  struct sample_summary of = {.n = n, .mean = wanted->mean, .standard_deviation = wanted->deviation};
  of.half_width = wanted->deviation > 0 ? sample_student(n, 0.95) * wanted->deviation / sqrt((double)n) : (double)NAN;
  sample_of_share(&of, 0.95);
  const double widest = isnan(of.half_width) ? fmax(of.high - of.mean, of.mean - of.low) : of.half_width;
  return widest <= wanted->half_width;
}

static bool rule_is_narrow(const struct wanted *wanted, size_t n) {
  return sample_may_stop_with(n, wanted->deviation, wanted->half_width, 0.95);
}

static bool rule_of_share_is_narrow(const struct wanted *wanted, size_t n) {
  return rule_is_narrow(wanted, n) &&
         !(sample_share_half_width(n, wanted->mean, wanted->deviation, 0.95) > wanted->half_width);
}

/* The smallest of `least`, `least` + `step`, ... that is enough. More runs are never less enough. 0: not known. */
static size_t fewest(const struct wanted *wanted, size_t least, size_t step) {
  const double ratio = wanted->deviation / wanted->half_width;
  if (!(wanted->deviation >= 0) || !(wanted->half_width > 0) || isinf(wanted->deviation) || !(ratio * ratio < 1e8))
    return 0;
  if (wanted->is_narrow(wanted, least))
    return least;
  size_t low = 0, high = 1; /* steps: `low` are too few, `high` are enough */
  while (!wanted->is_narrow(wanted, least + high * step)) {
    if (high > (size_t)1e9)
      return 0;
    low = high;
    high *= 2;
  }
  while (high - low > 1) {
    const size_t middle = low + (high - low) / 2;
    if (wanted->is_narrow(wanted, least + middle * step))
      high = middle;
    else
      low = middle;
  }
  return least + high * step;
}

size_t scatter_runs_needed(double deviation, double half_width) {
  return fewest(&(struct wanted){0, deviation, half_width, student_is_narrow}, 2, 1);
}

size_t scatter_runs_of_share(double mean, double deviation, double half_width) {
  return isnan(mean) ? 0 : fewest(&(struct wanted){mean, deviation, half_width, share_is_narrow}, 2, 1);
}

size_t scatter_runs_of_rule(double mean, double deviation, double half_width, bool share) {
  const struct wanted wanted = {mean, deviation, half_width, share ? rule_of_share_is_narrow : rule_is_narrow};
  return fewest(&wanted, SAMPLE_FIRST, SAMPLE_BATCH);
}

static double range_of(const struct scatter *s) {
  return s->sorted[s->n - 1] - s->sorted[0];
}

static double width_of(const struct scatter *s) {
  const double least = s->sorted[0], range = range_of(s);
  double width = 2 * (s->quantile[3].value - s->quantile[1].value) / cbrt((double)s->n);
  if (!(width > range / (SCATTER_BINS - 2)))
    width = range / (SCATTER_BINS - 2);
  if (!(width > 0)) /* all values are equal */
    width = fabs(least) > 0 ? fabs(least) / 10 : 1;
  const double power = pow(10, floor(log10(width))), rest = width / power;
  return power * (rest <= 1 ? 1 : rest <= 2 ? 2 : rest <= 5 ? 5 : 10);
}

double scatter_width_of_all(size_t count, const struct scatter *s) {
  OWNED double *own = memory_small(count, sizeof *own);
  size_t differ = 0;
  double least = 0, equal = 0;
  for (size_t i = 0; i < count; i++) {
    if (s[i].n > 0 && range_of(&s[i]) > 0)
      own[differ++] = width_of(&s[i]);
    else if (s[i].n > 0)
      equal = fmax(equal, width_of(&s[i]));
    least = fmax(least, s[i].n > 0 ? range_of(&s[i]) / (SCATTER_BINS - 2) : 0);
  }
  qsort(own, differ, sizeof *own, sample_ascending);
  size_t i = differ / 2;
  while (i < differ && own[i] < least)
    i++;
  return i < differ ? own[i] : equal;
}

struct scatter_histogram scatter_histogram_of(const struct scatter *s, double width) {
  struct scatter_histogram h = {0};
  if (s->n == 0)
    return h;
  h.width = width > 0 ? width : width_of(s);
  h.from = floor(s->sorted[0] / h.width) * h.width;
  for (size_t i = 0; i < s->n; i++) {
    double bin = floor((s->sorted[i] - h.from) / h.width);
    bin = fmin(fmax(bin, 0), SCATTER_BINS - 1);
    h.count[(size_t)bin]++;
    if ((size_t)bin + 1 > h.bins)
      h.bins = (size_t)bin + 1;
  }
  return h;
}

/* ---- The dip of a sample, and its distribution by chance. ---- */

/* The distribution function of n values, times n, jumps at value j from j to j + 1. Its greatest convex minorant runs
 * through points (value j, j), its least concave majorant through points (value j, j + 1). */
struct hull {
  const double *x;
  size_t *knot;  /* work space of n */
  double *low;   /* for each value: the convex minorant on the current interval */
  double *high;  /* the concave majorant */
  size_t *below; /* for each value: the minorant's knot at it or to its left */
  size_t *above; /* the majorant's knot at it or to its right */
};

/* Finds the knots of the minorant (sign 1) or the majorant (sign -1) between the values `from` and `to`; returns their
 * number. Of equal values the first is a knot of the minorant, the last of the majorant. Both ends are always knots. */
static size_t find_knots(struct hull *h, size_t from, size_t to, int sign) {
  const double *x = h->x;
  size_t count = 0;
  for (size_t j = from; j <= to; j++) {
    while (count > 1) {
      const size_t a = h->knot[count - 2], b = h->knot[count - 1];
      const double turn = (x[b] - x[a]) * (double)(j - b) - (double)(b - a) * (x[j] - x[b]);
      if (sign * turn > 0)
        break;
      count--;
    }
    h->knot[count++] = j;
  }
  return count;
}

/* Computes the minorant or the majorant, and the knot next to each value. A step between equal values at an end costs
 * nothing, because the mode may contain it. */
static void fill(struct hull *h, size_t from, size_t to, int sign) {
  const size_t knots = find_knots(h, from, to, sign);
  const double *x = h->x, up = sign < 0;
  double *line = sign > 0 ? h->low : h->high;
  for (size_t k = 0; k + 1 < knots; k++) {
    const size_t a = h->knot[k], b = h->knot[k + 1];
    const bool step = !(x[b] > x[a]);
    for (size_t j = a; j <= b; j++) {
      line[j] = up + (step ? (double)j : (double)a + (double)(b - a) * (x[j] - x[a]) / (x[b] - x[a]));
      if (sign > 0)
        h->below[j] = j == b ? b : a;
      else if (j > a || k == 0)
        h->above[j] = j == a ? a : b;
    }
  }
}

/* Returns 2 n times the dip: narrows the interval of the mode until the distance between both hulls is smaller than the
 * cost of the parts outside. */
static double search(struct hull *h, size_t n) {
  size_t low = 0, high = n - 1;
  double dip = 1;
  while (low < high) {
    fill(h, low, high, 1);
    fill(h, low, high, -1);
    double most = 0;
    size_t at = low;
    for (size_t j = low; j <= high; j++)
      if (h->high[j] - h->low[j] > most) {
        most = h->high[j] - h->low[j];
        at = j;
      }
    if (most < dip)
      break;
    const size_t left = h->below[at], right = h->above[at];
    for (size_t j = low; j <= left; j++)
      dip = fmax(dip, (double)j + 1 - h->low[j]);
    for (size_t j = right; j <= high; j++)
      dip = fmax(dip, h->high[j] - (double)j);
    if (left == low && right == high)
      break;
    low = left;
    high = right;
  }
  return dip;
}

double scatter_dip(size_t n, const double *values) {
  if (n == 0)
    return NAN;
  OWNED size_t *knots = calloc(3 * n, sizeof *knots);
  OWNED double *lines = malloc(2 * n * sizeof *lines);
  if (!knots || !lines)
    return NAN;
  struct hull h = {values, knots, lines, lines + n, knots + n, knots + 2 * n};
  return search(&h, n) / (2 * (double)n);
}

/* Sums of exponential steps are an ordered uniform sample up to a scale factor. */
static double drawn_dip(size_t size, uint64_t draw, double *sample) {
  double sum = 0;
  for (size_t i = 0; i < size; i++)
    sample[i] = sum -= log1p(-random_draw(size, RANDOM_RESAMPLE, draw, i));
  return scatter_dip(size, sample);
}

static size_t drawn_size(size_t n) {
  return n < SCATTER_DIP_MOST ? n : SCATTER_DIP_MOST;
}

double scatter_dip_share(size_t n, double dip) {
  enum { ENOUGH = 200 }; /* this many samples with a larger dip are enough: the share is then known to a tenth */
  if (n < 4 || !isfinite(dip))
    return NAN;
  const size_t size = drawn_size(n);
  const double limit = dip * sqrt((double)n / (double)size);
  OWNED double *sample = memory_small(size, sizeof *sample);
  size_t larger = 0, drawn = 0;
  for (; drawn < SCATTER_DIP_DRAWS && larger < ENOUGH; drawn++)
    larger += drawn_dip(size, drawn, sample) >= limit;
  return ((double)larger + 1) / ((double)drawn + 1);
}

double scatter_dip_limit(size_t n) {
  /* scatter_dip_share() is below 0.05 while fewer than this many of the drawn dips are larger. */
  const size_t fewer = (size_t)(0.05 * (SCATTER_DIP_DRAWS + 1));
  if (n < 4)
    return NAN;
  const size_t size = drawn_size(n);
  OWNED double *sample = memory_small(size, sizeof *sample);
  OWNED double *dip = memory_small(SCATTER_DIP_DRAWS, sizeof *dip);
  for (size_t d = 0; d < SCATTER_DIP_DRAWS; d++)
    dip[d] = drawn_dip(size, d, sample);
  qsort(dip, SCATTER_DIP_DRAWS, sizeof *dip, sample_descending);
  return dip[fewer - 1] * sqrt((double)size / (double)n);
}
