/* `clast spectrum STORE`: fragment mass spectra, pooled over the seeds of each point. */
#include <math.h>
#include <stdlib.h>

#include "analysis/picture.h"
#include "campaign/commands/commands.h"
#include "campaign/commands/pool.h"
#include "campaign/commands/rows.h"

struct options {
  int64_t point;
  const char *where, *picture;
  struct table_options table;
};

/* From the bins of single runs, so that any condition on runs can choose them. The scatter between runs gives the error:
 * fragments of one run are not independent. */
static const char sql_start[] =
    "with chosen as (select r.run_id, r.point_id, r.results_version, (select total_mass from run where run_id = r.run_id) as m"
    "   from run as r where r.counts and r.results_version ="
    "   (select max(results_version) from run as newest where newest.point_id = r.point_id)",
    sql_end[] =
        "), total as (select point_id, count(*) as n, sum(m) as mass from chosen group by point_id),"
        " pooled as (select point_id, bin, sum(count) as s1, sum(count * count) as s2, sum(mass) as mass"
        "   from chosen join spectrum using (run_id) group by point_id, bin)"
        " select point_id, lower, upper, n as runs, s1 as fragments,"
        "   s1 / (n * (upper - lower)) as density,"
        "   case when n > 1 then sqrt(max(0.0, (1.0 * s2 - 1.0 * s1 * s1 / n) / (n - 1) / n)) / (upper - lower) end as density_error,"
        "   pooled.mass / total.mass as mass_share"
        " from pooled join total using (point_id) join bin using (bin) order by point_id, bin";

enum { SERIES_MAXIMUM = 8, WIDTH = 900 }; /* more curves in one picture cannot be told apart */

struct series {
  int64_t points[SERIES_MAXIMUM];
  size_t count;
};

static status take_point(void *context, size_t count, const struct query_value *values, struct error *error) {
  (void)count, (void)error;
  struct series *series = context;
  if (series->count < SERIES_MAXIMUM)
    series->points[series->count++] = values[0].integer;
  return STATUS_OK;
}

/* One point's bins, and its headline exponent with the error from resampling runs. */
static status make_series(struct store *store, int64_t point, struct picture_series *series, struct picture_fit *fit,
                          char label[2][96], struct error *error) {
  struct pool pool;
  struct pooled_bin *bins = NULL;
  struct pooled_exponent exponent = {.fit = {.beta = NAN}};
  double lower = NAN;
  size_t count = 0;
  status code = pool_read(store, point, 0, &pool, error);
  if (!code)
    code = pooled_spectrum(&pool.runs, true, 1, &bins, &count, error);
  if (!code)
    code = pool_window(store, &pool, (enum estimates_window)ESTIMATES_HEADLINE_WINDOW, &lower, error);
  if (!code && lower > 0)
    code = pooled_exponent(&pool.runs, (enum exponent_method)ESTIMATES_HEADLINE_METHOD, lower, 400, 0.95, 1, &exponent, error);
  if (!code) {
    snprintf(label[0], 96, "point %lld, %zu runs", (long long)point, pool.runs.count);
    snprintf(label[1], 96, "beta %.2f +- %.2f", exponent.fit.beta, exponent.interval.standard_error);
    *fit = (struct picture_fit){label[1], exponent.fit.beta, exponent.fit.lower, exponent.fit.upper,
                                pool.runs.count ? (double)exponent.fit.n / (double)pool.runs.count : 0};
    *series = (struct picture_series){.label = label[0], .count = count, .bins = bins,
                                      .fits = isnan(exponent.fit.beta) ? 0u : 1u, .fit = fit};
    bins = NULL;
  }
  free(bins);
  pool_clear(&pool);
  return code;
}

static status draw(struct store *store, const struct options *options, struct error *error) {
  struct series chosen = {.points = {options->point}, .count = options->point ? 1 : 0};
  struct query_sink sink = {&chosen, NULL, take_point};
  struct picture_series series[SERIES_MAXIMUM] = {0};
  struct picture_fit fits[SERIES_MAXIMUM];
  char labels[SERIES_MAXIMUM][2][96];
  status code = STATUS_OK;
  if (!options->point)
    code = query_run(store, "select point_id from point_total where runs > 0 group by point_id order by point_id", 0, NULL, 0, &sink,
                     error);
  for (size_t i = 0; !code && i < chosen.count; i++)
    code = make_series(store, chosen.points[i], &series[i], &fits[i], labels[i], error);
  if (!code && chosen.count == 0)
    code = status_fail(error, STATUS_USAGE, "the store has no finished runs to draw");
  if (!code)
    code = picture_spectrum(options->picture, WIDTH, "fragment mass spectrum", "kg", chosen.count, series, error);
  for (size_t i = 0; i < chosen.count; i++)
    free((void *)series[i].bins);
  return code;
}

static status run(const struct command_line *line, struct error *error) {
  const struct options *options = line->options;
  enum table_format format = TABLE_TEXT;
  struct store *store = NULL;
  char *sql = NULL;
  size_t size = 0;
  status code = table_choose(&options->table, &format, error);
  if (!code)
    code = store_open_reader(line->arguments[0], &store, error);
  if (code)
    return code;
  FILE *text = open_memstream(&sql, &size);
  if (text) {
    fputs(sql_start, text);
    if (options->point)
      fprintf(text, " and r.point_id = %lld", (long long)options->point);
    if (options->where)
      fprintf(text, " and r.run_id in (select run_id from runs where %s\n)", options->where);
    fputs(sql_end, text);
    fclose(text);
  }
  code = sql ? rows_print(store, sql, 0, NULL, format, stdout, error)
             : status_fail(error, STATUS_MEMORY, "out of memory");
  free(sql);
  if (!code && options->picture)
    code = draw(store, options, error);
  store_close(store, NULL);
  return code;
}

static const struct option_row rows[] = {
    {"point", 'p', OPTION_INTEGER, "N", offsetof(struct options, point), 0, INT64_MAX, "0",
     "Only this point (point_id in the view points); 0 is all."},
    {"where", 'w', OPTION_TEXT, "SQL", offsetof(struct options, where), 0, 0, NULL,
     "Only runs for which this holds, on the view runs: \"threshold_strain > 0.02\"."},
    {"picture", 0, OPTION_TEXT, "FILE.png", offsetof(struct options, picture), 0, 0, NULL,
     "Draw F(m) with the fitted power law too: of --point, or of the first eight points. PNG or SVG by the ending."},
    TABLE_OPTIONS(struct options, table),
};

const struct command spectrum_command = {
    .name = "spectrum",
    .group = "results",
    .arguments = "STORE",
    .summary = "fragment mass spectra of the points, with errors from run to run",
    .doc = "Prints for each point and each mass bin that holds something the fragments of all runs that count, the\n"
           "density F(m) (fragments per kg and run) with its standard error from the scatter between runs, and the share\n"
           "of the mass. F(m) is differential: a power law m^-beta has this slope on it, N(>m) has beta - 1.",
    .examples = "clast spectrum out.db --point 1\nclast spectrum out.db --csv --picture spectrum.svg",
    .minimum_arguments = 1,
    .maximum_arguments = 1,
    .options = rows,
    .option_count = sizeof rows / sizeof rows[0],
    .options_size = sizeof(struct options),
    .run = run,
};
