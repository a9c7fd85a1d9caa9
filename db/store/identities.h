/* The identities a store holds, in memory: resume asks for every run of a campaign, and adding a run asks once more. */
#ifndef CLAST_DB_STORE_IDENTITIES_H
#define CLAST_DB_STORE_IDENTITIES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct identities_entry {
  uint8_t identity[16];
  uint32_t attempts; /* failed ones */
  bool used, stored;
};

struct identities { /* all zero = empty */
  struct identities_entry *slots;
  size_t capacity, count; /* capacity: 0 or a power of two */
};

/* The entry of an identity, added when absent. NULL when memory ran out. Valid until the next call. */
struct identities_entry *identities_add(struct identities *set, const uint8_t identity[16]);
/* NULL when absent. */
struct identities_entry *identities_find(const struct identities *set, const uint8_t identity[16]);
void identities_clear(struct identities *set);

#endif
