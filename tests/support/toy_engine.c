/* The toy engine, and the list of engines of the programs that have it. */
#include "tests/support/toy_engine.h"
#include "schemas/rows.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "engine/dem/dem.h"
#include "engine/frame.h"
#include "engine/random.h"
#include "engine/sph/sph.h"
#include "schemas/file.h"

/* This list stands in for that of engine/engines.c. */
const struct engine_kind *const engines_list[] = {&dem_engine, &sph_engine, &toy_engine, NULL};

#define INPUTS toy_inputs
#include "engine/input_rows.h"
static const struct field input_rows[] = {
    REAL(stick.strain, "1", 0.03, 1e-9, 1e3, .flags = FIELD_PERCENT, .doc = "Scale of the pieces' masses."),
    REAL(stick.angle, "rad", 0.07, 1e-9, 1e3, .doc = "Changes nothing."),
    REAL(stick.coarse, "kg", 0, 0, 1e3, .absent = "0", .doc = "Mass that the largest piece has too much, times steps."),
    SWITCH(stick.trouble, 0, .doc = "Some seeds end in trouble."),
    REAL(wait, "s", 0, 0, 1e6, .doc = "Time by the clock that a run takes."),
    COUNT(steps, 10, 1, 1000000, .doc = "Steps of a run."),
};
static const struct field_table inputs = FIELD_TABLE(input_rows, struct toy_inputs, "toy scene",
                                                     "A stick that breaks.");
static const struct field result_rows[] = {
    ROW_OF(toy_results, pieces, pieces, FIELD_INTEGER, "1", .maximum = HUGE_VAL, .doc = "Number of pieces."),
};
static const struct field_table results = FIELD_TABLE(result_rows, struct toy_results, "toy result", "A broken stick.");

static const struct knob knobs[] = {
    KNOB("steps", RESOLUTION, .inputs = {{"steps", 1}}, .factors = {0.25, 0.5, 1, 2}, .step_power = -1, .pairs = true,
         .meaning = "steps of a run"),
    KNOB("trouble", MODEL, .inputs = {{"stick.trouble"}}, KNOB_ON_OFF, .meaning = "some seeds end in trouble"),
    KNOB_OF_SETTINGS,
    {.name = NULL},
};

static double one_step(const void *in) {
  return (double)((const struct toy_inputs *)in)->steps;
}

static const struct condition conditions[] = {
    CONDITION("few", .number = "steps", .bound = 3, .least = true, .doubt = "a stick does not break in so few steps",
              .reason = "made up", .remedy = "take more steps", .results = "largest_fraction", .before = one_step),
    {0},
};

struct toy_run {
  struct frame frame;
  struct toy_inputs inputs;
  uint64_t seed;
  struct {
    struct frame_state frame;
    int64_t steps;
  } state;
};

static char *describe(const void *in, bool all) {
  (void)in, (void)all;
  return strdup("a stick, without physics\n");
}

static size_t memory(const void *in) {
  (void)in;
  return 1000000;
}

static double work(const void *in) {
  return 1 / ((const struct toy_inputs *)in)->stick.strain;
}

static status prepare(const void *in, uint64_t seed, void **run, struct error *error) {
  const struct toy_inputs *given = in;
  *run = NULL;
  if (given->stick.trouble && seed == 13)
    return status_fail(error, STATUS_CONTENT, "seed 13 is not run here");
  struct toy_run *made = calloc(1, sizeof *made);
  if (!made)
    return status_fail(error, STATUS_MEMORY, "no memory");
  made->inputs = *given;
  made->seed = seed;
  made->frame = (struct frame){.state = &made->state.frame,
                               .state_size = sizeof made->state,
                               .inputs = &made->inputs,
                               .seed = seed};
  *run = made;
  return STATUS_OK;
}

static status step(void *run, uint64_t most, bool *finished, struct error *error) {
  (void)error;
  struct toy_run *toy = run;
  const double each = toy->inputs.wait / (double)toy->inputs.steps;
  for (; most > 0 && toy->state.steps < toy->inputs.steps; most--, toy->state.steps++)
    if (each > 0)
      nanosleep(&(struct timespec){(time_t)each, (long)(1e9 * fmod(each, 1))}, NULL);
  *finished = toy->state.steps == toy->inputs.steps;
  return STATUS_OK;
}

static double progress(const void *run) {
  const struct toy_run *toy = run;
  return (double)toy->state.steps / (double)toy->inputs.steps;
}

static double time_of(const void *run) {
  return 1e-6 * (double)((const struct toy_run *)run)->state.steps;
}

static int by_mass(const void *a, const void *b) {
  const struct fragment *x = a, *y = b;
  return x->mass != y->mass ? (x->mass < y->mass ? 1 : -1) : (x->first > y->first) - (x->first < y->first);
}

static status finish(void *run, struct outcome *outcome, void *result, struct fragment **fragments, size_t *count,
                     struct error *error) {
  const struct toy_run *toy = run;
  const size_t n = 20 + (size_t)(toy->seed % 7);
  *fragments = calloc(n, sizeof **fragments);
  if (!*fragments)
    return status_fail(error, STATUS_MEMORY, "no memory");
  for (size_t k = 0; k < n; k++) {
    const double u = random_draw(toy->seed, RANDOM_LATTICE, k, 0);
    (*fragments)[k].mass = (k == 0 ? 5 + toy->inputs.stick.coarse / (double)toy->inputs.steps : 0) +
                           10 * toy->inputs.stick.strain / (1 + (double)k + u);
    (*fragments)[k].count = k + 5 < n ? 10 : 1;
    (*fragments)[k].first = (uint32_t)k;
  }
  qsort(*fragments, n, sizeof **fragments, by_mass);
  *count = n;
  field_defaults(&outcome_table, outcome);
  outcome_fragments(outcome, n, *fragments, &(struct outcome_small){.dust = NAN});
  outcome->state = OUTCOME_COMPLETED;
  if (toy->inputs.stick.trouble && toy->seed % 10 == 9)
    outcome->state = toy->seed % 50 == 49 ? OUTCOME_NOT_FINITE : OUTCOME_END_TIME;
  outcome->steps = toy->state.steps;
  outcome->time = time_of(run);
  outcome->time_step = 1e-6;
  condition_after(conditions, &(struct condition_run){.inputs = &toy->inputs}, outcome->warnings,
                  sizeof outcome->warnings);
  ((struct toy_results *)result)->pieces = (int64_t)n;
  return STATUS_OK;
}

status toy_write_fields(void *run, const char *path, struct error *error) {
  char text[32];
  const int length = snprintf(text, sizeof text, "%llu\n", (unsigned long long)((struct toy_run *)run)->seed);
  return file_write(path, "fields file", text, (size_t)length, error);
}

static void *copy_system(const void *run, size_t *size) {
  (void)run;
  *size = 1; /* no system, but a block of memory all the same */
  return calloc(1, 1);
}

static status load_system(void *run, const void *bytes, size_t size, struct error *error) {
  (void)run, (void)bytes, (void)size, (void)error;
  return STATUS_OK;
}

struct engine_kind toy_engine = {.name = "toy",
                                 .doc = "A stick, without physics.",
                                 .dimensions = 3,
                                 .results_version = 1,
                                 .inputs = &inputs,
                                 .results = &results,
                                 .knobs = knobs,
                                 .conditions = conditions,
                                 .describe = describe,
                                 .memory = memory,
                                 .work = work,
                                 .prepare = prepare,
                                 .step = step,
                                 .progress = progress,
                                 .time = time_of,
                                 .finish = finish,
                                 .write_snapshot = toy_write_fields,
                                 .copy_system = copy_system,
                                 .load_system = load_system,
                                 .free = free};
