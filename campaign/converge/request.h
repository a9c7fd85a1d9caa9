/* A user's request for a study of convergence, as text, and the study made from it. */
#ifndef CLAST_CAMPAIGN_CONVERGE_REQUEST_H
#define CLAST_CAMPAIGN_CONVERGE_REQUEST_H

#include "campaign/converge/subject.h"

/* As on the command line (`clast converge --help`); texts may be NULL. */
struct request {
  struct option_list knobs, set;
  const char *quantity, *store, *within, *seconds;
  int64_t first_seeds, most_seeds, first_seed;
  bool quiet; /* prints no remarks on levels that are left out */
};

/* Loads the scene or campaign `path` and sets up its study: quantities, rule, ladders. Clear *subject also after an
 * error. STATUS_USAGE: unknown words; STATUS_CONTENT: knobs that do not apply. */
status request_read(const struct request *request, const char *path, struct subject *subject, struct error *error);

#endif
