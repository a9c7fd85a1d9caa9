/* Times the first steps of runs, and whole runs of coarse scenes. */
#include "campaign/scheduler/pilot.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "campaign/converge/ladder.h"
#include "schemas/clock.h"

enum { HALVINGS = 20 };

static void mark(struct pilot_run *run) {
  if (run->marks == PILOT_MARKS) { /* keep every other one */
    for (size_t i = 0; i < PILOT_MARKS / 2; i++) {
      run->mark_steps[i] = run->mark_steps[2 * i + 1];
      run->mark_progress[i] = run->mark_progress[2 * i + 1];
    }
    run->marks = PILOT_MARKS / 2;
  }
  run->mark_steps[run->marks] = run->steps;
  run->mark_progress[run->marks++] = run->progress;
}

static status step(const struct engine_kind *kind, void *state, double until, struct pilot_run *run,
                   struct error *error) {
  uint64_t block = 1;
  status code = STATUS_OK;
  while (code == STATUS_OK && !run->finished && clock_cpu_s() < until) {
    const double from = clock_cpu_s();
    code = kind->step(state, block, &run->finished, error);
    const double took = clock_cpu_s() - from;
    run->step_s += took;
    run->steps += (double)block;
    run->progress = kind->progress ? kind->progress(state) : (double)NAN;
    mark(run);
    if (took < 0.002 && block < UINT64_C(1) << 40)
      block *= 2;
  }
  return code;
}

/* Copy of the scene with one thread: the processor time of several threads includes their waiting. Owned by the caller.
 * NULL: no memory. */
static struct scene *on_one_thread(const struct scene *scene) {
  struct scene *copy = scene_copy(scene);
  if (copy && copy->kind->threads)
    *copy->kind->threads(copy->inputs) = 1;
  return copy;
}

status pilot_try(const struct scene *scene, uint64_t seed, double seconds, struct pilot_run *run, struct error *error) {
  const struct engine_kind *kind = scene->kind;
  void *state = NULL, *result = NULL;
  struct fragment *list = NULL;
  struct outcome outcome;
  const double begin = clock_cpu_s();
  *run = (struct pilot_run){0};
  struct scene *alone = on_one_thread(scene);
  if (!alone)
    return status_fail(error, STATUS_MEMORY, "no memory for the trial's scene");
  status code = kind->prepare(alone->inputs, seed, &state, error);
  scene_free(alone);
  if (code != STATUS_OK)
    return code;
  run->prepare_s = clock_cpu_s() - begin;
  code = step(kind, state, begin + seconds, run, error);
  if (code != STATUS_OK)
    goto cleanup;
  result = calloc(1, kind->results->size);
  if (!result) {
    code = status_fail(error, STATUS_MEMORY, "no memory for the trial's result");
    goto cleanup;
  }
  const double stepped = clock_cpu_s();
  code = kind->finish(state, &outcome, result, &list, &run->fragments, error);
  run->finish_s = clock_cpu_s() - stepped;
cleanup:
  free(list);
  free(result);
  kind->free(state);
  return code;
}

/* Number of steps that the run had made at this progress. NaN: the run did not reach it. */
static double steps_at(const struct pilot_run *run, double progress) {
  double steps = 0, before = 0;
  for (size_t i = 0; i < run->marks; i++) {
    if (run->mark_progress[i] >= progress)
      return steps + (run->mark_steps[i] - steps) * (progress - before) / (run->mark_progress[i] - before);
    steps = run->mark_steps[i];
    before = run->mark_progress[i];
  }
  return NAN;
}

double pilot_whole(const struct pilot_run *piece, const struct pilot_run *coarse) {
  const double steps = steps_at(coarse, piece->progress);
  if (!coarse->finished || !(steps > 0))
    return NAN;
  return piece->prepare_s + piece->step_s * coarse->steps / steps + piece->finish_s;
}

double pilot_to_hard_end(const struct pilot_run *piece) {
  return piece->prepare_s + piece->step_s / piece->progress + piece->finish_s;
}

/* The first knob of the engine with a step that applies to the scene: its number of particles or grains. */
static const struct knob *size_knob(const struct scene *scene, double *own) {
  for (const struct knob *knob = scene->kind->knobs; knob && knob->name; knob++) {
    if (knob->step_power == 0)
      continue;
    struct field_value value;
    const struct field *row = field_find(scene->kind->inputs, knob->inputs[0].path, NULL);
    if (!row || !field_is_active(scene->kind->inputs, row, scene->inputs))
      return NULL;
    field_get(row, scene->inputs, &value);
    *own = row->kind == FIELD_INTEGER ? (double)value.integer : value.number;
    return knob;
  }
  return NULL;
}

void pilot_coarsen(const struct scene *scene, double rate, double seconds, struct scene **coarse, char setting[64]) {
  double own = NAN;
  const struct knob *knob = scene->kind->work ? size_knob(scene, &own) : NULL;
  *coarse = NULL;
  setting[0] = '\0';
  for (int i = 1; knob && i < HALVINGS; i++) {
    char text[64];
    const double value = knob->step_power < 0 ? own / pow(2, i) : own * pow(2, 0.5 * i);
    snprintf(text, sizeof text, "%.4g", value >= 100 ? round(value) : value);
    struct scene *next = pilot_coarsen_like(scene, text);
    if (!next)
      return;
    scene_free(*coarse);
    *coarse = next;
    snprintf(setting, 64, "%s", text);
    if (next->kind->work(next->inputs) * rate <= seconds)
      return;
  }
}

struct scene *pilot_coarsen_like(const struct scene *scene, const char *setting) {
  double own;
  struct error ignored;
  const struct knob *knob = size_knob(scene, &own);
  struct scene *copy = knob ? scene_copy(scene) : NULL;
  if (copy && ladder_turn(knob, copy, setting, &ignored) != STATUS_OK) {
    scene_free(copy);
    return NULL;
  }
  return copy;
}
