/* Runs campaigns one after the other through one farm and one store, where each depends on earlier results: the rounds
 * of a fit. Each is an ordinary campaign of the store. Stored runs are not computed again, so that a stopped series
 * goes on where it was. */
#ifndef CLAST_CAMPAIGN_DRIVER_SERIES_H
#define CLAST_CAMPAIGN_DRIVER_SERIES_H

#include "campaign/driver/driver.h"

struct series {
  void *context;
  /* Returns the next campaign, which the series then owns; NULL: there is none, or an error. */
  struct campaign *(*next)(void *context, struct store *store, struct error *error);
  /* Called when all runs of the campaign are in the store. */
  status (*done)(void *context, struct store *store, struct error *error);
};

struct series_summary {
  int64_t runs_done, runs_failed, runs_reused;
  double cpu_s;
};

/* Every rank calls it; only rank 0 opens the store and calls the callbacks. STATUS_STOPPED after a signal, or when too
 * many of a campaign's first runs failed (limits.failures); *error says which. Single failed runs are no error: they
 * have no result when `done` is called. */
status series_run(const struct series *series, struct farm *farm, const struct driver_options *options,
                  struct series_summary *summary, struct error *error);

#endif
