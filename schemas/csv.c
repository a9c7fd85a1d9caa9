/* Takes a CSV text apart, in place. */
#include "schemas/csv.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "schemas/file.h"

static const char digits[] = "0123456789";

static status begin(struct csv *csv, const char *name, struct error *error) {
  const bool marked = strncmp(csv->bytes, "\xEF\xBB\xBF", 3) == 0; /* byte order mark */
  csv->at = csv->bytes + (marked ? 3 : 0);
  csv->next = 1;
  const size_t length = strlen(csv->bytes);
  if (length == csv->size)
    return STATUS_OK;
  int64_t line = 1;
  for (size_t i = 0; i < length; i++)
    line += csv->bytes[i] == '\n';
  csv_close(csv);
  return status_fail(error, STATUS_CONTENT, "%s:%lld: a NUL byte; is this a text file? Save it as UTF-8", name,
                     (long long)line);
}

status csv_open(struct csv *csv, const char *path, const char *what, struct error *error) {
  unsigned char *bytes = NULL;
  *csv = (struct csv){0};
  TRY(file_input(path, error));
  TRY(file_read(path, what, &bytes, &csv->size, error));
  csv->bytes = (char *)bytes;
  return begin(csv, path, error);
}

status csv_text(struct csv *csv, const char *name, const char *text, size_t size, struct error *error) {
  *csv = (struct csv){.bytes = malloc(size + 1), .size = size};
  if (!csv->bytes)
    return status_fail(error, STATUS_MEMORY, "no memory to read '%s'", name);
  memcpy(csv->bytes, text, size);
  csv->bytes[size] = '\0';
  return begin(csv, name, error);
}

void csv_close(struct csv *csv) {
  free(csv->bytes);
  csv->bytes = NULL;
}

static bool blank(char c) {
  return c == ' ' || c == '\t';
}

/* The end of the line, where the byte is LF or the NUL behind the text. */
static char *line_end(char *at) {
  return at + strcspn(at, "\n");
}

static void skip_line(struct csv *csv) {
  csv->at = line_end(csv->at);
  csv->at += *csv->at == '\n';
  csv->next++;
}

/* The separator that the names have outside of double quotes. */
static char find_separator(const char *at) {
  bool quoted = false, tab = false;
  for (; *at && (quoted || *at != '\n'); at++) {
    if (*at == '"')
      quoted = !quoted;
    if (!quoted && *at == ';')
      return ';';
    tab = tab || (!quoted && *at == '\t');
  }
  return tab ? '\t' : ',';
}

static bool ends_line(const char *at) {
  return *at == '\0' || *at == '\n' || (*at == '\r' && (at[1] == '\n' || at[1] == '\0'));
}

static bool ends_cell(const struct csv *csv) {
  return ends_line(csv->at) || *csv->at == csv->separator;
}

static void skip_blanks(struct csv *csv) {
  while (blank(*csv->at) && *csv->at != csv->separator)
    csv->at++;
}

/* Reads a cell without the blanks around it. Returns its end, where the caller puts a NUL once it has looked at what
 * follows. NULL: csv->wrong says why. */
static char *read_cell(struct csv *csv, struct csv_cell *cell) {
  skip_blanks(csv);
  char *to = csv->at;
  *cell = (struct csv_cell){to, *to == '"'};
  if (!cell->quoted) {
    while (!ends_cell(csv))
      csv->at++;
    for (to = csv->at; to > cell->text && blank(to[-1]);)
      to--;
    return to;
  }
  for (csv->at++; *csv->at != '"' || csv->at[1] == '"'; *to++ = *csv->at++) {
    if (*csv->at == '\0') {
      snprintf(csv->wrong, sizeof csv->wrong, "a double quote is not closed");
      return NULL;
    }
    csv->at += *csv->at == '"'; /* "" means one quote */
    csv->next += *csv->at == '\n';
  }
  csv->at++;
  skip_blanks(csv);
  if (ends_cell(csv))
    return to;
  snprintf(csv->wrong, sizeof csv->wrong, "text after a closing double quote");
  return NULL;
}

static bool guards_formula(const char *text) {
  if (*text != '\'')
    return false; /* an empty last cell has nothing behind it */
  const char *first = text + 1 + strspn(text + 1, " \t\n");
  return *first && strchr(CSV_FORMULA, *first);
}

/* Reads the cells of a record. Returns their number; 0: csv->wrong says why. */
static size_t read_record(struct csv *csv) {
  size_t count = 0;
  for (bool last = false; !last; count++) {
    if (count == CSV_CELLS) {
      snprintf(csv->wrong, sizeof csv->wrong, "more than %d columns", CSV_CELLS);
      return 0;
    }
    char *end = read_cell(csv, &csv->cells[count]);
    if (!end)
      return 0;
    last = ends_line(csv->at);
    if (last)
      skip_line(csv);
    else
      csv->at++;
    *end = '\0';
    csv->cells[count].text += guards_formula(csv->cells[count].text);
  }
  return count;
}

/* A spreadsheet puts a remark with a comma in double quotes, and fills the line with separators. */
static enum csv_item take_remark(struct csv *csv, char *text) {
  const bool quoted = *text == '"';
  char *end = line_end(text);
  skip_line(csv);
  while (end > text && strchr(" \t\r,;", end[-1]))
    end--;
  *(quoted && end[-1] == '"' ? end - 1 : end) = '\0';
  csv->cells[0] = (struct csv_cell){text + (quoted ? 2 : 1), quoted};
  return CSV_REMARK;
}

/* What a spreadsheet writes for a failed formula (#DIV/0!, #NAME?, #N/A; #NV in German), or for a number that is wider
 * than its column (####): it is no remark. */
static bool is_error_value(const char *text) {
  const size_t length = strcspn(text, " ,;\t\"\r\n"), wide = strspn(text, "#");
  const size_t name = 1 + strspn(text + 1, "ABCDEFGHIJKLMNOPQRSTUVWXYZ/0");
  const char *behind = text + length + strspn(text + length, " \"");
  if (wide == length)
    return wide > 1 && *behind && strchr(",;\t", *behind) && !ends_line(behind + strspn(behind, " ,;\t"));
  if (name == length)
    return memchr(text, '/', length) || (length == 3 && strncmp(text, "#NV", 3) == 0);
  return name + 1 == length && strchr("!?", text[name]);
}

enum csv_item csv_next(struct csv *csv) {
  while (*csv->at) {
    char *text = csv->at + strspn(csv->at, " \t");
    csv->line = csv->next;
    if (text[*text == '"'] == '#' && !is_error_value(text + (*text == '"')))
      return take_remark(csv, text);
    if (csv->line == 1 && strncmp(text, "sep=", 4) == 0 && text[4] && strchr(";,\t", text[4]) && ends_line(text + 5)) {
      csv->separator = text[4];
      csv->told = true;
      skip_line(csv);
      continue;
    }
    if (csv->count == 0 && !csv->told)
      csv->separator = find_separator(csv->at);
    const size_t count = read_record(csv);
    if (count == 0) {
      skip_line(csv);
      return CSV_WRONG;
    }
    size_t empty = 0;
    while (empty < count && !csv->cells[empty].quoted && !*csv->cells[empty].text)
      empty++;
    if (empty == count)
      continue;
    if (csv->count == 0) {
      csv->count = count;
      return CSV_NAMES;
    }
    if (count == csv->count)
      return CSV_RECORD;
    snprintf(csv->wrong, sizeof csv->wrong,
             "%zu cells, but the header has %zu; a decimal comma needs semicolons between the cells, or double quotes",
             count, csv->count);
    return CSV_WRONG;
  }
  csv->line = csv->next;
  return CSV_END;
}

const char *csv_take_unit(char *name) {
  char *const last = name + strlen(name) - (*name != '\0');
  char *open = *last == ']' ? strrchr(name, '[') : *last == ')' ? strrchr(name, '(') : NULL;
  if (!open)
    return "";
  char *const unit = open + 1 + strspn(open + 1, " ");
  *last = '\0';
  while (open > name && blank(open[-1]))
    open--;
  *open = '\0';
  return unit;
}

bool csv_number(struct csv *csv, struct csv_cell *cell) {
  char *const first = cell->text + (*cell->text == '+' || *cell->text == '-');
  const size_t whole = strspn(first, digits);
  char *const mark = first + whole;
  if (*mark != '.' && *mark != ',')
    return true;
  const size_t behind = strspn(mark + 1, digits);
  const bool other = mark[1 + behind] == '.' || mark[1 + behind] == ',';
  const bool comma = *mark == ',';
  const char *why = NULL;
  if (other)
    why = "write digits without separators, such as 1234.5";
  else if (comma && csv->separator != ';' && !cell->quoted)
    why = "a decimal comma needs semicolons between the cells, or double quotes";
  else if (comma && csv->separator != ';' && whole > 0 && whole <= 3 && *first != '0' && behind == 3)
    why = "it may be a decimal comma or a separator of thousands; write a decimal point";
  else if (csv->mark && csv->mark != *mark)
    why = "numbers above have the other decimal mark; write one in the whole file";
  if (why) {
    snprintf(csv->wrong, sizeof csv->wrong, "'%.40s': %s", cell->text, why);
    return false;
  }
  csv->mark = *mark;
  *mark = '.';
  return true;
}
