/* Union-find against a flood fill on random graphs; the mechanics of a fragment against explicit sums. */

#include "engine/fragments.h"
#include "engine/outcome.h"
#include "engine/random.h"
#include "tests/support/check.h"

enum { N = 60 };

TEST(labels_match_flood_fill) {
  for (uint64_t seed = 0; seed < 200; seed++) {
    double mass[N];
    uint32_t links[N][2], label[N];
    for (uint32_t i = 0; i < N; i++) {
      mass[i] = 1 + floor(4 * random_draw(seed, 1, i, 0)); /* few values: ties happen */
      links[i][0] = (uint32_t)(N * random_draw(seed, 1, i, 1));
      links[i][1] = (uint32_t)(N * random_draw(seed, 1, i, 2));
    }
    size_t link_count = seed % N;
    size_t count = fragments_label(N, mass, link_count, (const uint32_t(*)[2])links, label);

    int group[N]; /* flood fill: repeat until nothing changes */
    for (int i = 0; i < N; i++)
      group[i] = i;
    for (bool changed = true; changed;) {
      changed = false;
      for (size_t k = 0; k < link_count; k++) {
        int *a = &group[links[k][0]], *b = &group[links[k][1]];
        if (*a != *b) {
          *a = *b = *a < *b ? *a : *b;
          changed = true;
        }
      }
    }
    double total[N] = {0};
    uint32_t first[N];
    memset(first, 0xff, sizeof first);
    for (uint32_t i = 0; i < N; i++) {
      for (uint32_t j = 0; j < N; j++)
        assert_true((label[i] == label[j]) == (group[i] == group[j]));
      assert_true(label[i] < count);
      total[label[i]] += mass[i];
      if (first[label[i]] == UINT32_MAX)
        first[label[i]] = i;
    }
    for (size_t k = 1; k < count; k++)
      assert_true(total[k - 1] > total[k] || (total[k - 1] == total[k] && first[k - 1] < first[k]));
  }
}

TEST(order_of_links_does_not_matter) {
  const double mass[5] = {1, 1, 1, 1, 1};
  const uint32_t links[3][2] = {{0, 4}, {4, 2}, {1, 3}}, reversed[3][2] = {{3, 1}, {2, 4}, {4, 0}};
  uint32_t a[5], b[5];
  assert_int_equal(fragments_label(5, mass, 3, links, a), 2);
  assert_int_equal(fragments_label(5, mass, 3, reversed, b), 2);
  assert_memory_equal(a, b, sizeof a);
  assert_int_equal(a[2], 0);
  assert_int_equal(a[3], 1);
}

static void near(double a, double b) {
  if (!(fabs(a - b) <= 1e-14 * (1 + fabs(b)))) /* a handful of roundings */
    fail_msg("%.17g is not %.17g", a, b);
}

TEST(dumbbell) {
  /* masses 1 and 3 turning as one body at 2 rad/s about their centre of mass, which moves at (5, -1); a third grain
   * apart. Reduced mass 0.75 at distance sqrt(20): I = 15 + own moments. */
  const struct fragment_member members[3] =
      {/* v = (5, -1) + 2 x (-y, x) at (-3, 1.5) and (1, -0.5): distances sqrt(11.25), sqrt(1.25) */
       {.mass = 1, .position = {-3, 1.5, 0}, .velocity = {5 - 3, -1 - 6, 0}, .spin = 2, .moment_of_inertia = 0.25},
       {.mass = 3, .position = {1, -0.5, 0}, .velocity = {5 + 1, -1 + 2, 0}, .spin = 2, .moment_of_inertia = 0.5},
       {.mass = 0.5, .position = {9, 9, 0}, .velocity = {1, 0, 0}, .spin = -7, .moment_of_inertia = 0.125}};
  const uint32_t links[1][2] = {{1, 0}};
  struct fragment *f;
  size_t count;
  assert_int_equal(fragments_find(false, 3, members, 1, links, NULL, &f, &count, NULL), STATUS_OK);
  assert_int_equal(count, 2);
  near(f[0].mass, 4);
  near(f[0].position[0], 0);
  near(f[0].velocity[0], 5);
  near(f[0].velocity[1], -1);
  near(f[0].moment_of_inertia, 15.75);
  near(f[0].spin[2], 2);
  near(f[0].kinetic_energy, 0.5 * 4 * 26 + 0.5 * 15.75 * 4);
  assert_int_equal(f[0].count, 2);
  assert_int_equal(f[0].first, 0);
  near(f[1].spin[2], -7);
  near(f[1].moment_of_inertia, 0.125);
  struct outcome outcome = {0};
  outcome_fragments(&outcome, count, f, &(struct outcome_small){.dust = NAN, .complete = 3});
  assert_int_equal(outcome.single_count, 1);
  near(outcome.total_mass, 4.5);
  near(outcome.dust_fraction, 0.5 / 4.5);
  near(outcome.complete_mass, 3);
  struct outcome heavy = {0}; /* dust means lighter than a mass, however many grains a fragment has */
  outcome_fragments(&heavy, count, f, &(struct outcome_small){.dust = 4.1, .complete = 3});
  near(heavy.dust_fraction, 1);
  assert_int_equal(heavy.single_count, 1);
  outcome_fragments(&heavy, count, f, &(struct outcome_small){.dust = 0.5, .complete = 3});
  near(heavy.dust_fraction, 0);
  near(outcome.largest_fraction, 4 / 4.5);
  near(outcome.mean_fragment_mass, 16.25 / 4.5);
  near(outcome.mean_fragment_mass_rest, 0.5);
  const struct fragment chips[] = {{.mass = 1, .count = 9}, {.mass = 3e-9, .count = 1}, {.mass = 1e-9, .count = 1}};
  outcome_fragments(&heavy, 3, chips, &(struct outcome_small){.dust = NAN, .complete = 1}); /* a body and two chips */
  near(heavy.mean_fragment_mass_rest * 1e9, 2.5);
  outcome_fragments(&heavy, 1, chips, &(struct outcome_small){.dust = NAN, .complete = 1});
  assert_true(heavy.mean_fragment_mass_rest == 0);
  free(f);
  assert_int_equal(fragments_find(false, 0, NULL, 0, NULL, NULL, &f, &count, NULL), STATUS_OK);
  assert_null(f);
}
