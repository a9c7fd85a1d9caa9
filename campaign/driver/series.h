/* Campaigns one after the other through one farm and one store, where what comes next depends on what was found: the
 * rounds of a fit. Each is an ordinary campaign of the store. What the store has is not computed again, so that a
 * series that was stopped goes on where it was. */
#ifndef CLAST_CAMPAIGN_DRIVER_SERIES_H
#define CLAST_CAMPAIGN_DRIVER_SERIES_H

#include "campaign/driver/driver.h"

struct series {
  void *context;
  /* The next campaign, owned by the series from then on; NULL: there is none, or an error. */
  struct campaign *(*next)(void *context, struct store *store, struct error *error);
  /* All its runs are in the store. */
  status (*done)(void *context, struct store *store, struct error *error);
};

struct series_summary {
  int64_t runs_done, runs_failed, runs_reused;
  double cpu_s;
};

/* Every rank calls it; only rank 0 opens the store, and all callbacks are its. STATUS_STOPPED after a signal, or when
 * so many of a campaign's first runs failed that it ended (limits.failures); *error says which. Single failed runs are
 * no error: `done` finds them missing. */
status series_run(const struct series *series, struct farm *farm, const struct driver_options *options,
                  struct series_summary *summary, struct error *error);

#endif
