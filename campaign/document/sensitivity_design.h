/* Designs for sensitivity indices, written as a campaign with a file of points, and found again in such a campaign. */
#ifndef CLAST_CAMPAIGN_DOCUMENT_SENSITIVITY_DESIGN_H
#define CLAST_CAMPAIGN_DOCUMENT_SENSITIVITY_DESIGN_H

#include "campaign/design/design_sensitivity.h"
#include "campaign/document/campaign.h"

/* Writes NEW.yaml, the campaign of `path` with another design, and NEW.csv, its points. Neither may exist. */
status sensitivity_design_write(const char *path, const char *output, enum design_sensitivity_kind kind, size_t blocks,
                                uint64_t seed, struct error *error);

/* Finds the kind of design that the points of a campaign form, and its number of blocks. STATUS_USAGE: it is neither
 * design. */
status sensitivity_design_find(const struct campaign *campaign, enum design_sensitivity_kind *kind, size_t *blocks,
                               struct error *error);
/* For a Morris design: the input that each step changes, and the signed change of its quantile. Both arrays: inputs x
 * blocks. */
void sensitivity_design_steps(const struct campaign *campaign, size_t blocks, size_t *order, double *step);

#endif
