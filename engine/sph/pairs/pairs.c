/* Making and freeing a pair loop, and its lists: when they are stale, and new ones. The sums are in pairs_sum.c. */
#include "engine/sph/pairs/pairs.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "engine/cpu_class.h"
#include "engine/grow.h"
#include "engine/sph/pairs/pairs_layout.h"

enum { PAD = 7 }; /* neighbours.h reads so many elements beyond the end */

const struct sph_pair_kernels *sph_pairs_kernels_choose(void) {
#ifdef __x86_64__
  const enum cpu_class best = cpu_class_choose();
  if (best == CPU_V4)
    return &sph_pairs_kernels_v4;
  if (best == CPU_V3)
    return &sph_pairs_kernels_v3;
#endif
  return &sph_pairs_kernels_baseline;
}

/* ---- life ---- */

static void choose_columns(struct sph_pairs *p, const struct sph_pair_options *options) {
  p->options = *options;
  p->threads = options->fidelity.threads > 1 ? (size_t)options->fidelity.threads : 1;
  p->single = options->fidelity.precision == SPH_FLOAT;
  p->artificial = options->artificial_stress.epsilon > 0 && options->strength;
  p->corrected = options->gradient_correction.on;
  p->kernels = sph_pairs_kernels_choose();
  p->records = p->single ? p->kernels->in_float : p->kernels->in_double;
  p->in_columns = sph_pair_columns(p->single, p->artificial, p->corrected);
  p->out_columns = sph_pair_columns(p->single, false, p->corrected);
}

static bool allocate(struct sph_pairs *p) {
  const size_t n = p->n;
  p->listed[0] = malloc(6 * (n + PAD) * sizeof(double));
  p->opposed[0] = p->artificial ? malloc(6 * (n + 1) * sizeof(double)) : NULL;
  p->buffer = malloc(p->threads * SPH_PAIRS_BUFFER * sizeof(double));
  if (!p->listed[0] || (p->artificial && !p->opposed[0]) || !p->buffer)
    return false;
  for (size_t k = 1; k < 5; k++)
    p->listed[k] = p->listed[0] + k * (n + PAD);
  p->reach = p->listed[0] + 5 * (n + PAD);
  for (size_t k = 1; k < 6 && p->artificial; k++)
    p->opposed[k] = p->opposed[0] + k * (n + 1);
  return true;
}

status sph_pairs_create(size_t n, const struct sph_pair_options *options, struct sph_pairs **out, struct error *error) {
  *out = NULL;
  if (options->fidelity.precision == SPH_FLOAT && n > SPH_NUMBER)
    return status_fail(error, STATUS_CONTENT, "float precision takes %d particles at most, not %zu: use double",
                       SPH_NUMBER, n);
  struct sph_pairs *p = calloc(1, sizeof *p);
  if (!p)
    return status_fail(error, STATUS_MEMORY, "no memory for the pair loop of %zu particles", n);
  p->n = n;
  p->units = (struct sph_pairs_units){1, 1, 1, 1, 1, 1, 1, 1, 1, 1};
  choose_columns(p, options);
  if (!allocate(p) ||
      sph_chunks_create(n, p->single ? PAIR_GROUP_FLOAT : PAIR_GROUP_DOUBLE, p->kernels, &p->lists, error)) {
    sph_pairs_free(p);
    return status_fail(error, STATUS_MEMORY, "no memory for the pair loop of %zu particles", n);
  }
  p->depth = sph_pairs_lag(p) + p->threads;
  if (p->depth > p->lists.count)
    p->depth = p->lists.count ? p->lists.count : 1;
  *out = p;
  return STATUS_OK;
}

void sph_pairs_free(struct sph_pairs *p) {
  if (!p)
    return;
  sph_chunks_clear(&p->lists);
  free(p->listed[0]);
  free(p->opposed[0]);
  free(p->in);
  free(p->out);
  free(p->halo);
  free(p->buffer);
  free(p);
}

size_t sph_pairs_bytes(const struct sph_pairs *p) {
  const size_t bytes = p->records->bytes;
  return sizeof *p + (p->artificial ? 12 : 6) * sizeof(double) * p->n + sph_chunks_bytes(&p->lists) +
         (p->out_capacity + p->halo_capacity) * p->out_columns * bytes + p->in_capacity * p->in_columns * bytes +
         p->threads * SPH_PAIRS_BUFFER * sizeof(double);
}

/* ---- lists ---- */

static double image(double along, double length) {
  return isnan(length) ? along : along - length * nearbyint(along / length);
}

double sph_pairs_slack(const struct sph_pairs *p, size_t low, size_t high, const double *x, const double *y,
                       const double *z, const double *h) {
  const double *periodic = p->options.periodic;
  const bool open = isnan(periodic[0]) && isnan(periodic[1]) && isnan(periodic[2]);
  double least = p->lists.most_slots ? HUGE_VAL : -HUGE_VAL;
  for (size_t i = low; i < high; i++) {
    double dx = x[i] - p->listed[0][i], dy = y[i] - p->listed[1][i], dz = z[i] - p->listed[2][i];
    if (!open) {
      dx = image(dx, periodic[0]);
      dy = image(dy, periodic[1]);
      dz = image(dz, periodic[2]);
    }
    const double left = p->listed[4][i] - (h[i] - p->listed[3][i]);
    const double unused = left - sqrt(dx * dx + dy * dy + dz * dz);
    if (!(unused >= least))
      least = isnan(unused) ? -HUGE_VAL : unused;
  }
  return least;
}

double *const *sph_pairs_listed(struct sph_pairs *p) {
  return p->listed;
}

status sph_pairs_relist(struct sph_pairs *p, struct error *error) {
  double *const *at = p->listed, least = INFINITY, widest = 0;
#ifdef _OPENMP
#pragma omp parallel for schedule(static) reduction(min                                                                \
                                                    : least) reduction(max                                             \
                                                                       : widest)                                       \
    num_threads((int)p->threads) if (p->threads > 1)
#endif
  for (size_t i = 0; i < p->n; i++) {
    p->reach[i] = at[3][i] + at[4][i];
    if (at[3][i] > 0 && at[3][i] < least)
      least = at[3][i];
    if (p->reach[i] > widest)
      widest = p->reach[i];
  }
  /* Pairs in the lists are at most four reaches apart until the lists are stale, and must be within 2^31 units. */
  p->h_unit = fmax(least * 0x1p-20, widest * 0x1p-29);
  for (int d = 0; d < 3; d++) /* a periodic axis has 2^32 units, so that integers wrap where it does */
    p->unit[d] = isnan(p->options.periodic[d]) ? p->h_unit : p->options.periodic[d] * 0x1p-32;

  const status code = sph_chunks_list(&p->lists, p->n, at[0], at[1], at[2], p->reach, p->options.periodic,
                                      (int)p->threads, error);
  if (code)
    return code;
  const size_t in_size = p->in_columns * p->records->bytes, out_size = p->out_columns * p->records->bytes;
  if (!grow_aligned(&p->halo, &p->halo_capacity, p->lists.halos, out_size, 0) ||
      !grow_aligned(&p->out, &p->out_capacity, p->depth * p->lists.most_slots, out_size, 0) ||
      !grow_aligned(&p->in, &p->in_capacity, p->threads * p->lists.most_slots, in_size, 0))
    return status_fail(error, STATUS_MEMORY, "no memory for the neighbours of %zu particles", p->n);
  p->units_chosen = !p->single;
  return STATUS_OK;
}

status sph_pairs_list(struct sph_pairs *p, size_t n, const double *x, const double *y, const double *z, const double *h,
                      const double *slack, struct error *error) {
  const double *const now[5] = {x, y, z, h, slack};
  for (int k = 0; k < 5; k++)
    memcpy(p->listed[k], now[k], n * sizeof(double));
  return sph_pairs_relist(p, error);
}

double sph_pairs_neighbours(const struct sph_pairs *p) {
  return p->n ? (double)p->within / (double)p->n : 0;
}

double sph_pairs_reached(const struct sph_pairs *p) {
  size_t pairs = 0;
  for (size_t k = 0; k < p->lists.count; k++)
    pairs += p->lists.chunk[k].lists.pairs;
  return p->n ? 2 * (double)pairs / (double)p->n : 0;
}
