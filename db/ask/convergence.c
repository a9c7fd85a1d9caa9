/* Reads the rows of a study into structs: the columns are those of the field table. */
#include "db/ask/convergence.h"

#include "db/sql.h"

struct answer ask_convergence_levels(struct store *store, int64_t base_point, int results_version, const char *quantity,
                                     struct error *error) {
  double there = 0;
  const status code = answer_number(store, &there, error,
                                    "SELECT count(*) FROM sqlite_schema WHERE name = 'convergence'");
  if (code || !(there > 0))
    return answer_failed(code, error);
  sqlite3_str *columns = sqlite3_str_new(NULL);
  for (size_t i = 0; i < convergence_table.count; i++) {
    char name[FIELD_TEXT_SIZE];
    field_column_name(convergence_table.rows[i].path, name, sizeof name);
    sqlite3_str_appendf(columns, "%s\"%w\"", i ? ", " : "", name);
  }
  char *list = sqlite3_str_finish(columns); /* NULL, no memory, is an empty list: the question then fails */
  const struct answer
      answer = answer_to(store, error,
                         "SELECT %z FROM convergence WHERE base_point_id = %lld AND results_version = %d AND "
                         "quantity = %Q ORDER BY knob, level",
                         list, (long long)base_point, results_version, quantity);
  return answer;
}

bool ask_convergence_next(struct answer *answer, struct convergence_row *row) {
  if (!answer_next(answer))
    return false;
  field_defaults(&convergence_table, row);
  for (size_t i = 0; i < convergence_table.count; i++) {
    const struct field *field = &convergence_table.rows[i];
    const struct query_value stored = answer_value(answer, i);
    struct field_value value = {.kind = field->kind, .number = stored.real, .integer = stored.integer};
    if (field->kind == FIELD_TEXT)
      field_copy_text(value.text, stored.kind == QUERY_TEXT ? stored.text : "");
    field_set_unchecked(field, row, &value);
  }
  return true;
}
