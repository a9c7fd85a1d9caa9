/* The pass over all pairs: chunk by chunk, on one thread or several.
 *
 * A chunk (chunks.h) is summed in records of its own particles and of its halo, which stay in the cache meanwhile:
 *
 *   columns -> pack -> records -> sum -> records of sums: | own particles | halo |
 *                                                              |             |
 *                                             kept in `out` <--+             +--> kept in `halo`
 *
 * A halo belongs to later chunks only. So when a chunk and all chunks before it are summed, its own sums are complete:
 * the sums that earlier chunks keep for it are added, always in the order of the chunks, and everything is unpacked to
 * columns and delivered. Bits therefore depend neither on the number of threads nor on their timing, and nobody reads
 * the chunk's fields any more. */
#include "engine/sph/pairs/pairs.h"

#include <math.h>
#include <sched.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#ifdef _OPENMP
#include <omp.h>
#endif
#ifdef __SSE__
#include <xmmintrin.h>
#endif

#include "engine/cpu_class.h"
#include "engine/sph/pairs/chunks.h"
#include "engine/sph/pairs/pairs_kernels.h"
#include "engine/sph/pairs/spline.h"

#define INLINE static inline __attribute__((always_inline))

enum {
  LINE = 64,
  PAD = 7, /* neighbours.h reads so many elements beyond the end */
  /* A buffer of one piece's sums has a row for each column of struct sph_pair_sums: those of enum sph_pair_sum up to
   * the signal, then power and correction. */
  ROW_POWER = 14,
  ROW_CORRECTION = 15,
  ROWS = 21,
  ROW = SPH_PIECE +
        8, /* length of a row: at multiples of 4 kB all rows would compete for the same lines of the cache */
  BUFFER = ROWS * ROW,
};

/* Units in which the numbers of float records are of the order of 1; in double all of them are 1. They are powers of
 * two. per_...: their inverses. */
struct units {
  double length, mass, velocity, density, specific; /* specific: of stress over density squared */
  double per_length, per_mass, per_velocity, per_density, per_specific;
};

struct sph_pairs {
  struct sph_pair_options options;
  const struct sph_pair_kernels *kernels;
  const struct sph_record_kernels *records; /* those of the precision */
  bool single;                              /* records are of float */
  bool artificial, corrected;               /* artificial stress; gradient correction */
  size_t n, threads;
  size_t in_columns, out_columns; /* of a record; of a record of sums */
  double *opposed[6];             /* artificial stress R of each particle, m^5/(kg s^2); NULL without */
  double *listed[5];              /* x y z h slack when the lists were made */
  double *reach;                  /* h + slack */
  struct sph_chunks lists;
  void *in; /* records of a chunk, one buffer per thread */
  size_t in_capacity;
  void *out; /* records of sums of `depth` chunks, used in turn */
  size_t out_capacity, depth;
  void *halo; /* records of sums of all halos */
  size_t halo_capacity;
  double *buffer; /* sums of a piece, one buffer per thread */
  double unit[3]; /* m, unit of float records' positions */
  double h_unit;  /* m, the unit of their h: the same, except on periodic axes */
  struct units units;
  bool units_chosen; /* since the lists were made; in double they stay 1 */
  size_t within;     /* pairs inside the support in the last pass, counted twice */
};

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

/* A chunk's sums are delivered this many chunks after it was summed. A single thread delivers at once, while the sums
 * are in its cache. Several threads keep some chunks for the end, as work for those that find no chunk left to sum. */
static size_t lag_of(const struct sph_pairs *p) {
  return p->threads > 1 ? 4 * p->threads : 0;
}

static bool grow(void **array, size_t *capacity, size_t wanted, size_t size) {
  if (wanted <= *capacity)
    return true;
  const size_t more = wanted + wanted / 8;
  void *grown = aligned_alloc(LINE, (more * size + LINE - 1) / LINE * LINE);
  if (!grown)
    return false;
  free(*array);
  *array = grown;
  *capacity = more;
  return true;
}

/* ---- life ---- */

static void choose_columns(struct sph_pairs *p, const struct sph_pair_options *options) {
  p->options = *options;
  p->threads = options->fidelity.threads > 1 ? (size_t)options->fidelity.threads : 1;
  p->single = options->fidelity.precision == SPH_FLOAT;
  p->artificial = options->method.artificial_stress > 0 && options->strength;
  p->corrected = options->method.gradient_correction;
  p->kernels = sph_pairs_kernels_choose();
  p->records = p->single ? p->kernels->in_float : p->kernels->in_double;
  p->in_columns = sph_pair_columns(p->single, p->artificial, p->corrected);
  p->out_columns = sph_pair_columns(p->single, false, p->corrected);
}

static bool allocate(struct sph_pairs *p) {
  const size_t n = p->n;
  p->listed[0] = malloc(6 * (n + PAD) * sizeof(double));
  p->opposed[0] = p->artificial ? malloc(6 * (n + 1) * sizeof(double)) : NULL;
  p->buffer = malloc(p->threads * BUFFER * sizeof(double));
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
  p->units = (struct units){1, 1, 1, 1, 1, 1, 1, 1, 1, 1};
  choose_columns(p, options);
  if (!allocate(p) ||
      sph_chunks_create(n, p->single ? PAIR_GROUP_FLOAT : PAIR_GROUP_DOUBLE, p->kernels, &p->lists, error)) {
    sph_pairs_free(p);
    return status_fail(error, STATUS_MEMORY, "no memory for the pair loop of %zu particles", n);
  }
  p->depth = lag_of(p) + p->threads;
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
         p->threads * BUFFER * sizeof(double);
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
  if (!grow(&p->halo, &p->halo_capacity, p->lists.halos, out_size) ||
      !grow(&p->out, &p->out_capacity, p->depth * p->lists.most_slots, out_size) ||
      !grow(&p->in, &p->in_capacity, p->threads * p->lists.most_slots, in_size))
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

/* ---- columns and records ---- */

static double power_of_two(double x) {
  int exponent;
  if (!(x > 0) || !isfinite(x))
    return 1;
  frexp(x, &exponent);
  return ldexp(1, exponent);
}

/* Chooses the units of float records. As powers of two they change no bit of a result, so they need not be the same
 * after a restart. */
static void choose_units(struct sph_pairs *p, size_t n, const struct sph_pair_fields *f) {
  struct units *u = &p->units;
  double h = 0, density = 0, sound = 0;
  for (size_t i = 0; i < n; i++) {
    h = f->h[i] > h ? f->h[i] : h;
    density = f->density[i] > density ? f->density[i] : density;
    sound = f->sound_speed[i] > sound ? f->sound_speed[i] : sound;
  }
  u->length = power_of_two(h);
  u->density = power_of_two(density);
  u->velocity = power_of_two(sound);
  u->mass = u->density * u->length * u->length * u->length;
  u->specific = u->velocity * u->velocity / u->density;
  u->per_length = 1 / u->length;
  u->per_mass = 1 / u->mass;
  u->per_velocity = 1 / u->velocity;
  u->per_density = 1 / u->density;
  u->per_specific = 1 / u->specific;
  p->units_chosen = true;
}

static struct sph_pair_source source_of(const struct sph_pairs *p, const struct sph_pair_fields *f) {
  const struct units *u = &p->units;
  struct sph_pair_source s = {
      .column = {f->x, f->y, f->z, f->h, f->vx, f->vy, f->vz, f->mass},
      .scale = {1, 1, 1, 0.5 / (p->single ? p->h_unit : 1), u->per_velocity, u->per_velocity, u->per_velocity,
                u->per_mass},
      .pressure = f->pressure_term,
      .stress_factor = f->stress_factor,
      .volume_weights = p->options.method.volume_weights,
  };
  s.column[PAIR_SOUND] = f->sound_speed;
  s.scale[PAIR_SOUND] = u->per_velocity;
  s.column[PAIR_DENSITY] = f->density;
  s.scale[PAIR_DENSITY] = u->per_density;
  for (int k = 0; k < 6; k++) {
    s.column[PAIR_XX + k] = p->options.strength && k < 5 ? f->stress[k] : NULL;
    s.column[PAIR_ARTIFICIAL + k] = p->opposed[k];
    s.scale[PAIR_XX + k] = u->per_specific;
    s.scale[PAIR_ARTIFICIAL + k] = u->per_specific;
    s.correction[k] = p->corrected ? f->correction[k] : NULL;
  }
  for (int d = 0; d < 3; d++)
    s.per_unit[d] = 1 / p->unit[d];
  return s;
}

/* The columns of a piece's sums in a buffer. */
static struct sph_pair_sums sums_in(const struct sph_pairs *p, double *buffer) {
  struct sph_pair_sums s = {.ax = buffer,
                            .ay = buffer + ROW,
                            .az = buffer + 2 * ROW,
                            .heating = buffer + SUM_HEATING * ROW,
                            .signal = buffer + SUM_SIGNAL * ROW};
  for (size_t k = 0; k < 9; k++)
    s.gradient[k] = buffer + (SUM_GRADIENT + k) * ROW;
  if (!p->corrected)
    return s;
  s.power = buffer + ROW_POWER * ROW;
  for (size_t k = 0; k < 6; k++)
    s.correction[k] = buffer + (ROW_CORRECTION + k) * ROW;
  return s;
}

static struct sph_pair_sink sink_of(const struct sph_pairs *p, const struct sph_pair_sums *sums) {
  const struct units *u = &p->units;
  const double acceleration = u->velocity * u->velocity / u->length;
  struct sph_pair_sink s = {.column = {sums->ax, sums->ay, sums->az},
                            .scale = {acceleration, acceleration, acceleration},
                            .mass_unit = u->mass,
                            .density_unit = u->density,
                            .volume_weights = p->options.method.volume_weights};
  for (int k = 0; k < 9; k++) {
    s.column[SUM_GRADIENT + k] = sums->gradient[k];
    s.scale[SUM_GRADIENT + k] = u->velocity / u->length;
  }
  s.column[SUM_HEATING] = sums->heating;
  s.scale[SUM_HEATING] = -0.5 * acceleration * u->velocity;
  s.column[SUM_SIGNAL] = sums->signal;
  s.scale[SUM_SIGNAL] = u->velocity;
  for (int k = 0; k < 6 && p->corrected; k++) {
    s.column[SUM_MOMENT + k] = sums->correction[k];
    s.scale[SUM_MOMENT + k] = p->single ? -p->h_unit / u->length : -1;
  }
  return s;
}

/* ---- one chunk ---- */

/* While a chunk is summed, numbers below the normal ones count as zero. Ahead of a wave all quantities fall by orders
 * of magnitude from particle to particle, and arithmetic with such numbers takes a hundred times as long. Returns the
 * mode before. */
static unsigned flush_tiny(void) {
#ifdef __SSE__
  const unsigned before = _mm_getcsr();
  _mm_setcsr(before | 0x8040); /* flush to zero, denormals are zero */
  return before;
#else
  return 0;
#endif
}
static void restore_tiny(unsigned before) {
#ifdef __SSE__
  _mm_setcsr(before);
#else
  (void)before;
#endif
}

/* Returns the number of pairs within the support. */
static double sum_chunk(struct sph_pairs *p, const struct sph_chunk *c, const struct sph_pair_source *source,
                        const struct sph_pair_constants *constants, void *in, void *out) {
  const struct sph_record_kernels *records = p->records;
  const struct sph_pair_chunk view = {.own = c->own,
                                      .slots = c->own + c->halo,
                                      .start = c->lists.start,
                                      .count = c->lists.count,
                                      .neighbour = c->lists.j};
  const size_t in_size = p->in_columns * records->bytes, out_size = p->out_columns * records->bytes;
  const unsigned mode = flush_tiny();
  memset(out, 0, view.slots * out_size);
  records->pack(source, c->first, NULL, c->own, p->in_columns, in);
  records->pack(source, 0, c->halo_particle, c->halo, p->in_columns, (char *)in + c->own * in_size);
  const double within = records->sum[p->corrected][p->artificial](&view, constants, in, out);
  restore_tiny(mode);
  if (c->halo)
    memcpy((char *)p->halo + c->halo_before * out_size, (const char *)out + c->own * out_size, c->halo * out_size);
  return within;
}

static void *sums_of_chunk(const struct sph_pairs *p, size_t k) {
  return (char *)p->out + k % p->depth * p->lists.most_slots * p->out_columns * p->records->bytes;
}

/* Adds one record of sums to another one: of the signal the larger, of the rest the sum. */
INLINE void add_record(void *to, const void *from, size_t columns, const bool single) {
  if (single) {
    float *a = to;
    const float *b = from, signal = (float)fmax((double)a[SUM_SIGNAL], (double)b[SUM_SIGNAL]);
    for (size_t column = 0; column < columns; column++)
      a[column] += b[column];
    a[SUM_SIGNAL] = signal;
  } else {
    double *a = to;
    const double *b = from, signal = fmax(a[SUM_SIGNAL], b[SUM_SIGNAL]);
    for (size_t column = 0; column < columns; column++)
      a[column] += b[column];
    a[SUM_SIGNAL] = signal;
  }
}

/* Adds to the own particles of chunk k what they got in the halos of all chunks before it. */
INLINE void add_halos(const struct sph_pairs *p, size_t k, const bool single) {
  const struct sph_chunk *c = &p->lists.chunk[k];
  const size_t columns = p->corrected ? SUM_COLUMNS : PAIR_NARROW, size = p->out_columns * p->records->bytes;
  char *own = sums_of_chunk(p, k);
  for (size_t q = 0; q < c->stretches; q++) {
    const struct sph_chunk_stretch stretch = c->stretch[q];
    const struct sph_chunk *before = &p->lists.chunk[stretch.chunk];
    for (size_t m = stretch.first; m < stretch.first + stretch.count; m++)
      add_record(own + (before->halo_particle[m] - c->first) * size,
                 (const char *)p->halo + (before->halo_before + m) * size, columns, single);
  }
}

/* Corrects the gradients of `count` particles from `first` on. */
static void correct(const struct sph_pairs *p, size_t first, size_t count, const struct sph_pair_fields *f,
                    const struct sph_pair_sums *sums) {
  struct sph_pair_correction c = {.density = f->density + first,
                                  .pressure_term = f->pressure_term + first,
                                  .stress_factor = p->options.strength ? f->stress_factor + first : NULL,
                                  .power = sums->power};
  for (int k = 0; k < 6; k++) {
    c.old[k] = f->correction[k] + first;
    c.correction[k] = sums->correction[k];
  }
  for (int k = 0; k < 5 && p->options.strength; k++)
    c.stress[k] = f->stress[k] + first;
  for (int k = 0; k < 9; k++)
    c.gradient[k] = sums->gradient[k];
  p->kernels->correct(&c, count);
}

/* ---- a pass ---- */

struct pass {
  struct sph_pairs *pairs;
  const struct sph_pair_fields *fields;
  struct sph_pair_source source;
  struct sph_pair_constants constants;
  sph_pairs_take *take;
  void *context;
  atomic_size_t next; /* turn */
  atomic_size_t within;
};

/* Delivers the sums of chunk k in SI units, piece by piece. */
static void deliver(const struct pass *w, size_t k, double *buffer) {
  const struct sph_pairs *p = w->pairs;
  const struct sph_pair_fields *f = w->fields;
  const struct sph_chunk *c = &p->lists.chunk[k];
  const size_t size = p->out_columns * p->records->bytes;
  const char *records = sums_of_chunk(p, k);
  const struct sph_pair_sums sums = sums_in(p, buffer);
  struct sph_pair_sink sink = sink_of(p, &sums);
  for (size_t done = 0; done < c->own; done += SPH_PIECE) {
    const size_t first = c->first + done, count = c->own - done < SPH_PIECE ? c->own - done : SPH_PIECE;
    const unsigned mode = flush_tiny();
    if (!done && p->single)
      add_halos(p, k, true);
    else if (!done)
      add_halos(p, k, false);
    sink.density = f->density + first;
    sink.mass = f->mass + first;
    p->records->unpack(&sink, 0, count, p->out_columns, records + done * size);
    if (p->corrected)
      correct(p, first, count, f, &sums);
    restore_tiny(mode);
    w->take(w->context, first, count, &sums);
  }
}

/* Waits for another thread, which took that turn long before. */
static void wait_for(atomic_bool *done) {
  while (!atomic_load_explicit(done, memory_order_acquire))
    sched_yield();
}

static void sum_in_turn(struct pass *w, size_t k, size_t thread) {
  struct sph_pairs *p = w->pairs;
  struct sph_chunk *c = &p->lists.chunk[k];
  if (k >= p->depth)
    wait_for(&p->lists.chunk[k - p->depth].delivered);
  void *in = (char *)p->in + thread * p->lists.most_slots * p->in_columns * p->records->bytes;
  atomic_fetch_add(&w->within, (size_t)sum_chunk(p, c, &w->source, &w->constants, in, sums_of_chunk(p, k)));
  atomic_store_explicit(&c->summed, true, memory_order_release);
}

static void deliver_in_turn(struct pass *w, size_t k, size_t thread) {
  struct sph_pairs *p = w->pairs;
  for (size_t before = 0; before <= k; before++)
    wait_for(&p->lists.chunk[before].summed);
  deliver(w, k, p->buffer + thread * BUFFER);
  atomic_store_explicit(&p->lists.chunk[k].delivered, true, memory_order_release);
}

/* A thread takes the next turn until there are none: even turns sum the chunks 0, 1, ..., odd turns deliver them,
 * lag_of chunks later. As turns are taken in order, a thread waits only for turns that others have already taken. */
static void take_turns(struct pass *w, size_t thread) {
  const size_t count = w->pairs->lists.count, lag = lag_of(w->pairs);
  for (size_t turn; (turn = atomic_fetch_add(&w->next, 1)) < 2 * (count + lag);) {
    const size_t k = turn / 2;
    if (turn % 2 == 0 && k < count)
      sum_in_turn(w, k, thread);
    if (turn % 2 == 1 && k >= lag && k - lag < count)
      deliver_in_turn(w, k - lag, thread);
  }
}

static struct sph_pair_constants constants_of(const struct sph_pairs *p) {
  const struct sph_pair_options *o = &p->options;
  struct sph_pair_constants c = {.alpha = o->viscosity.alpha,
                                 .twice_beta = 2 * o->viscosity.beta,
                                 .spline_at_spacing = sph_spline(o->spacing_over_h, 1) / SPH_SPLINE_NORM,
                                 .norm = SPH_SPLINE_NORM * (p->single ? pow(p->units.length / p->h_unit, 4) : 1),
                                 .strength = o->strength,
                                 .volume_weights = o->method.volume_weights};
  for (int d = 0; d < 3; d++) {
    c.periodic[d] = o->periodic[d];
    c.per_period[d] = 1 / o->periodic[d];
    c.unit[d] = p->unit[d] / p->h_unit;
    c.wrapped |= !isnan(o->periodic[d]);
  }
  return c;
}

void sph_pairs_sum(struct sph_pairs *p, size_t n, const struct sph_pair_fields *f, sph_pairs_take *take,
                   void *context) {
  if (!p->units_chosen)
    choose_units(p, n, f);
  struct pass w = {.pairs = p, .fields = f, .constants = constants_of(p), .take = take, .context = context};
#ifdef _OPENMP
#pragma omp parallel for schedule(dynamic, 1) num_threads((int)p->threads) if (p->threads > 1)
#endif
  for (size_t k = 0; k < p->lists.count; k++) {
    struct sph_chunk *c = &p->lists.chunk[k];
    atomic_init(&c->summed, false);
    atomic_init(&c->delivered, false);
    if (p->artificial)
      p->kernels->oppose(p->options.method.artificial_stress, f->stress, f->stress_factor, f->pressure_term, c->first,
                         c->first + c->own, p->opposed);
  }
  w.source = source_of(p, f);
#ifdef _OPENMP
#pragma omp parallel num_threads((int)p->threads) if (p->threads > 1)
  take_turns(&w, (size_t)omp_get_thread_num());
#else
  take_turns(&w, 0);
#endif
  p->within = 2 * w.within;
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
