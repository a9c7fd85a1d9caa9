/* `clast exponents STORE`: the exponent of every point under its four names, and a test of the power law. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "campaign/commands/commands.h"
#include "campaign/terminal/words.h"

struct options {
  int64_t draws, dimensions;
};

enum { UNTOLD = 400 };

static double with_two_digits(double number) {
  char text[32];
  snprintf(text, sizeof text, "%.2g", number);
  return strtod(text, NULL);
}

struct seen {
  bool flat;           /* beta is 1 or less: numbers above a mass are no power law then */
  bool unsized;        /* the dimensions of a program's model are not known */
  char untold[UNTOLD]; /* why exponents are not told, */
  const char *open;    /* and why one has no interval; NULL: each has */
};

/* Prints a point's exponent under its four names, with the goodness of its fit.
 * Points without estimates have no row. */
static status print_pool(struct table *table, const struct options *options, bool people, const struct ask_pools *pools,
                         const struct ask_pool *pool, struct seen *seen, struct error *error) {
  const double lower = point_window(&pool->data, (enum estimates_window)ESTIMATES_HEADLINE_WINDOW);
  struct pooled_exponent fit;
  struct pooled_goodness goodness;
  struct pooled_rivals rivals;
  if (!(lower > 0))
    return STATUS_OK; /* the store has no estimates of its runs */
  const struct pooled_runs *runs = &pool->data.runs;
  TRY(pooled_exponent(runs, (enum exponent_method)ESTIMATES_HEADLINE_METHOD, lower, 0.95, &fit, error));
  TRY(pooled_goodness(runs, lower, (size_t)options->draws, &goodness, error));
  TRY(pooled_rivals(runs, lower, &rivals, error));
  print_pool_cells(table, pools, pool);
  table_reals(table, 2, (const double[]){lower, pool->data.complete_mass});
  table_integer(table, (int64_t)runs->count);
  table_integer(table, fit.fit.n);
  const char *untold = pooled_exponent_untold(&fit);
  pooled_exponent_tell(untold, seen->untold, UNTOLD);
  const bool weak = !untold && runs->count > 1 && !isfinite(fit.interval.half_width);
  if (weak)
    seen->open = pooled_exponent_no_interval(&fit);
  if (people && untold)
    fit.fit.beta = NAN;
  const double any = 1; /* a density: the exponents by size do not depend on it */
  seen->flat |= fit.fit.beta <= 1;
  const bool unsized = pool->data.dimensions == 0;
  seen->unsized |= unsized;
  for (int form = 0; form < 4; form++) {
    const struct pooled_form named = ask_pool_form(pool, form % 2, form / 2 ? any : 0);
    const bool none = (people && form % 2 && fit.fit.beta <= 1) || (form / 2 && unsized);
    table_rests_on(table, &pool->doubts);
    table_fixed(table, none ? (double)NAN : pooled_spectrum_exponent(&named, fit.fit.beta),
                people ? pooled_exponent_decimals(&fit) : 2);
    if (form == 0 || form == 3)
      table_fixed(table, none ? (double)NAN : pooled_spectrum_half_width(&named, fit.interval.half_width), 2);
    if (people)
      table_integer(table, weak && !none);
  }
  const double tests[] = {goodness.distance, goodness.p, rivals.cutoff_p, rivals.open_cutoff_p, rivals.lognormal_p};
  for (size_t k = 0; k < sizeof tests / sizeof tests[0]; k++) {
    table_rests_on(table, &pool->doubts);
    table_real(table, people ? with_two_digits(tests[k]) : tests[k]);
  }
  table_doubt_cells(table, &pool->doubts);
  return STATUS_OK;
}

static status ask(struct store *store, const struct command_line *line, struct error *error) {
  const struct options *options = line->options;
  char kg[64]; /* none with runs of the plane and of space */
  TRY(ask_columns_unit(store, OUTCOME_NAME(mean_fragment_mass), kg, sizeof kg, error));
  ASK_POOLS pools = ask_pools(store, &(struct ask_pool_choice){.inputs = true, .dimensions = (int)options->dimensions},
                              NULL, error);
  TABLE table = table_new(line->format, stdout);
  print_pool_columns(table, &pools);
  table_column(table, "from", kg);
  table_column(table, OUTCOME_NAME(complete_mass), kg);
  table_rare(table);
  table_columns(table, table_for_people(line->format)
                           ? (const char *const[]){"runs", "fragments", "F(m)", "F(m)_hw95", "F(m)_weak", "N(>m)",
                                                   "N(>m)_weak", "F(L)", "F(L)_weak", "N(>L)", "N(>L)_hw95",
                                                   "N(>L)_weak", "distance", NULL}
                           : (const char *const[]){"runs", "fragments", "F(m)", "F(m)_hw95", "N(>m)", "F(L)", "N(>L)",
                                                   "N(>L)_hw95", "distance", NULL});
  table_rare(table);
  table_columns(table, (const char *const[]){"p", "cutoff_p", "open_cutoff_p", NULL});
  table_column(table, "lognormal_p", NULL);
  table_doubt_columns(table);
  struct ask_doubts doubts = {0};
  struct seen seen = {.flat = false};
  for (const struct ask_pool *pool; !table_broken(table) && (pool = ask_pools_next(&pools));) {
    ask_doubts_add(&doubts, &pool->doubts);
    TRY(print_pool(table, options, table_for_people(line->format), &pools, pool, &seen, error));
  }
  TRY(ask_pools_end(&pools));
  TRY(table_end(table, error));
  if (table_for_people(line->format)) {
    uncertainty_doubts(&doubts, stderr);
    words_print(
        stderr, "",
        "clast: exponents by maximum likelihood on masses, from the lightest mass on, which is never below the "
        "complete mass. p below 0.1: a power law does not fit. p of cut-off below 0.05: one with an exponential "
        "cut-off fits better; largest included: the same with the largest fragments, where they belong to the "
        "law%s%s%s%s%s%s",
        *seen.untold ? ". -: " : "", seen.untold, seen.open ? ". ~: no interval, " : "", seen.open ? seen.open : "",
        seen.flat ? ". N(>m), N(>L) -: numbers above a mass follow no power law where F(m) is at most 1" : "",
        seen.unsized ? ". F(L), N(>L) -: clast does not know the dimensions of a program's model (--dimensions 2 or 3)"
                     : "");
  }
  return STATUS_OK;
}

static const struct option_row option_rows[] = {
    OPTION_ROW_INTEGER("draws", 0, "N", struct options, draws, 100, 1000000, "2500"),
    OPTION_ROW_INTEGER("dimensions", 0, "D", struct options, dimensions, 2, 3, 0),
};

COMMAND(exponents, "results", "STORE", .chooses_runs = true, COMMAND_OPTIONS(struct options, option_rows),
        .has_table = true, .ask = ask);
