#include "campaign/commands/rows.h"

#include <stdlib.h>
#include <string.h>

enum { BLOB_SHOWN = 64 }; /* bytes shown in the aligned table: an identity fits, a list of masses does not */

/* A column that has a different unit in another table gets none rather than a wrong one. */
static status take_unit(void *context, size_t count, const struct query_value *values, struct error *error) {
  (void)error;
  if (count == 1 && values[0].kind == QUERY_TEXT)
    snprintf(context, 64, "%s", values[0].text);
  return STATUS_OK;
}

static status columns(void *context, size_t count, const char *const *names, struct error *error) {
  (void)error;
  struct rows *rows = context;
  rows->table = table_new(rows->format, rows->out);
  for (size_t i = 0; i < count; i++) {
    char unit[64] = "";
    struct query_parameter name = {"name", names[i]};
    struct query_sink sink = {unit, NULL, take_unit};
    if (rows->format == TABLE_TEXT)
      (void)query_run(rows->store,
                      "select min(unit) from column_doc where column_name = :name having count(distinct unit) = 1", 1,
                      &name, 0, &sink, NULL); /* a store without the table: no units */
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
    case QUERY_NULL:
      table_missing(rows->table);
      break;
    case QUERY_INTEGER:
      table_integer(rows->table, values[i].integer);
      break;
    case QUERY_REAL:
      table_real(rows->table, values[i].real);
      break;
    case QUERY_TEXT:
      table_text(rows->table, values[i].text);
      break;
    case QUERY_BLOB:
      print_blob(rows, values[i].blob, values[i].size);
      break;
    }
  rows->count++;
  return table_broken(rows->table) ? STATUS_IO : STATUS_OK; /* rows_end says what it was */
}

struct query_sink rows_sink(struct rows *rows, struct store *store, enum table_format format, FILE *out) {
  *rows = (struct rows){.store = store, .format = format, .out = out};
  return (struct query_sink){rows, columns, row};
}

status rows_end(struct rows *rows, status code, struct error *error) {
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

status rows_print(struct store *store, const char *sql, size_t parameter_count, const struct query_parameter *parameters,
                  enum table_format format, FILE *out, struct error *error) {
  struct rows rows;
  struct query_sink sink = rows_sink(&rows, store, format, out);
  status code = query_run(store, sql, parameter_count, parameters, 0, &sink, error);
  return rows_end(&rows, code, error);
}
