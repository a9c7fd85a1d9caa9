/* Rows of a query as cells of a table, with the units of the store's columns. */
#include "campaign/terminal/rows.h"

#include <stdlib.h>
#include <string.h>

#include "schemas/text.h"

enum {
  ROWS_AXES = 64,
  BLOB_SHOWN = 64
}; /* bytes shown in the aligned table: an identity fits, a list of masses does not */

struct rows {
  struct table *table;
  enum table_format format;
  struct ask_column written[ROWS_AXES]; /* varied inputs, in the campaign's units */
  size_t written_count;
  int *place; /* per column: index of `written`, or -1; owned */
};

/* The varied input of this name, or -1. */
static int written_place(const struct rows *rows, const char *name) {
  for (size_t i = 0; i < rows->written_count; i++)
    if (strcmp(rows->written[i].name, name) == 0)
      return (int)i;
  return -1;
}

/* The headings, with the units of the store's columns: people see varied inputs in the campaign's units (`written`). */
static status name_columns(struct rows *rows, const struct answer *answer, bool written) {
  const bool people = rows->format == TABLE_TEXT;
  struct ask_column *units = NULL;
  size_t unit_count = 0;
  const size_t count = answer_count(answer);
  if (people) /* on an error headings have no units, and values stay in SI */
    (void)ask_columns_units(answer->store, &units, &unit_count, NULL);
  if (people && written)
    (void)ask_columns_axes(answer->store, true, ROWS_AXES, rows->written, &rows->written_count, NULL);
  rows->place = calloc(count + 1, sizeof *rows->place);
  if (!rows->place) {
    free(units);
    return status_fail(answer->error, STATUS_MEMORY, "no memory for a table");
  }
  for (size_t i = 0; i < count; i++) {
    const char *name = answer_name(answer, i);
    rows->place[i] = written_place(rows, name);
    const char *unit = rows->place[i] >= 0 ? rows->written[rows->place[i]].unit : NULL;
    for (size_t k = 0; k < unit_count && !unit; k++)
      if (strcmp(units[k].name, name) == 0)
        unit = units[k].unit;
    table_column(rows->table, name, unit);
  }
  free(units);
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
  text_hex(bytes, size, hex);
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

static void print_row(struct rows *rows, const struct answer *answer) {
  for (size_t i = 0; i < answer_count(answer); i++) {
    const struct query_value value = answer_value(answer, i);
    const struct query_value shown = rows->place[i] >= 0 ? ask_columns_value(&rows->written[rows->place[i]], &value)
                                                         : value;
    if (shown.kind == QUERY_BLOB)
      print_blob(rows, shown.blob, shown.size);
    else
      rows_cell(rows->table, &shown);
  }
}

status rows_print(struct answer answer, bool written, enum table_format format, FILE *out) {
  struct rows rows = {.format = format};
  if (answer_status(&answer)) /* the question itself failed: no table */
    return answer_end(&answer);
  rows.table = table_new(format, out);
  status code = name_columns(&rows, &answer, written);
  while (code == STATUS_OK && !table_broken(rows.table) && answer_next(&answer))
    print_row(&rows, &answer);
  free(rows.place);
  const status end = answer_end(&answer);
  code = code ? code : end;
  if (code && !table_broken(rows.table)) { /* the printed rows stay */
    (void)table_end(rows.table, NULL);
    return code;
  }
  return table_end(rows.table, answer.error);
}
