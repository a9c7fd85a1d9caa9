/* Numbers of single runs: from the table run, from their exponents, from their fragment masses. */
#include "db/ask/specimens.h"

#include <string.h>

#include "db/ask/answer.h"

struct giving {
  ask_specimens_each each;
  void *context;
};

static void take_result(void *context, const struct store_point_run *run) {
  const struct giving *giving = context;
  if (!run->surplus && outcome_is_usable(run->state))
    giving->each(giving->context, run->seed, run->value);
}

/* The number, or the share of the mass, of fragments heavier than a share of the body. */
static double heavier(const struct ask_specimens_quantity *quantity, size_t n, const void *masses) {
  double total = 0, number = 0, heavy = 0, mass;
  for (size_t i = 0; i < n; i++) {
    memcpy(&mass, (const char *)masses + i * sizeof mass, sizeof mass);
    total += mass;
  }
  for (size_t i = 0; i < n; i++) {
    memcpy(&mass, (const char *)masses + i * sizeof mass, sizeof mass);
    if (mass > quantity->share * total) {
      number++;
      heavy += mass;
    }
  }
  return quantity->kind == ASK_SPECIMENS_COUNT ? number : heavy / total;
}

status ask_specimens(struct store *store, int64_t point_id, const struct engine_kind *kind,
                     const struct ask_specimens_quantity *quantity, ask_specimens_each each, void *context,
                     struct error *error) {
  if (quantity->kind == ASK_SPECIMENS_RESULT)
    return store_point_runs(store, point_id, kind, quantity->row, quantity->of_outcome, take_result,
                            &(struct giving){each, context}, error);
  if (quantity->kind == ASK_SPECIMENS_EXPONENT) {
    ANSWER
    betas = answer_to(store, error,
                      "SELECT seed, beta FROM run JOIN estimate USING (run_id) WHERE point_id = %lld AND "
                      "results_version = %d AND counts = 1 AND method = %Q AND \"window\" = %Q ORDER BY replicate",
                      (long long)point_id, kind->results_version, exponent_method_names[quantity->method],
                      estimates_window_names[quantity->window]);
    while (answer_next(&betas))
      each(context, (uint64_t)answer_integer(&betas, 0), answer_real(&betas, 1));
    return answer_end(&betas);
  }
  ANSWER runs = answer_to(store, error,
                          "SELECT seed, masses FROM run JOIN fragment_mass USING (run_id) WHERE point_id = %lld AND "
                          "results_version = %d AND counts = 1 ORDER BY replicate",
                          (long long)point_id, kind->results_version);
  const void *masses;
  size_t n;
  while (answer_next(&runs) && answer_masses(&runs, 1, "a run", &masses, &n))
    each(context, (uint64_t)answer_integer(&runs, 0), heavier(quantity, n, masses));
  return answer_end(&runs);
}
