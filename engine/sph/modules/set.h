/* Sets of the numbers below a constant count: of columns, of modules. A set is a struct with `word`, a bit for each
 * number in as many words as the count needs:
 *
 *   struct sph_column_set { uint64_t word[SET_WORDS(SPH_COLUMNS)]; };
 *
 * The functions take the words, so that they serve sets of any size. */
#ifndef CLAST_ENGINE_SPH_MODULES_SET_H
#define CLAST_ENGINE_SPH_MODULES_SET_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { SET_BITS = 64 };
#define SET_WORDS(count) (((count) + SET_BITS - 1) / SET_BITS)

static inline bool set_has(const uint64_t *word, size_t number) {
  return word[number / SET_BITS] >> number % SET_BITS & 1;
}

/* Adds `count` numbers from `first` on. */
static inline void set_add(uint64_t *word, size_t first, size_t count) {
  for (size_t k = first; k < first + count; k++)
    word[k / SET_BITS] |= (uint64_t)1 << k % SET_BITS;
}

/* Adds all members of another set. Both are of numbers below `count`. */
static inline void set_unite(uint64_t *word, const uint64_t *other, size_t count) {
  for (size_t w = 0; w < SET_WORDS(count); w++)
    word[w] |= other[w];
}

/* How many members a set of numbers below `count` has. */
static inline size_t set_size(const uint64_t *word, size_t count) {
  size_t size = 0;
  for (size_t w = 0; w < SET_WORDS(count); w++)
    size += (size_t)__builtin_popcountll(word[w]);
  return size;
}

/* The first member from `from` on; `count` when there is none. */
static inline size_t set_next(const uint64_t *word, size_t count, size_t from) {
  while (from < count && !set_has(word, from))
    from++;
  return from;
}

/* The members in ascending order. */
#define FOR_SET(k, word, count) for (size_t k = set_next(word, count, 0); k < (count); k = set_next(word, count, k + 1))

#endif
