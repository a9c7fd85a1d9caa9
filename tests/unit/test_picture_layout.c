/* Fragments side by side: none hides another, the heaviest is kept; and the visible part of fragments in a heap. */
#include <math.h>
#include <stdlib.h>

#include "analysis/pictures/picture_layout.h"
#include "engine/random.h"
#include "tests/support/check.h"

enum { PIECES = 30, EACH = 40, DISCS = PIECES * EACH };

/* A heap of fragments that cover each other; fragment 0 is the heaviest. */
static void make_heap(struct picture_cloud *cloud, struct picture_layout_disc *discs) {
  for (uint32_t i = 0; i < DISCS; i++) {
    const uint64_t piece = i / EACH;
    cloud->fragment[i] = (int64_t)piece;
    cloud->part[i] = PICTURE_CORE;
    const double x = 5 * random_draw(1, 1, piece, 0), y = 5 * random_draw(1, 1, piece, 1);
    discs[i] = (struct picture_layout_disc){x + 3 * random_draw(2, 1, i, 0), y + 2 * random_draw(2, 1, i, 1), 0.2,
                                            random_draw(2, 1, i, 2), i};
  }
}

static void none_hides_another(void **state) {
  (void)state;
  static int64_t fragment[DISCS], part[DISCS];
  static struct picture_layout_disc discs[DISCS], before[DISCS];
  struct picture_cloud cloud = {.n = DISCS, .fragment = fragment, .part = part};
  make_heap(&cloud, discs);
  make_heap(&cloud, before);
  assert_int_equal(picture_layout_apart(&cloud, DISCS, discs), STATUS_OK);
  for (size_t i = 0; i < DISCS; i++) {
    const size_t first = i - i % EACH; /* a fragment keeps its shape */
    assert_true(fabs(discs[i].x - discs[first].x - before[i].x + before[first].x) < 1e-9);
    assert_true(fabs(discs[i].y - discs[first].y - before[i].y + before[first].y) < 1e-9);
    if (fragment[i] == 0)
      assert_true(discs[i].x == before[i].x && discs[i].y == before[i].y);
    for (size_t j = 0; j < i; j++)
      assert_true(fragment[i] == fragment[j] ||
                  hypot(discs[i].x - discs[j].x, discs[i].y - discs[j].y) > discs[i].radius + discs[j].radius);
  }
  double visible[PIECES];
  assert_int_equal(picture_layout_visible(&cloud, DISCS, discs, PIECES, visible), STATUS_OK);
  for (int f = 0; f < PIECES; f++)
    assert_true(visible[f] > 0.999);
  assert_int_equal(picture_layout_apart(&cloud, 0, discs), STATUS_OK);
}

/* Three discs, drawn in this order: the second covers the first, single particles the left half of the third. */
static void what_can_be_seen(void **state) {
  (void)state;
  int64_t fragment[4] = {0, 1, 2, 3}, part[4] = {PICTURE_CORE, PICTURE_CORE, PICTURE_CORE, PICTURE_DUST};
  const struct picture_cloud cloud = {.n = 4, .fragment = fragment, .part = part};
  const struct picture_layout_disc discs[4] = {{0, 0, 1, 0, 0}, {0, 0, 1.2, 1, 1}, {5, 0, 1, 2, 2}, {4, 0, 1, 3, 3}};
  double visible[4];
  assert_int_equal(picture_layout_visible(&cloud, 4, discs, 4, visible), STATUS_OK);
  assert_true(visible[0] == 0 && visible[1] == 1);
  /* a lens of two discs of radius 1 at a distance of 1: 2 pi/3 - sqrt(3)/2 of pi */
  assert_true(fabs(visible[2] - (1 - (2 * M_PI / 3 - sqrt(3) / 2) / M_PI)) < 0.02);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(none_hides_another), cmocka_unit_test(what_can_be_seen)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
