/* Rows as text for users: the output of `clast explain`. */
#include <string.h>

#include "schemas/field.h"
#include "schemas/text.h"

enum { WIDTH = 100, INDENT = 4 };

static void explain_choices(const struct field *row, FILE *out) {
  const char *doc = row->choice_docs;
  for (size_t i = 0; row->choices[i]; i++) {
    size_t length = doc ? strcspn(doc, "\n") : 0;
    fprintf(out, "%*s%s%s%.*s\n", INDENT + 2, "", row->choices[i], length ? ": " : "", (int)length, doc ? doc : "");
    if (doc)
      doc += length + (doc[length] == '\n');
  }
}

/* " in m, above 0 m, or off" */
static void explain_range(const struct field *row, FILE *out) {
  char range[160];
  field_describe_range(row, range, sizeof range);
  if (row->unit && strcmp(row->unit, "1"))
    fprintf(out, " in %s", row->unit);
  if (row->flags & FIELD_PERCENT)
    fputs(" in percent", out);
  if (strncmp(range, "a number", 8) != 0)
    fprintf(out, ", %s", range);
  if (row->flags & FIELD_MAY_BE_OFF)
    fputs(", or off", out);
}

static void explain_default(const struct field *row, FILE *out) {
  struct field_value value;
  char text[FIELD_TEXT_SIZE + 64];
  if (row->flags & FIELD_REQUIRED) {
    fputs("; required\n", out);
    return;
  }
  if (row->flags & FIELD_DERIVED) {
    fputs("; default follows from other inputs\n", out);
    return;
  }
  field_default(row, &value);
  field_print(row, &value, text, sizeof text);
  fprintf(out, row->kind == FIELD_TEXT ? "; default \"%s\"\n" : "; default %s\n", text);
}

static void explain_row(const struct field *row, FILE *out) {
  static const char *const kinds[] = {"real", "integer", "true or false", "choice", "text"};
  fprintf(out, "%s: %s", row->path, kinds[row->kind]);
  if (row->kind == FIELD_REAL || row->kind == FIELD_INTEGER)
    explain_range(row, out);
  explain_default(row, out);
  if (row->doc && *row->doc)
    text_wrap(row->doc, 0, INDENT, WIDTH, out);
  if (row->kind == FIELD_CHOICE)
    explain_choices(row, out);
  if (row->when) {
    fprintf(out, "%*sOnly when %.*s is ", INDENT, "", (int)strcspn(row->when, "="), row->when);
    field_describe_condition(row, out);
    fputc('\n', out);
  }
  if (row->source)
    fprintf(out, "%*sSource: %s\n", INDENT, "", row->source);
}

size_t field_explain(const struct field_table *table, const char *prefix, FILE *out) {
  size_t length = strlen(prefix), count = 0;
  while (length && prefix[length - 1] == '.')
    length--;
  for (size_t i = 0; i < table->count; i++) {
    const char *path = table->rows[i].path;
    if (strncmp(path, prefix, length) != 0 || (length && path[length] != 0 && path[length] != '.'))
      continue;
    explain_row(&table->rows[i], out);
    count++;
  }
  return count;
}
