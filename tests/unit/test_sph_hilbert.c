/* The order of particles along Hilbert's curve. */

#include "engine/sph/body/kd_tree.h"
#include "tests/support/check.h"
#include "tests/support/noise.h"

enum { SIDE = 12, COUNT = SIDE * SIDE * SIDE, GRID = 16, CELLS = GRID * GRID * GRID };

TEST(a_permutation_that_keeps_neighbours_near) {
  static double x[3][COUNT];
  static uint32_t order[COUNT];
  char seen[COUNT] = {0};
  uint64_t seed = 5;
  for (int i = 0; i < COUNT; i++) { /* a jittered cubic lattice */
    const int at[3] = {i % SIDE, i / SIDE % SIDE, i / SIDE / SIDE};
    for (int d = 0; d < 3; d++)
      x[d][i] = at[d] + 0.5 + 0.2 * noise(&seed);
  }
  x[2][3] = 1e9; /* the rest must not fall into one cell */
  OK(sph_hilbert_find(COUNT, x[0], x[1], x[2], order, &error));
  double step = 0;
  for (size_t k = 0; k < COUNT; k++) {
    assert_in_range(order[k], 0, COUNT - 1);
    assert_false(seen[order[k]]);
    seen[order[k]] = 1;
    if (k && order[k] != 3 && order[k - 1] != 3) {
      const uint32_t i = order[k], j = order[k - 1];
      step += sqrt(pow(x[0][i] - x[0][j], 2) + pow(x[1][i] - x[1][j], 2) + pow(x[2][i] - x[2][j], 2));
    }
  }
  assert_true(step / COUNT < 2.5); /* spacing 1; drawn at random it would be about 8 */
}

/* Hilbert's curve goes from each cell of a grid to one that shares a face with it. */
TEST(from_cell_to_cell_by_faces) {
  static double x[3][CELLS];
  static uint32_t order[CELLS];
  for (size_t i = 0; i < CELLS; i++)
    x[0][i] = (double)(i % GRID), x[1][i] = (double)(i / GRID % GRID), x[2][i] = (double)(i / GRID / GRID);
  OK(sph_hilbert_find(CELLS, x[0], x[1], x[2], order, &error));
  for (size_t k = 1; k < CELLS; k++) {
    double way = 0;
    for (int d = 0; d < 3; d++)
      way += fabs(x[d][order[k]] - x[d][order[k - 1]]);
    assert_true(way == 1);
  }
}

/* The order depends only on places and numbers. */
TEST(ties_stand_by_number) {
  static double x[3][COUNT];
  static uint32_t order[COUNT];
  for (int i = 0; i < COUNT; i++)
    x[0][i] = i % 2, x[1][i] = x[2][i] = 0;
  OK(sph_hilbert_find(COUNT, x[0], x[1], x[2], order, &error));
  for (uint32_t k = 1; k < COUNT; k++)
    assert_true(k == COUNT / 2 ? order[k] % 2 != order[k - 1] % 2 : order[k] == order[k - 1] + 2);
  OK(sph_hilbert_find(0, NULL, NULL, NULL, NULL, &error));
}
