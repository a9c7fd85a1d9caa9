/* The sentences of a fit's report: which inputs the data determine, which they do not, and what the errors include. */
#ifndef CLAST_CAMPAIGN_FIT_FIT_TELL_H
#define CLAST_CAMPAIGN_FIT_FIT_TELL_H

#include <stdio.h>

#include "campaign/fit/fit.h"

void fit_tell(const struct fit *fit, FILE *out);

#endif
