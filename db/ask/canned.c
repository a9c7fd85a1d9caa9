/* Canned queries. People also learn the views from them: they are plain SQL without functions of our own, so that each
 * can be pasted into any tool. They read the views, not table run: the views leave out values that are withheld. */
#include "db/ask/ask.h"

#include <string.h>

extern const char canned_scatter_sql[]; /* db/ask/canned_scatter.sql, which the build embeds */

static const struct query_canned queries[] = {
    {"points", "Statistics of every point: n, failed, censored, mean, scatter and interval of the main results.",
     "SELECT * FROM points", ""},
    {"point-stats",
     "Mean, standard deviation and standard error of the largest fragment's mass share M_1/M, per point.",
     "SELECT point_id, results_version, n, " OUTCOME_DEFAULT "_mean AS mean, " OUTCOME_DEFAULT
     "_sd AS sd, " OUTCOME_DEFAULT "_se AS se FROM points WHERE n > 0 ORDER BY point_id, results_version",
     ""},
    {"runs", "Every run of a point, with its inputs and results (:point).",
     "SELECT * FROM runs WHERE point_id = :point ORDER BY replicate, seed", "point"},
    {"spectrum",
     "Pooled fragment mass spectrum of a point with its density F(m) and the scatter between runs (:point).",
     "SELECT bin, lower, upper, n, runs, count, count_mean, count_sd, density FROM spectra WHERE point_id = :point "
     "ORDER BY bin",
     "point"},
    {"spectra", "Pooled fragment mass spectrum of every point.", "SELECT * FROM spectra ORDER BY point_id, bin", ""},
    {"run-spectrum", "Fragment mass spectrum of one run (:run).",
     "SELECT s.bin, b.lower, b.upper, s.count, s.mass FROM spectrum s JOIN bin b USING (bin) WHERE s.run_id = :run "
     "ORDER BY s.bin",
     "run"},
    {"exponents",
     "Exponent beta of F(m) ~ m^-beta by method and window: pooled over each point's runs, with its error.",
     "SELECT * FROM estimates WHERE run_id IS NULL ORDER BY point_id, ordinal", ""},
    {"run-exponents", "Mean and scatter over runs of the exponent that each run gave, by point, method and window.",
     "SELECT point_id, results_version, method, \"window\", count(beta) AS n, avg(beta) AS beta_mean, "
     "sqrt(total((beta - mean) * (beta - mean)) / (max(count(beta), 1) - 1)) AS beta_sd,\n"
     "  avg(standard_error) AS standard_error_mean\n"
     "FROM (SELECT *, avg(beta) OVER (PARTITION BY point_id, results_version, method, \"window\") AS mean FROM "
     "estimates WHERE counts = 1)\n"
     "GROUP BY point_id, results_version, method, \"window\" ORDER BY point_id, "
     "min(ordinal)",
     ""},
    {"scatter", "How much the seed matters: relative scatter of the main results per point.", canned_scatter_sql, ""},
    {"failures", "Runs without a usable result, and attempts that failed, with what they said.",
     "SELECT point_id, replicate, seed, state AS reason, attempt, wall_time, host, message FROM runs WHERE counts = 0 "
     "AND surplus = 0\nUNION ALL\n"
     "SELECT point_id, replicate, seed, reason || iif(signal, ' (signal ' || signal || ')', ''), number, wall_time, "
     "host, "
     "message FROM attempt ORDER BY point_id, replicate, attempt",
     ""},
    {"censored", "Runs that count and ended at their time: fragments may still have been breaking.",
     "SELECT point_id, run_id, replicate, seed, time, " OUTCOME_DEFAULT
     " FROM runs WHERE counts = 1 AND state = 'end-time' ORDER BY point_id, replicate",
     ""},
    {"slowest", "The twenty runs that took longest.",
     "SELECT run_id, point_id, replicate, seed, wall_time, cpu_time, peak_memory, steps, host, rank FROM runs ORDER BY "
     "wall_time DESC, point_id, replicate LIMIT 20",
     ""},
    {"cost", "Time and memory per point.",
     "SELECT point_id, count(*) AS runs, total(wall_time) AS wall_time, avg(wall_time) AS wall_time_mean, "
     "max(wall_time) AS wall_time_max, max(peak_memory) AS peak_memory FROM runs GROUP BY point_id ORDER BY wall_time "
     "DESC",
     ""},
    {"progress", "Runs stored per session.",
     "SELECT s.session_id, s.started_at, s.ended_at, s.outcome, s.host, count(r.run_id) AS runs, total(r.cpu_time) AS "
     "cpu_time FROM session s LEFT JOIN runs r USING (session_id) GROUP BY s.session_id",
     ""},
    {"axes", "The inputs that campaigns varied, and how many values each has.",
     "SELECT a.column_name, a.path, a.unit, (SELECT count(DISTINCT value) FROM point_input i JOIN point USING "
     "(point_id) WHERE i.path = a.path) AS "
     "\"values\", a.meaning FROM axis a ORDER BY a.path",
     ""},
    {"columns", "Every table and view, column by column, with unit and meaning.",
     "SELECT table_name, column_name, unit, meaning FROM column_doc ORDER BY table_name, column_name", ""},
    {"provenance", "What computed the runs: program, compiler, machine, command line.",
     "SELECT session_id, started_at, host, key, value FROM session, json_each(facts) ORDER BY session_id, id", ""},
};

size_t ask_canned_count(void) {
  return sizeof queries / sizeof queries[0];
}

const struct query_canned *ask_canned_at(size_t index) {
  return index < ask_canned_count() ? &queries[index] : NULL;
}

const struct query_canned *ask_canned_find(const char *name, struct error *error) {
  char known[512] = "";
  for (size_t i = 0; i < ask_canned_count(); i++) {
    if (strcmp(queries[i].name, name) == 0)
      return ask_canned_at(i);
    text_append(known, sizeof known, "%s%s", i ? ", " : "", queries[i].name);
  }
  status_fail(error, STATUS_USAGE, "There is no ready query '%.60s'. Ready queries are: %s.", name, known);
  return NULL;
}
