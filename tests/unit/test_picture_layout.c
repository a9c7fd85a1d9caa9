/* Fragments side by side: none hides another, the heaviest is kept. */

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

TEST(none_hides_another) {
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
  assert_int_equal(picture_layout_apart(&cloud, 0, discs), STATUS_OK);
}
