/* `design: {file: points.csv}`: the points of a campaign from another program. For campaign.c only.
 *
 * CSV (RFC 4180) with a header of input paths, or unique endings of one. "threshold.angle [deg]" gives the unit of the
 * column's bare numbers, "[1]" fractions. A cell may carry its own unit ("3 deg"). Line i makes point i. */
#ifndef CLAST_CAMPAIGN_DOCUMENT_CAMPAIGN_POINTS_H
#define CLAST_CAMPAIGN_DOCUMENT_CAMPAIGN_POINTS_H

#include "campaign/document/campaign.h"
#include "schemas/document.h"

/* Reads the file that campaign->design.file names (relative to `folder`; NULL: the current one) into campaign->axes and
 * campaign->points. False when anything was reported, at `node`, with the file's name and line. */
bool campaign_points_read(document_node *node, const char *folder, struct campaign *campaign);

#endif
