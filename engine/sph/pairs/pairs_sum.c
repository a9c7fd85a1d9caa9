/* The pass over all pairs: chunk by chunk, on one thread or several.
 *
 * A chunk (chunks.h) is summed in records of its own particles and of its halo, which stay in the cache meanwhile:
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
#include <string.h>
#ifdef _OPENMP
#include <omp.h>
#endif
#ifdef __SSE__
#include <xmmintrin.h>
#endif

#include "engine/sph/pairs/pairs_layout.h"

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
  const struct sph_pair_sums sums = sph_pairs_columns_sums(p, buffer);
  struct sph_pair_sink sink = sph_pairs_columns_sink(p, &sums);
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
  deliver(w, k, p->buffer + thread * SPH_PAIRS_BUFFER);
  atomic_store_explicit(&p->lists.chunk[k].delivered, true, memory_order_release);
}

/* A thread takes the next turn until there are none: even turns sum the chunks 0, 1, ..., odd turns deliver them,
 * sph_pairs_lag chunks later. As turns are taken in order, a thread waits only for turns that others have already
 * taken. */
static void take_turns(struct pass *w, size_t thread) {
  const size_t count = w->pairs->lists.count, lag = sph_pairs_lag(w->pairs);
  for (size_t turn; (turn = atomic_fetch_add(&w->next, 1)) < 2 * (count + lag);) {
    const size_t k = turn / 2;
    if (turn % 2 == 0 && k < count)
      sum_in_turn(w, k, thread);
    if (turn % 2 == 1 && k >= lag && k - lag < count)
      deliver_in_turn(w, k - lag, thread);
  }
}

void sph_pairs_sum(struct sph_pairs *p, size_t n, const struct sph_pair_fields *f, sph_pairs_take *take,
                   void *context) {
  if (!p->units_chosen)
    sph_pairs_columns_units(p, n, f);
  struct pass w = {.pairs = p,
                   .fields = f,
                   .constants = sph_pairs_columns_constants(p),
                   .take = take,
                   .context = context};
#ifdef _OPENMP
#pragma omp parallel for schedule(dynamic, 1) num_threads((int)p->threads) if (p->threads > 1)
#endif
  for (size_t k = 0; k < p->lists.count; k++) {
    struct sph_chunk *c = &p->lists.chunk[k];
    atomic_init(&c->summed, false);
    atomic_init(&c->delivered, false);
    if (p->artificial)
      p->kernels->oppose(p->options.artificial_stress.epsilon, f->stress, f->stress_factor, f->pressure_term, c->first,
                         c->first + c->own, p->opposed);
  }
  w.source = sph_pairs_columns_source(p, f);
#ifdef _OPENMP
#pragma omp parallel num_threads((int)p->threads) if (p->threads > 1)
  take_turns(&w, (size_t)omp_get_thread_num());
#else
  take_turns(&w, 0);
#endif
  p->within = 2 * w.within;
}
