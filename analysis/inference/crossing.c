/* The crossing of a level by isotonic regression with the level as a constraint. */
#include "analysis/inference/crossing.h"

#include <gsl/gsl_cdf.h>
#include <math.h>
#include <stdlib.h>

#include "analysis/statistics/statistics.h"
#include "schemas/memory.h"

/* The limit of the likelihood ratio is that of Student's t squared, times this factor: rounds that end when the
 * interval is narrow favour intervals that are narrow by chance. Found by simulations (tests/verification/find.md). */
static const double WIDENING = 1.4;
static const double GAP = 0.3;    /* a wider gap around the level, as a share of the range: there may be two modes */
static const double BEYOND = 0.1; /* width that stands for what is beyond an end of the bracket */
/* The variance at a place is pooled over its nearest runs, so many degrees of freedom: */
static const double FREEDOM = 12, FREEDOM_SHARE = 0.25;  /* or this share of all runs */
static const double PLATEAU = 0.2, PLATEAU_RANGE = 0.03; /* a plateau is wider, and within this share of the range */
enum { PLATEAU_RUNS = 60 };
static const double CHECKED = 0.25;  /* an interval that is narrower is checked by the places outside */
static const double OTHER_SIDE = 2;  /* standard errors of a place on the other side, which is looked at again */
enum { ALONE = CROSSING_RUNS };      /* runs of a place whose own scatter alone counts before there is a crossing */
static const double SEVERAL = 0.998; /* confidence of each part of a response that crosses several times */

const char *const crossing_kind_names[] = {"crossing", "above", "below", "several", "plateau", "open", NULL};

struct place { /* the runs at one x */
  double x, n;
  double mean;     /* of the results relative to the level; of a share: share of runs above the level - `share` */
  double squares;  /* sum of squares about the mean */
  double fit;      /* of the best monotone curve */
  bool first;      /* of a block of the curve */
  double variance; /* of one run */
  double pure;     /* the same from the scatter within places alone */
  double weight;   /* n / variance, with the largest variance of the neighbourhood */
};

struct response {
  struct place *place;
  size_t count;
  double n, share; /* share: NaN for means */
  double freedom;  /* least degrees of freedom of a variance */
  struct block {
    double weight, mean;
    size_t length;
  } * block; /* space for the fit */
};

static bool is_share(const struct response *response) {
  return !isnan(response->share);
}

/* ---- the monotone curve ---- */

/* Fits places from..to-1 by a rising (sign 1) or falling (-1) curve: neighbours that are out of order are pooled.
 * Returns the number of blocks. */
static size_t fit_monotone(const struct response *response, size_t from, size_t to, double sign, bool weighted) {
  struct block *block = response->block;
  size_t count = 0;
  for (size_t i = from; i < to; i++) {
    const struct place *place = &response->place[i];
    struct block last = {weighted ? place->weight : place->n, sign * place->mean, 1};
    while (count && block[count - 1].mean >= last.mean) {
      const struct block *before = &block[--count];
      const double weight = before->weight + last.weight;
      last.mean = (before->mean * before->weight + last.mean * last.weight) / weight;
      last.weight = weight;
      last.length += before->length;
    }
    block[count++] = last;
  }
  return count;
}

/* Minus twice the logarithm of the likelihood of a place's runs, when the curve has this value there. */
static double misfit_of(const struct response *response, const struct place *place, double value) {
  if (!is_share(response))
    return place->weight * (place->mean - value) * (place->mean - value);
  const double p = fmin(fmax(response->share + value, 0), 1);
  const double above = round(place->n * (place->mean + response->share)), below = place->n - above;
  return (above > 0 ? -2 * above * log(p) : 0) + (below > 0 ? -2 * below * log(1 - p) : 0);
}

/* Of the best monotone curve of places from..to-1, which stays on one side of the level: side -1 for sign * value <= 0,
 * 1 for >= 0, 0 for either. */
static double misfit(const struct response *response, size_t from, size_t to, double sign, int side) {
  const size_t blocks = fit_monotone(response, from, to, sign, !is_share(response));
  double sum = 0;
  for (size_t b = 0, i = from; b < blocks; b++) {
    const double mean = response->block[b].mean;
    const double value = sign * (side < 0 ? fmin(mean, 0) : side > 0 ? fmax(mean, 0) : mean);
    for (size_t end = i + response->block[b].length; i < end; i++)
      sum += misfit_of(response, &response->place[i], value);
  }
  return sum;
}

/* ---- the runs ---- */

/* Gathers runs of equal x. pairs: sorted (x, result relative to the level). */
static void gather(struct response *response, size_t n, double (*pairs)[2]) {
  for (size_t i = 0; i < n; i++) {
    struct place *place = response->count ? &response->place[response->count - 1] : NULL;
    const double value = is_share(response) ? (pairs[i][1] > 0) - response->share : pairs[i][1];
    if (!place || place->x != pairs[i][0]) {
      place = &response->place[response->count++];
      *place = (struct place){.x = pairs[i][0]};
    }
    const double deviation = value - place->mean;
    place->n++;
    place->mean += deviation / place->n;
    place->squares += deviation * (value - place->mean);
  }
}

/* Variance of a run at place i: squares about the monotone curve (or, `pure`, about the places' means) of the nearest
 * runs. */
static double variance_at(struct response *response, size_t i, bool pure) {
  const struct place *place = response->place;
  const double need = fmax(FREEDOM, FREEDOM_SHARE * response->n);
  double freedom = 0, squares = 0;
  for (size_t next = i, low = i, high = i;;) {
    const struct place *at = &place[next];
    const double deviation = at->mean - at->fit;
    freedom += at->n - (pure || at->first);
    squares += at->squares + (pure ? 0 : at->n * deviation * deviation);
    if (freedom >= need || (low == 0 && high + 1 == response->count))
      break;
    const double left = low > 0 ? place[i].x - place[low - 1].x : HUGE_VAL;
    const double right = high + 1 < response->count ? place[high + 1].x - place[i].x : HUGE_VAL;
    next = left <= right ? --low : ++high;
  }
  if (!pure)
    response->freedom = fmin(response->freedom, freedom);
  return squares / fmax(freedom, 1);
}

static void weigh(struct response *response) {
  struct place *place = response->place;
  const size_t count = response->count;
  double most = 0;
  for (size_t i = 0; i < count; i++)
    place[i].weight = place[i].n;
  const double sign = misfit(response, 0, count, 1, 0) <= misfit(response, 0, count, -1, 0) ? 1 : -1;
  const size_t blocks = fit_monotone(response, 0, count, sign, false);
  for (size_t b = 0, i = 0; b < blocks; b++) {
    place[i].first = true;
    for (size_t end = i + response->block[b].length; i < end; i++)
      place[i].fit = sign * response->block[b].mean;
  }
  for (size_t i = 0; i < count; i++)
    most = fmax(most, fabs(place[i].mean));
  const double rounding = 1e-18 * most * most + 1e-300; /* without noise the order of the means decides */
  response->freedom = HUGE_VAL;
  for (size_t i = 0; i < count; i++) {
    place[i].variance = variance_at(response, i, false) + rounding;
    place[i].pure = variance_at(response, i, true) + rounding;
  }
  for (size_t i = 0; i < count; i++) {
    double variance = 0;
    for (size_t j = i > 2 ? i - 2 : 0; j <= i + 2 && j < count; j++)
      variance = fmax(variance, place[j].variance);
    place[i].weight = place[i].n / variance;
  }
}

/* ---- the other answers ---- */

/* Sum of a stretch of runs relative to the level, in standard errors; its sign is that of the response there. */
struct stretch {
  double weight, sum;
};

static double add_place(const struct response *response, size_t i, struct stretch *stretch) {
  const struct place *place = &response->place[i];
  const double variance = is_share(response) ? response->share * (1 - response->share) : place->pure;
  stretch->weight += place->n / variance;
  stretch->sum += place->n / variance * place->mean;
  return stretch->sum / sqrt(stretch->weight);
}

/* Walks from the left and notes where a stretch that is surely on one side of the level follows one that is surely on
 * the other side. Towards a crossing the response nears the level: a stretch on one side says that the crossing behind
 * it comes after its first place, and the one before it before its last place. */
static void find_parts(const struct response *response, struct crossing *out) {
  const double tail = (1 + SEVERAL) / 2;
  const double limit = is_share(response) ? gsl_cdf_ugaussian_Pinv(tail)
                                          : gsl_cdf_tdist_Pinv(tail, fmax(response->freedom, 1));
  double sign = 0;
  size_t start = 0, sure = 0; /* first place of this side; the last one that is surely on it */
  for (size_t last = 0; last < response->count; last++) {
    struct stretch stretch = {0};
    for (size_t first = last + 1; first-- > start;) {
      const double z = add_place(response, first, &stretch);
      if (fabs(z) <= limit)
        continue;
      if (z * sign > 0) {
        sure = first > sure ? first : sure;
      } else if (sign == 0 || first > sure) {
        if (sign != 0 && out->parts < CROSSING_PARTS)
          out->part[out->parts++] = (struct crossing_part){response->place[sure].x, response->place[last].x};
        sign = z > 0 ? 1 : -1;
        start = sure = first;
      }
    }
  }
}

/* Are the means of all thirds of the interval's runs at the level? */
static bool is_plateau(const struct response *response, const struct crossing *out) {
  const double low = fmax(out->low, 0), high = fmin(out->high, 1);
  double inside = 0, least = HUGE_VAL, most = -HUGE_VAL;
  for (size_t i = 0; i < response->count; i++) {
    const struct place *place = &response->place[i];
    inside += place->x >= low && place->x <= high ? place->n : 0;
    least = fmin(least, place->fit);
    most = fmax(most, place->fit);
  }
  if (!(high - low > PLATEAU) || inside < PLATEAU_RUNS)
    return false;
  const double rounding = 1e-140; /* of a response that is the level everywhere: weigh() gives it a variance */
  double n = 0, sum = 0, variance = 0, seen = 0;
  size_t thirds = 0;
  for (size_t i = 0; i < response->count; i++) {
    const struct place *place = &response->place[i];
    if (place->x < low || place->x > high)
      continue;
    n += place->n;
    seen += place->n;
    sum += place->n * place->mean;
    variance += place->n * (is_share(response) ? response->share * (1 - response->share) : place->variance);
    if (seen < (double)(thirds + 1) * inside / 3 - 0.5) /* a third may end in the middle of a place with many runs */
      continue;
    if (fabs(sum / n) + 2 * sqrt(variance) / n >
        fmax(PLATEAU_RANGE * (is_share(response) ? 1 : most - least), rounding))
      return false;
    n = sum = variance = 0;
    thirds++;
  }
  return thirds >= 3;
}

/* ---- the crossing ---- */

/* Left end of gap i: the bracket's, or that of a place. */
static double edge(const struct response *response, size_t i) {
  return i == 0 ? -BEYOND : i <= response->count ? response->place[i - 1].x : 1 + BEYOND;
}

/* The place below which this share of the likelihood lies. `weight`: of the gaps, with their sum. */
static double quantile(const struct response *response, const double *weight, double sum, double share) {
  double below = 0, part = share * sum;
  size_t gap = 0;
  while (gap < response->count && below + weight[gap] < part)
    below += weight[gap++];
  const double low = edge(response, gap), high = edge(response, gap + 1);
  return low + (high - low) * fmin((part - below) / weight[gap], 1);
}

static void find_interval(const struct response *response, double *weight, struct crossing *out) {
  const size_t count = response->count;
  const double rising = misfit(response, 0, count, 1, 0), falling = misfit(response, 0, count, -1, 0);
  const double best = fmin(rising, falling), sign = rising <= falling ? 1 : -1;
  const double t = is_share(response) ? gsl_cdf_ugaussian_Pinv(0.975)
                                      : gsl_cdf_tdist_Pinv(0.975, fmax(response->freedom, 1));
  double sum = 0, least = HUGE_VAL;
  out->rising = sign > 0;
  for (size_t gap = 0; gap <= count; gap++) {
    weight[gap] = misfit(response, 0, gap, sign, -1) + misfit(response, gap, count, sign, 1) - best;
    least = fmin(least, weight[gap]);
  }
  const double limit = fmax(WIDENING * t * t, least);
  out->low = HUGE_VAL;
  for (size_t gap = 0; gap <= count; gap++) {
    if (weight[gap] <= limit) {
      out->low = fmin(out->low, edge(response, gap));
      out->high = edge(response, gap + 1);
    }
    weight[gap] = exp((least - weight[gap]) / 2) * (edge(response, gap + 1) - edge(response, gap));
    sum += weight[gap];
  }
  out->at = quantile(response, weight, sum, 0.5);
  for (int i = 0; i < CROSSING_PLACES; i++)
    out->next[i] = fmin(fmax(quantile(response, weight, sum, (2 * i + 1) / (2.0 * CROSSING_PLACES)), 0), 1);
}

static bool is_above(const struct response *response) {
  struct stretch all = {0};
  for (size_t i = 0; i < response->count; i++)
    add_place(response, i, &all);
  return all.sum > 0;
}

/* The mean of the places from `first` to `last` in standard errors, by the scatter of their runs alone: the variance
 * that neighbours share is far too large where nothing breaks and all runs are equal. But equal is not sure: n runs
 * miss what a share of about 1/n of all runs does, so `unseen` runs more count, with the variance that neighbours
 * share. */
static double alone(const struct response *response, size_t first, size_t last, double unseen) {
  double n = 0, mean = 0, squares = 0, shared = 0;
  for (size_t i = first; i <= last; i++) {
    const struct place *place = &response->place[i];
    const double deviation = place->mean - mean, before = n;
    n += place->n;
    mean += deviation * place->n / n;
    squares += place->squares + deviation * deviation * before * place->n / n;
    shared = fmax(shared, place->pure);
  }
  if (is_share(response))
    return mean * sqrt(n / (response->share * (1 - response->share)));
  const double freedom = fmax(n - 1 + unseen, 1), tail = gsl_cdf_ugaussian_P(OTHER_SIDE);
  return mean * sqrt(n * freedom / (squares + fmax(unseen, 1e-9) * shared)) * OTHER_SIDE /
         gsl_cdf_tdist_Pinv(tail, freedom);
}

/* An end of the bracket whose runs lie on the wrong side of the crossing: those at the end, with as many places behind
 * it as show it best, up to the interval. Returns the standard errors. */
static double find_other_end(const struct response *response, const struct crossing *out, size_t *place) {
  const size_t count = response->count;
  double most = 0;
  for (int end = 0; end <= 1; end++) {
    const size_t from = end ? count - 1 : 0;
    const double side = (end ? 1 : -1) * (out->rising ? 1 : -1);
    for (size_t k = 0; k < count && side * response->place[from].mean < 0; k++) {
      const size_t to = end ? from - k : k;
      if (end ? response->place[to].x < out->high : response->place[to].x > out->low)
        break;
      const double z = -side * alone(response, end ? to : from, end ? from : to, 1);
      if (z > most) {
        most = z;
        *place = from;
      }
    }
  }
  return most;
}

/* The place that is farthest from where the answer has it, in standard errors: on the wrong side of a crossing, or of
 * the level when nothing crosses. False: there is none. */
static bool find_other_side(const struct response *response, const struct crossing *out, size_t *place) {
  const bool none = out->kind == CROSSING_ABOVE || out->kind == CROSSING_BELOW, found = out->kind == CROSSING_FOUND;
  double most = none ? 0 : find_other_end(response, out, place);
  for (size_t i = 0; i < response->count && (!found || out->high - out->low < CHECKED); i++) {
    const double x = response->place[i].x, after = x >= out->high ? 1 : x <= out->low ? -1 : 0;
    const double side = out->kind == CROSSING_ABOVE   ? 1
                        : out->kind == CROSSING_BELOW ? -1
                                                      : after * (out->rising ? 1 : -1);
    struct stretch pooled = {0};
    double z = -side * add_place(response, i, &pooled);
    if (!found && response->place[i].n >= ALONE)
      z = fmax(z, -side * alone(response, i, i, 0));
    if (z > most) {
      most = z;
      *place = i;
    }
  }
  return most > (is_share(response) && none ? 0 : OTHER_SIDE);
}

/* The answer waits while a place contradicts it, as a second crossing would: the next runs are there. */
static void doubt(const struct response *response, struct crossing *out) {
  const struct place *place = response->place;
  size_t i = 0;
  if (!find_other_side(response, out, &i))
    return;
  out->contradicted = true;
  out->contradiction = place[i].x;
  for (int k = 0; k < CROSSING_PLACES; k++)
    out->next[k] = place[i].x;
  out->next[0] = i > 0 ? (place[i - 1].x + place[i].x) / 2 : place[i].x;
  out->next[CROSSING_PLACES - 1] = i + 1 < response->count ? (place[i].x + place[i + 1].x) / 2 : place[i].x;
  if (out->kind != CROSSING_ABOVE && out->kind != CROSSING_BELOW)
    return;
  out->kind = CROSSING_OPEN;
  out->low = -BEYOND;
  out->high = 1 + BEYOND;
}

static void tell_kind(const struct response *response, struct crossing *out) {
  const double least = response->place[0].x, most = response->place[response->count - 1].x;
  find_parts(response, out);
  if (out->parts >= 2)
    out->kind = CROSSING_SEVERAL;
  else if (out->high <= least || out->low >= most)
    out->kind = is_above(response) ? CROSSING_ABOVE : CROSSING_BELOW;
  else if (is_plateau(response, out))
    out->kind = CROSSING_PLATEAU;
  else
    out->kind = out->low < 0 || out->high > 1 ? CROSSING_OPEN : CROSSING_FOUND;
  if (out->kind != CROSSING_SEVERAL && out->kind != CROSSING_PLATEAU)
    doubt(response, out);
}

/* The share of the upper of two modes at which the mean is at the level. NaN: results lie near the level. */
static double share_of_modes(size_t n, double (*pairs)[2]) {
  double least = HUGE_VAL, most = -HUGE_VAL, under = -HUGE_VAL, over = HUGE_VAL, below = 0, above = 0, sum[2] = {0};
  for (size_t i = 0; i < n; i++) {
    const double y = pairs[i][1];
    least = fmin(least, y);
    most = fmax(most, y);
    if (y > 0) {
      over = fmin(over, y);
      sum[1] += y;
      above++;
    } else {
      under = fmax(under, y);
      sum[0] += y;
      below++;
    }
  }
  if (below == 0 || above == 0 || !(over - under > GAP * (most - least)) || !(sum[0] < 0))
    return NAN;
  return -sum[0] / below / (sum[1] / above - sum[0] / below);
}

status crossing_find(const struct crossing_data *data, struct crossing *out, struct error *error) {
  OWNED double(*pairs)[2] = NULL;
  OWNED double *weight = NULL;
  OWNED struct place *place = NULL;
  OWNED struct block *block = NULL;
  *out = (struct crossing){.kind = CROSSING_OPEN, .at = NAN, .low = -BEYOND, .high = 1 + BEYOND, .share = data->share};
  TRY(memory_array(&pairs, data->n, sizeof *pairs, "a crossing", error));
  TRY(memory_array(&weight, data->n + 1, sizeof *weight, "a crossing", error));
  TRY(memory_array(&place, data->n, sizeof *place, "a crossing", error));
  TRY(memory_array(&block, data->n, sizeof *block, "a crossing", error));
  for (size_t i = 0; i < data->n; i++)
    if (isfinite(data->y[i])) {
      pairs[out->n][0] = data->x[i];
      pairs[out->n++][1] = data->y[i] - data->level;
    }
  qsort(pairs, out->n, sizeof *pairs, sample_ascending); /* by x */
  if (isnan(out->share))
    out->share = share_of_modes(out->n, pairs);
  struct response response = {.place = place, .block = block, .n = (double)out->n, .share = out->share};
  gather(&response, out->n, pairs);
  if (response.count < 2)
    return status_fail(error, STATUS_CONTENT, "runs with a result are at %zu places; a crossing needs two",
                       response.count);
  weigh(&response);
  find_interval(&response, weight, out);
  tell_kind(&response, out);
  return STATUS_OK;
}

size_t crossing_next(const struct crossing *found, size_t runs, double place[CROSSING_PLACES]) {
  for (int i = 0; i < CROSSING_PLACES; i++)
    place[i] = found->next[i];
  const size_t each = runs / (6 * CROSSING_PLACES);
  return each > 2 ? each : 2;
}

size_t crossing_runs_for(size_t runs, double width, double within) {
  const double exact = (double)runs * (width / within) * (width / within), step = pow(10, floor(log10(exact)) - 1);
  return exact < 1e15 ? (size_t)(ceil(exact / step - 1e-9) * step + 0.5) : SIZE_MAX;
}

bool crossing_is_answer(const struct crossing *found, double within) {
  return found->kind == CROSSING_FOUND ? !found->contradicted && found->high - found->low <= within
                                       : found->kind != CROSSING_OPEN;
}
