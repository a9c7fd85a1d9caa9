/* The runs of a round, read from the store. For fit_rounds.c and fit.c only. */
#ifndef CLAST_CAMPAIGN_FIT_FIT_VALUES_H
#define CLAST_CAMPAIGN_FIT_FIT_VALUES_H

#include "campaign/fit/fit.h"

/* Reads the values of the shot under way for the members at z into fit->values, after the existing points. */
status fit_values_read(struct fit *fit, struct store *store, const double *z, struct error *error);
/* Reads the values of the particles at z into fit->specimens: means over the shot's specimens. */
status fit_values_check(struct fit *fit, struct store *store, const double *z, struct error *error);

/* All values in the order that the algebra takes them; packed has room for all of them. */
struct surfaces_runs fit_values_runs(const struct fit *fit, double *packed);

#endif
