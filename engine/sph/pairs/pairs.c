/* Chunks of particles that stand together in space, each with records of its own particles and of the foreign ones that
 * they meet: a chunk's records stay in the cache while it is summed. What its foreign ones got is kept until their own
 * chunk has been summed, and then added in the order of chunks, so that bits depend on neither the number of threads
 * nor their timing. Foreign ones belong to later chunks only: when a chunk and all before it are summed, its sums are
 * complete and nobody needs its fields any more. */
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

#include "engine/sph/pairs/chunks.h"
#include "engine/sph/pairs/pairs_kernels.h"
#include "engine/sph/pairs/spline.h"

enum {
  LINE = 64,
  PAD = 7, /* how far neighbours.h reads beyond the end */
  FIRST_CORRECTION = 15,
  SUMS = 21, /* columns of struct sph_pair_sums */
  STRIDE = SPH_PIECE +
           8, /* from one to the next: not a multiple of 4 kB, where all would want the same places in the cache */
  ROOM = SUMS * STRIDE,
};

/* Units in which the numbers of float records are of the order of 1; in double all are 1. per_...: their inverses. */
struct units {
  double length, mass, velocity, density, specific; /* specific: of stress over density squared */
  double per_length, per_mass, per_velocity, per_density, per_specific;
};

struct sph_pairs {
  struct sph_pair_options options;
  const struct sph_pair_kernels *kernels;
  const struct sph_record_kernels *records; /* those of the precision */
  bool single;                              /* records are of float */
  size_t n, in_columns, out_columns;
  bool artificial;    /* there is artificial stress */
  double *opposed[6]; /* the artificial stress R of each particle, m^5/(kg s^2); NULL without */
  double *listed[5];  /* x y z h slack when the lists were made */
  double *reach;
  struct sph_chunks lists;
  void *in; /* records of a chunk, per thread */
  size_t in_capacity;
  void *out; /* records of sums of a chunk: `depth` of them, used in turn */
  size_t out_capacity, depth;
  void *foreign; /* records of sums of the foreign ones, of all chunks */
  size_t foreign_capacity;
  double *room;      /* sums of a piece, per thread */
  double quantum[3]; /* m, of float records' positions, */
  double grain;      /* and the same but for periodic axes: the unit of h there */
  struct units units;
  bool units_chosen; /* since the last listing; in double they stay 1 */
  size_t within;     /* pairs inside the support at the last pass, twice */
};

static size_t threads_of(const struct sph_pairs *p) {
  return p->options.fidelity.threads > 1 ? (size_t)p->options.fidelity.threads : 1;
}

/* So many chunks later than summed a chunk's sums are handed over. One thread does it at once, while they are in its
 * cache; several keep some for the end, for those that find no chunk to sum while the last ones are. */
static size_t lag_of(const struct sph_pairs *p) {
  return threads_of(p) > 1 ? 4 * threads_of(p) : 0;
}

static bool grow(void **array, size_t *capacity, size_t wanted, size_t size) {
  if (wanted <= *capacity)
    return true;
  const size_t more = wanted + wanted / 8;
  void *grown = aligned_alloc(LINE, (more * size + LINE - 1) / LINE * LINE);
  if (!grown)
    return false;
  if (*array && *capacity)
    memcpy(grown, *array, *capacity * size);
  free(*array);
  *array = grown;
  *capacity = more;
  return true;
}

status sph_pairs_create(size_t n, const struct sph_pair_options *options, struct sph_pairs **out, struct error *error) {
  *out = NULL;
  if (options->fidelity.precision == SPH_FLOAT && n > SPH_NUMBER)
    return status_fail(error, STATUS_CONTENT, "float precision takes %d particles at most, not %zu: use double",
                       SPH_NUMBER, n);
  struct sph_pairs *p = calloc(1, sizeof *p);
  if (p) {
    p->options = *options;
    p->units = (struct units){1, 1, 1, 1, 1, 1, 1, 1, 1, 1};
    p->n = n;
    p->kernels = sph_pairs_kernels_choose();
    p->single = options->fidelity.precision == SPH_FLOAT;
    p->records = p->single ? p->kernels->in_float : p->kernels->in_double;
    p->artificial = options->method.artificial_stress > 0 && options->strength;
    const bool corrected = options->method.gradient_correction;
    const size_t middle = p->single ? PAIR_MIDDLE_FLOAT : PAIR_MIDDLE_DOUBLE;
    p->in_columns = p->artificial && corrected ? PAIR_WIDE : p->artificial || corrected ? middle : PAIR_NARROW;
    p->out_columns = corrected ? middle : PAIR_NARROW;
    p->listed[0] = malloc(6 * (n + PAD) * sizeof(double));
    if (p->artificial)
      p->opposed[0] = malloc(6 * (n + 1) * sizeof(double));
    p->room = malloc(threads_of(p) * ROOM * sizeof(double));
  }
  if (!p || !p->listed[0] || (p->artificial && !p->opposed[0]) || !p->room ||
      sph_chunks_create(n, p->single ? PAIR_GROUP_FLOAT : PAIR_GROUP_DOUBLE, p->kernels, &p->lists, error) !=
          STATUS_OK) {
    sph_pairs_free(p);
    return status_fail(error, STATUS_MEMORY, "no memory for the pair loop of %zu particles", n);
  }
  for (size_t k = 1; k < 5; k++)
    p->listed[k] = p->listed[0] + k * (n + PAD);
  for (size_t k = 1; k < 6 && p->artificial; k++)
    p->opposed[k] = p->opposed[0] + k * (n + 1);
  p->reach = p->listed[0] + 5 * (n + PAD);
  p->depth = lag_of(p) + threads_of(p);
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
  free(p->foreign);
  free(p->room);
  free(p);
}

size_t sph_pairs_bytes(const struct sph_pairs *p) {
  return sizeof *p + (p->artificial ? 12 : 6) * sizeof(double) * p->n + sph_chunks_bytes(&p->lists) +
         (p->out_capacity + p->foreign_capacity) * p->out_columns * p->records->bytes +
         p->in_capacity * p->in_columns * p->records->bytes + threads_of(p) * ROOM * sizeof(double);
}

static double image(double along, double length) {
  return isnan(length) ? along : along - length * nearbyint(along / length);
}

double sph_pairs_slack(const struct sph_pairs *p, size_t low, size_t high, const double *x, const double *y,
                       const double *z, const double *h) {
  const double *periodic = p->options.periodic;
  const bool open = isnan(periodic[0]) && isnan(periodic[1]) && isnan(periodic[2]);
  double least = p->lists.most_slots ? HUGE_VAL : -HUGE_VAL;
  for (size_t i = low; i < high;
       i++) { /* both partners of a pair within their slack: r_listed < h_i + h_j + both slacks */
    double dx = x[i] - p->listed[0][i], dy = y[i] - p->listed[1][i], dz = z[i] - p->listed[2][i];
    if (!open)
      dx = image(dx, periodic[0]), dy = image(dy, periodic[1]), dz = image(dz, periodic[2]);
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
    num_threads((int)p->options.fidelity.threads) if (p->options.fidelity.threads > 1)
#endif
  for (size_t i = 0; i < p->n; i++) {
    p->reach[i] = at[3][i] + at[4][i];
    if (at[3][i] > 0 && at[3][i] < least)
      least = at[3][i];
    if (p->reach[i] > widest)
      widest = p->reach[i];
  }
  /* listed pairs, at most four reaches apart until the lists are stale, must lie within 2^31 quanta */
  p->grain = fmax(least * 0x1p-20, widest * 0x1p-29);
  for (int d = 0; d < 3; d++) /* a periodic axis is 2^32 quanta round, so that integers wrap where it does */
    p->quantum[d] = isnan(p->options.periodic[d]) ? p->grain : p->options.periodic[d] * 0x1p-32;
  const status code = sph_chunks_list(&p->lists, p->n, at[0], at[1], at[2], p->reach, p->options.periodic,
                                      (int)p->options.fidelity.threads, error);
  if (code)
    return code;
  if (!grow(&p->foreign, &p->foreign_capacity, p->lists.halos, p->out_columns * p->records->bytes) ||
      !grow(&p->out, &p->out_capacity, p->depth * p->lists.most_slots, p->out_columns * p->records->bytes) ||
      !grow(&p->in, &p->in_capacity, threads_of(p) * p->lists.most_slots, p->in_columns * p->records->bytes))
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

static double power_of_two(double x) {
  int exponent;
  return x > 0 && isfinite(x) ? (frexp(x, &exponent), ldexp(1, exponent)) : 1;
}

/* Powers of two: whatever they are, they change no bit of a result, so that they need not be those of before a restart.
 */
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
  u->per_length = 1 / u->length, u->per_mass = 1 / u->mass, u->per_velocity = 1 / u->velocity;
  u->per_density = 1 / u->density, u->per_specific = 1 / u->specific;
  p->units_chosen = true;
}

static struct sph_pair_source source_of(const struct sph_pairs *p, const struct sph_pair_fields *f) {
  const struct units *u = &p->units;
  const double length = p->single ? p->grain : 1;
  struct sph_pair_source s = {.column = {f->x, f->y, f->z, f->h, f->vx, f->vy, f->vz, f->mass},
                              .scale = {1, 1, 1, 0.5 / length, u->per_velocity, u->per_velocity, u->per_velocity,
                                        u->per_mass},
                              .pressure = f->pressure_term,
                              .stress_factor = f->stress_factor,
                              .volume_weights = p->options.method.volume_weights};
  s.column[PAIR_SOUND] = f->sound_speed, s.scale[PAIR_SOUND] = u->per_velocity;
  s.column[PAIR_DENSITY] = f->density, s.scale[PAIR_DENSITY] = u->per_density;
  for (int k = 0; k < 6; k++) {
    s.column[PAIR_XX + k] = p->options.strength && k < 5 ? f->stress[k] : NULL;
    s.column[PAIR_ARTIFICIAL + k] = p->opposed[k];
    s.scale[PAIR_XX + k] = s.scale[PAIR_ARTIFICIAL + k] = u->per_specific;
    s.correction[k] = p->options.method.gradient_correction ? f->correction[k] : NULL;
  }
  for (int d = 0; d < 3; d++)
    s.per_quantum[d] = 1 / p->quantum[d];
  return s;
}

/* Numbers below the normal ones count as zero while a chunk is summed: ahead of a wave all quantities fall off by
 * orders of magnitude from particle to particle, and arithmetic with such numbers takes a hundred times as long.
 * Returns the mode before. */
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

/* Returns how many pairs are within the support. */
static double sum_chunk(struct sph_pairs *p, const struct sph_chunk *c, const struct sph_pair_source *source,
                        const struct sph_pair_constants *constants, void *in, void *out) {
  const struct sph_record_kernels *records = p->records;
  const struct sph_pair_chunk view = {.own = c->own,
                                      .slots = c->own + c->halo,
                                      .start = c->lists.start,
                                      .count = c->lists.count,
                                      .neighbour = c->lists.j};
  const bool corrected = p->options.method.gradient_correction;
  const unsigned mode = flush_tiny();
  const size_t size = p->out_columns * records->bytes;
  memset(out, 0, view.slots * size);
  records->pack(source, c->first, NULL, c->own, p->in_columns, in);
  records->pack(source, 0, c->halo_particle, c->halo, p->in_columns,
                (char *)in + c->own * p->in_columns * records->bytes);
  const double within = records->sum[corrected][p->artificial](&view, constants, in, out);
  restore_tiny(mode);
  if (c->halo)
    memcpy((char *)p->foreign + c->halo_before * size, (const char *)out + c->own * size, c->halo * size);
  return within;
}

#define INLINE static inline __attribute__((always_inline))

INLINE double at(bool whole, const void *record, size_t column) {
  return whole ? ((const double *)record)[column] : (double)((const float *)record)[column];
}

static void *sums_of_chunk(const struct sph_pairs *p, size_t k) {
  return (char *)p->out + k % p->depth * p->lists.most_slots * p->out_columns * p->records->bytes;
}

/* What the own particles of chunk k got as foreign ones of all chunks before it. */
INLINE void add_foreign(const struct sph_pairs *p, size_t k, const bool whole) {
  const struct sph_chunk *c = &p->lists.chunk[k];
  const size_t columns = p->options.method.gradient_correction ? SUM_COLUMNS : PAIR_NARROW,
               size = p->out_columns * p->records->bytes;
  char *own = sums_of_chunk(p, k);
  for (size_t q = 0; q < c->stretches; q++) {
    const struct sph_chunk_stretch stretch = c->stretch[q];
    const struct sph_chunk *b = &p->lists.chunk[stretch.chunk];
    for (size_t m = stretch.first; m < stretch.first + stretch.count; m++) {
      char *to = own + (b->halo_particle[m] - c->first) * size;
      const char *from = (const char *)p->foreign + (b->halo_before + m) * size;
      const double signal = fmax(at(whole, to, SUM_SIGNAL), at(whole, from, SUM_SIGNAL));
      if (whole) {
        for (size_t column = 0; column < columns; column++)
          ((double *)(void *)to)[column] += ((const double *)(const void *)from)[column];
        ((double *)(void *)to)[SUM_SIGNAL] = signal;
      } else {
        for (size_t column = 0; column < columns; column++)
          ((float *)(void *)to)[column] += ((const float *)(const void *)from)[column];
        ((float *)(void *)to)[SUM_SIGNAL] = (float)signal;
      }
    }
  }
}

/* Columns of a piece's sums. */
static struct sph_pair_sums sums_in(const struct sph_pairs *p, double *room) {
  struct sph_pair_sums s = {.ax = room,
                            .ay = room + STRIDE,
                            .az = room + 2 * STRIDE,
                            .heating = room + 12 * STRIDE,
                            .signal = room + 13 * STRIDE};
  for (size_t k = 0; k < 9; k++)
    s.gradient[k] = room + (SUM_GRADIENT + k) * STRIDE;
  if (!p->options.method.gradient_correction)
    return s;
  s.power = room + 14 * STRIDE;
  for (size_t k = 0; k < 6; k++)
    s.correction[k] = room + (FIRST_CORRECTION + k) * STRIDE;
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
  for (int k = 0; k < 9; k++)
    s.column[SUM_GRADIENT + k] = sums->gradient[k], s.scale[SUM_GRADIENT + k] = u->velocity / u->length;
  s.column[SUM_HEATING] = sums->heating, s.scale[SUM_HEATING] = -0.5 * acceleration * u->velocity;
  s.column[SUM_SIGNAL] = sums->signal, s.scale[SUM_SIGNAL] = u->velocity;
  for (int k = 0; k < 6 && p->options.method.gradient_correction; k++)
    s.column[SUM_MOMENT + k] = sums->correction[k], s.scale[SUM_MOMENT + k] = p->single ? -p->grain / u->length : -1;
  return s;
}

/* A pass: every chunk is summed, and handed over when it and all before it are summed. */
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

/* Of `count` particles from `first` on, whose moments stand where their new corrections will. */
static void correct(const struct sph_pairs *p, size_t first, size_t count, const struct sph_pair_fields *f,
                    const struct sph_pair_sums *sums) {
  struct sph_pair_correction c = {.density = f->density + first,
                                  .pressure_term = f->pressure_term + first,
                                  .power = sums->power};
  for (int k = 0; k < 6; k++)
    c.old[k] = f->correction[k] + first, c.correction[k] = sums->correction[k];
  for (int k = 0; k < 5 && p->options.strength; k++)
    c.stress[k] = f->stress[k] + first, c.stress_factor = f->stress_factor + first;
  for (int k = 0; k < 9; k++)
    c.gradient[k] = sums->gradient[k];
  p->kernels->correct(&c, count);
}

/* The sums of chunk k in SI units, piece by piece. */
static void hand_over(const struct pass *w, size_t k, double *room) {
  const struct sph_pairs *p = w->pairs;
  const struct sph_pair_fields *f = w->fields;
  const struct sph_chunk *c = &p->lists.chunk[k];
  const size_t size = p->out_columns * p->records->bytes;
  const char *records = sums_of_chunk(p, k);
  const struct sph_pair_sums sums = sums_in(p, room);
  struct sph_pair_sink sink = sink_of(p, &sums);
  for (size_t done = 0; done < c->own; done += SPH_PIECE) {
    const size_t first = c->first + done, count = c->own - done < SPH_PIECE ? c->own - done : SPH_PIECE;
    const unsigned mode = flush_tiny();
    if (!done)
      p->single ? add_foreign(p, k, false) : add_foreign(p, k, true);
    sink.density = f->density + first, sink.mass = f->mass + first;
    p->records->unpack(&sink, 0, count, p->out_columns, records + done * size);
    if (p->options.method.gradient_correction)
      correct(p, first, count, f, &sums);
    restore_tiny(mode);
    w->take(w->context, first, count, &sums);
  }
}

/* Until another thread, which took that turn long ago, has done its work. */
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

static void hand_over_in_turn(struct pass *w, size_t k, size_t thread) {
  struct sph_pairs *p = w->pairs;
  for (size_t before = 0; before <= k; before++)
    wait_for(&p->lists.chunk[before].summed);
  hand_over(w, k, p->room + thread * ROOM);
  atomic_store_explicit(&p->lists.chunk[k].delivered, true, memory_order_release);
}

/* Turns are taken in order: chunk 0, 1, ... is summed, and handed over some chunks later. */
static void take_turns(struct pass *w, size_t thread) {
  const size_t count = w->pairs->lists.count, lag = lag_of(w->pairs);
  for (size_t turn; (turn = atomic_fetch_add(&w->next, 1)) < 2 * (count + lag);) {
    const size_t k = turn / 2;
    if (turn % 2 == 0 && k < count)
      sum_in_turn(w, k, thread);
    if (turn % 2 == 1 && k >= lag && k - lag < count)
      hand_over_in_turn(w, k - lag, thread);
  }
}

void sph_pairs_sum(struct sph_pairs *p, size_t n, const struct sph_pair_fields *f, sph_pairs_take *take,
                   void *context) {
  const struct sph_pair_options *o = &p->options;
  if (!p->units_chosen)
    choose_units(p, n, f);
  struct pass w = {.pairs = p, .fields = f, .take = take, .context = context};
  struct sph_pair_constants *constants = &w.constants;
  *constants = (struct sph_pair_constants){.alpha = o->viscosity.alpha,
                                           .twice_beta = 2 * o->viscosity.beta,
                                           .spline_at_spacing = sph_spline(o->spacing_over_h, 1) / SPH_SPLINE_NORM,
                                           .norm = SPH_SPLINE_NORM *
                                                   (p->single ? pow(p->units.length / p->grain, 4) : 1),
                                           .strength = o->strength,
                                           .volume_weights = o->method.volume_weights};
  for (int d = 0; d < 3; d++) {
    constants->periodic[d] = o->periodic[d];
    constants->per_period[d] = 1 / o->periodic[d];
    constants->quantum[d] = p->quantum[d] / p->grain;
    constants->wrapped |= !isnan(o->periodic[d]);
  }
#ifdef _OPENMP
#pragma omp parallel for schedule(dynamic, 1) num_threads((int)o->fidelity.threads) if (o->fidelity.threads > 1)
#endif
  for (size_t k = 0; k < p->lists.count; k++) {
    struct sph_chunk *c = &p->lists.chunk[k];
    atomic_init(&c->summed, false);
    atomic_init(&c->delivered, false);
    if (p->artificial)
      p->kernels->oppose(o->method.artificial_stress, f->stress, f->stress_factor, f->pressure_term, c->first,
                         c->first + c->own, p->opposed);
  }
  w.source = source_of(p, f);
#ifdef _OPENMP
#pragma omp parallel num_threads((int)o->fidelity.threads) if (o->fidelity.threads > 1)
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
