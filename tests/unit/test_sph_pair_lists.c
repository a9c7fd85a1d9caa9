/* Lists of neighbours: against brute force, shared by several particles, invalid after motion, bounded in memory. */

#include "engine/sph/pairs/lists.h"
#include "engine/sph/pairs/pairs.h"
#include "tests/bench/reference_sph.h"
#include "tests/support/allocated.h"
#include "tests/support/check.h"
#include "tests/support/pair_cloud.h"

static void swap_particles(struct cloud *c, size_t i, size_t j) {
  for (int k = 0; k < 4; k++) {
    const double kept = c->a[k][i];
    c->a[k][i] = c->a[k][j];
    c->a[k][j] = kept;
  }
}

/* Bounded by n and by pairs, whatever the extent: the cloud, and the same with every third particle spread over 1e12 m.
 */
TEST(memory_does_not_grow_with_the_extent) {
  OWNED struct cloud *c = cloud_make(SIDE, 1, false, 12);
  size_t bytes[2];
  for (int flung = 0; flung < 2; flung++) {
    struct sph_pairs *pairs;
    for (size_t i = 0; flung && i < c->n; i += 3)
      for (int k = 0; k < 3; k++)
        c->a[k][i] *= 1e11;
    const size_t before = allocated();
    OK(sph_pairs_create(c->n, &usual, &pairs, &error));
    OK(sph_pairs_list(pairs, c->n, c->a[0], c->a[1], c->a[2], c->a[3], c->slack, &error));
    bytes[flung] = (allocated() - before) / c->n;
    sph_pairs_free(pairs);
  }
  assert_in_range(bytes[0], 100, 1000);
  assert_true(bytes[1] <= bytes[0]);
}

/* Every pair within reach and no other, once, ascending: in open and periodic boxes, in every CPU class, cut into
 * chunks of any size, sorted in space or not at all, reaches 10:1, and with particles that are far off, not finite,
 * without reach or coincident. */
TEST(lists_equal_brute_force) {
  static const size_t chunks[] = {4096, 256, 100};
  for (int variant = 0; variant < 24; variant++) {
    const bool periodic = variant & 1, shuffled = variant & 2, odd = variant & 4;
    OWNED struct cloud *c = cloud_make(12, 1, true, 4);
    double length[3] = {periodic ? 12 : (double)NAN, NAN, periodic ? 15 : (double)NAN};
    for (size_t i = 0; i < c->n; i++)
      c->a[3][i] = periodic ? fmin(c->a[3][i], 3) : c->a[3][i];
    uint64_t seed = 5;
    for (size_t i = c->n; shuffled && i-- > 1;)
      swap_particles(c, i, (size_t)((noise(&seed) + 0.5) * (double)i));
    c->a[1][17] = 1e9, c->a[1][20] = -1e15;
    if (odd) {
      c->a[1][25] = NAN, c->a[0][300] = INFINITY, c->a[2][301] = -INFINITY, c->a[1][1000] = 1e200, c->a[3][700] = 0;
      for (int k = 0; k < 3; k++)
        c->a[k][40] = c->a[k][41], c->a[k][1200] = c->a[k][3];
    }
    OWNED_BY(reference_sph_lists_free) struct reference_sph_lists lists;
    const double *const place[3] = {c->a[0], c->a[1], c->a[2]};
    setenv("CLAST_CPU", classes[variant % 3], 1);
    assert_int_equal(reference_sph_lists_make(c->n, chunks[variant / 2 % 3], place, c->a[3], length, 1 + variant / 12,
                                              &lists, &error),
                     STATUS_OK);
    for (size_t i = 0; i < c->n; i++) {
      const uint32_t *j = lists.j + lists.start[i];
      size_t at = 0;
      for (size_t k = i + 1; k < c->n; k++) {
        double square = 0, reach = c->a[3][i] + c->a[3][k];
        for (int d = 0; d < 3; d++) {
          double along = c->a[d][i] - c->a[d][k];
          if (!isnan(length[d]))
            along -= length[d] * nearbyint(along / length[d]);
          square += along * along;
        }
        if (!(square < reach * reach))
          continue;
        assert_true(at < lists.count[i]);
        assert_int_equal(j[at++], k);
      }
      assert_int_equal(lists.count[i], at);
    }
  }
  unsetenv("CLAST_CPU");
}

/* A list for several particles contains the neighbours of all of them: sorted in space or not, with members far apart.
 */
TEST(shared_lists_join_those_of_their_members) {
  enum { CHUNK = 240 };
  for (int variant = 0; variant < 8; variant++) {
    const size_t share = variant & 1 ? 4 : 2;
    OWNED struct cloud *c = cloud_make(10, 1, variant & 4, 4);
    uint64_t seed = 5;
    for (size_t i = c->n; variant & 2 && i-- > 1;)
      swap_particles(c, i, (size_t)((noise(&seed) + 0.5) * (double)i));
    c->a[1][11] = 1e9, c->a[1][26] = -1e9, c->a[0][27] = 1e15, c->a[0][500] = NAN, c->n -= 1;
    OWNED_BY(reference_sph_lists_free) struct reference_sph_lists single;
    const double *const place[3] = {c->a[0], c->a[1], c->a[2]};
    OK(reference_sph_lists_make(c->n, CHUNK, place, c->a[3], usual.periodic, 1, &single, &error));
    struct sph_neighbours *neighbours = sph_neighbours_create(c->n, CHUNK, share, sph_pairs_kernels_choose());
    uint32_t start[CHUNK + 1], count[CHUNK];
    struct sph_neighbour_lists lists = {.start = start, .count = count};
    assert_int_equal(sph_neighbours_find(neighbours, c->n, place[0], place[1], place[2], c->a[3], usual.periodic, 1,
                                         &error),
                     STATUS_OK);
    for (size_t chunk = 0; chunk * CHUNK < c->n; chunk++) {
      const size_t base = chunk * CHUNK, own = c->n - base < CHUNK ? c->n - base : CHUNK;
      assert_true(sph_neighbours_list(neighbours, chunk, &lists));
      for (size_t g = 0; g * share < own; g++) {
        const size_t first = g * share, last = first + share < own ? first + share : own;
        char met[1000] = {0}, is_there[1000] = {0};
        for (size_t i = first; i < last; i++)
          for (size_t k = 0; k < single.count[base + i]; k++)
            met[single.j[single.start[base + i] + k]] = 1;
        assert_true(start[g] % SPH_LIST_ALIGN == 0 && start[g + 1] >= start[g] + count[g]);
        for (size_t k = 0; k < count[g]; k++) {
          const uint32_t j = lists.j[start[g] + k] & SPH_NUMBER, whose = lists.j[start[g] + k] >> SPH_TAGS;
          assert_true(j > first && (k == 0 || j > (lists.j[start[g] + k - 1] & SPH_NUMBER)));
          assert_true(met[base + j] || j < last);
          for (size_t i = first; i < last && j >= last; i++) {
            bool its = false;
            for (size_t m = 0; m < single.count[base + i]; m++)
              its |= single.j[single.start[base + i] + m] == base + j;
            assert_int_equal(whose >> (i - first) & 1, its);
          }
          is_there[base + j] = 1;
        }
        for (size_t k = count[g]; k < start[g + 1] - start[g]; k++)
          assert_int_equal(lists.j[start[g] + k], first);
        for (size_t j = 0; j < c->n; j++)
          assert_true(is_there[j] || !met[j]);
      }
    }
    free(lists.j);
    sph_neighbours_free(neighbours);
  }
}

TEST(thin_periodic_boxes_are_refused) {
  OWNED struct cloud *c = cloud_make(4, 1, false, 4);
  struct reference_sph_lists lists;
  const double length[3] = {NAN, 4, NAN}, *const place[3] = {c->a[0], c->a[1], c->a[2]};
  assert_int_equal(reference_sph_lists_make(c->n, 64, place, c->a[3], length, 1, &lists, &error), STATUS_CONTENT);
  assert_non_null(strstr(error.message, "too thin"));
}

/* Stale exactly when a pair could be missed: each particle may use up its slack by moving or by growing. */
TEST(lists_wear_out_with_the_slack) {
  OWNED struct cloud *c = cloud_make(6, 1, false, 5);
  struct sph_pairs *pairs;
  OK(sph_pairs_create(c->n, &usual, &pairs, &error));
  OK(sph_pairs_list(pairs, c->n, c->a[0], c->a[1], c->a[2], c->a[3], c->slack, &error));
  const double x = c->a[0][7], h = c->a[3][7];
  c->a[0][7] = x + 0.9 * c->slack[7];
  assert_true(fabs(slack_of(c, pairs) - 0.1 * c->slack[7]) < 1e-14);
  c->a[0][7] = x - 1.1 * c->slack[7];
  assert_true(slack_of(c, pairs) < 0);
  c->a[0][7] = x, c->a[3][7] = h + 1.1 * c->slack[7];
  assert_true(slack_of(c, pairs) < 0);
  c->a[0][7] = x + 0.6 * c->slack[7], c->a[3][7] = h + 0.6 * c->slack[7];
  assert_true(slack_of(c, pairs) < 0);
  sph_pairs_free(pairs);
}

/* Entries of shared lists have bits for the neighbour's number, and bits for the members it belongs to. */
TEST(float_takes_so_many_particles) {
  struct sph_pair_options options = usual;
  struct sph_pairs *pairs;
  options.fidelity.precision = SPH_FLOAT;
  assert_int_equal(sph_pairs_create((size_t)1 << 28, &options, &pairs, &error), STATUS_CONTENT);
  assert_null(pairs);
  assert_non_null(strstr(error.message, "268435455"));
}
