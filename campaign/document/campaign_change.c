/* Puts the changes into the document before it is read: they are checked like what the file says. */
#include "campaign/document/campaign_change.h"

#include <inttypes.h>
#include <string.h>

static const char origin[] = "command line";

static status change_input(struct document *document, const char *text, struct error *error) {
  const char *equals = strchr(text, '=');
  char path[FIELD_TEXT_SIZE];
  if (!equals || equals == text || (size_t)(equals - text) >= sizeof path)
    return status_fail(error, STATUS_USAGE, "--set expects PATH=VALUE (--set contact.friction=0.3), got \"%.128s\"",
                       text);
  snprintf(path, sizeof path, "%.*s", (int)(equals - text), text);
  return document_change_put(document, (const char *const[]){"set", path}, equals + 1, origin, error);
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
