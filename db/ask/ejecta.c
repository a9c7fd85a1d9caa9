/* Ejecta of impacts over their speed: of one run, and the means of a pool. */
#include "db/ask/ask.h"

#include <math.h>
#include <stdlib.h>

#include "db/store/internal.h"
#include "db/store/schema.h"
#include "schemas/memory.h"

status ask_run_ejecta(struct store *store, int64_t run_id, struct ejecta *ejecta, bool *stored, struct error *error) {
  *ejecta = (struct ejecta){.bin = {{0, 0}}};
  *stored = false;
  if (!schema_has_column(store->db, "ejecta", NULL))
    return STATUS_OK;
  ANSWER answer = answer_to(store, error,
                            "SELECT bin, mass, momentum FROM ejecta WHERE run_id = %lld AND bin BETWEEN %d AND %d",
                            (long long)run_id, EJECTA_FIRST, EJECTA_FIRST + EJECTA_BINS - 1);
  while (answer_next(&answer)) {
    ejecta->bin[answer_integer(&answer, 0) - EJECTA_FIRST] = (struct ejecta_bin){answer_real(&answer, 1),
                                                                                 answer_real(&answer, 2)};
    *stored = true;
  }
  return answer_end(&answer);
}

status ask_ejecta_known(struct store *store, bool *known, struct error *error) {
  char name[FIELD_TEXT_SIZE];
  double count = 0;
  field_column_name(engine_ejecta_sum()->path, name, sizeof name);
  TRY(answer_number(store, &count, error, "SELECT count(*) FROM pragma_table_info('runs') WHERE name = %Q", name));
  *known = count > 0;
  return STATUS_OK;
}

struct ask_pools ask_ejecta_pools(struct store *store, const struct ask_pool_choice *choice, struct error *error) {
  char name[FIELD_TEXT_SIZE];
  field_column_name(engine_ejecta_sum()->path, name, sizeof name);
  return ask_pools(store, choice, name, error);
}

/* Of all runs with ejecta, point after point: what leaves at the speed of a bin or faster. */
struct ejecta_runs {
  size_t room, points;
  size_t *first; /* of each point */
  uint64_t *seed;
  double *mass, *momentum; /* [bin * room + run] */
};

#define EJECTA_RUNS __attribute__((cleanup(release))) struct ejecta_runs
static void release(struct ejecta_runs *runs) {
  free(runs->first);
  free(runs->seed);
  free(runs->mass);
  free(runs->momentum);
}

static status make(const struct ask_pool *pool, struct ejecta_runs *runs, struct error *error) {
  static const char what[] = "the ejecta of runs";
  runs->room = pool->data.runs.count;
  TRY(memory_array(&runs->first, pool->points + 1, sizeof *runs->first, what, error));
  TRY(memory_array(&runs->seed, runs->room, sizeof *runs->seed, what, error));
  TRY(memory_array(&runs->mass, runs->room * EJECTA_BINS, sizeof *runs->mass, what, error));
  return memory_array(&runs->momentum, runs->room * EJECTA_BINS, sizeof *runs->momentum, what, error);
}

static status tell(const struct ejecta_runs *runs, const double *value, struct ask_ejecta_mean *out,
                   struct error *error) {
  const struct pooled_form form = {.units = runs->points, .first_run = runs->first, .seed = runs->seed};
  if (runs->points > 1)
    return pooled_mean(runs->first[runs->points], &form, value, &out->mean, &out->half_width, error);
  const struct sample_summary summary = sample_summarise(runs->first[1], value, 0.95);
  *out = (struct ask_ejecta_mean){summary.mean, summary.half_width};
  return STATUS_OK;
}

status ask_ejecta(struct store *store, const struct ask_pool *pool, struct ask_ejecta *out, struct error *error) {
  EJECTA_RUNS runs = {0};
  int first = EJECTA_BINS, last = -1; /* bins that hold something */
  TRY(make(pool, &runs, error));
  *out = (struct ask_ejecta){0};
  for (size_t p = 0; p < pool->points; p++) {
    for (size_t r = pool->first_run[p]; r < pool->first_run[p + 1]; r++) {
      struct ejecta run;
      bool stored;
      if (isnan(pool->value[r])) /* off or withheld */
        continue;
      TRY(ask_run_ejecta(store, pool->data.run_id[r], &run, &stored, error));
      if (!stored && pool->value[r] > 0) { /* of a program that did not store them */
        out->without++;
        continue;
      }
      for (int i = 0; i < EJECTA_BINS; i++)
        if (run.bin[i].mass > 0) {
          first = i < first ? i : first;
          last = i > last ? i : last;
        }
      ejecta_sum(&run);
      for (size_t i = 0; i < EJECTA_BINS; i++) {
        runs.mass[i * runs.room + out->runs] = run.bin[i].mass;
        runs.momentum[i * runs.room + out->runs] = run.bin[i].momentum;
      }
      runs.seed[out->runs++] = pool->data.seed[r];
    }
    if (out->runs > runs.first[runs.points])
      runs.first[++runs.points] = out->runs;
  }
  for (int i = first; i <= last; i++) {
    struct ask_ejecta_row *row = &out->row[out->count++];
    *row = (struct ask_ejecta_row){.speed = bins_edge(EJECTA_FIRST + i), .upper = bins_edge(EJECTA_FIRST + i + 1)};
    TRY(tell(&runs, runs.mass + (size_t)i * runs.room, &row->mass, error));
    TRY(tell(&runs, runs.momentum + (size_t)i * runs.room, &row->momentum, error));
  }
  return STATUS_OK;
}
