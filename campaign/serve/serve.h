/* `clast serve`: a campaign as an UM-Bridge model. Requests and the farm share one thread. */
#ifndef CLAST_CAMPAIGN_SERVE_SERVE_H
#define CLAST_CAMPAIGN_SERVE_SERVE_H

#include "campaign/farm/farm.h"
#include "campaign/serve/http.h"

struct serve_options {
  const char *store, *facts;
  const char *address;
  int port;
  double wait_s;
  /* Called when the server listens. May be NULL. */
  void (*ready)(void *context, const struct serve_http *http);
  void *context;
};

/* Serves until a signal stops it (STATUS_OK) or the store fails. The farm has been started; ranks other than 0 compute
 * runs. */
status serve_run(const struct serve_model *model, struct farm *farm, const struct serve_options *options,
                 struct serve_jobs_counts *counts, struct error *error);

#endif
