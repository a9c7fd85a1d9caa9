/* Rows of a query as cells of a table, with the units of the store's columns. */
#include "campaign/terminal/rows.h"

#include <stdlib.h>
#include <string.h>

enum { BLOB_SHOWN = 64 }; /* bytes shown in the aligned table: an identity fits, a list of masses does not */

/* The varied input of this name, or -1. */
static int written_place(const struct rows *rows, const char *name) {
  for (size_t i = 0; i < rows->written_count; i++)
    if (strcmp(rows->written[i].name, name) == 0)
      return (int)i;
  return -1;
}

static status columns(void *context, size_t count, const char *const *names, struct error *error) {
  struct rows *rows = context;
  rows->place = calloc(count + 1, sizeof *rows->place);
  if (!rows->place)
    return status_fail(error, STATUS_MEMORY, "no memory for a table");
  rows->table = table_new(rows->format, rows->out);
  for (size_t i = 0; i < count; i++) {
    rows->place[i] = written_place(rows, names[i]);
    const char *unit = rows->place[i] >= 0 ? rows->written[rows->place[i]].unit : NULL;
    for (size_t k = 0; k < rows->unit_count && !unit; k++)
      if (strcmp(rows->units[k].name, names[i]) == 0)
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

void rows_cell(struct table *table, const struct query_value *value) {
  switch (value->kind) {
  case QUERY_NULL: table_missing(table); break;
  case QUERY_INTEGER: table_integer(table, value->integer); break;
  case QUERY_REAL: table_real(table, value->real); break;
  case QUERY_TEXT: table_text(table, value->text); break;
  case QUERY_BLOB: break; /* print_blob */
  }
}

static status row(void *context, size_t count, const struct query_value *values, struct error *error) {
  (void)error;
  struct rows *rows = context;
  for (size_t i = 0; i < count; i++) {
    if (values[i].kind == QUERY_BLOB) {
      print_blob(rows, values[i].blob, values[i].size);
      continue;
    }
    const struct query_value shown = rows->place[i] >= 0 ? ask_columns_value(&rows->written[rows->place[i]], &values[i])
                                                         : values[i];
    rows_cell(rows->table, &shown);
  }
  return table_broken(rows->table) ? STATUS_IO : STATUS_OK; /* rows_end reports the error */
}

struct query_sink rows_sink(struct rows *rows, struct store *store, enum table_format format, FILE *out) {
  *rows = (struct rows){.format = format, .out = out};
  if (format == TABLE_TEXT)
    (void)ask_columns_units(store, &rows->units, &rows->unit_count, NULL); /* on an error headings have no units */
  return (struct query_sink){rows, columns, row};
}

struct query_sink rows_sink_written(struct rows *rows, struct store *store, enum table_format format, FILE *out) {
  const struct query_sink sink = rows_sink(rows, store, format, out);
  if (format == TABLE_TEXT) /* on an error they stay in SI */
    (void)ask_columns_axes(store, true, ROWS_AXES, rows->written, &rows->written_count, NULL);
  return sink;
}

status rows_end(struct rows *rows, status code, struct error *error) {
  free(rows->units);
  free(rows->place);
  rows->units = NULL;
  rows->place = NULL;
  if (!rows->table)
    return code;
  bool broken = table_broken(rows->table);
  if (code && !broken) { /* an error of the query itself: the printed rows stay */
    (void)table_end(rows->table, NULL);
    return code;
  }
  if (error)
    error->message[0] = '\0';
  return table_end(rows->table, error);
}
