/* Lists of points, as functions with typed results. */
#include "db/ask/points.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "db/ask/columns.h"
#include "db/sql.h"
#include "db/store/internal.h"
#include "db/store/schema.h"
#include "engine/grow.h"

/* Condition that selects the chosen points, for any table with a column point_id. */
static void write_choice(FILE *sql, const struct ask_points_choice *choice) {
  fputs(" WHERE true", sql);
  if (choice->campaign)
    fprintf(sql, " AND point_id IN (SELECT point_id FROM campaign_point WHERE campaign_id = %lld)",
            (long long)choice->campaign);
  if (choice->point)
    fprintf(sql, " AND point_id = %lld", (long long)choice->point);
}

/* Runs the SQL text that was written to `out` (from open_memstream); closes `out` and frees the text. */
static status run_written(struct store *store, FILE *out, char **sql, const struct query_sink *sink,
                          struct error *error) {
  fclose(out);
  if (!*sql)
    return status_fail(error, STATUS_MEMORY, "no memory for a question to the store");
  status code = query_run(store, *sql, 0, NULL, 0, sink, error);
  free(*sql);
  return code;
}

static status take_integer(void *context, size_t count, const struct query_value *values, struct error *error) {
  (void)count, (void)error;
  *(int64_t *)context = values[0].integer;
  return STATUS_OK;
}

status ask_points_count(struct store *store, const struct ask_points_choice *choice, int64_t *points,
                        struct error *error) {
  *points = 0;
  const struct query_sink sink = {.context = points, .row = take_integer};
  char *sql = NULL;
  size_t size = 0;
  FILE *out = open_memstream(&sql, &size);
  if (!out)
    return status_fail(error, STATUS_MEMORY, "no memory for a question to the store");
  fputs("SELECT count(*) FROM point", out);
  write_choice(out, choice);
  return run_written(store, out, &sql, &sink, error);
}

static status take_range(void *context, size_t count, const struct query_value *values, struct error *error) {
  (void)error;
  int64_t *range = context;
  for (size_t i = 0; i < count; i++)
    range[i] = values[i].integer;
  return STATUS_OK;
}

status ask_points_known(struct store *store, int64_t point, struct error *error) {
  int64_t range[3] = {0}; /* number of matching points (1 or 0); lowest and highest number */
  const struct query_sink sink = {.context = range, .row = take_range};
  char sql[160];
  if (point == 0)
    return STATUS_OK;
  snprintf(sql, sizeof sql,
           "SELECT count(*) FILTER (WHERE point_id = %lld), ifnull(min(point_id), 0), ifnull(max(point_id), 0) FROM "
           "point",
           (long long)point);
  const status code = query_run(store, sql, 0, NULL, 0, &sink, error);
  if (code != STATUS_OK || range[0] > 0)
    return code;
  if (range[2] == 0)
    return status_fail(error, STATUS_USAGE, "there is no point %lld: the store has no points yet", (long long)point);
  return status_fail(error, STATUS_USAGE, "there is no point %lld: the store has the points %lld to %lld",
                     (long long)point, (long long)range[1], (long long)range[2]);
}

struct rows {
  ask_points_each each;
  void *context;
};

enum { FIRST_INPUT = 8 }; /* column of the first input in the query of ask_points_rows */

static status give_row(void *context, size_t count, const struct query_value *values, struct error *error) {
  const struct rows *rows = context;
  const struct ask_points_row row = {.point_id = values[0].integer,
                                     .results_version = values[1].integer,
                                     .n = values[2].integer,
                                     .failed = values[3].integer,
                                     .mean = values[4].real,
                                     .half_width = values[5].real,
                                     .resolution = values[6].real,
                                     .resolution_verdict = ask_resolution_verdict(
                                         values[7].kind == QUERY_TEXT ? values[7].text : NULL),
                                     .input_count = count - FIRST_INPUT,
                                     .inputs = values + FIRST_INPUT};
  return rows->each(rows->context, &row, error);
}

status ask_points_rows(struct store *store, const struct ask_points_choice *choice, bool newest, size_t input_count,
                       const char *const *inputs, ask_points_each each, void *context, struct error *error) {
  struct rows rows = {each, context};
  const struct query_sink sink = {.context = &rows, .row = give_row};
  char *sql = NULL;
  size_t size = 0;
  FILE *out = open_memstream(&sql, &size);
  if (!out)
    return status_fail(error, STATUS_MEMORY, "no memory for a question to the store");
  fputs("SELECT point_id, results_version, n, failed, largest_fraction_mean, largest_fraction_hw95, "
        "largest_fraction_resolution, largest_fraction_resolution_verdict",
        out);
  for (size_t i = 0; i < input_count; i++) {
    fputs(", ", out);
    sql_write_name(inputs[i], out);
  }
  fputs(" FROM points AS p", out);
  write_choice(out, choice);
  if (newest)
    fputs(" AND (results_version IS NULL OR results_version ="
          " (SELECT max(results_version) FROM point_total AS t WHERE t.point_id = p.point_id))",
          out);
  fputs(" ORDER BY point_id, results_version", out);
  return run_written(store, out, &sql, &sink, error);
}

struct label {
  char *text;
  size_t size, used;
};

/* A row of path, value, SI unit and written unit. */
static status add_input(void *context, size_t count, const struct query_value *values, struct error *error) {
  (void)count, (void)error;
  struct label *label = context;
  const char *path = values[0].text, *word = strrchr(path, '.');
  struct ask_column column = {.factor = 1};
  snprintf(column.unit, sizeof column.unit, "%s", values[2].kind == QUERY_TEXT ? values[2].text : "");
  if (values[3].kind == QUERY_TEXT)
    ask_columns_write_in(&column, values[3].text);
  const struct query_value shown = ask_columns_value(&column, &values[1]);
  const char *unit = strcmp(column.unit, "1") != 0 ? column.unit : "";
  char value[64], item[256];
  if (shown.kind == QUERY_TEXT)
    snprintf(value, sizeof value, "%s", shown.text);
  else
    snprintf(value, sizeof value, "%.3g", shown.real);

  const int size = snprintf(item, sizeof item, "%s%s %s%s%s", label->used ? ", " : "", word ? word + 1 : path, value,
                            *unit ? " " : "", unit);
  if (size <= 0 || (size_t)size >= sizeof item || label->used + (size_t)size >= label->size)
    return STATUS_OK; /* inputs that do not fit are left out */
  memcpy(label->text + label->used, item, (size_t)size + 1);
  label->used += (size_t)size;
  return STATUS_OK;
}

status ask_points_label(struct store *store, int64_t point_id, char *text, size_t size, struct error *error) {
  struct label label = {text, size, 0};
  const struct query_sink sink = {.context = &label, .row = add_input};
  char sql[256];
  snprintf(text, size, "point %lld", (long long)point_id);
  bool written = false;
  const status code = schema_has_column(store->db, "axis", "written_unit", &written, error);
  if (code != STATUS_OK)
    return code;
  snprintf(sql, sizeof sql,
           "SELECT path, value, unit, %s FROM point_input JOIN axis USING (path) WHERE point_id = %lld ORDER BY path "
           "DESC",
           written ? "written_unit" : "NULL", (long long)point_id);
  return query_run(store, sql, 0, NULL, 0, &sink, error);
}

struct versions {
  struct ask_points_version *list;
  size_t count, capacity;
};

static status take_version(void *context, size_t count, const struct query_value *values, struct error *error) {
  (void)count;
  struct versions *versions = context;
  if (!grow_room(&versions->list, &versions->capacity, versions->count + 1, sizeof *versions->list))
    return status_fail(error, STATUS_MEMORY, "no memory for the list of points");
  versions->list[versions->count++] = (struct ask_points_version){values[0].integer, (int)values[1].integer};
  return STATUS_OK;
}

status ask_points_without_estimates(struct store *store, int64_t campaign, struct ask_points_version **list,
                                    size_t *count, struct error *error) {
  struct versions versions = {0};
  const struct query_sink sink = {.context = &versions, .row = take_version};
  char sql[512];
  snprintf(sql, sizeof sql,
           "SELECT point_id, results_version FROM point_total AS t WHERE runs > 0 AND (%lld = 0 OR point_id IN"
           " (SELECT point_id FROM campaign_point WHERE campaign_id = %lld)) AND NOT EXISTS (SELECT 1 FROM"
           " point_estimate AS e WHERE e.point_id = t.point_id AND e.results_version = t.results_version)"
           " ORDER BY point_id, results_version",
           (long long)campaign, (long long)campaign);
  status code = query_run(store, sql, 0, NULL, 0, &sink, error);
  *list = versions.list;
  *count = versions.count;
  return code;
}
