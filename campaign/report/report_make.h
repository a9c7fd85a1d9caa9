/* Makes the page of `clast report` from stores. */
#ifndef CLAST_CAMPAIGN_REPORT_REPORT_MAKE_H
#define CLAST_CAMPAIGN_REPORT_REPORT_MAKE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "schemas/status.h"

enum { REPORT_STORES = 8 };

struct report_choice {
  size_t count; /* paths of stores, at most REPORT_STORES */
  char *const *stores;
  const char *output;
  int64_t refresh; /* s, after which an open page loads itself again; 0: never */
};

/* *size: bytes of the page. */
status report_make(const struct report_choice *choice, size_t *size, struct error *error);

/* True while a campaign writes one of the stores. */
bool report_make_running(const struct report_choice *choice);

#endif
