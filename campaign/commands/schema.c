/* `clast schema scene|campaign`: JSON Schemas, for editors that complete and check YAML. */
#include "campaign/commands/commands.h"
#include "schemas/json_schema.h"

struct options {
  const char *engine;
};

/* document/campaign.schema.in.json, embedded by CMakeLists.txt. It holds the keys that have several forms (vary, set,
 * design, keep, seeds); the plain keys are filled in from their tables. A value there is a number, string or boolean;
 * the input's own row checks unit and range when the document is read. */
extern const char campaign_text[];

/* Writes the part of the template that ends at `mark` and returns what follows the mark. */
static const char *write_until(const char *text, const char *mark) {
  const char *end = strstr(text, mark);
  if (!end)
    return text;
  fwrite(text, 1, (size_t)(end - text), stdout);
  return end + strlen(mark);
}

static status run(const struct command_line *line, struct error *error) {
  const struct options *options = line->options;
  if (strcmp(line->arguments[0], "campaign") == 0) {
    const char *rest = write_until(campaign_text, "@REQUIRED@");
    json_schema_required(&campaign_table, stdout);
    rest = write_until(rest, "@DESIGN@");
    json_schema_properties(&campaign_design_table, 4, stdout);
    rest = write_until(rest, "@KEYS@");
    json_schema_properties(&campaign_table, 2, stdout);
    fputs(rest, stdout);
    return STATUS_OK;
  }
  if (strcmp(line->arguments[0], "scene") != 0)
    return status_fail(error, STATUS_USAGE, "there are schemas of \"scene\" and \"campaign\", not of \"%.64s\"",
                       line->arguments[0]);
  const struct engine_kind *kind = engine_find(options->engine, error);
  if (!kind)
    return STATUS_USAGE;
  scene_schema(kind, stdout);
  return STATUS_OK;
}

static const struct option_row rows[] = {
    OPTION_ROW_TEXT("engine", 0, "NAME", struct options, engine, "dem"),
};

COMMAND(schema, "scenes and inputs", "scene|campaign", COMMAND_OPTIONS(struct options, rows), .run = run);
