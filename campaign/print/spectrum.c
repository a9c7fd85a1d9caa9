/* Writes spectra and their distances as rows. */
#include "campaign/print/print.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

#include "campaign/terminal/table.h"

struct printing {
  const struct spectrum_choice *choice;
  enum table_format format;
  struct table *table;
  double complete; /* kg, of all pools */
};

/* Columns that tell the pools apart: the inputs of --by, or the point. pool NULL: there is none. */
static void name_pools(struct printing *printing, const struct ask_pool *pool) {
  printing->table = table_new(printing->format, stdout);
  for (size_t a = 0; pool && a < pool->axes; a++)
    table_column(printing->table, pool->column[a], NULL);
  if (!printing->choice->pool.by)
    table_column(printing->table, "point_id", NULL);
  else
    table_column(printing->table, "points", NULL);
}

static void tell_pool(struct printing *printing, const struct ask_pool *pool) {
  for (size_t a = 0; a < pool->axes; a++)
    table_value(printing->table, &pool->input[a]);
  table_integer(printing->table, printing->choice->pool.by ? (int64_t)pool->points : pool->data.point_id);
}

static void name_bins(struct printing *printing, const struct ask_pool *pool) {
  const struct spectrum_choice *choice = printing->choice;
  const bool sizes = choice->density > 0;
  const char *unit = sizes ? "m" : "kg";
  name_pools(printing, pool);
  struct table *table = printing->table;
  if (choice->runs)
    table_column(table, "run_id", NULL);
  table_column(table, "lower", unit);
  if (!choice->cumulative)
    table_column(table, "upper", unit);
  table_columns(table, (const char *const[]){"runs", "fragments", NULL});
  table_column(table, choice->cumulative ? "number" : "density", choice->cumulative ? NULL : sizes ? "1/m" : "1/kg");
  table_column(table, choice->cumulative ? "number_hw95" : "density_hw95",
               choice->cumulative ? NULL
               : sizes            ? "1/m"
                                  : "1/kg");
  table_column(table, "mass_share", NULL);
}

/* Prints the bins of a pool, or with run_id those of one of its runs. */
static status print_bins(struct printing *printing, const struct ask_pool *pool, const struct pooled_runs *runs,
                         const int64_t *run_id, struct error *error) {
  struct pooled_form form = ask_pool_form(pool, printing->choice->cumulative, printing->choice->density);
  struct table *table = printing->table;
  struct pooled_bin *bins;
  size_t count;
  double mass = 0;
  if (run_id)
    form.first_run = NULL;
  const status code = pooled_spectrum(runs, &form, &bins, &count, error);
  if (code)
    return code;
  for (size_t b = 0; b < count; b++)
    mass = form.cumulative ? fmax(mass, bins[b].mass) : mass + bins[b].mass;
  for (size_t b = 0; b < count && !table_broken(table); b++) {
    tell_pool(printing, pool);
    if (run_id)
      table_integer(table, *run_id);
    table_real(table, bins[b].lower);
    if (!form.cumulative)
      table_real(table, bins[b].upper);
    table_integer(table, (int64_t)runs->count);
    table_integer(table, bins[b].count);
    table_real(table, bins[b].value);
    table_real(table, bins[b].half_width);
    table_real(table, bins[b].mass / mass);
  }
  free(bins);
  return table_broken(table) ? STATUS_IO : STATUS_OK;
}

static status print_pool(struct printing *printing, const struct ask_pool *pool, struct error *error) {
  const struct pooled_runs *runs = &pool->data.runs;
  if (!printing->table)
    name_bins(printing, pool);
  if (!printing->choice->runs)
    return print_bins(printing, pool, runs, NULL, error);
  status code = STATUS_OK;
  for (size_t r = 0; r < runs->count && code == STATUS_OK; r++)
    code = print_bins(printing, pool, &(struct pooled_runs){1, runs->first + r, runs->masses}, &pool->data.run_id[r],
                      error);
  return code;
}

static status each_pool(struct store *store,
                        status (*print)(struct printing *printing, const struct ask_pool *pool, struct error *error),
                        struct printing *printing, struct error *error) {
  ASK_POOLS pools = ask_pools(store, &printing->choice->pool, NULL, error);
  for (const struct ask_pool *pool; (pool = ask_pools_next(&pools));)
    TRY(print(printing, pool, error));
  return ask_pools_end(&pools);
}

/* Ends the table. Rows printed before an error are kept. */
static status end_table(struct table *table, status code, struct error *error) {
  if (code && !table_broken(table)) {
    (void)table_end(table, NULL);
    return code;
  }
  return table_end(table, error);
}

status print_spectrum(struct store *store, const struct spectrum_choice *choice, enum table_format format,
                      struct error *error) {
  struct printing printing = {.choice = choice, .format = format};
  const status code = each_pool(store, print_pool, &printing, error);
  if (!printing.table && code)
    return code;
  if (!printing.table)
    name_bins(&printing, NULL);
  return end_table(printing.table, code, error);
}

static void name_matches(struct printing *printing, const struct ask_pool *pool) {
  name_pools(printing, pool);
  table_column(printing->table, "from", "kg");
  table_columns(printing->table, (const char *const[]){"measured", "runs", "fragments_mean", "fragments_hw95",
                                                       "distance", "runs_as_far", "log_likelihood", NULL});
}

static status print_match(struct printing *printing, const struct ask_pool *pool, struct error *error) {
  struct measured_match match;
  const status code = measured_compare(printing->choice->measured, &pool->data.runs, printing->complete, &match, error);
  if (code)
    return code;
  if (!printing->table)
    name_matches(printing, pool);
  tell_pool(printing, pool);
  table_real(printing->table, match.from);
  table_real(printing->table, match.fragments);
  table_integer(printing->table, (int64_t)pool->data.runs.count);
  table_real(printing->table, match.simulated.mean);
  table_real(printing->table, match.simulated.half_width);
  table_real(printing->table, match.distance);
  table_real(printing->table, match.share);
  table_real(printing->table, match.log_likelihood);
  return STATUS_OK;
}

status print_spectrum_match(struct store *store, const struct spectrum_choice *choice, enum table_format format,
                            struct error *error) {
  struct printing printing = {.choice = choice, .format = format, .complete = choice->measured->complete};
  ASK_POOLS pools = ask_pools(store, &choice->pool, NULL, error);
  for (const struct ask_pool *pool; (pool = ask_pools_next(&pools));)      /* likelihoods are compared above one mass */
    printing.complete = fmax(printing.complete, pool->data.complete_mass); /* fmax ignores a NaN */
  TRY(ask_pools_end(&pools));
  const status code = each_pool(store, print_match, &printing, error);
  if (!printing.table && code)
    return code;
  if (!printing.table)
    name_matches(&printing, NULL);
  if (code == STATUS_OK && format == TABLE_TEXT)
    fprintf(stderr,
            "clast: fragments from %.3g kg on, where the measured and all simulated spectra are complete. distance: "
            "Kolmogorov's, of %s; runs_as_far: share of the runs that are as far from the other runs as the "
            "measured one (one experiment is one specimen; below 0.05 speaks against the point)\n",
            printing.complete, choice->measured->weighed ? "the shares of mass" : "the shapes");
  return end_table(printing.table, code, error);
}
