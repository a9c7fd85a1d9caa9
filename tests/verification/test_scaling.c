/* Does `clast scaling` find the exponents of percolation, and do its intervals hold them? Page: scaling.md.
 *
 * Quick: small sizes, few samples. CLAST_FULL=1: the widths asked for (20 minutes), and other lattices. Of a size L the
 * samples are as 1/L of those of the smallest size; CLAST_SEEDS=n: n of those, whatever the widths. */

#include "analysis/inference/scaling.h"
#include "analysis/statistics/statistics.h"
#include "engine/random.h"
#include "schemas/memory.h"
#include "tests/support/check.h"

enum { GRID = 13, MOST_SIZES = 6, REPEATS = 20, LEAST_HELD = 17 };

/* What is occupied with probability p: a site, a bond between neighbours, or a bond between any two sites (of as many
 * as there are sites). Neighbours with and without the diagonal x + y: a triangular and a square lattice. */
enum kind { SITES, TRIANGULAR, BONDS, RANDOM };

struct law {
  const char *name;
  enum kind kind;
  int dimensions;
  bool periodic;
  size_t sizes, samples; /* samples of the smallest size */
  uint32_t size[MOST_SIZES];
  double middle, step, nu;      /* the p are middle + k step L^(-1/nu), k from -6 to 6 */
  double exact[SCALING_VALUES]; /* p_c, nu, beta/nu, gamma/nu, D, tau */
  double widest[SCALING_VALUES];
};

#define PLANE 4.0 / 3, 5.0 / 48, 43.0 / 24, 91.0 / 48, 187.0 / 91
#define AT(p, p_c)                                                                                                     \
  p, 0.14, 4.0 / 3, {                                                                                                  \
    p_c, PLANE                                                                                                         \
  }
#define NONE HUGE_VAL, HUGE_VAL, HUGE_VAL, HUGE_VAL, HUGE_VAL, HUGE_VAL
#define SMALL                                                                                                          \
  5, 2000, {                                                                                                           \
    20, 36, 64, 115, 207                                                                                               \
  }
static const struct law quick =
    {"square, sites, periodic",           SITES, 2, true, 4, 1600, {20, 36, 64, 115}, AT(0.593, 0.592746),
     {0.006, 0.55, 0.055, 0.2, 0.27, 0.1}};
static const struct law asked = {"square, sites, periodic",
                                 SITES,
                                 2,
                                 true,
                                 6,
                                 60000,
                                 {36, 65, 117, 210, 378, 680},
                                 AT(0.593, 0.592746),
                                 {0.001, 0.05, 0.005, 0.02, HUGE_VAL, 0.015}};
/* Open sides: the corrections of the border fall as 1/L. Bonds of a random graph: those of the mean field fall as
 * N^(-1/3) = L^(-2/3), more slowly than the intervals take account of. The cubic lattice: p_c and exponents of Wang and
 * others 2013 (doi 10.1103/PhysRevE.87.052107), tau by hyperscaling. */
static const struct law others[] = {
    {"square, sites, open sides", SITES, 2, false, SMALL, AT(0.593, 0.592746), {NONE}},
    {"square, bonds, periodic", BONDS, 2, true, SMALL, AT(0.5, 0.5), {NONE}},
    {"square, bonds, open sides", BONDS, 2, false, SMALL, AT(0.5, 0.5), {NONE}},
    {"triangular, sites, periodic", TRIANGULAR, 2, true, SMALL, AT(0.5, 0.5), {NONE}},
    {"random graph", RANDOM, 2, true, SMALL, 0.5, 0.165, 1.5, {0.5, 1.5, 2.0 / 3, 2.0 / 3, 4.0 / 3, 2.5}, {NONE}},
    {"cubic, sites, periodic",
     SITES,
     3,
     true,
     5,
     2000,
     {8, 12, 18, 27, 40},
     0.3116,
     0.14,
     0.8764,
     {0.311608, 0.8764, 0.47705, 2.0459, 2.52295, 1 + 3 / 2.52295},
     {NONE}},
};

/* ---- clusters: union and find ---- */

struct lattice {
  const struct law *law;
  uint32_t length, sites, items;   /* items: sites or bonds that may be occupied */
  uint32_t *parent, *size, *order; /* order: items to be occupied later, at the p number step */
  uint8_t *step;
  uint64_t random;
  uint64_t largest;
  double squares, cubes; /* of all clusters */
};

static uint32_t root(struct lattice *l, uint32_t i) {
  while (l->parent[i] != i)
    i = l->parent[i] = l->parent[l->parent[i]];
  return i;
}

static void join(struct lattice *l, uint32_t i, uint32_t j) {
  uint32_t a = root(l, i), b = root(l, j);
  if (a == b)
    return;
  if (l->size[a] < l->size[b]) {
    const uint32_t c = a;
    a = b;
    b = c;
  }
  const double p = l->size[a], q = l->size[b];
  l->parent[b] = a;
  l->size[a] += l->size[b];
  l->squares += 2 * p * q;
  l->cubes += 3 * p * q * (p + q);
  if (l->size[a] > l->largest)
    l->largest = l->size[a];
}

static uint64_t next_random(uint64_t *state) { /* splitmix64 (Steele, Lea & Flood 2014) */
  uint64_t z = *state += UINT64_C(0x9e3779b97f4a7c15);
  z = (z ^ z >> 30) * UINT64_C(0xbf58476d1ce4e5b9);
  z = (z ^ z >> 27) * UINT64_C(0x94d049bb133111eb);
  return z ^ z >> 31;
}

static void add_site(struct lattice *l, uint32_t i) {
  l->parent[i] = i;
  l->size[i] = 1;
  l->squares += 1;
  l->cubes += 1;
  if (l->largest == 0)
    l->largest = 1;
}

static void join_if(struct lattice *l, bool linked, uint32_t i, uint32_t j) {
  if (linked && l->size[j])
    join(l, i, j);
}

static void occupy(struct lattice *l, uint32_t item) {
  const struct law *law = l->law;
  if (law->kind == RANDOM) {
    const uint32_t i = (uint32_t)(next_random(&l->random) % l->sites);
    join(l, i, (uint32_t)(next_random(&l->random) % l->sites));
    return;
  }
  const bool bond = law->kind == BONDS;
  const uint32_t axes = (uint32_t)law->dimensions, i = bond ? item / axes : item;
  uint32_t up[3], down[3], stride = 1, rest = i;
  if (!bond)
    add_site(l, i);
  for (uint32_t d = 0; d < axes; d++, stride *= l->length) {
    const uint32_t x = rest % l->length, row = stride * l->length;
    rest /= l->length;
    up[d] = x + 1 < l->length ? i + stride : i + stride - row;
    down[d] = x > 0 ? i - stride : i - stride + row;
    join_if(l, (law->periodic || x + 1 < l->length) && (!bond || d == item % axes), i, up[d]);
    join_if(l, (law->periodic || x > 0) && !bond, i, down[d]);
  }
  join_if(l, law->kind == TRIANGULAR, i, up[0] + up[1] - i);
  join_if(l, law->kind == TRIANGULAR, i, down[0] + down[1] - i);
}

/* One sample: each item has a number in 0..1 and is occupied where p is above it. Items are added from one p of the
 * grid to the next, so that all p share a sample, as the points of a campaign share a seed. */
static void sample(struct lattice *l, uint64_t seed, const double *grid, struct scaling_run *runs) {
  uint32_t count[GRID + 1] = {0}, later = 0;
  l->random = seed;
  memset(l->size, 0, l->sites * sizeof *l->size);
  l->largest = 0;
  l->squares = l->cubes = 0;
  for (uint32_t i = 0; i < l->sites && l->law->kind >= BONDS; i++)
    add_site(l, i);
  for (uint32_t i = 0; i < l->items; i++) {
    const double u = random_uniform(next_random(&l->random));
    if (u < grid[0])
      occupy(l, i);
    else if (u < grid[GRID - 1]) {
      size_t k = 1;
      while (u >= grid[k])
        k++;
      l->order[later] = i;
      l->step[later++] = (uint8_t)k;
      count[k]++;
    }
  }
  for (size_t k = 0; k < GRID; k++) {
    for (uint32_t i = 0; i < later && count[k]; i++)
      if (l->step[i] == k)
        occupy(l, l->order[i]);
    const double n = (double)l->sites, m = (double)l->largest;
    runs[k] = (struct scaling_run){(double)l->length,         grid[k], seed, m / n, m / n, (l->squares - m * m) / n,
                                   (l->cubes - m * m * m) / n};
  }
}

static size_t make(const struct law *law, uint64_t repeat, struct scaling_run *runs) {
  size_t n = 0;
  for (size_t i = 0; i < law->sizes; i++) {
    struct lattice l = {.law = law, .length = law->size[i], .sites = 1};
    for (int d = 0; d < law->dimensions; d++)
      l.sites *= l.length;
    l.items = l.sites * (law->kind == BONDS ? (uint32_t)law->dimensions : 1);
    l.parent = malloc(l.sites * sizeof *l.parent);
    l.size = malloc(l.sites * sizeof *l.size);
    l.order = malloc(l.items * sizeof *l.order);
    l.step = malloc(l.items);
    double grid[GRID];
    for (size_t k = 0; k < GRID; k++)
      grid[k] = law->middle + law->step * ((double)k - GRID / 2) * pow((double)l.length, -1 / law->nu);
    for (size_t r = 0; r < law->samples * law->size[0] / law->size[i]; r++, n += GRID)
      sample(&l, (uint64_t)(random_draw(repeat, 100, i, r) * 0x1p62), grid, runs + n);
    free(l.parent);
    free(l.size);
    free(l.order);
    free(l.step);
  }
  return n;
}

/* Repeats of a law: how often the intervals hold the exact values, and their widths. */
static void check(const struct law *given, bool judge) {
  struct law chosen = *given, *law = &chosen;
  const char *seeds = getenv("CLAST_SEEDS");
  if (seeds)
    law->samples = (size_t)atoi(seeds);
  static const char *const names[] = {"p_c", "nu", "beta/nu", "gamma/nu", "D", "tau"};
  OWNED struct scaling_run *runs = malloc(law->samples * GRID * law->sizes * sizeof *runs);
  int held[SCALING_VALUES] = {0};
  double widths[SCALING_VALUES][REPEATS], off[SCALING_VALUES] = {0}, square[SCALING_VALUES] = {0};
  double quality[4] = {0};
  assert_non_null(runs);
  for (uint64_t repeat = 1; repeat <= REPEATS; repeat++) {
    SCALING found = {0};
    OK(scaling_find(make(law, repeat, runs), runs, law->dimensions, &found, &error));
    assert_int_equal(found.kind, SCALING_FOUND);
    for (int v = 0; v < SCALING_VALUES; v++) {
      const double half = found.value[v].half_width, error_of = found.value[v].estimate - law->exact[v];
      held[v] += fabs(error_of) <= half;
      widths[v][repeat - 1] = half;
      off[v] += error_of / REPEATS;
      square[v] += error_of * error_of / REPEATS;
    }
    for (int k = 0; k < 4; k++)
      quality[k] += (k < 2 ? found.chi_square[k] : found.distance[k - 2]) / REPEATS;
  }
  printf("%s, L %u to %u, %zu samples to %zu; chi-square of P %.1f, of S %.1f; distance %.3f, %.3f\n", law->name,
         law->size[0], law->size[law->sizes - 1], law->samples, law->samples * law->size[0] / law->size[law->sizes - 1],
         quality[0], quality[1], quality[2], quality[3]);
  printf("| value | exact | held of %d | half width: median | widest | asked | mean error | rms error |\n"
         "|---|---|---|---|---|---|---|---|\n",
         REPEATS);
  for (int v = 0; v < SCALING_VALUES; v++) {
    qsort(widths[v], REPEATS, sizeof widths[v][0], sample_ascending);
    printf("| %s | %.5f | %d | %.5f | %.5f | %g | %.5f | %.5f |\n", names[v], law->exact[v], held[v],
           (widths[v][REPEATS / 2 - 1] + widths[v][REPEATS / 2]) / 2, widths[v][REPEATS - 1], law->widest[v], off[v],
           sqrt(square[v]));
  }
  for (int v = 0; judge && v < SCALING_VALUES; v++) {
    assert_true(held[v] >= LEAST_HELD);
    assert_true(seeds || widths[v][REPEATS - 1] <= law->widest[v]);
  }
}

TEST(percolation_on_the_square_lattice) {
  check(getenv("CLAST_FULL") ? &asked : &quick, true);
}

TEST(other_laws) {
  for (size_t k = 0; getenv("CLAST_FULL") && k < sizeof others / sizeof *others; k++)
    check(&others[k], false);
}
