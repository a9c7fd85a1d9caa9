/* Numbers of single runs: from the table run, from their exponents, from their fragment masses. */
#include "db/ask/specimens.h"

#include <stdio.h>
#include <string.h>

#include "db/ask/query.h"

struct giving {
  const struct ask_specimens_quantity *quantity;
  ask_specimens_each each;
  void *context;
};

static void take_result(void *context, const struct store_point_run *run) {
  const struct giving *giving = context;
  if (!run->surplus && outcome_is_usable(run->state))
    giving->each(giving->context, run->seed, run->value);
}

/* Seed and exponent. */
static status take_exponent(void *context, size_t count, const struct query_value *values, struct error *error) {
  (void)count, (void)error;
  const struct giving *giving = context;
  giving->each(giving->context, (uint64_t)values[0].integer, values[1].real);
  return STATUS_OK;
}

/* Seed and masses: little-endian float64, the machine's own order. */
static status take_masses(void *context, size_t count, const struct query_value *values, struct error *error) {
  (void)count;
  const struct giving *giving = context;
  if (values[1].kind != QUERY_BLOB || values[1].size % sizeof(double) != 0)
    return status_fail(error, STATUS_CONTENT, "the fragment masses of a run are damaged; `clast check` tells more");
  const size_t n = values[1].size / sizeof(double);
  double total = 0, number = 0, heavier = 0, mass;
  for (size_t i = 0; i < n; i++) {
    memcpy(&mass, (const char *)values[1].blob + i * sizeof mass, sizeof mass);
    total += mass;
  }
  for (size_t i = 0; i < n; i++) {
    memcpy(&mass, (const char *)values[1].blob + i * sizeof mass, sizeof mass);
    if (mass > giving->quantity->share * total) {
      number++;
      heavier += mass;
    }
  }
  giving->each(giving->context, (uint64_t)values[0].integer,
               giving->quantity->kind == ASK_SPECIMENS_COUNT ? number : heavier / total);
  return STATUS_OK;
}

static const char exponents[] = "SELECT seed, beta FROM run JOIN estimate USING (run_id) WHERE point_id = :point AND "
                                "results_version = :version AND "
                                "counts = 1 AND method = :method AND \"window\" = :window ORDER BY replicate";
static const char masses[] =
    "SELECT seed, masses FROM run JOIN fragment_mass USING (run_id) WHERE point_id = :point AND results_version = "
    ":version AND counts = 1 ORDER BY replicate";

status ask_specimens(struct store *store, int64_t point_id, const struct engine_kind *kind,
                     const struct ask_specimens_quantity *quantity, ask_specimens_each each, void *context,
                     struct error *error) {
  struct giving giving = {quantity, each, context};
  if (quantity->kind == ASK_SPECIMENS_RESULT)
    return store_point_runs(store, point_id, kind, quantity->row, quantity->of_outcome, take_result, &giving, error);
  char point[32], version[32];
  snprintf(point, sizeof point, "%lld", (long long)point_id);
  snprintf(version, sizeof version, "%d", kind->results_version);
  const bool exponent = quantity->kind == ASK_SPECIMENS_EXPONENT;
  const struct query_parameter parameters[] = {{"point", point},
                                               {"version", version},
                                               {"method", exponent ? exponent_method_names[quantity->method] : ""},
                                               {"window", exponent ? estimates_window_names[quantity->window] : ""}};
  const struct query_sink sink = {.context = &giving, .row = exponent ? take_exponent : take_masses};
  return query_run(store, exponent ? exponents : masses, exponent ? 4 : 2, parameters, 0, &sink, error);
}
