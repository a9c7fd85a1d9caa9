/* Changes of a campaign from the command line. They become part of its document, so that the store keeps them and
 * `clast retry` runs the same campaign. */
#ifndef CLAST_CAMPAIGN_DOCUMENT_CAMPAIGN_CHANGE_H
#define CLAST_CAMPAIGN_DOCUMENT_CAMPAIGN_CHANGE_H

#include "schemas/document.h"
#include "schemas/field.h"

struct campaign_changes {
  size_t input_count;
  const char *const *inputs; /* "PATH=VALUE": as if under `set` */
  int64_t seeds;             /* seeds.per_point; 0: as written */
};

/* Splits PATH=VALUE of --set. *value points into the text. STATUS_USAGE: the text has another form. */
status campaign_change_split(const char *text, char path[FIELD_TEXT_SIZE], const char **value, struct error *error);

/* STATUS_USAGE: no PATH=VALUE. */
status campaign_change(struct document *document, const struct campaign_changes *changes, struct error *error);

#endif
