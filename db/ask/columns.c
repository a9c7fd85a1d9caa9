/* Names and units of the columns of a store. */
#include "db/ask/columns.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "db/store/internal.h"
#include "db/store/schema.h"
#include "engine/grow.h"
#include "schemas/unit.h"

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

  if (list->count == list->capacity && !list->grows)
    return STATUS_OK;
  if (!grow_room(&list->columns, &list->capacity, list->count + 1, sizeof *list->columns))
    return status_fail(error, STATUS_MEMORY, "no memory for the units of the columns");

  struct ask_column *column = &list->columns[list->count++];
  column->factor = 1;
  snprintf(column->name, sizeof column->name, "%s", values[0].text);
  snprintf(column->unit, sizeof column->unit, "%s", values[1].kind == QUERY_TEXT ? values[1].text : "");
  return STATUS_OK;
}

/* A written unit comes from the file. It is used only if it is a valid unit of the input's dimension. */
void ask_columns_write_in(struct ask_column *column, const char *written) {
  struct unit own, other;
  if (unit_parse(*column->unit ? column->unit : "1", &own, NULL) || unit_parse(written, &other, NULL) ||
      !unit_same_dimension(&own, &other) || strlen(written) >= sizeof column->unit)
    return;
  snprintf(column->unit, sizeof column->unit, "%s", written);
  column->factor = other.factor / own.factor;
}

/* name, SI unit, written unit */
static status take_axis(void *context, size_t count, const struct query_value *values, struct error *error) {
  struct list *list = context;
  const size_t before = list->count;
  const status code = take_column(context, count - 1, values, error);
  if (code == STATUS_OK && list->count > before && values[2].kind == QUERY_TEXT)
    ask_columns_write_in(&list->columns[before], values[2].text);
  return code;
}

status ask_columns_axes(struct store *store, bool written, size_t most, struct ask_column *axes, size_t *count,
                        struct error *error) {
  struct list list = {.columns = axes, .capacity = most};
  const struct query_sink sink = {.context = &list, .row = take_axis};
  char sql[128];
  bool has = false; /* false: a read-only store of an older program has no written units */
  status code = written ? schema_has_column(store->db, "axis", "written_unit", &has, error) : STATUS_OK;
  if (code != STATUS_OK)
    return code;
  snprintf(sql, sizeof sql, "SELECT column_name, unit, %s FROM axis ORDER BY path", has ? "written_unit" : "NULL");
  code = query_run(store, sql, 0, NULL, 0, &sink, error);
  *count = list.count;
  return code;
}

status ask_columns_written(struct store *store, const char *column, struct ask_column *out, struct error *error) {
  enum { MOST = 256 };
  struct ask_column *axes = calloc(MOST, sizeof *axes);
  size_t count = 0;
  if (!axes)
    return status_fail(error, STATUS_MEMORY, "no memory for the units of the columns");
  *out = (struct ask_column){.factor = 1};
  snprintf(out->name, sizeof out->name, "%s", column);
  status code = ask_columns_axes(store, true, MOST, axes, &count, error);
  size_t found = 0;
  while (found < count && strcmp(axes[found].name, column) != 0)
    found++;
  if (code == STATUS_OK && found < count)
    *out = axes[found];
  else if (code == STATUS_OK)
    code = ask_columns_unit(store, column, out->unit, sizeof out->unit, error);
  free(axes);
  return code;
}

struct query_value ask_columns_value(const struct ask_column *column, const struct query_value *value) {
  struct query_value shown = *value;
  if (column->factor == 1 || (value->kind != QUERY_REAL && value->kind != QUERY_INTEGER))
    return shown;
  shown.kind = QUERY_REAL;
  shown.real = value->real / column->factor;
  return shown;
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
