/* Cells and records of a CSV text. */
#include "campaign/document/csv.h"

#include <string.h>

static bool ends_line(const struct csv *csv) {
  return csv->text == csv->end || *csv->text == '\n' ||
         (*csv->text == '\r' && csv->text + 1 < csv->end && csv->text[1] == '\n');
}

static void skip_line(struct csv *csv) {
  const char *next = memchr(csv->text, '\n', (size_t)(csv->end - csv->text));
  csv->text = next ? next + 1 : csv->end;
  csv->line++;
}

bool csv_record(struct csv *csv) {
  while (csv->text < csv->end && (*csv->text == '#' || ends_line(csv)))
    skip_line(csv);
  return csv->text < csv->end;
}

static bool fail(struct csv *csv, const char *why) {
  csv->wrong = why;
  return false;
}

static bool put(struct csv *csv, char cell[CSV_CELL], size_t *length) {
  if (*csv->text == '\0')
    return fail(csv, "a NUL byte; is this a text file?");
  if (*length + 1 >= CSV_CELL)
    return fail(csv, "a cell of more than 255 bytes");
  cell[(*length)++] = *csv->text++;
  return true;
}

static bool quoted(struct csv *csv, char cell[CSV_CELL], size_t *length) {
  for (csv->text++; csv->text < csv->end;) {
    if (*csv->text == '"') {
      if (csv->text + 1 == csv->end || csv->text[1] != '"') {
        csv->text++;
        return true;
      }
      csv->text++; /* "" means one quote */
    }
    csv->line += *csv->text == '\n';
    if (!put(csv, cell, length))
      return false;
  }
  return fail(csv, "a double quote is not closed");
}

static bool blank(char c) {
  return c == ' ' || c == '\t';
}

static void skip_blanks(struct csv *csv) {
  while (csv->text < csv->end && blank(*csv->text))
    csv->text++;
}

static bool ends_cell(const struct csv *csv) {
  return ends_line(csv) || *csv->text == ',';
}

/* Reads a cell without quotes. Trailing blanks are not part of it. */
static bool plain(struct csv *csv, char cell[CSV_CELL], size_t *length) {
  while (!ends_cell(csv))
    if (!put(csv, cell, length))
      return false;
  while (*length > 0 && blank(cell[*length - 1]))
    (*length)--;
  return true;
}

bool csv_cell(struct csv *csv, char cell[CSV_CELL], bool *last) {
  size_t length = 0;
  csv->wrong = NULL;
  skip_blanks(csv);
  const bool in_quotes = csv->text < csv->end && *csv->text == '"';
  if (!(in_quotes ? quoted : plain)(csv, cell, &length))
    return false;
  skip_blanks(csv);
  if (!ends_cell(csv))
    return fail(csv, "text after a closing double quote");
  cell[length] = '\0';
  *last = ends_line(csv);
  if (*last)
    skip_line(csv);
  else
    csv->text++;
  return true;
}
