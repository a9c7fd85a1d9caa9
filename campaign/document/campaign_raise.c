/* Raises the limits for runs that reached them. */
#include "campaign/document/campaign_raise.h"

/* A limit given on the command line, or twice the campaign's. */
static status raise_limit(const char *path, const char *text, double *limit, struct error *error) {
  if (!text) {
    *limit *= 2;
    return STATUS_OK;
  }
  const struct field *row = field_find(&campaign_table, path, error);
  struct field_value value;
  if (!row)
    return STATUS_INTERNAL;
  status code = field_parse(row, text, &value, error);
  if (code)
    return STATUS_USAGE;
  *limit = value.number;
  return STATUS_OK;
}

status campaign_raise(struct campaign *campaign, const char *time, const char *memory, int64_t attempts,
                      struct error *error) {
  status code = raise_limit("limits.time", time, &campaign->time_limit, error);
  if (code == STATUS_OK)
    code = raise_limit("limits.memory", memory, &campaign->memory_limit, error);
  if (code)
    return code;
  campaign->attempts += attempts;
  campaign->failures = 0; /* the user was told of these failures before */
  return STATUS_OK;
}
