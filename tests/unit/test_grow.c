/* Growing arrays: what is in them stays, they double, and one large need is met at once. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <stdlib.h>

#include "engine/grow.h"

#ifdef __SANITIZE_ADDRESS__
__attribute__((visibility("default"))) const char *__asan_default_options(void);
const char *__asan_default_options(void) {
  return "allocator_may_return_null=1";
} /* as malloc does when there is no memory */
#endif

static void items_stay_and_the_room_doubles(void **state) {
  (void)state;
  double *values = NULL;
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
  free(values);
}

static void a_large_need_is_met_at_once(void **state) {
  (void)state;
  char *text = NULL;
  size_t room = 0;
  assert_true(grow_room(&text, &room, 100000, 1));
  assert_int_equal(room, 100000);
  text[99999] = 'x';
  assert_true(grow_room(&text, &room, 100000, 1));
  assert_int_equal(room, 100000);
  free(text);
}

static void without_memory_the_array_stays(void **state) {
  (void)state;
  char *text = NULL;
  size_t room = 0;
  assert_true(grow_room(&text, &room, 1, 1));
  text[0] = 'x';
  const size_t before = room;
  assert_false(grow_room(&text, &room, SIZE_MAX / 2, 1));
  assert_int_equal(room, before);
  assert_int_equal(text[0], 'x');
  free(text);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(items_stay_and_the_room_doubles),
      cmocka_unit_test(a_large_need_is_met_at_once),
      cmocka_unit_test(without_memory_the_array_stays),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
