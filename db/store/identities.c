/* The identities of a store in a hash table. */
#include <stdlib.h>
#include <string.h>

#include "db/store/internal.h"

/* An identity is already a hash, so multiplying its words is enough. */
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

static status take_identity(struct store *store, sqlite3_stmt *row, struct error *error) {
  if (sqlite3_column_bytes(row, 0) != 16)
    return status_fail(error, STATUS_CONTENT, "%s: an identity is damaged; `clast check` tells more", store->path);
  struct identities_state *state = identities_add(&store->identities, sqlite3_column_blob(row, 0));
  if (!state)
    return status_fail(error, STATUS_MEMORY, "%s: memory ran out while reading the stored identities", store->path);
  if (sqlite3_column_int(row, 1))
    state->stored = true;
  else
    state->attempts++;
  return STATUS_OK;
}

status identities_load(struct store *store, struct error *error) {
  static const char doing[] = "reading the stored identities";
  STATEMENT statement = NULL;
  status result = sql_prepare(store->db, "SELECT identity, 1 FROM run UNION ALL SELECT identity, 0 FROM attempt",
                              &statement, doing, error);
  while (sql_next(statement, &result, doing, error))
    result = take_identity(store, statement, error);
  TRY(result);
  TRY(sql_integer(store->db, "SELECT min(bin) FROM bin", 1, &store->lowest_bin, error));
  TRY(sql_integer(store->db, "SELECT max(bin) FROM bin", 0, &store->highest_bin, error));
  store->identities_loaded = true;
  return STATUS_OK;
}
