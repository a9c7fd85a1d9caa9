/* The pooled spectra of any choice of runs. */
#include "db/ask/spectrum.h"

#include <stdio.h>
#include <stdlib.h>

static const char start[] = "WITH chosen AS (SELECT r.run_id, r.point_id, r.results_version,"
                            "   (SELECT %s FROM run WHERE run_id = r.run_id) AS m"
                            "   FROM run AS r WHERE r.counts AND r.results_version ="
                            "   (SELECT max(results_version) FROM run AS newest WHERE newest.point_id = r.point_id)";

static const char
    end[] = "), total AS (SELECT point_id, count(*) AS n, sum(m) AS mass FROM chosen GROUP BY point_id),"
            " pooled AS (SELECT point_id, bin, sum(count) AS s1, sum(count * count) AS s2, sum(mass) AS mass"
            "   FROM chosen JOIN spectrum USING (run_id) GROUP BY point_id, bin)"
            " SELECT point_id, lower, upper, n AS runs, s1 AS fragments,"
            "   s1 / (n * (upper - lower)) AS density,"
            "   pooled_hw95(n, s1, s2) / (upper - lower) AS density_hw95,"
            "   pooled.mass / total.mass AS mass_share"
            " FROM pooled JOIN total USING (point_id) JOIN bin USING (bin) ORDER BY point_id, bin";

status ask_spectrum(struct store *store, int64_t point_id, const char *where, const struct query_sink *sink,
                    struct error *error) {
  status code = ask_register_functions(store, error);
  if (code)
    return code;
  char *sql = NULL;
  size_t size = 0;
  FILE *out = open_memstream(&sql, &size);
  if (!out)
    return status_fail(error, STATUS_MEMORY, "out of memory");
  fprintf(out, start, OUTCOME_NAME(total_mass));
  if (point_id)
    fprintf(out, " AND r.point_id = %lld", (long long)point_id);
  if (where)
    fprintf(out, " AND r.run_id IN (SELECT run_id FROM runs WHERE %s\n)", where);
  fputs(end, out);
  fclose(out);
  if (!sql)
    return status_fail(error, STATUS_MEMORY, "out of memory");

  code = query_run(store, sql, 0, NULL, 0, sink, error);
  free(sql);
  return code;
}
