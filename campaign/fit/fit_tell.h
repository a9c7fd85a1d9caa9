/* What a fit says of itself in sentences: what the data determine, what they leave open, what its errors hold. */
#ifndef CLAST_CAMPAIGN_FIT_FIT_TELL_H
#define CLAST_CAMPAIGN_FIT_FIT_TELL_H

#include <stdio.h>

#include "campaign/fit/fit.h"

void fit_tell(const struct fit *fit, FILE *out);

#endif
