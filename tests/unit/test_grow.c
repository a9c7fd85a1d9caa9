/* Growing arrays: their contents stay, they double, and one large request is met in one step. Aligned ones keep only as
 * many elements as the caller names. */

#include "engine/grow.h"
#include "tests/support/check.h"

TEST(items_stay_and_the_room_doubles) {
  OWNED double *values = NULL;
  size_t room = 0, moves = 0;
  for (size_t i = 0; i < 10000; i++) {
    const size_t before = room;
    assert_true(grow_room(&values, &room, i + 1, sizeof *values));
    assert_true(room > i);
    moves += room != before;
    values[i] = (double)i;
  }
  for (size_t i = 0; i < 10000; i++)
    assert_true(values[i] == (double)i);
  assert_true(moves <= 10); /* 32 doubled nine times is more than 10000 */
}

TEST(a_large_need_is_met_at_once) {
  OWNED char *text = NULL;
  size_t room = 0;
  assert_true(grow_room(&text, &room, 100000, 1));
  assert_int_equal(room, 100000);
  text[99999] = 'x';
  assert_true(grow_room(&text, &room, 100000, 1));
  assert_int_equal(room, 100000);
}

TEST(without_memory_the_array_stays) {
  OWNED char *text = NULL;
  size_t room = 0;
  assert_true(grow_room(&text, &room, 1, 1));
  text[0] = 'x';
  const size_t before = room;
  assert_false(grow_room(&text, &room, SIZE_MAX / 2, 1));
  assert_int_equal(room, before);
  assert_int_equal(text[0], 'x');
}

TEST(aligned_arrays_keep_what_is_asked_for) {
  uint32_t *values = NULL;
  size_t room = 0;
  assert_true(grow_aligned(&values, &room, 800, sizeof *values, 0));
  assert_int_equal(room, 900 + GROW_SPARE);
  for (uint32_t i = 0; i < 10; i++)
    values[i] = i;
  const uint32_t *before = values;
  assert_true(grow_aligned(&values, &room, 900, sizeof *values, 10)); /* the capacity is enough */
  assert_ptr_equal(values, before);
  assert_true(grow_aligned(&values, &room, 5000, sizeof *values, 10));
  assert_int_equal((uintptr_t)values % 64, 0);
  for (uint32_t i = 0; i < 10; i++)
    assert_int_equal(values[i], i);
  assert_false(grow_aligned(&values, &room, SIZE_MAX / 16, sizeof *values, 10));
  assert_int_equal(values[9], 9);
  free(values);
}
