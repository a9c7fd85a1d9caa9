/* `clast spectrum STORE`: fragment mass spectra, pooled over the seeds of each point. */
#include <stdlib.h>

#include "campaign/commands/commands.h"
#include "campaign/commands/rows.h"

struct options {
  int64_t point;
  const char *where;
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
  store_close(store, NULL);
  return code;
}

static const struct option_row rows[] = {
    {"point", 'p', OPTION_INTEGER, "N", offsetof(struct options, point), 0, INT64_MAX, "0",
     "Only this point (point_id in the view points); 0 is all."},
    {"where", 'w', OPTION_TEXT, "SQL", offsetof(struct options, where), 0, 0, NULL,
     "Only runs for which this holds, on the view runs: \"threshold_strain > 0.02\"."},
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
    .examples = "clast spectrum out.db --point 1\nclast spectrum out.db --where \"largest_fraction < 0.5\" --csv",
    .minimum_arguments = 1,
    .maximum_arguments = 1,
    .options = rows,
    .option_count = sizeof rows / sizeof rows[0],
    .options_size = sizeof(struct options),
    .run = run,
};
