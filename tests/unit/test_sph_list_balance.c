/* Pairs move between lists so that most lists fill whole batches: no pair is lost or appears twice, and few lanes stay
 * empty. */

#include "engine/sph/pairs/lists.h"
#include "engine/sph/pairs/pairs.h"
#include "tests/support/check.h"
#include "tests/support/noise.h"

enum { SIDE = 11, MOST = SIDE * SIDE * SIDE };

struct cloud {
  double x[MOST + 7], y[MOST + 7], z[MOST + 7], reach[MOST + 7];
};

/* A jittered lattice of spacing 1, row by row; some particles are far off, not finite or coincident, some reach three
 * times as far. */
static struct cloud *cloud_make(bool odd) {
  struct cloud *c = calloc(1, sizeof *c);
  uint64_t seed = 12;
  assert_non_null(c);
  for (int i = 0; i < MOST; i++) {
    c->x[i] = i % SIDE + 0.2 * noise(&seed), c->y[i] = i / SIDE % SIDE + 0.2 * noise(&seed);
    c->z[i] = i / SIDE / SIDE + 0.2 * noise(&seed), c->reach[i] = odd && i % 50 == 0 ? 3.6 : 1.2;
  }
  if (odd)
    c->y[11] = 1e9, c->x[27] = 1e15, c->x[500] = NAN, c->z[700] = INFINITY, c->x[800] = c->x[801],
    c->y[800] = c->y[801];
  return c;
}

static bool is_near(const struct cloud *c, const double periodic[3], size_t i, size_t j) {
  double d[3] = {c->x[i] - c->x[j], c->y[i] - c->y[j], c->z[i] - c->z[j]}, square = 0;
  for (int k = 0; k < 3; k++) {
    if (periodic[k] > 0)
      d[k] -= periodic[k] * nearbyint(d[k] / periodic[k]);
    square += d[k] * d[k];
  }
  return square < pow(c->reach[i] + c->reach[j], 2);
}

/* Lists of one chunk whose own particles are those from `first` on, `own` of them; returns the idle lanes over all
 * lanes. */
static double check(const struct cloud *c, const double periodic[3], const struct sph_neighbours *neighbours,
                    size_t share, size_t chunk, size_t first, size_t own) {
  static char met[MOST][MOST];
  static uint32_t start[MOST + 1], count[MOST];
  struct sph_neighbour_lists lists = {.start = start, .count = count};
  size_t filled = 0, handed = 0;
  memset(met, 0, sizeof met);
  assert_true(sph_neighbours_list(neighbours, chunk, &lists) && sph_chunks_balance(own, share, &lists));
  for (size_t g = 0; g * share < own; g++) {
    bool foreign = false;
    assert_true(start[g] % SPH_LIST_ALIGN == 0 && start[g + 1] >= start[g] + count[g]);
    for (size_t k = start[g]; k < start[g] + count[g]; k++) {
      const size_t j = lists.j[k];
      assert_true(j < MOST - first && j != g * share);
      assert_true(j >= own || !foreign); /* foreign ones are at the end */
      foreign = j >= own;
      handed += j < g * share;
      for (size_t i = g * share; i < (g + 1) * share && i < own; i++)
        if (i != j && (j / share != g || i < j)) /* among themselves: once */
          assert_int_equal(met[i < j ? i : j][i < j ? j : i]++, 0);
    }
    for (size_t k = start[g] + count[g]; k < start[g + 1]; k++)
      assert_int_equal(lists.j[k], g * share);
    filled += count[g];
  }
  for (size_t i = 0; i < own; i++)
    for (size_t j = i + 1; first + j < MOST; j++)
      assert_true(met[i][j] || !is_near(c, periodic, first + i, first + j));
  assert_true(handed > own); /* several entries per list were moved */
  const double lanes = start[(own + share - 1) / share];
  free(lists.j);
  return 1 - (double)filled / lanes;
}

TEST(every_pair_is_met_once_and_batches_are_whole) {
  static const char *const classes[] = {"baseline", "v3", "v4"};
  (void)state;
  for (int variant = 0; variant < 48; variant++) {
    const size_t share = variant < 24 ? PAIR_GROUP_FLOAT : PAIR_GROUP_DOUBLE;
    const bool odd = variant & 1, periodic = variant & 2;
    const size_t size = variant & 4 ? 400 : MOST + 1;
    const double periods[3] = {periodic && !odd ? SIDE : (double)NAN, NAN, periodic ? 4 * 3.6 : (double)NAN};
    OWNED struct cloud *c = cloud_make(odd);
    assert_int_equal(setenv("CLAST_CPU", classes[variant / 8 % 3], 1), 0);
    struct sph_neighbours *n = sph_neighbours_create(MOST, size, share, sph_pairs_kernels_choose());
    OK(sph_neighbours_find(n, MOST, c->x, c->y, c->z, c->reach, periods, 1, &error));
    for (size_t chunk = 0; chunk * size < MOST; chunk++) {
      const size_t first = chunk * size, own = MOST - first < size ? MOST - first : size;
      const double idle = check(c, periods, n, share, chunk, first, own);
      /* without moving pairs, a sixth of the lanes or more is idle; idle lanes remain in the last lists, which have no
       * later list to give pairs to, and in lists without the right number */
      if (size > MOST)
        assert_true(idle < 0.04);
    }
    sph_neighbours_free(n);
  }
  unsetenv("CLAST_CPU");
}
