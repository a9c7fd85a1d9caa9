/* Lists of points, as functions with typed results. */
#include "db/ask/points.h"

#include <stdio.h>
#include <string.h>

#include "db/ask/columns.h"
#include "db/sql.h"
#include "db/store/internal.h"
#include "db/store/schema.h"
#include "engine/grow.h"

enum { FIRST_INPUT = 8 }; /* column of the first input in the query of ask_points_rows */

/* Condition that selects the chosen points, for any table with a column point_id. */
static void write_choice(sqlite3_str *sql, const struct ask_points_choice *choice) {
  sqlite3_str_appendall(sql, " WHERE true");
  if (choice->campaign)
    sqlite3_str_appendf(sql, " AND point_id IN (SELECT point_id FROM campaign_point WHERE campaign_id = %lld)",
                        (long long)choice->campaign);
  if (choice->point)
    sqlite3_str_appendf(sql, " AND point_id = %lld", (long long)choice->point);
}

status ask_points_count(struct store *store, const struct ask_points_choice *choice, int64_t *points,
                        struct error *error) {
  sqlite3_str *where = sqlite3_str_new(NULL);
  write_choice(where, choice);
  ANSWER answer = answer_to(store, error, "SELECT count(*) FROM point%z", sqlite3_str_finish(where));
  *points = answer_next(&answer) ? answer_integer(&answer, 0) : 0;
  return answer_end(&answer);
}

status ask_points_known(struct store *store, int64_t point, struct error *error) {
  if (point == 0)
    return STATUS_OK;
  ANSWER answer =
      answer_to(store, error,
                "SELECT count(*) FILTER (WHERE point_id = %lld), ifnull(min(point_id), 0), ifnull(max(point_id), "
                "0) FROM point",
                (long long)point);
  if (!answer_next(&answer) || answer_integer(&answer, 0) > 0)
    return answer_end(&answer);
  if (answer_integer(&answer, 2) == 0)
    return status_fail(error, STATUS_USAGE, "there is no point %lld: the store has no points yet", (long long)point);
  return status_fail(error, STATUS_USAGE, "there is no point %lld: the store has the points %lld to %lld",
                     (long long)point, (long long)answer_integer(&answer, 1), (long long)answer_integer(&answer, 2));
}

struct answer ask_points_rows(struct store *store, const struct ask_points_choice *choice, bool newest,
                              size_t input_count, const char *const *inputs, struct error *error) {
  sqlite3_str *sql = sqlite3_str_new(NULL);
  sqlite3_str_appendall(sql, "SELECT point_id, results_version, n, failed, largest_fraction_mean, "
                             "largest_fraction_hw95, largest_fraction_resolution, largest_fraction_resolution_verdict");
  for (size_t i = 0; i < input_count && i < ASK_POINTS_INPUTS; i++)
    sqlite3_str_appendf(sql, ", \"%w\"", inputs[i]);
  sqlite3_str_appendall(sql, " FROM points AS p");
  write_choice(sql, choice);
  if (newest)
    sqlite3_str_appendall(sql, " AND (results_version IS NULL OR results_version ="
                               " (SELECT max(results_version) FROM point_total AS t WHERE t.point_id = p.point_id))");
  return answer_to(store, error, "%z ORDER BY point_id, results_version", sqlite3_str_finish(sql));
}

bool ask_points_next(struct answer *answer, struct ask_points_row *row) {
  if (!answer_next(answer))
    return false;
  *row = (struct ask_points_row){.point_id = answer_integer(answer, 0),
                                 .results_version = answer_integer(answer, 1),
                                 .n = answer_integer(answer, 2),
                                 .failed = answer_integer(answer, 3),
                                 .mean = answer_real(answer, 4),
                                 .half_width = answer_real(answer, 5),
                                 .resolution = answer_real(answer, 6),
                                 .resolution_verdict = ask_resolution_verdict(answer_text(answer, 7)),
                                 .input_count = answer_count(answer) - FIRST_INPUT};
  for (size_t i = 0; i < row->input_count; i++)
    row->inputs[i] = answer_value(answer, FIRST_INPUT + i);
  return true;
}

status ask_points_label(struct store *store, int64_t point_id, char *text, size_t size, struct error *error) {
  snprintf(text, size, "point %lld", (long long)point_id);
  bool written = false;
  TRY(schema_has_column(store->db, "axis", "written_unit", &written, error));
  ANSWER
  answer = answer_to(store, error,
                     "SELECT path, value, unit, %s FROM point_input JOIN axis USING (path) WHERE point_id = %lld "
                     "ORDER BY path DESC",
                     written ? "written_unit" : "NULL", (long long)point_id);
  for (size_t used = 0; answer_next(&answer);) {
    const char *path = answer_text(&answer, 0), *word = strrchr(path, '.');
    struct ask_column column = {.factor = 1};
    snprintf(column.unit, sizeof column.unit, "%s", answer_text(&answer, 2));
    if (answer_value(&answer, 3).kind == QUERY_TEXT)
      ask_columns_write_in(&column, answer_text(&answer, 3));
    const struct query_value value = answer_value(&answer, 1), shown = ask_columns_value(&column, &value);
    const char *unit = strcmp(column.unit, "1") != 0 ? column.unit : "";
    char number[64], item[256];
    snprintf(number, sizeof number, "%.3g", shown.real);
    const int length = snprintf(item, sizeof item, "%s%s %.63s%s%s", used ? ", " : "", word ? word + 1 : path,
                                shown.kind == QUERY_TEXT ? shown.text : number, *unit ? " " : "", unit);
    if (length <= 0 || (size_t)length >= sizeof item || used + (size_t)length >= size)
      continue; /* inputs that do not fit are left out */
    memcpy(text + used, item, (size_t)length + 1);
    used += (size_t)length;
  }
  return answer_end(&answer);
}

status ask_points_without_estimates(struct store *store, int64_t campaign, struct ask_points_version **list,
                                    size_t *count, struct error *error) {
  size_t room = 0;
  *list = NULL;
  *count = 0;
  ANSWER
  answer =
      answer_to(store, error,
                "SELECT point_id, results_version FROM point_total AS t WHERE runs > 0 AND (%lld = 0 OR point_id IN"
                " (SELECT point_id FROM campaign_point WHERE campaign_id = %lld)) AND NOT EXISTS (SELECT 1 FROM"
                " point_estimate AS e WHERE e.point_id = t.point_id AND e.results_version = t.results_version)"
                " ORDER BY point_id, results_version",
                (long long)campaign, (long long)campaign);
  while (answer_next(&answer)) {
    if (!grow_room(list, &room, *count + 1, sizeof **list))
      return status_fail(error, STATUS_MEMORY, "no memory for the list of points");
    (*list)[(*count)++] = (struct ask_points_version){answer_integer(&answer, 0), (int)answer_integer(&answer, 1)};
  }
  return answer_end(&answer);
}
