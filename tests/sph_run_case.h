/* Running a built-in sph scene, changed by a few overrides, from a test. Everything fails the test by itself. */
#ifndef CLAST_TESTS_SPH_RUN_CASE_H
#define CLAST_TESTS_SPH_RUN_CASE_H

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

#include "engine/sph/sph.h"
#include "engine/scene.h"

#define UNUSED __attribute__((unused))

/* `overrides`: "path=text" items, closed by NULL; NULL for none. */
UNUSED static struct sph_inputs sph_run_case(const char *scene_name, const char *const *overrides) {
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
  struct sph_inputs inputs = *(const struct sph_inputs *)scene->inputs;
  scene_free(scene);
  return inputs;
}
#define SPH_RUN_CASE(name, ...) sph_run_case(name, (const char *const[]){__VA_ARGS__, NULL})

struct sph_ran {
  struct outcome outcome;
  struct sph_results results;
  struct fragment *fragments; /* owned by the test */
  size_t count;
};

UNUSED static struct sph_ran sph_run_case_run(const struct sph_inputs *inputs, uint64_t seed) {
  struct error error = {0};
  void *run = NULL;
  struct sph_ran ran = {0};
  bool finished = false;
  if (sph_engine.prepare(inputs, seed, &run, &error))
    fail_msg("prepare: %s", error.message);
  while (!finished)
    assert_int_equal(sph_engine.step(run, 1000, &finished, &error), STATUS_OK);
  assert_int_equal(sph_engine.finish(run, &ran.outcome, &ran.results, &ran.fragments, &ran.count, &error), STATUS_OK);
  sph_engine.free(run);
  return ran;
}

UNUSED static bool sph_run_case_full(void) {
  const char *full = getenv("CLAST_FULL");
  return full && strcmp(full, "1") == 0;
}

/* Number of seeds: CLAST_SEEDS, or the form's own. */
UNUSED static size_t sph_run_case_seeds(size_t quick, size_t full) {
  const char *asked = getenv("CLAST_SEEDS");
  size_t n = asked ? strtoul(asked, NULL, 10) : 0;
  return n > 0 && n <= 1000 ? n : sph_run_case_full() ? full : quick;
}

#endif
