/* Sets of columns and modules: of any size, also beyond a word. */

#include "engine/sph/modules/module.h"
#include "tests/support/check.h"

enum { MOST = 130 };
static const size_t sizes[] = {1, 63, 64, 65, 128, MOST};
#define FOR_SIZES(count) for (size_t k_ = 0, count; k_ < sizeof sizes / sizeof *sizes && (count = sizes[k_]); k_++)

TEST(words_hold_every_number) {
  assert_int_equal(SET_WORDS(63), 1);
  assert_int_equal(SET_WORDS(64), 1);
  assert_int_equal(SET_WORDS(65), 2);
  assert_int_equal(SET_WORDS(MOST), 3);
}

/* Every range of every size, against an array of flags. */
TEST(ranges) {
  FOR_SIZES(count)
  for (size_t first = 0; first < count; first++)
    for (size_t length = 0; first + length <= count; length++) {
      uint64_t word[SET_WORDS(MOST)] = {0};
      size_t seen = 0;
      set_add(word, first, length);
      for (size_t n = 0; n < SET_WORDS(count) * SET_BITS; n++) /* to the end of its words */
        if (set_has(word, n) != (n >= first && n < first + length))
          fail_msg("count %zu, %zu from %zu on: %zu", count, length, first, n);
      assert_int_equal(set_size(word, count), length);
      FOR_SET(n, word, count)
      assert_int_equal(n, first + seen++);
      assert_int_equal(seen, length);
      assert_int_equal(set_next(word, count, first + length), count);
    }
}

TEST(a_union) {
  FOR_SIZES(count) {
    uint64_t word[SET_WORDS(MOST)] = {0}, other[SET_WORDS(MOST)] = {0};
    set_add(word, 0, 1);
    for (size_t n = 0; n < count; n += 3)
      set_add(other, n, 1);
    set_add(other, count - 1, 1);
    set_unite(word, other, count);
    assert_memory_equal(word, other, sizeof word); /* 0 was in both */
    memset(other, 0, sizeof other);
    set_unite(other, word, count);
    assert_memory_equal(word, other, sizeof word);
    set_unite(word, (uint64_t[SET_WORDS(MOST)]){0}, count);
    assert_memory_equal(word, other, sizeof word);
  }
}
