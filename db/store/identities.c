/* Open addressing with linear probing, at most three quarters full. An identity is a hash already: its first word is
 * the place to start. */
#include "db/store/identities.h"

#include <stdlib.h>
#include <string.h>

static size_t place(const struct identities_entry *slots, size_t capacity, const uint8_t identity[16]) {
  uint64_t word;
  memcpy(&word, identity, sizeof word);
  size_t at = (size_t)word & (capacity - 1);
  while (slots[at].used && memcmp(slots[at].identity, identity, 16) != 0)
    at = (at + 1) & (capacity - 1);
  return at;
}

static bool grow(struct identities *set) {
  size_t capacity = set->capacity ? 2 * set->capacity : 1024;
  struct identities_entry *slots = calloc(capacity, sizeof *slots);
  if (!slots)
    return false;
  for (size_t i = 0; i < set->capacity; i++)
    if (set->slots[i].used)
      slots[place(slots, capacity, set->slots[i].identity)] = set->slots[i];
  free(set->slots);
  set->slots = slots;
  set->capacity = capacity;
  return true;
}

struct identities_entry *identities_add(struct identities *set, const uint8_t identity[16]) {
  if (4 * (set->count + 1) > 3 * set->capacity && !grow(set))
    return NULL;
  struct identities_entry *entry = &set->slots[place(set->slots, set->capacity, identity)];
  if (!entry->used) {
    memcpy(entry->identity, identity, 16);
    entry->used = true;
    set->count++;
  }
  return entry;
}

struct identities_entry *identities_find(const struct identities *set, const uint8_t identity[16]) {
  if (set->capacity == 0)
    return NULL;
  struct identities_entry *entry = &set->slots[place(set->slots, set->capacity, identity)];
  return entry->used ? entry : NULL;
}

void identities_clear(struct identities *set) {
  free(set->slots);
  *set = (struct identities){0};
}
