/* Prints and draws how runs scatter. */
#include "campaign/print/print.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "schemas/memory.h"

enum { COLUMNS = 100 };

struct printing {
  const struct scatter_choice *choice;
  struct table *table;
  const struct ask_pools *pools;
  const struct ask_pool *pool;
};

static void row(const struct printing *printing, const char *name, double value, double low, double high) {
  print_pool_cells(printing->table, printing->pools, printing->pool);
  table_text(printing->table, name);
  if (strcmp(name, "runs") != 0)
    table_rests_on(printing->table, &printing->pool->doubts);
  table_real(printing->table, value);
  table_real(printing->table, low);
  table_real(printing->table, high);
  table_doubt_cells(printing->table, &printing->pool->doubts);
}

/* Number of runs for the wanted interval, from the standard deviation. NaN: not known. */
static double needed(double deviation, double half_width) {
  const size_t runs = scatter_runs_needed(deviation, half_width);
  return runs ? (double)runs : (double)NAN;
}

static void print_scatter(const struct printing *printing, struct scatter *s) {
  static const char *const names[SCATTER_QUANTILES] = {"q05", "q25", "median", "q75", "q95"};
  const double wanted = printing->choice->half_width, deviation = s->mean.standard_deviation;
  if (printing->pools->share)
    sample_of_share(&s->mean, 0.95);
  row(printing, "runs", (double)s->n, NAN, NAN);
  row(printing, "mean", s->mean.mean, s->mean.low, s->mean.high);
  if (s->mean.weak)
    row(printing, "mean is weak", 1, NAN, NAN);
  row(printing, "standard deviation", deviation, NAN, NAN);
  row(printing, "skewness", s->skewness, NAN, NAN);
  for (int q = 0; q < SCATTER_QUANTILES; q++)
    row(printing, names[q], s->quantile[q].value, s->quantile[q].low, s->quantile[q].high);
  row(printing, "dip", s->dip, NAN, NAN);
  row(printing, "dip p", s->dip_share, NAN, NAN);
  if (isfinite(s->between)) {
    row(printing, "lower mode", s->lower_mode, s->sorted[0], s->between);
    row(printing, "upper mode", s->upper_mode, s->between, s->sorted[s->n - 1]);
    row(printing, "share of upper mode", s->upper_share, s->upper_low, s->upper_high);
  }
  if (isfinite(wanted))
    row(printing, "runs needed", needed(deviation, wanted), NAN, NAN);
}

status print_scatter_rows(struct store *store, const struct scatter_choice *choice, enum table_format format,
                          struct error *error) {
  ASK_POOLS pools = ask_pools(store, &choice->pool, choice->quantity, error);
  TRY(pools.code);
  TABLE table = table_new(format, stdout);
  struct printing printing = {.choice = choice, .table = table, .pools = &pools};
  print_pool_columns(table, &pools);
  table_columns(table, (const char *const[]){"statistic", "value", "low", "high", NULL});
  table_doubt_columns(table);
  struct ask_doubts doubts = {0};
  bool several = false; /* a pool has more than one point */
  while (!table_broken(table) && (printing.pool = ask_pools_next(&pools))) {
    struct scatter scatter;
    several |= printing.pool->points > 1;
    ask_doubts_add(&doubts, &printing.pool->doubts);
    TRY(scatter_make(printing.pool->data.runs.count, printing.pool->value, &scatter, error));
    print_scatter(&printing, &scatter);
    scatter_release(&scatter);
  }
  TRY(ask_pools_end(&pools));
  TRY(table_end(table, error));
  if (format == TABLE_TEXT) {
    uncertainty_doubts(&doubts, stderr);
    fputs(
        "clast: low and high: 95 % intervals over runs; of modes the values that belong to them. dip p below 0.05: the "
        "runs have two modes\n",
        stderr);
  }
  if (several)
    fputs("clast: pooled over points: the scatter holds that of the inputs; the intervals take the runs as "
          "independent\n",
          stderr);
  return STATUS_OK;
}

static status plot_pool(bool ascii, const struct ask_pool *pool, struct error *error) {
  struct scatter scatter;
  char mark[UNCERTAINTY_TEXT];
  TRY(scatter_make(pool->data.runs.count, pool->value, &scatter, error));
  const struct scatter_histogram histogram = scatter_histogram_of(&scatter);
  uncertainty_mark(&pool->doubts, mark);
  printf("%s, %zu runs%s\n", pool->label, scatter.n, mark);
  text_plot_histogram(stdout, COLUMNS, !ascii, &histogram);
  if (isfinite(scatter.between))
    printf("two modes: %.4g and %.4g, apart at %.4g; %.0f %% of the runs are in the upper one (%.0f to %.0f %%)\n",
           scatter.lower_mode, scatter.upper_mode, scatter.between, 100 * scatter.upper_share, 100 * scatter.upper_low,
           100 * scatter.upper_high);
  scatter_release(&scatter);
  return STATUS_OK;
}

status print_scatter_plots(struct store *store, const struct scatter_choice *choice, bool ascii, struct error *error) {
  ASK_POOLS pools = ask_pools(store, &choice->pool, choice->quantity, error);
  struct ask_doubts doubts = {0};
  for (const struct ask_pool *pool; (pool = ask_pools_next(&pools));) {
    TRY(plot_pool(ascii, pool, error));
    ask_doubts_add(&doubts, &pool->doubts);
  }
  uncertainty_doubts(&doubts, stderr);
  return ask_pools_end(&pools);
}

struct samples {
  size_t count;
  bool more;
  struct scatter scatter[PICTURE_SERIES];
  struct ask_doubts doubts;
  char label[PICTURE_SERIES][ASK_POOL_LABEL + 64];
};

static status take_samples(struct store *store, const struct scatter_choice *choice, struct samples *samples,
                           struct error *error) {
  ASK_POOLS pools = ask_pools(store, &choice->pool, choice->quantity, error);
  for (const struct ask_pool *pool; !samples->more && (pool = ask_pools_next(&pools));) {
    samples->more = samples->count == PICTURE_SERIES; /* enough */
    if (samples->more)
      break;
    struct scatter *scatter = &samples->scatter[samples->count];
    TRY(scatter_make(pool->data.runs.count, pool->value, scatter, error));
    if (scatter->n == 0)
      scatter_release(scatter);
    else
      snprintf(samples->label[samples->count++], sizeof samples->label[0], "%s, %zu runs%s%s", pool->label, scatter->n,
               isfinite(scatter->between) ? ", two modes" : "", pool->doubts.doubtful ? " !" : "");
    ask_doubts_add(&samples->doubts, &pool->doubts);
  }
  TRY(ask_pools_end(&pools));
  if (samples->count > 0)
    return STATUS_OK;
  return status_fail(error, STATUS_USAGE, "no finished run has a value of %s", choice->quantity);
}

static status draw_samples(const struct samples *samples, const char *axis, const struct picture_page *page,
                           struct error *error) {
  struct picture_sample sample[PICTURE_SERIES];
  for (size_t i = 0; i < samples->count; i++)
    sample[i] = (struct picture_sample){samples->label[i], samples->scatter[i].n, samples->scatter[i].sorted,
                                        scatter_histogram_of(&samples->scatter[i])};
  char caption[CHARTS_LABEL] = "";
  charts_doubts(&samples->doubts, caption, sizeof caption);
  const status code = picture_scatter(page,
                                      &(struct picture_words){"Scatter of the runs", *caption ? caption : NULL, axis,
                                                              NULL},
                                      samples->count, sample, error);
  if (code == STATUS_OK && samples->more)
    fprintf(stderr, "clast: only the first %d are drawn; --point, --where and --by choose others\n", PICTURE_SERIES);
  return code;
}

status print_scatter_picture(struct store *store, const struct scatter_choice *choice, const struct picture_page *page,
                             struct error *error) {
  char column[ASK_GROUP_NAME], axis[CHARTS_LABEL] = "";
  OWNED struct samples *samples = memory_small(1, sizeof *samples);
  TRY(ask_group_quantity(store, choice->quantity, column, error));
  TRY(charts_axis(store, column, axis, error));
  status code = take_samples(store, choice, samples, error);
  if (code == STATUS_OK)
    code = draw_samples(samples, axis, page, error);
  for (size_t i = 0; i < samples->count; i++)
    scatter_release(&samples->scatter[i]);
  return code;
}
