/* Fills the template of the JSON Schema. */
#include "campaign/document/campaign_schema.h"

#include <string.h>

#include "campaign/document/campaign.h"
#include "schemas/json_schema.h"

extern const char campaign_schema_template[]; /* campaign.schema.in.json, embedded by CMakeLists.txt */

/* Writes the part of the template that ends at `mark` and returns what follows the mark. */
static const char *write_until(const char *text, const char *mark, FILE *out) {
  const char *end = strstr(text, mark);
  if (!end)
    return text;
  fwrite(text, 1, (size_t)(end - text), out);
  return end + strlen(mark);
}

void campaign_schema_write(FILE *out) {
  const char *rest = write_until(campaign_schema_template, "@REQUIRED@", out);
  json_schema_required(&campaign_table, out);
  rest = write_until(rest, "@DESIGN@", out);
  json_schema_properties(&campaign_design_table, 4, out);
  rest = write_until(rest, "@KEYS@", out);
  json_schema_properties(&campaign_table, 2, out);
  fputs(rest, out);
}
