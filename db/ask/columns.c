/* Names and units of the columns of a store. */
#include "db/ask/columns.h"

#include <stdio.h>
#include <stdlib.h>

struct list {
  struct ask_column *columns;
  size_t count, capacity;
  bool grows;
};

/* name, unit */
static status take_column(void *context, size_t count, const struct query_value *values, struct error *error) {
  struct list *list = context;
  if (count != 2 || values[0].kind != QUERY_TEXT)
    return STATUS_OK;

  if (list->count == list->capacity) {
    if (!list->grows)
      return STATUS_OK;
    size_t capacity = list->capacity ? 2 * list->capacity : 64;
    struct ask_column *grown = realloc(list->columns, capacity * sizeof *grown);
    if (!grown)
      return status_fail(error, STATUS_MEMORY, "no memory for the units of the columns");
    list->columns = grown;
    list->capacity = capacity;
  }

  struct ask_column *column = &list->columns[list->count++];
  snprintf(column->name, sizeof column->name, "%s", values[0].text);
  snprintf(column->unit, sizeof column->unit, "%s", values[1].kind == QUERY_TEXT ? values[1].text : "");
  return STATUS_OK;
}

status ask_columns_axes(struct store *store, size_t most, struct ask_column *axes, size_t *count, struct error *error) {
  struct list list = {.columns = axes, .capacity = most};
  const struct query_sink sink = {.context = &list, .row = take_column};
  status code = query_run(store, "SELECT column_name, unit FROM axis ORDER BY path", 0, NULL, 0, &sink, error);
  *count = list.count;
  return code;
}

status ask_columns_unit(struct store *store, const char *column, char *unit, size_t size, struct error *error) {
  static const char sql[] = "SELECT '', min(unit) FROM column_doc WHERE column_name = :column AND unit <> '1'";
  struct ask_column found = {.unit = ""};
  struct list list = {.columns = &found, .capacity = 1};
  const struct query_parameter parameter = {"column", column};
  const struct query_sink sink = {.context = &list, .row = take_column};
  status code = query_run(store, sql, 1, &parameter, 0, &sink, error);
  snprintf(unit, size, "%s", found.unit);
  return code;
}

status ask_columns_units(struct store *store, struct ask_column **columns, size_t *count, struct error *error) {
  static const char sql[] = "SELECT column_name, min(unit) FROM column_doc WHERE unit <> '1' GROUP BY column_name "
                            "HAVING count(DISTINCT unit) = 1";
  struct list list = {.grows = true};
  const struct query_sink sink = {.context = &list, .row = take_column};
  status code = query_run(store, sql, 0, NULL, 0, &sink, error);
  *columns = list.columns;
  *count = list.count;
  return code;
}

status ask_columns_view(struct store *store, const char *view, const struct query_sink *sink, struct error *error) {
  char sql[160];
  snprintf(sql, sizeof sql, "SELECT * FROM %.128s", view);
  return query_run(store, sql, 0, NULL, 0, sink, error);
}
