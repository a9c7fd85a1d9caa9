#include "campaign/terminal/rows.h"

#include <stdlib.h>
#include <string.h>

enum { BLOB_SHOWN = 64 }; /* bytes shown in the aligned table: an identity fits, a list of masses does not */

static status take_unit(void *context, size_t count, const struct query_value *values, struct error *error) {
  (void)error;
  struct rows *rows = context;
  if (count != 2 || values[0].kind != QUERY_TEXT || values[1].kind != QUERY_TEXT)
    return STATUS_OK;
  if ((rows->unit_count & (rows->unit_count - 1)) == 0) { /* full at every power of two */
    size_t capacity = rows->unit_count ? 2 * rows->unit_count : 1;
    struct rows_unit *grown = realloc(rows->units, capacity * sizeof *grown);
    if (!grown)
      return STATUS_MEMORY;
    rows->units = grown;
  }
  struct rows_unit *unit = &rows->units[rows->unit_count++];
  snprintf(unit->column, sizeof unit->column, "%s", values[0].text);
  snprintf(unit->unit, sizeof unit->unit, "%s", values[1].text);
  return STATUS_OK;
}

static status columns(void *context, size_t count, const char *const *names, struct error *error) {
  (void)error;
  struct rows *rows = context;
  rows->table = table_new(rows->format, rows->out);
  for (size_t i = 0; i < count; i++) {
    const char *unit = NULL;
    for (size_t k = 0; k < rows->unit_count && !unit; k++)
      if (strcmp(rows->units[k].column, names[i]) == 0)
        unit = rows->units[k].unit;
    table_column(rows->table, names[i], unit);
  }
  return STATUS_OK;
}

static void print_blob(struct rows *rows, const unsigned char *bytes, size_t size) {
  char text[2 * BLOB_SHOWN + 1];
  if (rows->format == TABLE_TEXT && size > BLOB_SHOWN) {
    snprintf(text, sizeof text, "(%zu bytes)", size);
    table_text(rows->table, text);
    return;
  }
  char *hex = size <= BLOB_SHOWN ? text : malloc(2 * size + 1);
  if (!hex) {
    table_missing(rows->table);
    return;
  }
  for (size_t i = 0; i < size; i++)
    snprintf(hex + 2 * i, 3, "%02x", bytes[i]);
  hex[2 * size] = '\0';
  table_text(rows->table, hex);
  if (hex != text)
    free(hex);
}

static status row(void *context, size_t count, const struct query_value *values, struct error *error) {
  (void)error;
  struct rows *rows = context;
  for (size_t i = 0; i < count; i++)
    switch (values[i].kind) {
    case QUERY_NULL: table_missing(rows->table); break;
    case QUERY_INTEGER: table_integer(rows->table, values[i].integer); break;
    case QUERY_REAL: table_real(rows->table, values[i].real); break;
    case QUERY_TEXT: table_text(rows->table, values[i].text); break;
    case QUERY_BLOB: print_blob(rows, values[i].blob, values[i].size); break;
    }
  return table_broken(rows->table) ? STATUS_IO : STATUS_OK; /* rows_end says what it was */
}

struct query_sink rows_sink(struct rows *rows, struct store *store, enum table_format format, FILE *out) {
  *rows = (struct rows){.format = format, .out = out};
  struct query_sink units = {rows, NULL, take_unit};
  if (format == TABLE_TEXT) /* a column that has another unit in another table gets none rather than a wrong one */
    (void)query_run(store,
                    "select column_name, min(unit) from column_doc where unit <> '1' group by column_name"
                    " having count(distinct unit) = 1",
                    0, NULL, 0, &units, NULL); /* without them the headings have no units */
  return (struct query_sink){rows, columns, row};
}

status rows_end(struct rows *rows, status code, struct error *error) {
  free(rows->units);
  rows->units = NULL;
  if (!rows->table)
    return code;
  bool broken = table_broken(rows->table);
  if (code && !broken) { /* an error of the query itself: what was printed so far stays */
    (void)table_end(rows->table, NULL);
    return code;
  }
  if (error)
    error->message[0] = '\0';
  return table_end(rows->table, error);
}

static status take_count(void *context, size_t count, const struct query_value *values, struct error *error) {
  (void)count, (void)error;
  *(int64_t *)context = values[0].integer;
  return STATUS_OK;
}

status rows_pool(struct store *store, const char *x, const char *y, bool *pool, struct error *error) {
  int64_t most = 0;
  const struct query_sink sink = {&most, NULL, take_count};
  char sql[1000];
  snprintf(sql, sizeof sql,
           "select coalesce(max(n), 0) from (select count(distinct point_id) as n from points where n > 0 group by "
           "\"%s\"%s%s%s)",
           x, y ? ", \"" : "", y ? y : "", y ? "\"" : "");
  status code = query_run(store, sql, 0, NULL, 0, &sink, error);
  *pool = most > 1;
  return code;
}

status rows_print(struct store *store, const char *sql, size_t parameter_count,
                  const struct query_parameter *parameters, enum table_format format, FILE *out, struct error *error) {
  struct rows rows;
  struct query_sink sink = rows_sink(&rows, store, format, out);
  status code = query_run(store, sql, parameter_count, parameters, 0, &sink, error);
  return rows_end(&rows, code, error);
}
