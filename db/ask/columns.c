/* Names and units of the columns of a store. */
#include "db/ask/columns.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "db/store/internal.h"
#include "db/store/schema.h"
#include "engine/grow.h"
#include "schemas/unit.h"

/* Reads a column from a row of name, SI unit and written unit, of which the last two may be missing. */
static void read_column(const struct answer *answer, struct ask_column *column) {
  *column = (struct ask_column){.factor = 1};
  snprintf(column->name, sizeof column->name, "%s", answer_text(answer, 0));
  snprintf(column->unit, sizeof column->unit, "%s", answer_text(answer, 1));
  if (answer_value(answer, 2).kind == QUERY_TEXT)
    ask_columns_write_in(column, answer_text(answer, 2));
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

status ask_columns_axes(struct store *store, bool written, size_t most, struct ask_column *axes, size_t *count,
                        struct error *error) {
  bool has = false; /* false: a read-only store of an older program has no written units */
  if (written)
    TRY(schema_has_column(store->db, "axis", "written_unit", &has, error));
  ANSWER answer = answer_to(store, error, "SELECT column_name, unit, %s FROM axis ORDER BY path",
                            has ? "written_unit" : "NULL");
  for (*count = 0; *count < most && answer_next(&answer);)
    read_column(&answer, &axes[(*count)++]);
  return answer_end(&answer);
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
  ANSWER answer = answer_to(store, error, "SELECT min(unit) FROM column_doc WHERE column_name = %Q AND unit <> '1'",
                            column);
  snprintf(unit, size, "%s", answer_next(&answer) ? answer_text(&answer, 0) : "");
  return answer_end(&answer);
}

status ask_columns_units(struct store *store, struct ask_column **columns, size_t *count, struct error *error) {
  size_t room = 0;
  ANSWER
  answer = answer_to(store, error,
                     "SELECT column_name, min(unit), NULL FROM column_doc WHERE unit <> '1' GROUP BY column_name "
                     "HAVING count(DISTINCT unit) = 1");
  *columns = NULL;
  for (*count = 0; answer_next(&answer);) {
    if (!grow_room(columns, &room, *count + 1, sizeof **columns))
      return status_fail(error, STATUS_MEMORY, "no memory for the units of the columns");
    read_column(&answer, &(*columns)[(*count)++]);
  }
  return answer_end(&answer);
}

struct answer ask_columns_view(struct store *store, const char *view, struct error *error) {
  return answer_to(store, error, "SELECT * FROM \"%w\"", view);
}
