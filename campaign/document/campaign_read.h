/* The readers of a campaign's document. For campaign/document only. */
#pragma once

#include "campaign/document/campaign.h"

/* Fills the whole struct, text excepted. Errors are reported to the document: see document_finish(). The paths of scene
 * and design.file are relative to `folder` (NULL: the current one). `stored`: the document is
 * that of a store, which may set an input twice. */
void campaign_read(document_node *root, const char *folder, bool stored, struct campaign *campaign);

/* Reads `set` (NULL: none) into `scene`. An input that is an axis of the campaign is refused with the words `varied`.
 * One input under two of its names is a slip, which the document of a store may still have. A value of the command line
 * replaces that of the document. False after a report. */
bool campaign_read_set(document_node *set, const char *folder, const struct campaign *campaign, struct scene *scene,
                       bool stored, const char *varied);
/* One value of an input. The name of a material's file is relative to `folder`, on the command line to the current one.
 * False: reported. */
bool campaign_read_value(document_node *node, const struct field *row, const char *folder, struct field_value *value);

/* `design: {file: points.csv}`: the points of a campaign from another program. For campaign_read.c only.
 *
 * CSV (RFC 4180) with a header of input paths, or unique endings of one. "threshold.angle [deg]" gives the unit of the
 * column's bare numbers, "[1]" fractions. A cell may carry its own unit ("3 deg"). Line i makes point i. */

/* Reads the file that campaign->design.file names (relative to `folder`; NULL: the current one) into campaign->axes and
 * campaign->points. False when anything was reported, at `node`, with the file's name and line. */
bool campaign_points_read(document_node *node, const char *folder, struct campaign *campaign);

/* ---- The key `vary` of a campaign: paths into the scene and what values they take. For campaign_read.c only ---- */

/* Fills campaign->axes from the mapping (NULL: nothing varied). False when anything was reported. */
bool campaign_vary_read(document_node *vary, const char *folder, struct campaign *campaign);
