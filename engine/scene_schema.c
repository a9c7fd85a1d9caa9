#include "engine/scene.h"
#include "schemas/json_schema.h"

void scene_schema(const struct engine_kind *kind, FILE *out) {
  char title[128], extra[512];
  snprintf(title, sizeof title, "A scene of clast's engine %s", kind->name);
  snprintf(extra, sizeof extra,
           "\"engine\": {\"const\": \"%s\", \"description\": \"Which engine runs the scene.\"},\n"
           "    \"name\": {\"type\": [\"string\", \"number\", \"boolean\"], \"maxLength\": %d, \"description\": \"The "
           "scene's name.\"},\n"
           "    \"source\": {\"type\": [\"string\", \"number\", \"boolean\"], \"maxLength\": %d, \"description\": "
           "\"Where it comes from: "
           "paper, section, figure.\"}",
           kind->name, FIELD_TEXT_SIZE - 1, FIELD_TEXT_SIZE - 1);
  json_schema_write(kind->inputs, title, extra, "engine", out);
}
