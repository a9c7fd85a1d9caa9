/* Writes spectra and their distances as rows. */
#include "campaign/print/print.h"

#include <math.h>
#include <stdlib.h>

#include "schemas/memory.h"

/* Prints the bins of a pool, or with run_id those of one of its runs. */
static status print_bins(struct table *table, const struct spectrum_choice *choice, const struct ask_pools *pools,
                         const struct ask_pool *pool, const struct pooled_runs *runs, const int64_t *run_id,
                         const struct ask_doubts *doubts, struct error *error) {
  struct pooled_form form = ask_pool_form(pool, choice->cumulative, choice->density);
  OWNED struct pooled_bin *bins = NULL;
  size_t count;
  double mass = 0;
  if (run_id)
    form.first_run = NULL;
  TRY(pooled_spectrum(runs, &form, &bins, &count, error));
  for (size_t b = 0; b < count; b++)
    mass = form.cumulative ? fmax(mass, bins[b].mass) : mass + bins[b].mass;
  for (size_t b = 0; b < count && !table_broken(table); b++) {
    print_pool_cells(table, pools, pool);
    if (run_id)
      table_integer(table, *run_id);
    table_real(table, bins[b].lower);
    if (!form.cumulative)
      table_real(table, bins[b].upper);
    table_integer(table, (int64_t)runs->count);
    table_integer(table, bins[b].count);
    table_rests_on(table, doubts);
    table_real(table, bins[b].value);
    table_real(table, bins[b].half_width);
    table_real(table, bins[b].mass / mass);
    table_doubt_cells(table, doubts);
  }
  return STATUS_OK;
}

status print_spectrum(struct store *store, const struct spectrum_choice *choice, enum table_format format,
                      struct error *error) {
  const bool sizes = choice->density > 0;
  const char *unit = sizes ? "m" : "kg", *per_unit = choice->cumulative ? NULL : sizes ? "1/m" : "1/kg";
  ASK_POOLS pools = ask_pools(store, &choice->pool, NULL, error);
  TRY(pools.code);
  TABLE table = table_new(format, stdout);
  print_pool_columns(table, &pools);
  if (choice->runs)
    table_column(table, "run_id", NULL);
  table_column(table, "lower", unit);
  if (!choice->cumulative)
    table_column(table, "upper", unit);
  table_columns(table, (const char *const[]){"runs", "fragments", NULL});
  table_column(table, choice->cumulative ? "number" : "density", per_unit);
  table_column(table, choice->cumulative ? "number_hw95" : "density_hw95", per_unit);
  table_column(table, "mass_share", NULL);
  table_doubt_columns(table);
  struct ask_doubts sum = {0};
  for (const struct ask_pool *pool; !table_broken(table) && (pool = ask_pools_next(&pools));) {
    const struct pooled_runs *runs = &pool->data.runs;
    ask_doubts_add(&sum, &pool->doubts);
    if (!choice->runs)
      TRY(print_bins(table, choice, &pools, pool, runs, NULL, &pool->doubts, error));
    for (size_t r = 0; choice->runs && r < runs->count && !table_broken(table); r++) {
      struct ask_doubts doubts = {0};
      TRY(ask_doubts(store, &(struct ask_doubts_choice){.run = pool->data.run_id[r]}, OUTCOME_NAME(mean_fragment_mass),
                     &doubts, error));
      TRY(print_bins(table, choice, &pools, pool, &(struct pooled_runs){1, runs->first + r, runs->masses},
                     &pool->data.run_id[r], &doubts, error));
    }
  }
  TRY(ask_pools_end(&pools));
  TRY(table_end(table, error));
  if (format == TABLE_TEXT)
    uncertainty_doubts(&sum, stderr);
  return STATUS_OK;
}

status print_spectrum_match(struct store *store, const struct spectrum_choice *choice, enum table_format format,
                            struct error *error) {
  double complete = choice->measured->complete; /* kg; likelihoods are compared above one mass */
  ASK_POOLS before = ask_pools(store, &choice->pool, NULL, error);
  for (const struct ask_pool *pool; (pool = ask_pools_next(&before));)
    complete = fmax(complete, pool->data.complete_mass); /* fmax ignores a NaN */
  TRY(ask_pools_end(&before));
  ASK_POOLS pools = ask_pools(store, &choice->pool, NULL, error);
  TRY(pools.code);
  TABLE table = table_new(format, stdout);
  print_pool_columns(table, &pools);
  table_column(table, "from", "kg");
  table_columns(table, (const char *const[]){"measured", "runs", "fragments_mean", "fragments_hw95", "distance",
                                             "runs_as_far", "log_likelihood", NULL});
  table_doubt_columns(table);
  struct ask_doubts sum = {0};
  for (const struct ask_pool *pool; (pool = ask_pools_next(&pools));) {
    struct measured_match match;
    TRY(measured_compare(choice->measured, &pool->data.runs, complete, &match, error));
    print_pool_cells(table, &pools, pool);
    table_real(table, match.from);
    table_real(table, match.fragments);
    table_integer(table, (int64_t)pool->data.runs.count);
    table_rests_on(table, &pool->doubts);
    table_real(table, match.simulated.mean);
    table_real(table, match.simulated.half_width);
    table_rests_on(table, &pool->doubts);
    table_real(table, match.distance);
    table_rests_on(table, &pool->doubts);
    table_real(table, match.share);
    table_rests_on(table, &pool->doubts);
    table_real(table, match.log_likelihood);
    table_doubt_cells(table, &pool->doubts);
    ask_doubts_add(&sum, &pool->doubts);
  }
  TRY(ask_pools_end(&pools));
  TRY(table_end(table, error));
  if (format == TABLE_TEXT) {
    uncertainty_doubts(&sum, stderr);
    fprintf(stderr,
            "clast: fragments from %.3g kg on, where the measured and all simulated spectra are complete. distance: "
            "Kolmogorov's, of %s; runs_as_far: share of the runs that are as far from the other runs as the "
            "measured one (one experiment is one specimen; below 0.05 speaks against the point)\n",
            complete, choice->measured->weighed ? "the shares of mass" : "the shapes");
  }
  return STATUS_OK;
}
