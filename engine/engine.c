/* The list of engines. */
#include "engine/engine.h"

#include <string.h>

#include "engine/dem/dem.h"
#include "engine/sph/sph.h"

/* The registry: one line per engine, ended by NULL. */
static const struct engine_kind *const kinds[] = {
    &dem_engine,
    &sph_engine,
    NULL,
};

size_t engine_count(void) {
  return sizeof kinds / sizeof kinds[0] - 1;
}

const struct engine_kind *engine_at(size_t index) {
  return index < engine_count() ? kinds[index] : NULL;
}

const struct engine_kind *engine_find(const char *name, struct error *error) {
  char list[256] = "";
  for (size_t i = 0; i < engine_count(); i++) {
    if (strcmp(kinds[i]->name, name) == 0)
      return kinds[i];
    text_append(list, sizeof list, "%s%s", i ? ", " : "", kinds[i]->name);
  }
  status_fail(error, STATUS_CONTENT, "there is no engine '%.60s'; known are: %s", name, list);
  return NULL;
}
