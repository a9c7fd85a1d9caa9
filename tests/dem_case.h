/* Running a built-in dem scene, changed by a few overrides, from a test. Everything fails the test by itself. */
#ifndef CLAST_TESTS_DEM_CASE_H
#define CLAST_TESTS_DEM_CASE_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#include "engine/dem/dem.h"
#include "engine/scene.h"

#define UNUSED __attribute__((unused))

/* `overrides`: "path=text" items, closed by NULL; NULL for none. */
UNUSED static struct dem_inputs dem_case(const char *scene_name, const char *const *overrides) {
  struct scene *scene = NULL;
  struct error error = {0};
  if (scene_load(scene_name, NULL, &scene, &error))
    fail_msg("%s: %s", scene_name, error.message);
  for (size_t k = 0; overrides && overrides[k]; k++) {
    char path[100];
    const char *text = strchr(overrides[k], '=');
    snprintf(path, sizeof path, "%.*s", (int)(text - overrides[k]), overrides[k]);
    if (scene_set_text(scene, path, text + 1, &error))
      fail_msg("%s: %s", overrides[k], error.message);
  }
  if (scene_check(scene, &error))
    fail_msg("%s: %s", scene_name, error.message);
  struct dem_inputs inputs = *(const struct dem_inputs *)scene->inputs;
  scene_free(scene);
  return inputs;
}
#define DEM_CASE(name, ...) dem_case(name, (const char *const[]){__VA_ARGS__, NULL})

struct dem_ran {
  struct outcome outcome;
  struct dem_results results;
  struct fragment *fragments; /* owned by the test */
  size_t count;
};

UNUSED static struct dem_ran dem_case_run(const struct dem_inputs *inputs, uint64_t seed) {
  struct error error = {0};
  void *run = NULL;
  struct dem_ran ran = {0};
  bool finished = false;
  if (dem_engine.prepare(inputs, seed, &run, &error))
    fail_msg("prepare: %s", error.message);
  while (!finished)
    assert_int_equal(dem_engine.step(run, 1000, &finished, &error), STATUS_OK);
  assert_int_equal(dem_engine.finish(run, &ran.outcome, &ran.results, &ran.fragments, &ran.count, &error), STATUS_OK);
  dem_engine.free(run);
  return ran;
}

UNUSED static bool dem_case_full(void) {
  const char *full = getenv("CLAST_FULL");
  return full && strcmp(full, "1") == 0;
}

/* Number of seeds: CLAST_SEEDS, or the form's own. */
UNUSED static size_t dem_case_seeds(size_t quick, size_t full) {
  const char *asked = getenv("CLAST_SEEDS");
  size_t n = asked ? strtoul(asked, NULL, 10) : 0;
  return n > 0 && n <= 1000 ? n : dem_case_full() ? full : quick;
}

#endif
