/* Reads the rows of a study into structs: the columns are those of the field table. */
#include "db/ask/convergence.h"

#include <stdio.h>
#include <stdlib.h>

#include "schemas/text.h"

struct reading {
  ask_convergence_each each;
  void *context;
};

static status take_level(void *context, size_t count, const struct query_value *values, struct error *error) {
  const struct reading *reading = context;
  struct convergence_row row;
  field_defaults(&convergence_table, &row);
  for (size_t i = 0; i < count && i < convergence_table.count; i++) {
    const struct field *field = &convergence_table.rows[i];
    struct field_value value = {.kind = field->kind, .number = values[i].real, .integer = values[i].integer};
    if (field->kind == FIELD_TEXT)
      field_copy_text(value.text, values[i].kind == QUERY_TEXT ? values[i].text : "");
    field_set_unchecked(field, &row, &value);
  }
  return reading->each(reading->context, &row, error);
}

static char *levels_sql(void) {
  char *sql = NULL;
  size_t size = 0;
  FILE *out = open_memstream(&sql, &size);
  if (!out)
    return NULL;
  fputs("SELECT ", out);
  for (size_t i = 0; i < convergence_table.count; i++) {
    char name[FIELD_TEXT_SIZE];
    field_column_name(convergence_table.rows[i].path, name, sizeof name);
    fprintf(out, "%s\"%s\"", i ? ", " : "", name);
  }
  fputs(" FROM convergence WHERE base_point_id = :point AND results_version = :version AND quantity = :quantity"
        " ORDER BY knob, level",
        out);
  return text_close(out, &sql);
}

status ask_convergence_levels(struct store *store, int64_t base_point, int results_version, const char *quantity,
                              ask_convergence_each each, void *context, struct error *error) {
  double there = 0;
  status code = query_number(store, "SELECT count(*) FROM sqlite_schema WHERE name = 'convergence'", 0, NULL, &there,
                             error);
  if (code != STATUS_OK || !(there > 0))
    return code;
  char point[32], version[32], *sql = levels_sql();
  if (!sql)
    return status_fail(error, STATUS_MEMORY, "no memory for a question to the store");
  snprintf(point, sizeof point, "%lld", (long long)base_point);
  snprintf(version, sizeof version, "%d", results_version);
  const struct query_parameter parameters[] = {{"point", point}, {"version", version}, {"quantity", quantity}};
  struct reading reading = {each, context};
  const struct query_sink sink = {.context = &reading, .row = take_level};
  code = query_run(store, sql, 3, parameters, 0, &sink, error);
  free(sql);
  return code;
}
