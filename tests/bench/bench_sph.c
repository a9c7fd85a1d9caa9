/* Speed of the SPH solid on one core: `name value unit` per line.
 *
 * First the pair loop alone, on a resting sphere of basalt with drawn velocities and stresses: time per particle, pairs
 * and flops per second against the peak rate of the core's multiply-add units, the frozen plain C loop
 * (reference_sph.c), float against double, threads. Then whole steps and whole runs (sph_whole_runs.h). An argument
 * selects one part: pairs, sizes, modules, threads, run, 10000 or 100000; all parts together take about a quarter of an
 * hour on one core. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "engine/cpu_class.h"
#include "engine/sph/body/bodies.h"
#include "engine/sph/body/kd_tree.h"
#include "engine/sph/pairs/pairs.h"
#include "tests/bench/reference_sph.h"
#include "tests/bench/sph_whole_runs.h"
#include "tests/support/allocated.h"
#include "tests/support/noise.h"
#include "tests/support/pair_sums.h"

enum { COLUMNS = 17, SUMS = 14, FLOPS = 139 }; /* per pair, counted in pairs_kernels_sum.h: an inverse or a root is 1 */

static _Noreturn void fail(const char *what, const struct error *error) {
  fprintf(stderr, "bench_sph: %s %s\n", what, error ? error->message : "");
  exit(70);
}

static double clock_of(clockid_t id) {
  struct timespec t;
  clock_gettime(id, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static double now(void) {
  return clock_of(CLOCK_PROCESS_CPUTIME_ID);
}

struct cloud {
  size_t n;
  /* acting: S/rho^2, the input of the reference */
  double *column[COLUMNS], *sum[SUMS], *slack, *other[SUMS], *acting[6];
  struct sph_pair_fields fields;
  struct sph_pair_sums sums;
};

static double *column(size_t n) {
  double *a = calloc(n + 7, sizeof *a); /* neighbours.c reads up to 7 elements beyond n */
  if (!a)
    fail("memory", NULL);
  return a;
}

static void cloud_make(size_t wanted, struct cloud *c) {
  struct error error = {0};
  struct sph_particles *p = NULL;
  struct sph_range range;
  struct sph_body body = {.shape = {.kind = SPH_SHAPE_SPHERE, .radius = 0.03}, .density = 2700, .h_over_spacing = NAN};
  body.lattice.particles = (double)wanted;
  if (sph_bodies_make(&body, 1, 0, &p, &range, &error) != STATUS_OK)
    fail("set-up:", &error);
  uint32_t *order = malloc(p->n * sizeof *order);
  if (!order || sph_hilbert_find(p->n, p->x, p->y, p->z, order, &error) != STATUS_OK)
    fail("order:", &error);
  uint64_t seed = 1;
  c->n = p->n;
  for (int k = 0; k < COLUMNS; k++)
    c->column[k] = column(c->n);
  for (int k = 0; k < SUMS; k++)
    c->sum[k] = column(c->n), c->other[k] = column(c->n);
  c->slack = column(c->n);
  for (int k = 0; k < 6; k++)
    c->acting[k] = column(c->n);
  for (size_t i = 0; i < c->n; i++) {
    const size_t from = order[i];
    const double *const at[4] = {p->x, p->y, p->z, p->h};
    for (int k = 0; k < 4; k++)
      c->column[k][i] = at[k][from];
    for (int k = 4; k < 7; k++)
      c->column[k][i] = 10 * noise(&seed);
    c->column[7][i] = p->mass[from], c->column[8][i] = p->density[from], c->column[9][i] = 3100;
    c->column[10][i] = 1e8 / (2700.0 * 2700.0) * noise(&seed);
    for (int k = 0; k < 5; k++)
      c->column[11 + k][i] = 1e8 * noise(&seed);
    c->column[16][i] = 1 / (2700.0 * 2700.0);
    for (int k = 0; k < 6; k++)
      c->acting[k][i] = c->column[16][i] * (k < 5 ? c->column[11 + k][i] : -(c->column[11][i] + c->column[14][i]));
    c->slack[i] = 0.05 * p->h[from];
  }
  double **a = c->column, **s = c->sum;
  c->fields = (struct sph_pair_fields){.x = a[0],
                                       .y = a[1],
                                       .z = a[2],
                                       .h = a[3],
                                       .vx = a[4],
                                       .vy = a[5],
                                       .vz = a[6],
                                       .mass = a[7],
                                       .density = a[8],
                                       .sound_speed = a[9],
                                       .pressure_term = a[10],
                                       .stress_factor = a[16]};
  for (int k = 0; k < 5; k++)
    c->fields.stress[k] = a[11 + k];
  c->sums = (struct sph_pair_sums){.ax = s[0], .ay = s[1], .az = s[2], .heating = s[12], .signal = s[13]};
  for (int k = 0; k < 9; k++)
    c->sums.gradient[k] = s[3 + k];
  free(order);
  sph_particles_free(p);
}

static void cloud_free(struct cloud *c) {
  for (int k = 0; k < COLUMNS; k++)
    free(c->column[k]);
  for (int k = 0; k < 6; k++)
    free(c->acting[k]);
  for (int k = 0; k < SUMS; k++)
    free(c->sum[k]), free(c->other[k]);
  free(c->slack);
}

static const struct sph_pair_options usual = {.viscosity = {.alpha = 1.5, .beta = 3},
                                              .strength = true,
                                              .spacing_over_h = 0.9,
                                              .periodic = {NAN, NAN, NAN},
                                              .fidelity.threads = 1};

/* Shortest time of one pass, s; *listing: shortest time of making the lists, s. */
static double pass(struct cloud *c, const struct sph_pair_options *options, clockid_t clock, double *listing,
                   double *neighbours, size_t *bytes) {
  struct sph_pairs *pairs = NULL;
  struct error error = {0};
  double best = INFINITY;
  *listing = INFINITY;
  double *const *a = c->column;
  const size_t before = allocated();
  if (sph_pairs_create(c->n, options, &pairs, &error) != STATUS_OK)
    fail("create:", &error);
  for (int k = 0; k < 3; k++) {
    const double start = now();
    if (sph_pairs_list(pairs, c->n, a[0], a[1], a[2], a[3], c->slack, &error) != STATUS_OK)
      fail("list:", &error);
    *listing = fmin(*listing, now() - start);
  }
  const int repeats = (int)(4e5 / (double)c->n) + 1;
  for (int k = 0; k < 6; k++) {
    const double start = clock_of(clock);
    for (int r = 0; r < repeats; r++)
      sph_pairs_sum(pairs, c->n, &c->fields, pair_sums_keep, &c->sums);
    best = fmin(best, (clock_of(clock) - start) / repeats);
  }
  *neighbours = sph_pairs_neighbours(pairs);
  *bytes = allocated() - before;
  sph_pairs_free(pairs);
  return best;
}

static double reference(const struct cloud *c) {
  struct reference_sph_lists lists;
  struct error error = {0};
  double *const *a = c->column, *reach = column(c->n), best = INFINITY;
  for (size_t i = 0; i < c->n; i++)
    reach[i] = a[3][i] + c->slack[i];
  if (reference_sph_lists_make(c->n, 4096, (const double *const *)a, reach, usual.periodic, 1, &lists, &error) !=
      STATUS_OK)
    fail("reference lists:", &error);
  struct sph_pair_sums sums = c->sums;
  sums.ax = c->other[0], sums.ay = c->other[1], sums.az = c->other[2], sums.heating = c->other[12],
  sums.signal = c->other[13];
  for (int k = 0; k < 9; k++)
    sums.gradient[k] = c->other[3 + k];
  for (int k = 0; k < 3; k++) {
    const double start = now();
    reference_sph_sum(c->n, lists.start, lists.count, lists.j, &usual, &c->fields, (const double *const *)c->acting,
                      NULL, &sums);
    best = fmin(best, now() - start);
  }
  reference_sph_lists_free(&lists);
  free(reach);
  return best;
}

/* Root mean square difference of accelerations over their root mean square value. */
static double difference(const struct cloud *c) {
  double square = 0, scale = 0;
  for (int k = 0; k < 3; k++)
    for (size_t i = 0; i < c->n; i++) {
      square += pow(c->sum[k][i] - c->other[k][i], 2);
      scale += pow(c->other[k][i], 2);
    }
  return sqrt(square / scale);
}

/* Peak rate of the core, flop/s: multiply-adds of independent registers. */
#if defined(__x86_64__) && defined(__GNUC__)
#define PEAK(name, level, real, bytes)                                                                                 \
  __attribute__((target("arch=x86-64-" level))) static double name(void) {                                             \
    typedef real vector __attribute__((vector_size(bytes)));                                                           \
    vector s[16];                                                                                                      \
    const vector f = (vector){0} + (real)0.999999, g = (vector){0} + (real)1e-6;                                       \
    const int rounds = 10000000;                                                                                       \
    for (int k = 0; k < 16; k++)                                                                                       \
      s[k] = f * (real)k;                                                                                              \
    const double start = now();                                                                                        \
    for (int r = 0; r < rounds; r++)                                                                                   \
      for (int k = 0; k < 16; k++) {                                                                                   \
        s[k] = s[k] * f + g;                                                                                           \
        __asm__("" : "+v"(s[k]));                                                                                      \
      }                                                                                                                \
    const double spent = now() - start;                                                                                \
    volatile real keep = 0;                                                                                            \
    for (int k = 0; k < 16; k++)                                                                                       \
      keep += s[k][0];                                                                                                 \
    return 2.0 * 16 * rounds * (double)(bytes / sizeof(real)) / spent;                                                 \
  }
PEAK(peak_v4_double, "v4", double, 64)
PEAK(peak_v3_double, "v3", double, 32)
static double peak(void) {
  const char *name = sph_pairs_kernels_choose()->name;
  return !strcmp(name, "v4") ? peak_v4_double() : !strcmp(name, "v3") ? peak_v3_double() : (double)NAN;
}
#else
static double peak(void) {
  return (double)NAN;
}
#endif

static void pairs(const char *name, size_t n) {
  struct cloud c;
  double listing, neighbours;
  size_t bytes;
  struct sph_pair_options options = usual;
  cloud_make(n, &c);
  const double real = (double)c.n, plain = reference(&c);
  const double spent = pass(&c, &options, CLOCK_PROCESS_CPUTIME_ID, &listing, &neighbours, &bytes),
               rate = real * neighbours / 2 / spent;
  printf("sph_pairs_ns_per_particle_%s %.1f ns\n", name, 1e9 * spent / real);
  printf("sph_pairs_neighbours_%s %.1f 1\n", name, neighbours);
  printf("sph_pairs_per_s_%s %.4g pairs/s\n", name, rate);
  printf("sph_pairs_flops_per_pair %d 1\n", FLOPS);
  printf("sph_pairs_share_of_peak_%s %.3f 1\n", name, rate * FLOPS / peak());
  printf("sph_pairs_listing_ns_per_particle_%s %.1f ns\n", name, 1e9 * listing / real);
  printf("sph_pairs_bytes_per_particle_%s %.0f B\n", name, (double)bytes / real);
  printf("sph_reference_ns_per_particle_%s %.1f ns\n", name, 1e9 * plain / real);
  printf("sph_pairs_ratio_to_reference_%s %.3g 1\n", name, plain / spent);
  printf("sph_pairs_difference_%s %.2e 1\n", name, difference(&c));
  options.fidelity.precision = SPH_FLOAT;
  const double shorter = pass(&c, &options, CLOCK_PROCESS_CPUTIME_ID, &listing, &neighbours, &bytes);
  printf("sph_pairs_ns_per_particle_%s_float %.1f ns\n", name, 1e9 * shorter / real);
  printf("sph_pairs_ratio_float_%s %.3g 1\n", name, spent / shorter);
  printf("sph_pairs_listing_ns_per_particle_%s_float %.1f ns\n", name, 1e9 * listing / real);
  printf("sph_pairs_bytes_per_particle_%s_float %.0f B\n", name, (double)bytes / real);
  printf("sph_pairs_difference_%s_float %.2e 1\n", name, difference(&c));
  options.fidelity.precision = SPH_DOUBLE;
  const double wall = pass(&c, &options, CLOCK_MONOTONIC, &listing, &neighbours, &bytes);
  options.fidelity.threads = 2;
  printf("sph_pairs_threads_2_ratio_%s %.3g 1\n", name,
         wall / pass(&c, &options, CLOCK_MONOTONIC, &listing, &neighbours, &bytes));
  cloud_free(&c);
}

int main(int argc, char **argv) {
  const char *only = argc > 1 ? argv[1] : "";
  printf("sph_cpu_class %d 1\n", (int)cpu_class_choose()); /* 1 baseline, 3 AVX2, 4 AVX-512 */
  if (!*only || !strcmp(only, "pairs")) {
    pairs("10000", 10000);
    pairs("100000", 100000);
  }
  if (!*only || !strcmp(only, "sizes"))
    sph_whole_runs_sizes();
  if (!*only || !strcmp(only, "modules"))
    sph_whole_runs_modules();
  if (!*only || !strcmp(only, "threads"))
    sph_whole_runs_threads();
  if (!*only || !strcmp(only, "run") || !strcmp(only, "10000"))
    sph_whole_runs_figures("10000", "10000");
  if (!*only || !strcmp(only, "run") || !strcmp(only, "100000"))
    sph_whole_runs_figures("100000", "100000");
  return 0;
}
