/* The canonical text of an object, from which a run's identity is made. */
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "schemas/field.h"
#include "schemas/memory.h"
#include "schemas/text.h"

static int by_path(const void *a, const void *b) {
  const struct field *const *left = a, *const *right = b;
  return strcmp((*left)->path, (*right)->path);
}

/* Writes text with line breaks and backslashes escaped, so that no value can look like another line. */
static void write_text(const char *text, FILE *out) {
  for (; *text; text++) {
    if (*text == '\n')
      fputs("\\n", out);
    else if (*text == '\\')
      fputs("\\\\", out);
    else
      fputc(*text, out);
  }
}

static void write_value(const struct field *row, const struct field_value *value, FILE *out) {
  switch (row->kind) {
  case FIELD_REAL:
    if (isnan(value->number))
      fputs("off", out);
    else
      fprintf(out, "%a", value->number + 0.0);
    break;
  case FIELD_INTEGER: fprintf(out, "%" PRId64, value->integer); break;
  case FIELD_BOOLEAN: fputs(value->number != 0 ? "true" : "false", out); break;
  case FIELD_CHOICE:
  case FIELD_TEXT: write_text(value->text, out); break;
  }
}

/* Has a row that came later the value of the runs before it? */
static bool is_absent(const struct field *row, const void *object) {
  struct field_value value, absent;
  if (!row->absent || field_parse_si(row, row->absent, &absent, NULL))
    return false;
  field_get(row, object, &value);
  return field_same_value(row, &value, &absent);
}

char *field_identity(const struct field_table *table, const void *object) {
  char *text = NULL;
  size_t size = 0, count = 0;
  const struct field **rows = memory_small(table->count + 1, sizeof *rows);
  FILE *out = text_open(&text, &size);
  if (!out)
    memory_refused();
  for (size_t i = 0; i < table->count; i++)
    if (field_is_active(table, &table->rows[i], object) && !is_absent(&table->rows[i], object))
      rows[count++] = &table->rows[i];
  qsort(rows, count, sizeof *rows, by_path);

  for (size_t i = 0; i < count; i++) {
    struct field_value value;
    field_get(rows[i], object, &value);
    fprintf(out, "%s=", rows[i]->path);
    write_value(rows[i], &value, out);
    fputc('\n', out);
  }
  free(rows);
  if (!text_close(out, &text))
    memory_refused();
  return text;
}
