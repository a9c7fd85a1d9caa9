/* The engines by number and by name. */
#include "engine/engine.h"

#include <string.h>

FIELD_WORDS(engine_knob_groups, KNOB_GROUPS, [KNOB_RESOLUTION] = "resolution", [KNOB_PART] = "part",
            [KNOB_MODEL] = "model", [KNOB_SETTINGS] = "settings");

static bool commands_allowed;

void engine_allow_commands(void) {
  commands_allowed = true;
}

bool engine_commands_allowed(void) {
  return commands_allowed;
}

status engine_ready(const struct engine_kind *kind, const void *inputs, struct error *error) {
  return kind->ready ? kind->ready(inputs, error) : STATUS_OK;
}

status engine_has_fields(const struct engine_kind *kind, const char *what, struct error *error) {
  return kind->write_snapshot ? STATUS_OK : status_fail(error, STATUS_USAGE, "engine %s has no %s", kind->name, what);
}

size_t engine_count(void) {
  size_t count = 0;
  while (engines_list[count])
    count++;
  return count;
}

const struct engine_kind *engine_at(size_t index) {
  return index < engine_count() ? engines_list[index] : NULL;
}

struct ejecta *engine_ejecta(const struct engine_kind *kind, void *result) {
  return kind->ejecta ? (struct ejecta *)((char *)result + kind->ejecta) : NULL;
}

const struct field *engine_ejecta_sum(void) {
  for (size_t i = 0; i < engine_count(); i++)
    for (size_t k = 0; engines_list[i]->ejecta && k < engines_list[i]->results->count; k++)
      if (engines_list[i]->results->rows[k].offset == engines_list[i]->ejecta_sum)
        return &engines_list[i]->results->rows[k];
  return NULL;
}

const struct engine_kind *engine_find(const char *name, struct error *error) {
  char list[256] = "";
  for (size_t i = 0; i < engine_count(); i++) {
    if (strcmp(engines_list[i]->name, name) == 0)
      return engines_list[i];
    text_append(list, sizeof list, "%s%s", i ? ", " : "", engines_list[i]->name);
  }
  status_fail(error, STATUS_CONTENT, "there is no engine '%.60s'; known are: %s", name, list);
  return NULL;
}

const struct knob *engine_knob(const struct engine_kind *kind, const char *name, struct error *error) {
  char known[1024] = "";
  for (const struct knob *knob = kind->knobs; knob && knob->name; knob++) {
    if (strcmp(knob->name, name) == 0)
      return knob;
    text_append(known, sizeof known, "%s%s", *known ? ", " : "", knob->name);
  }
  status_fail(error, STATUS_USAGE, "engine %s has no setting (knob) '%.64s'; it has %s (`clast converge --list`)",
              kind->name, name, *known ? known : "none");
  return NULL;
}
