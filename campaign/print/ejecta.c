/* Ejecta of impacts over their speed, as rows and a picture. */
#include "campaign/print/print.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "schemas/memory.h"

/* The chart of spectra draws bins over any axis. */
static const struct pooled_form above = {.cumulative = true};

struct curves {
  size_t count, more; /* drawn, and not drawn */
  size_t without;     /* runs of older programs */
  struct ask_doubts doubts;
  struct picture_series series[PICTURE_SERIES];
  char label[PICTURE_SERIES][ASK_POOL_LABEL + 64];
  struct pooled_bin bins[PICTURE_SERIES][EJECTA_BINS];
};

static void keep_curve(struct curves *curves, const struct ask_pool *pool, const struct ask_ejecta *ejecta) {
  if (curves->count == PICTURE_SERIES) {
    curves->more++;
    return;
  }
  struct pooled_bin *bins = curves->bins[curves->count];
  char *label = curves->label[curves->count];
  snprintf(label, sizeof curves->label[0], "%s, %zu run%s%s", pool->label, ejecta->runs, ejecta->runs == 1 ? "" : "s",
           pool->doubts.doubtful ? " !" : "");
  for (size_t i = 0; i < ejecta->count; i++) {
    const struct ask_ejecta_row *row = &ejecta->row[i];
    bins[i] = (struct pooled_bin){.lower = row->speed,
                                  .upper = row->upper,
                                  .value = row->mass.mean,
                                  .half_width = row->mass.half_width};
  }
  curves->series[curves->count++] = (struct picture_series){.label = label, .count = ejecta->count, .bins = bins};
}

static void print_rows(struct table *table, const struct ask_pools *pools, const struct ask_pool *pool,
                       const struct ask_ejecta *ejecta) {
  for (size_t i = 0; i < ejecta->count && !table_broken(table); i++) {
    const struct ask_ejecta_row *row = &ejecta->row[i];
    print_pool_cells(table, pools, pool);
    table_real(table, row->speed);
    table_integer(table, (int64_t)ejecta->runs);
    table_rests_on(table, &pool->doubts);
    table_reals(table, 2, (const double[]){row->mass.mean, row->mass.half_width});
    table_rests_on(table, &pool->doubts);
    table_reals(table, 2, (const double[]){row->momentum.mean, row->momentum.half_width});
    table_doubt_cells(table, &pool->doubts);
  }
}

static status take(struct store *store, const struct ask_pool_choice *choice, struct table *table,
                   struct curves *curves, struct error *error) {
  static const struct sample_range positive = {.least = 0, .most = HUGE_VAL};
  OWNED struct ask_ejecta *ejecta = memory_small(1, sizeof *ejecta);
  ASK_POOLS pools = ask_ejecta_pools(store, choice, error);
  TRY(pools.code);
  print_pool_columns(table, &pools);
  table_column(table, "speed", "m/s");
  table_column(table, "runs", NULL);
  table_column(table, "mass", "kg");
  table_column(table, "mass_hw95", "kg");
  table_range(table, positive);
  table_column(table, "momentum", "kg m/s");
  table_column(table, "momentum_hw95", "kg m/s");
  table_range(table, positive);
  table_doubt_columns(table);
  for (const struct ask_pool *pool; !table_broken(table) && (pool = ask_pools_next(&pools));) {
    TRY(ask_ejecta(store, pool, ejecta, error));
    ask_doubts_add(&curves->doubts, &pool->doubts);
    curves->without += ejecta->without;
    if (ejecta->count)
      keep_curve(curves, pool, ejecta);
    print_rows(table, &pools, pool, ejecta);
  }
  return ask_pools_end(&pools);
}

static status draw(struct store *store, const char *by, const struct curves *curves, const struct picture_page *page,
                   struct error *error) {
  struct ask_group_pooled pooled;
  char title[300], scenes[200], intervals[600], caption[1200];
  TRY(ask_group_pooled(store, by, &pooled, error));
  charts_intervals(&pooled, intervals, sizeof intervals);
  snprintf(caption, sizeof caption,
           "Mass of the target's matter that leaves at a speed or faster, mean of a run. Bands: %s", intervals);
  charts_doubts(store, &curves->doubts, caption, sizeof caption);
  TRY(ask_points_scenes(store, scenes, sizeof scenes, error));
  snprintf(title, sizeof title, "Ejecta of %s", scenes);
  const struct picture_words words = {title, caption, "speed v (m/s)", "mass faster than v (kg)"};
  return picture_spectrum(page, &words, &above, curves->count, curves->series, error);
}

status print_ejecta(struct store *store, const struct ask_pool_choice *choice, const struct picture_page *page,
                    enum table_format format, struct error *error) {
  OWNED struct curves *curves = memory_small(1, sizeof *curves);
  const bool people = table_for_people(format);
  TABLE table = table_new(format, stdout);
  bool known;
  TRY(ask_ejecta_known(store, &known, error));
  struct ask_pool_choice pool_choice = *choice;
  pool_choice.inputs = people;
  if (known)
    TRY(take(store, &pool_choice, table, curves, error));
  if (curves->count == 0)
    return status_fail(error, STATUS_USAGE, "no run has ejecta%s",
                       curves->without ? " over their speed: an older clast computed them. Run the campaign in a new "
                                         "store (--store)"
                                       : ": no impact is stored, or no matter left a target");
  TRY(table_end(table, error));
  if (page)
    TRY(draw(store, choice->by, curves, page, error));
  if (people)
    uncertainty_doubts(&curves->doubts, stderr);
  if (people)
    fputs(
        "clast: mass and momentum (along the outward normal) of the target's matter that leaves at a speed or faster; "
        "±: 95 % intervals over runs, of pooled points over points and seeds\n",
        stderr);
  if (curves->without)
    fprintf(stderr, "clast: %zu runs are left out: an older clast stored no speeds of their ejecta\n", curves->without);
  if (curves->more && page)
    fprintf(stderr, "clast: only the first %d curves are drawn; --point, --where and --by choose others\n",
            PICTURE_SERIES);
  return STATUS_OK;
}
