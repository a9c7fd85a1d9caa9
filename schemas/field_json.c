/* An object as nested JSON. */
#include <inttypes.h>
#include <math.h>
#include <string.h>

#include "schemas/field.h"
#include "schemas/text.h"

void field_json_value(const struct field *row, const struct field_value *value, FILE *out) {
  char number[32];
  switch (row->kind) {
  case FIELD_REAL:
    field_print_number(value->number, number);
    if (isnan(value->number))
      fputs("\"off\"", out);
    else
      fputs(isinf(value->number) ? "null" : number, out); /* JSON has no infinity */
    break;
  case FIELD_INTEGER: fprintf(out, "%" PRId64, value->integer); break;
  case FIELD_BOOLEAN: fputs(value->number != 0 ? "true" : "false", out); break;
  case FIELD_CHOICE:
  case FIELD_TEXT: text_json_string(value->text, out); break;
  }
}

/* Rows that share their first word become one object. They need not be neighbours in the table: a section is opened
 * once, at its first active row, and includes all later rows of the section. */
static void write_level(const struct field_table *table, const void *object, const char *prefix, size_t length,
                        FILE *out) {
  bool first = true;
  for (size_t i = 0; i < table->count; i++) {
    const struct field *row = &table->rows[i];
    if (strncmp(row->path, prefix, length) != 0 || !field_is_active(table, row, object))
      continue;
    const char *word = row->path + length;
    size_t word_length = strcspn(word, "."), whole = length + word_length + 1;
    bool section = word[word_length] == '.', seen = false;
    for (size_t j = 0; section && j < i && !seen; j++)
      seen = strncmp(table->rows[j].path, row->path, whole) == 0 && field_is_active(table, &table->rows[j], object);
    if (seen)
      continue;
    fprintf(out, "%s\"%.*s\":", first ? "" : ",", (int)word_length, word);
    first = false;
    if (section) {
      fputc('{', out);
      write_level(table, object, row->path, whole, out);
      fputc('}', out);
    } else {
      struct field_value value;
      field_get(row, object, &value);
      field_json_value(row, &value, out);
    }
  }
}

void field_json_members(const struct field_table *table, const void *object, FILE *out) {
  write_level(table, object, "", 0, out);
}

char *field_json(const struct field_table *table, const void *object) {
  char *text = NULL;
  size_t size = 0;
  FILE *out = text_open(&text, &size);
  if (!out)
    return NULL;
  fputc('{', out);
  write_level(table, object, "", 0, out);
  fputc('}', out);
  return text_close(out, &text);
}
