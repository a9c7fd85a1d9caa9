/* The identities in a store, held in memory: a resumed campaign looks up every run, and adding a run looks it up
 * again. */
#ifndef CLAST_DB_STORE_IDENTITIES_H
#define CLAST_DB_STORE_IDENTITIES_H

#include <stdbool.h>
#include <stdint.h>

#include "schemas/status.h"

struct identities_entry;
struct store;

struct identities { /* all zero: empty */
  struct identities_entry *table;
};

/* The stored facts about an identity. */
struct identities_state {
  uint32_t attempts; /* failed attempts */
  bool stored;
};

/* The state of an identity, added when absent. NULL when memory ran out. Valid until identities_clear(). */
struct identities_state *identities_add(struct identities *set, const uint8_t identity[16]);
/* NULL when absent. */
struct identities_state *identities_find(const struct identities *set, const uint8_t identity[16]);
void identities_clear(struct identities *set);

/* Reads the identities of the store, and its range of bins. error may be NULL. */
status identities_load(struct store *store, struct error *error);

#endif
