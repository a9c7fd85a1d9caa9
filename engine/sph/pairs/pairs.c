/* The pair loop: making and freeing it, its lists (when they are stale, and new ones), and the pass over all pairs:
 * chunk by chunk, on one thread or several.
 *
 * A chunk (lists.h) is summed in records of its own particles and of its halo, which stay in the cache meanwhile:
 *
 *   columns -> pack -> records -> sum -> records of sums: | own particles | halo |
 *                                                              |             |
 *                                             kept in `out` <--+             +--> kept in `halo`
 *
 * A halo belongs to later chunks only. So when a chunk and all chunks before it are summed, its own sums can be
 * completed: the sums that earlier chunks keep for it are added, always in the order of the chunks, and everything is
 * unpacked to columns and delivered. Bits therefore depend neither on the number of threads nor on their timing, and
 * the pass no longer reads the chunk's fields. */
#include <math.h>
#include <sched.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#ifdef __SSE__
#include <xmmintrin.h>
#endif

#include "engine/cpu_class.h"
#include "engine/grow.h"
#include "engine/sph/pairs/lists.h"
#include "engine/sph/pairs/pairs.h"
#include "engine/threads.h"
#include "schemas/memory.h"

enum { PAD = 7 }; /* neighbours.c reads so many elements beyond the end */

/* A buffer of one piece's sums has a row for each of them, and one for the power. */
enum {
  ROW = SPH_PIECE + 8, /* its length: at multiples of 4 kB all rows would compete for the same lines of the cache */
  BUFFER = (SUM_ALL + 1 + FOUND_ALL) * ROW,
};

struct sph_pairs {
  struct sph_pair_options options;
  const struct sph_pair_kernels *kernels;
  const struct sph_record_kernels *records; /* those of the precision */
  bool single;                              /* records are of float */
  struct sph_pair_shape shape;              /* its terms */
  enum sph_pair_combination combination;    /* the kernel that is compiled for them */
  size_t n, threads;
  size_t in_columns, out_columns; /* length of a record; of a record of sums */
  size_t sums;                    /* columns of a record of sums that are in use */
  double *made[MADE_ALL];         /* arrays that terms make before a pass (PAIR_MADE); NULL where the term is off */
  double *listed[5];              /* x y z h slack when the lists were made */
  double *reach;                  /* h + slack */
  struct sph_chunks lists;
  struct sph_foreign foreign;
  double *apart; /* positions on an open axis with bodies far apart: of float records with `body`; else NULL */
  int apart_axis;
  void *in; /* records of a chunk, one buffer per thread */
  size_t in_capacity;
  void *out; /* records of sums of `depth` chunks, used in turn */
  size_t out_capacity, depth;
  void *halo; /* records of sums of all halos */
  size_t halo_capacity;
  double *buffer; /* sums of a piece, one buffer per thread */
  double unit[3]; /* m, unit of float records' positions */
  double h_unit;  /* m, the unit of their h: the same, except on periodic axes */
  struct sph_pair_units units;
  bool units_chosen; /* since the lists were made; in double they stay 1 */
  size_t within;     /* pairs inside the support in the last pass, counted twice */
};

/* A chunk's sums are delivered this many chunks after it was summed. A single thread delivers at once, while the sums
 * are in its cache. Several threads keep some chunks for the end, as work for those that find no chunk left to sum. */
static size_t lag_of(const struct sph_pairs *p) {
  return p->threads > 1 ? 4 * p->threads : 0;
}

const struct sph_pair_kernels *sph_pairs_kernels_choose(void) {
  return CPU_CLASS_OF(sph_pairs_kernels);
}

/* ---- life ---- */

/* Finds the combination of terms of a shape. */
static status find_combination(const struct sph_pair_shape *shape, enum sph_pair_combination *out,
                               struct error *error) {
  static const struct sph_pair_shape compiled[] = {
#define COMBINATION(name, ...) [PAIR_SHAPE_##name] = {__VA_ARGS__},
      SPH_PAIR_COMBINATIONS(COMBINATION)
#undef COMBINATION
  };
  for (int k = 0; k < PAIR_SHAPES; k++)
    if (!memcmp(&compiled[k], shape, sizeof *shape)) {
      *out = k;
      return STATUS_OK;
    }
  return status_fail(error, STATUS_CONTENT,
                     "these terms of the pair loop do not go together:%s"
#define PAIR_TERM(name, on) "%s"
#include "engine/sph/modules/declarations.h"
                     ". Turn one of them off",
                     ""
#define PAIR_TERM(name, on) , shape->name ? " " #name : ""
#include "engine/sph/modules/declarations.h"
  );
}

static bool allocate(struct sph_pairs *p) {
  const size_t n = p->n;
  p->listed[0] = malloc(6 * (n + PAD) * sizeof(double));
  p->buffer = malloc(p->threads * BUFFER * sizeof(double));
  bool enough = p->listed[0] && p->buffer;
  if (p->single && p->options.body) {
    p->apart = malloc(n * sizeof(double));
    enough = enough && p->apart;
  }
#define PAIR_MADE(term, count)                                                                                         \
  for (size_t k = 0; k < (count) && p->shape.term; k++) {                                                              \
    p->made[MADE_##term + k] = malloc((n + 1) * sizeof(double));                                                       \
    enough = enough && p->made[MADE_##term + k];                                                                       \
  }
#include "engine/sph/modules/declarations.h"
  if (!enough)
    return false;
  for (size_t k = 1; k < 5; k++)
    p->listed[k] = p->listed[0] + k * (n + PAD);
  p->reach = p->listed[0] + 5 * (n + PAD);
  return true;
}

status sph_pairs_create(size_t n, const struct sph_pair_options *options, struct sph_pairs **out, struct error *error) {
  *out = NULL;
  const struct sph_pair_options *o = options;
  const struct sph_pair_shape shape = {
#define PAIR_TERM(name, on) .name = on,
#include "engine/sph/modules/declarations.h"
  };
  enum sph_pair_combination combination = 0;
  TRY(find_combination(&shape, &combination, error));
  if (options->fidelity.precision == SPH_FLOAT && n > SPH_NUMBER)
    return status_fail(error, STATUS_CONTENT, "float precision takes %d particles at most, not %zu: use double",
                       SPH_NUMBER, n);
  int open = 0;
  while (open < 3 && !isnan(options->periodic[open]))
    open++;
  if (options->body && open == 3)
    return status_fail(error, STATUS_CONTENT, "bodies in a box that is periodic along all axes are not told apart");
  struct sph_pairs *p = memory_small(1, sizeof *p);
  p->n = n;
  p->apart_axis = open;
  p->units = (struct sph_pair_units){1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1};
  p->shape = shape;
  p->combination = combination;
  p->options = *options;
  p->threads = options->fidelity.threads > 1 ? (size_t)options->fidelity.threads : 1;
  p->single = options->fidelity.precision == SPH_FLOAT;
  p->kernels = sph_pairs_kernels_choose();
  p->records = p->single ? p->kernels->in_float : p->kernels->in_double;
  p->sums = sph_pair_shape_sums(p->shape, PAIR_TERMS);
  p->in_columns = sph_pair_shape_stride(sph_pair_shape_columns(p->shape, PAIR_TERMS), p->records->bytes);
  p->out_columns = sph_pair_shape_stride(p->sums, p->records->bytes);
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
  sph_foreign_clear(&p->foreign);
  free(p->apart);
  free(p->listed[0]);
  for (size_t k = 0; k < MADE_ALL; k++)
    free(p->made[k]);
  free(p->in);
  free(p->out);
  free(p->halo);
  free(p->buffer);
  free(p);
}

bool sph_pairs_look_back(const struct sph_pairs *p) {
  return p->sums > SUM_BASE;
}

/* ---- lists ---- */

double sph_pairs_image(double along, double length) {
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
      dx = sph_pairs_image(dx, periodic[0]);
      dy = sph_pairs_image(dy, periodic[1]);
      dz = sph_pairs_image(dz, periodic[2]);
    }
    /* Foreign pairs reach as far as at the start, however small h is now. */
    const double grown = h[i] - p->listed[3][i], left = p->listed[4][i] - (p->options.body ? fmax(grown, 0) : grown);
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
#pragma omp parallel for schedule(static) reduction(min                                                                \
                                                    : least) reduction(max                                             \
                                                                       : widest)                                       \
    num_threads((int)p->threads) if (p->threads > 1)
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

  TRY(sph_chunks_list(&p->lists, p->n, at[0], at[1], at[2], p->reach, p->options.periodic, p->options.body,
                      (int)p->threads, error));
  if (p->options.body && !sph_foreign_collect(&p->lists, p->n, &p->foreign))
    return status_fail(error, STATUS_MEMORY, "no memory for the neighbours of %zu particles", p->n);
  const size_t in_size = p->in_columns * p->records->bytes, out_size = p->out_columns * p->records->bytes;
  if (!grow_aligned(&p->halo, &p->halo_capacity, p->lists.halos, out_size, 0) ||
      !grow_aligned(&p->out, &p->out_capacity, p->depth * p->lists.most_slots, out_size, 0) ||
      !grow_aligned(&p->in, &p->in_capacity, p->threads * p->lists.most_slots, in_size, 0))
    return status_fail(error, STATUS_MEMORY, "no memory for the neighbours of %zu particles", p->n);
  p->units.distance = p->single ? p->h_unit : 1;
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

const struct sph_foreign *sph_pairs_foreign(const struct sph_pairs *p) {
  return &p->foreign;
}

/* Adds the volumes of two particles of one body to each other's sum. */
static void add_volumes(const struct sph_pairs *p, const struct sph_pair_fields *f, size_t i, size_t j,
                        double (*weight)(double square, double h), double *sum) {
  const double d[3] = {sph_pairs_image(f->x[j] - f->x[i], p->options.periodic[0]),
                       sph_pairs_image(f->y[j] - f->y[i], p->options.periodic[1]),
                       sph_pairs_image(f->z[j] - f->z[i], p->options.periodic[2])};
  const double w = weight(d[0] * d[0] + d[1] * d[1] + d[2] * d[2], 0.5 * (f->h[i] + f->h[j]));
  sum[i] += w * f->mass[j] / f->density[j];
  sum[j] += w * f->mass[i] / f->density[i];
}

void sph_pairs_volumes(const struct sph_pairs *p, const struct sph_pair_fields *f,
                       double (*weight)(double square, double h), double *sum) {
  const size_t per_list = p->lists.per_list;
  const uint8_t *body = p->options.body;
  for (size_t i = 0; i < p->n; i++)
    sum[i] += weight(0, f->h[i]) * f->mass[i] / f->density[i];
  for (size_t k = 0; k < p->lists.count; k++) {
    const struct sph_chunk *c = &p->lists.chunk[k];
    for (size_t own = 0; own < c->own; own++) {
      const uint32_t *entry = c->lists.j + c->lists.start[own / per_list];
      for (uint32_t e = 0; e < c->lists.count[own / per_list]; e++) {
        const size_t j = entry[e] < c->own ? c->first + entry[e] : c->halo_particle[entry[e] - c->own];
        if (j != c->first + own && (!body || body[j] == body[c->first + own]))
          add_volumes(p, f, c->first + own, j, weight, sum);
      }
    }
  }
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

/* ---- columns: units of float records, sources and sinks of records, constants ---- */

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
  struct sph_pair_units *u = &p->units;
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

/* The columns from which records are packed. */
static struct sph_pair_source source_of(const struct sph_pairs *p, const struct sph_pair_fields *f) {
  const struct sph_pair_units *u = &p->units;
  struct sph_pair_source s = {
      .column = {f->x, f->y, f->z, f->h, f->vx, f->vy, f->vz, f->mass},
      .scale = {1, 1, 1, 0.5 / u->distance, u->per_velocity, u->per_velocity, u->per_velocity, u->per_mass},
      .pressure = f->pressure_term,
      .stress_factor = f->stress_factor,
      .volume_weights = p->options.method.volume_weights,
      .geometric_weights = p->shape.gradient_correction && !p->options.method.volume_weights,
      .shape = p->shape,
      .unit = *u,
      .fields = *f,
  };
  for (size_t k = 0; k < MADE_ALL; k++)
    s.made[k] = p->made[k];
  s.column[PAIR_SOUND] = f->sound_speed;
  s.scale[PAIR_SOUND] = u->per_velocity;
  s.column[PAIR_DENSITY] = f->density;
  s.scale[PAIR_DENSITY] = u->per_density;
  for (int k = 0; k < 6; k++) {
    s.column[PAIR_XX + k] = p->options.strength && k < 5 ? f->stress[k] : NULL;
    s.scale[PAIR_XX + k] = u->per_specific;
  }
  for (int d = 0; d < 3; d++)
    s.per_unit[d] = 1 / p->unit[d];
  return s;
}

/* The sums of a piece in its buffer. */
static struct sph_pair_sums sums_in(const struct sph_pairs *p, double *buffer) {
  struct sph_pair_sums s = {.ax = buffer,
                            .ay = buffer + ROW,
                            .az = buffer + 2 * ROW,
                            .heating = buffer + SUM_HEATING * ROW,
                            .signal = buffer + SUM_SIGNAL * ROW};
  for (size_t k = 0; k < 9; k++)
    s.gradient[k] = buffer + (SUM_GRADIENT + k) * ROW;
#define PAIR_POWER(term) s.power = p->shape.term ? buffer + SUM_ALL * ROW : s.power;
#define PAIR_SUMS(term, member, count, scale_)                                                                         \
  for (size_t k = 0; k < (count) && p->shape.term; k++)                                                                \
    s.member[k] = buffer + (sph_pair_shape_sums(p->shape, PAIR_TERM_##term) + k) * ROW;
#define PAIR_FOUND(term, member, count)                                                                                \
  for (size_t k = 0; k < (count) && p->shape.term; k++)                                                                \
    s.member[k] = buffer + (SUM_ALL + 1 + FOUND_##member + k) * ROW;
#include "engine/sph/modules/declarations.h"
  return s;
}

/* The columns that records of sums become: those of a buffer. */
static struct sph_pair_sink sink_of(const struct sph_pairs *p, const struct sph_pair_sums *sums) {
  const struct sph_pair_units *u = &p->units;
  const double acceleration = u->velocity * u->velocity / u->length;
  struct sph_pair_sink s = {.column = {sums->ax, sums->ay, sums->az},
                            .scale = {acceleration, acceleration, acceleration},
                            .mass_unit = u->mass,
                            .density_unit = u->density,
                            .volume_weights = p->options.method.volume_weights,
                            .geometric_weights = p->shape.gradient_correction && !p->options.method.volume_weights,
                            .columns = p->sums};
  for (int k = 0; k < 9; k++) {
    s.column[SUM_GRADIENT + k] = sums->gradient[k];
    s.scale[SUM_GRADIENT + k] = u->velocity / u->length;
  }
  s.column[SUM_HEATING] = sums->heating;
  s.scale[SUM_HEATING] = -0.5 * acceleration * u->velocity;
  s.column[SUM_SIGNAL] = sums->signal;
  s.scale[SUM_SIGNAL] = u->velocity;
#define PAIR_SUMS(term, member, count, scale_)                                                                         \
  for (size_t k = 0; k < (count) && p->shape.term; k++) {                                                              \
    s.column[sph_pair_shape_sums(p->shape, PAIR_TERM_##term) + k] = sums->member[k];                                   \
    s.scale[sph_pair_shape_sums(p->shape, PAIR_TERM_##term) + k] = (scale_);                                           \
  }
#include "engine/sph/modules/declarations.h"
  return s;
}

static struct sph_pair_constants constants_of(const struct sph_pairs *p) {
  const struct sph_pair_options *o = &p->options;
  struct sph_pair_constants c = {
#define PAIR_CONSTANT(name, value) .name = value,
#include "engine/sph/modules/declarations.h"
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

#define INLINE static inline __attribute__((always_inline))

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
  const double within = records->sum[p->combination](&view, constants, in, out);
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
  const size_t columns = p->sums, size = p->out_columns * p->records->bytes;
  char *own = sums_of_chunk(p, k);
  for (size_t q = 0; q < c->stretches; q++) {
    const struct sph_chunk_stretch stretch = c->stretch[q];
    const struct sph_chunk *before = &p->lists.chunk[stretch.chunk];
    for (size_t m = stretch.first; m < stretch.first + stretch.count; m++)
      add_record(own + (before->halo_particle[m] - c->first) * size,
                 (const char *)p->halo + (before->halo_before + m) * size, columns, single);
  }
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
#define PAIR_FINISH(term)                                                                                              \
  if (p->shape.term)                                                                                                   \
    p->kernels->finish_##term(&p->options, f, first, count, &sums);
#include "engine/sph/modules/declarations.h"
    restore_tiny(mode);
    w->take(w->context, first, count, &sums);
  }
}

/* Waits for another thread, which took that turn earlier. */
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
 * lag_of chunks later. As turns are taken in order, a thread waits only for turns that others have already
 * taken. */
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

/* Two particles that share a list may belong to two bodies, and the kernel pairs both with every entry. So float
 * records, whose positions are integers modulo 2^32, hold the bodies in parts of that range of their own. */
static void move_apart(struct sph_pairs *p, const double *x) {
  const double range = p->unit[p->apart_axis] * 0x1p32;
  const int bodies = p->options.body[p->n - 1] + 1;
  for (size_t i = 0; i < p->n; i++)
    p->apart[i] = x[i] + range * p->options.body[i] / bodies;
}

void sph_pairs_sum(struct sph_pairs *p, size_t n, const struct sph_pair_fields *f, sph_pairs_take *take,
                   void *context) {
  if (!p->units_chosen)
    choose_units(p, n, f);
  struct pass w = {.pairs = p, .fields = f, .constants = constants_of(p), .take = take, .context = context};
#pragma omp parallel for schedule(dynamic, 1) num_threads((int)p->threads) if (p->threads > 1)
  for (size_t k = 0; k < p->lists.count; k++) {
    struct sph_chunk *c = &p->lists.chunk[k];
    atomic_init(&c->summed, false);
    atomic_init(&c->delivered, false);
#define PAIR_MADE(term, count)                                                                                         \
  if (p->shape.term)                                                                                                   \
    p->kernels->make_##term(&p->options, f, c->first, c->first + c->own, p->made + MADE_##term);
#include "engine/sph/modules/declarations.h"
  }
  w.source = source_of(p, f);
  if (p->apart) {
    move_apart(p, w.source.column[PAIR_X + p->apart_axis]);
    w.source.column[PAIR_X + p->apart_axis] = p->apart;
  }
#pragma omp parallel num_threads((int)p->threads) if (p->threads > 1)
  take_turns(&w, (size_t)omp_get_thread_num());
  p->within = 2 * w.within;
}
