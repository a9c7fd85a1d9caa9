/* The identities of a store in a hash table. */
#include "db/store/identities.h"

#include <stdlib.h>
#include <string.h>

/* An identity is a hash already, so that multiplying its words is enough. */
#define HASH_FUNCTION(key, size, hash) ((hash) = hash_of(key))
#define HASH_NONFATAL_OOM              1
#define uthash_nonfatal_oom(entry)     ((entry)->identity_is_added = false)
#include <uthash.h>

static unsigned hash_of(const void *identity) {
  uint64_t words[2];
  memcpy(words, identity, sizeof words);
  return (unsigned)((words[0] ^ words[1]) * 0x9e3779b97f4a7c15u >> 32);
}

struct identities_entry {
  UT_hash_handle hh;
  uint8_t identity[16];
  struct identities_state state;
  bool identity_is_added;
};

static struct identities_entry *find(const struct identities *set, const uint8_t identity[16]) {
  struct identities_entry *entry;
  HASH_FIND(hh, set->table, identity, 16, entry);
  return entry;
}

struct identities_state *identities_find(const struct identities *set, const uint8_t identity[16]) {
  struct identities_entry *entry = find(set, identity);
  return entry ? &entry->state : NULL;
}

struct identities_state *identities_add(struct identities *set, const uint8_t identity[16]) {
  struct identities_entry *entry = find(set, identity);
  if (entry)
    return &entry->state;
  entry = calloc(1, sizeof *entry);
  if (!entry)
    return NULL;
  memcpy(entry->identity, identity, 16);
  entry->identity_is_added = true;
  HASH_ADD(hh, set->table, identity, 16, entry);
  if (entry->identity_is_added)
    return &entry->state;
  free(entry);
  return NULL;
}

void identities_clear(struct identities *set) {
  struct identities_entry *entry, *next;
  HASH_ITER(hh, set->table, entry, next) {
    HASH_DEL(set->table, entry);
    free(entry);
  }
}
