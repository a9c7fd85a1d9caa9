/* The keys of a campaign that have several forms (vary, set, design, keep), for `clast explain`. The plain keys are
 * rows of campaign_table. */
#ifndef CLAST_CAMPAIGN_DOCUMENT_CAMPAIGN_KEYS_H
#define CLAST_CAMPAIGN_DOCUMENT_CAMPAIGN_KEYS_H

#include <stddef.h>

#include "schemas/field.h"

struct campaign_key {
  const char *name;
  const char *words;               /* words that may occur in its value, separated by spaces */
  const char *doc;                 /* one sentence */
  const char *forms;               /* lines of examples and their meaning */
  const struct field_table *table; /* the rows of its mapping; NULL: none */
};

extern const struct campaign_key campaign_keys[];
extern const size_t campaign_keys_count;

/* Finds the key that is named `path`, contains it ("keep.fields"), or has it among its words. NULL: none. */
const struct campaign_key *campaign_keys_find(const char *path);

#endif
