/* Puts the changes into the document before it is read: they are checked like the file's own values. */
#include "campaign/document/campaign_change.h"

#include <inttypes.h>
#include <string.h>

static const char origin[] = "command line";

status campaign_change_split(const char *text, char path[FIELD_TEXT_SIZE], const char **value, struct error *error) {
  const char *equals = strchr(text, '=');
  if (!equals || equals == text || equals - text >= FIELD_TEXT_SIZE)
    return status_fail(error, STATUS_USAGE, "--set expects PATH=VALUE (--set contact.friction=0.3), got \"%.128s\"",
                       text);
  snprintf(path, FIELD_TEXT_SIZE, "%.*s", (int)(equals - text), text);
  *value = equals + 1;
  return STATUS_OK;
}

static status change_input(struct document *document, const char *text, struct error *error) {
  char path[FIELD_TEXT_SIZE];
  const char *value = NULL;
  const status code = campaign_change_split(text, path, &value, error);
  return code ? code : document_change_put(document, (const char *const[]){"set", path}, value, origin, error);
}

status campaign_change(struct document *document, const struct campaign_changes *changes, struct error *error) {
  status code = STATUS_OK;
  for (size_t i = 0; code == STATUS_OK && i < changes->input_count; i++)
    code = change_input(document, changes->inputs[i], error);
  if (code || changes->seeds == 0)
    return code;
  char number[32];
  snprintf(number, sizeof number, "%" PRId64, changes->seeds);
  return document_change_put(document, (const char *const[]){"seeds", "per_point"}, number, origin, error);
}
