/* A small engine of invented numbers and functions that fill a store with it, for the tests and the bench of the store.
 * Like real engines it has an input that may be off, one that depends on another, choices, and its own result table. */
#pragma once

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "db/ask/ask.h"
#include "db/store/store.h"
#include "schemas/rows.h"
#include "tests/support/owned.h"

#define assert_near(a, b, tolerance) assert_true(fabs((a) - (b)) <= (tolerance))

struct fixture_inputs {
  double m, k, threshold, depth;
  int64_t grains;
  int law;
};
struct fixture_result {
  int64_t broken;
  double hardest;
};

static const char *const fixture_laws[] = {"plain", "deep", NULL};
static const struct field fixture_input_rows[] = {
    REAL_OF(fixture_inputs, material.m, m, "1", 6, 0, HUGE_VAL, .doc = "Weibull modulus."),
    REAL_OF(fixture_inputs, material.k, k, "1/m^3", 1e30, 0, HUGE_VAL, .doc = "Flaw density."),
    REAL_OF(fixture_inputs, material.threshold, threshold, "Pa", NAN, 0, HUGE_VAL, .flags = FIELD_MAY_BE_OFF,
            .doc = "Threshold, or off."),
    ROW_OF(fixture_inputs, law, law, FIELD_CHOICE, NULL, .choices = fixture_laws, .doc = "Which law."),
    REAL_OF(fixture_inputs, depth, depth, "m", 1, 0, HUGE_VAL, .when = "law=deep", .doc = "Depth of the deep law."),
    ROW_OF(fixture_inputs, fidelity.grains, grains, FIELD_INTEGER, "1", .number = 100, .minimum = 1, .maximum = 1e9,
           .doc = "Grains."),
};
static const struct field_table fixture_inputs_table = FIELD_TABLE(fixture_input_rows, struct fixture_inputs,
                                                                   "fake scene", "A scene for tests.");
static const struct field fixture_result_rows[] = {
    ROW_OF(fixture_result, broken.count, broken, FIELD_INTEGER, "1", .minimum = 0, .maximum = HUGE_VAL,
           .doc = "Broken bonds."),
    REAL_OF(fixture_result, hardest, hardest, "m/s", 0, -HUGE_VAL, HUGE_VAL, .doc = "Hardest hit."),
};
static const struct field_table fixture_results_table = FIELD_TABLE(fixture_result_rows, struct fixture_result,
                                                                    "fake result", "A result for tests.");
static const struct engine_kind fixture_kind = {.name = "fake",
                                                .doc = "Made-up numbers.",
                                                .results_version = 3,
                                                .inputs = &fixture_inputs_table,
                                                .results = &fixture_results_table};

static inline struct scene fixture_scene(struct fixture_inputs *inputs, double m, double k) {
  struct scene scene = {.kind = &fixture_kind, .inputs = inputs, .name = "made-up"};
  field_defaults(&fixture_inputs_table, inputs);
  inputs->m = m;
  inputs->k = k;
  return scene;
}

/* A number in [0,1) from two integers, the same everywhere (splitmix64). */
static inline double fixture_random(uint64_t a, uint64_t b) {
  uint64_t x = a * 0x9e3779b97f4a7c15u + b * 0xd1b54a32d192ed03u + 0x2545f4914f6cdd1du;
  x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9u;
  x = (x ^ x >> 27) * 0x94d049bb133111ebu;
  return (double)((x ^ x >> 31) >> 11) * 0x1p-53;
}

enum { FIXTURE_FRAGMENTS = 60 };
struct fixture_run { /* owns the memory that a store_run points to */
  struct outcome outcome;
  struct fixture_result result;
  struct estimate estimates[2];
  struct fragment fragments[FIXTURE_FRAGMENTS];
  struct store_run run;
};

static inline int fixture_by_mass(const void *a, const void *b) {
  double x = ((const struct fragment *)a)->mass, y = ((const struct fragment *)b)->mass;
  return x < y ? 1 : x > y ? -1 : 0;
}

/* Replicate r of a point: fragments over three decades, everything a function of (point, replicate). */
static inline void fixture_fill(struct fixture_run *f, const struct scene *scene, int64_t point_id, int64_t session_id,
                                int64_t replicate, size_t fragments) {
  memset(f, 0, sizeof *f);
  const struct fixture_inputs *in = scene->inputs;
  uint64_t point = (uint64_t)(in->m * 1000) + (uint64_t)(log10(in->k) * 1e6);
  double total = 0, square = 0;
  for (size_t i = 0; i < fragments; i++) {
    f->fragments[i].mass = pow(10, -3 * fixture_random(point * 7919 + i, (uint64_t)replicate));
    f->fragments[i].position[0] = (double)i;
    f->fragments[i].count = 2;
    total += f->fragments[i].mass;
    square += f->fragments[i].mass * f->fragments[i].mass;
  }
  qsort(f->fragments, fragments, sizeof f->fragments[0], fixture_by_mass);
  f->outcome = (struct outcome){.state = OUTCOME_COMPLETED,
                                .steps = 1000 + replicate,
                                .time = 1e-3,
                                .time_step = 1e-6,
                                .total_mass = total,
                                .energy_error = 1e-4,
                                .momentum_error = 1e-13,
                                .fragment_count = (int64_t)fragments,
                                .kinetic_energy_share = NAN};
  if (fragments) {
    f->outcome.largest_fraction = f->fragments[0].mass / total;
    f->outcome.second_fraction = fragments > 1 ? f->fragments[1].mass / total : 0;
    f->outcome.mean_fragment_mass = square / total;
    f->outcome.mean_fragment_mass_rest = square / total / 2;
    f->outcome.dust_fraction = f->fragments[fragments - 1].mass / total;
  }
  f->result = (struct fixture_result){.broken = 3 * replicate, .hardest = 0.5 * (double)replicate};
  f->estimates[0] = (struct estimate){.window = ESTIMATES_FROM_2, .fit.beta = 1.5 + 0.01 * (double)replicate};
  f->estimates[1] = (struct estimate){.window = ESTIMATES_FROM_5, .fit.beta = NAN};
  f->run = (struct store_run){.point_id = point_id,
                              .session_id = session_id,
                              .replicate = replicate,
                              .seed = (uint64_t)(1000 + replicate),
                              .kind = scene->kind,
                              .outcome = &f->outcome,
                              .result = &f->result,
                              .fragments = f->fragments,
                              .fragment_count = fragments,
                              .estimates = f->estimates,
                              .estimate_count = 2,
                              .wall_s = 0.5,
                              .cpu_s = 0.25,
                              .peak_memory = 1 << 20,
                              .attempt = 1,
                              .host = "testhost"};
  scene_identity(scene, f->run.seed, f->run.identity);
}

static const char *const fixture_axes[] = {"material.m", "material.k"};

/* Adds points_m x points_k points with `replicates` runs each: point after point, or the last replicate of every point
 * first. */
static inline status fixture_populate(struct store *store, int points_m, int points_k, int64_t replicates,
                                      bool by_replicate, struct error *e) {
  struct fixture_inputs inputs;
  OWNED struct fixture_run *f = malloc(sizeof *f);
  int64_t campaign = 0, session = 0, point = 0;
  status result = store_add_campaign(store, "made-up", "name: made-up", "{}", &campaign, e);
  if (result == STATUS_OK)
    result = store_begin_session(store, "{\"version\":\"test\"}", &session, e);
  int64_t outer = by_replicate ? replicates : 1;
  for (int64_t r = 0; result == STATUS_OK && r < outer; r++)
    for (int p = 0; result == STATUS_OK && p < points_m * points_k; p++) {
      struct scene scene = fixture_scene(&inputs, 6 + p / points_k, pow(10, 30 + p % points_k));
      result = store_add_point(store, campaign, &scene, 2, fixture_axes, &point, e);
      int64_t from = by_replicate ? replicates - 1 - r : 0, to = by_replicate ? from + 1 : replicates;
      for (int64_t q = from; result == STATUS_OK && q < to; q++) {
        fixture_fill(f, &scene, point, session, q, FIXTURE_FRAGMENTS);
        result = store_add_run(store, &f->run, e);
      }
    }
  if (result == STATUS_OK)
    result = store_end_session(store, session, "ok", e);
  return result;
}

/* A new path in the current folder; no file has it. */
static inline const char *fixture_path(char path[64], const char *name) {
  static const char *const ends[] = {"", "-wal", "-shm", "-journal", ".version0", ".version1", ".out"};
  snprintf(path, 64, "test-store-%s.db", name);
  for (size_t i = 0; i < sizeof ends / sizeof ends[0]; i++) {
    char other[96];
    snprintf(other, sizeof other, "%s%s", path, ends[i]);
    unlink(other);
  }
  return path;
}
