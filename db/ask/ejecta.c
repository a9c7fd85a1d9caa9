/* Ejecta of impacts over their speed: of one run, and the means of a pool. */
#include "db/ask/ask.h"

#include <math.h>

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

/* Sums of a unit of the mean, which is a run or a point, and the moments of the units. */
struct ejecta_sums {
  struct ejecta unit;
  size_t runs;
  int first, last; /* bins that hold something */
  struct sample_moments mass[EJECTA_BINS], momentum[EJECTA_BINS];
};

static void end_unit(struct ejecta_sums *sums) {
  for (int i = 0; sums->runs > 0 && i < EJECTA_BINS; i++) {
    sample_add(&sums->mass[i], sums->unit.bin[i].mass / (double)sums->runs);
    sample_add(&sums->momentum[i], sums->unit.bin[i].momentum / (double)sums->runs);
  }
  sums->unit = (struct ejecta){.bin = {{0, 0}}};
  sums->runs = 0;
}

static void add_run(struct ejecta_sums *sums, struct ejecta *run) {
  for (int i = 0; i < EJECTA_BINS; i++)
    if (run->bin[i].mass > 0) {
      sums->first = i < sums->first ? i : sums->first;
      sums->last = i > sums->last ? i : sums->last;
    }
  ejecta_sum(run);
  for (int i = 0; i < EJECTA_BINS; i++) {
    sums->unit.bin[i].mass += run->bin[i].mass;
    sums->unit.bin[i].momentum += run->bin[i].momentum;
  }
  sums->runs++;
}

status ask_ejecta(struct store *store, const struct ask_pool *pool, struct ask_ejecta *out, struct error *error) {
  OWNED struct ejecta_sums *sums = memory_small(1, sizeof *sums);
  sums->first = EJECTA_BINS;
  sums->last = -1;
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
      out->runs++;
      add_run(sums, &run);
      if (pool->points == 1)
        end_unit(sums);
    }
    end_unit(sums);
  }
  for (int i = sums->first; i <= sums->last; i++)
    out->row[out->count++] = (struct ask_ejecta_row){bins_edge(EJECTA_FIRST + i), bins_edge(EJECTA_FIRST + i + 1),
                                                     sample_summarise_moments(&sums->mass[i], 0.95),
                                                     sample_summarise_moments(&sums->momentum[i], 0.95)};
  return STATUS_OK;
}
