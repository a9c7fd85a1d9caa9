/* Four formats behind one row-by-row interface, and the rows of a question as such a table. */
#include "campaign/terminal/table.h"

#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <poll.h>
#include <stdlib.h>
#include <string.h>

#include "campaign/terminal/uncertainty.h"
#include "schemas/csv.h"
#include "schemas/limits.h"
#include "schemas/memory.h"
#include "schemas/text.h"

enum { SAMPLE_ROWS = 500, COLUMNS_MAXIMUM = 2000 }; /* SQLite's own limit on columns is 2000 */

struct column {
  char *name, *unit;
  size_t width; /* width in the aligned table, characters */
  bool text;    /* aligned left */
  bool marked;  /* a number has a mark behind it; the others leave its room free */
};

struct table {
  enum table_format format;
  FILE *out;
  struct column *columns;
  size_t column_count, cell;
  uint64_t rows;
  struct kept { /* cells of the aligned table's first rows, not yet printed */
    char *text;
    bool left;
  } * kept;
  size_t kept_count;
  char mark[UNCERTAINTY_TEXT]; /* behind the next cell */
  bool out_of_memory, broken, ended;
  int write_error;
};

struct table *table_new(enum table_format format, FILE *out) {
  struct table *table = memory_small(1, sizeof *table);
  table->format = format;
  table->out = out;
  return table;
}

bool table_broken(const struct table *table) {
  return table->broken;
}

static void fail(struct table *table) {
  table->out_of_memory = true;
  table->broken = true;
}

static char *copy(struct table *table, const char *text) {
  char *made = strdup(text);
  if (!made)
    fail(table);
  return made;
}

/* A name or a unit can come from a store, too. */
static char *copy_plain(struct table *table, const char *text) {
  char *made = copy(table, text);
  if (made && table->format == TABLE_TEXT)
    text_make_plain(made, "");
  return made;
}

void table_column(struct table *table, const char *name, const char *unit) {
  if (table->broken)
    return;
  struct column *columns = realloc(table->columns, (table->column_count + 1) * sizeof *columns);
  if (!columns || table->column_count == COLUMNS_MAXIMUM) {
    if (columns)
      table->columns = columns;
    fail(table);
    return;
  }
  table->columns = columns;
  columns[table->column_count] = (struct column){.name = copy_plain(table, name)};
  if (unit && strcmp(unit, "1") != 0 && *unit)
    columns[table->column_count].unit = copy_plain(table, unit);
  table->column_count++;
}

void table_columns(struct table *table, const char *const *names) {
  for (; *names; names++)
    table_column(table, *names, NULL);
}

/* Characters, not bytes: continuation bytes of UTF-8 do not count. */
static size_t width_of(const char *text) {
  size_t width = 0;
  for (; *text; text++)
    width += (*text & 0xC0) != 0x80;
  return width;
}

static void pad(struct table *table, size_t count) {
  for (size_t i = 0; i < count; i++)
    fputc(' ', table->out);
}

static bool has_mark(const char *text) {
  const size_t length = strlen(text), mark = strlen(UNCERTAINTY_MARK);
  return length > mark && strcmp(text + length - mark, UNCERTAINTY_MARK) == 0;
}

/* Characters behind a number where another one has its mark. */
static size_t room_of_mark(const struct column *column, const char *text, bool left) {
  return column->marked && !left && !has_mark(text) ? strlen(UNCERTAINTY_MARK) : 0;
}

static void print_aligned(struct table *table, size_t column, const char *text, const char *unit, bool left) {
  const size_t room = unit ? 0 : room_of_mark(&table->columns[column], text, left);
  size_t width = width_of(text) + (unit ? width_of(unit) + 3 : 0) + room;
  size_t gap = table->columns[column].width > width ? table->columns[column].width - width : 0;
  bool last = column + 1 == table->column_count;
  if (!left)
    pad(table, gap);
  fputs(text, table->out);
  if (unit)
    fprintf(table->out, " [%s]", unit);
  if (!last)
    pad(table, left ? gap : room);
  fputs(last ? "\n" : "  ", table->out);
}

static void print_kept(struct table *table) {
  for (size_t c = 0; c < table->column_count; c++) {
    struct column *column = &table->columns[c];
    column->width = width_of(column->name) + (column->unit ? width_of(column->unit) + 3 : 0);
    for (size_t i = c; i < table->kept_count; i += table->column_count)
      column->marked |= !table->kept[i].left && has_mark(table->kept[i].text);
    for (size_t i = c; i < table->kept_count; i += table->column_count) {
      size_t width = width_of(table->kept[i].text) + room_of_mark(column, table->kept[i].text, table->kept[i].left);
      column->width = width > column->width ? width : column->width;
      column->text |= table->kept[i].left;
    }
  }
  for (size_t c = 0; c < table->column_count; c++)
    print_aligned(table, c, table->columns[c].name, table->columns[c].unit, table->columns[c].text);
  for (size_t i = 0; i < table->kept_count; i++) {
    size_t c = i % table->column_count;
    print_aligned(table, c, table->kept[i].text, NULL, table->columns[c].text);
    free(table->kept[i].text);
  }
  free(table->kept);
  table->kept = NULL;
  table->kept_count = 0;
}

/* Would a spreadsheet run the text as a formula? It takes a number as a number. */
static bool is_formula(const char *text) {
  const char *first = text + strspn(text, " \t\n");
  char *end = NULL;
  if (!*first || !strchr(CSV_FORMULA, *first))
    return false;
  (void)strtod(first, &end);
  return end == first || *end;
}

/* The text comes from a store, perhaps a foreign one: it neither controls a terminal nor runs in a spreadsheet. */
static void print_csv_text(struct table *table, const char *text) {
  FILE *const out = table->out;
  char *plain = copy(table, text);
  if (!plain)
    return;
  text_make_plain(plain, "\t\n");
  const char *before = is_formula(plain) ? "'" : "";
  if (!strpbrk(plain, ",\"\t\n") && *plain && *plain != ' ') {
    fprintf(out, "%s%s", before, plain);
  } else {
    fprintf(out, "\"%s", before);
    for (const char *at = plain; *at; at++) {
      if (*at == '"')
        fputc('"', out);
      fputc(*at, out);
    }
    fputc('"', out);
  }
  free(plain);
}

static void header(struct table *table) {
  if (table->format == TABLE_TEXT) {
    print_kept(table);
  } else if (table->format == TABLE_CSV) {
    for (size_t c = 0; c < table->column_count; c++) {
      print_csv_text(table, table->columns[c].name);
      fputs(c + 1 < table->column_count ? "," : "\r\n", table->out);
    }
  } else if (table->format == TABLE_JSON) {
    fputc('[', table->out);
  }
}

/* Why a write to `out` failed. errno may have changed since; a pipe whose reader has gone still reports it. */
static int failure_of(FILE *out, int code) {
  struct pollfd pipe_end = {.fd = fileno(out), .events = POLLOUT};
  if (poll(&pipe_end, 1, 0) == 1 && (pipe_end.revents & POLLERR))
    return EPIPE;
  return code ? code : EIO;
}

static void check_output(struct table *table) {
  if (ferror(table->out)) {
    table->write_error = failure_of(table->out, errno);
    table->broken = true;
  }
}

struct cell {
  enum { CELL_TEXT, CELL_NUMBER, CELL_MISSING } kind;
  const char *text;  /* for programs; digits of a number */
  const char *shown; /* for people */
};

/* The aligned table's first rows are kept until their widths are known. */
static void keep(struct table *table, const struct cell *cell) {
  const size_t most = table->column_count * SAMPLE_ROWS;
  if (!table->kept)
    table->kept = calloc(most, sizeof *table->kept);
  char *made = table->kept ? copy(table, cell->shown) : NULL;
  if (made)
    table->kept[table->kept_count++] = (struct kept){made, cell->kind == CELL_TEXT};
  else
    fail(table);
}

static void print_csv(struct table *table, const struct cell *cell) {
  if (cell->kind == CELL_TEXT)
    print_csv_text(table, cell->text);
  else if (cell->kind == CELL_NUMBER)
    fputs(cell->text, table->out);
  fputs(table->cell + 1 < table->column_count ? "," : "\r\n", table->out);
}

static void print_json(struct table *table, const struct cell *cell) {
  const bool lines = table->format == TABLE_JSON_LINES;
  if (table->cell > 0)
    fputs(", ", table->out);
  else
    fputs(lines ? "{" : table->rows ? ",\n {" : "\n {", table->out);
  text_json_string(table->columns[table->cell].name, table->out);
  fputs(": ", table->out);
  if (cell->kind == CELL_TEXT)
    text_json_string(cell->text, table->out);
  else
    fputs(cell->kind == CELL_NUMBER ? cell->text : "null", table->out);
  if (table->cell + 1 == table->column_count)
    fputs(lines ? "}\n" : "}", table->out);
}

static void add_cell(struct table *table, struct cell cell) {
  if (table->broken || table->column_count == 0)
    return;
  const uint64_t header_row = table->format == TABLE_TEXT ? SAMPLE_ROWS : 0;
  char marked[2 * UNCERTAINTY_TEXT];
  if (table->cell == 0 && table->rows == header_row)
    header(table);
  if (*table->mark && cell.kind != CELL_MISSING) {
    snprintf(marked, sizeof marked, "%.*s%s", UNCERTAINTY_TEXT, cell.shown, table->mark);
    cell.shown = marked;
  }
  table->mark[0] = 0;
  switch (table->format) {
  case TABLE_CSV: print_csv(table, &cell); break;
  case TABLE_JSON:
  case TABLE_JSON_LINES: print_json(table, &cell); break;
  case TABLE_TEXT:
    if (table->rows < SAMPLE_ROWS)
      keep(table, &cell);
    else
      print_aligned(table, table->cell, cell.shown, NULL, table->columns[table->cell].text);
    break;
  }
  if (table->broken || ++table->cell < table->column_count)
    return;
  table->cell = 0;
  table->rows++;
  check_output(table);
}

void table_rests_on(struct table *table, const struct ask_doubts *doubts) {
  if (!table->broken)
    uncertainty_mark(doubts, table->mark);
}

void table_doubt_columns(struct table *table) {
  if (table->format != TABLE_TEXT)
    table_columns(table, (const char *const[]){"doubtful", "doubts", NULL});
}

void table_doubt_cells(struct table *table, const struct ask_doubts *doubts) {
  char words[UNCERTAINTY_TEXT];
  if (table->format == TABLE_TEXT)
    return;
  ask_doubts_words(doubts, words, sizeof words);
  table_integer(table, doubts->doubtful);
  table_text(table, words);
}

void table_missing(struct table *table) {
  add_cell(table, (struct cell){CELL_MISSING, "", "-"});
}

void table_text(struct table *table, const char *text) {
  if (!text) {
    table_missing(table);
    return;
  }
  if (table->format != TABLE_TEXT || text_is_plain(text)) {
    add_cell(table, (struct cell){CELL_TEXT, text, text});
    return;
  }
  char *line = copy(table, text); /* a row stays one line, and a text from a file cannot control the terminal */
  if (!line)
    return;
  text_make_plain(line, "");
  add_cell(table, (struct cell){CELL_TEXT, line, line});
  free(line);
}

void table_integer(struct table *table, int64_t number) {
  char digits[32];
  snprintf(digits, sizeof digits, "%" PRId64, number);
  add_cell(table, (struct cell){CELL_NUMBER, digits, digits});
}

static bool is_json(const struct table *table) {
  return table->format == TABLE_JSON || table->format == TABLE_JSON_LINES;
}

void table_boolean(struct table *table, bool value) {
  if (is_json(table))
    add_cell(table, (struct cell){CELL_NUMBER, value ? "true" : "false", ""});
  else
    add_cell(table, (struct cell){CELL_TEXT, value ? "true" : "false", value ? "yes" : "no"});
}

void table_real(struct table *table, double number) {
  table_fixed(table, number, -1);
}

void table_fixed(struct table *table, double number, int decimals) {
  if (isnan(number)) {
    table_missing(table);
    return;
  }
  if (isinf(number)) { /* JSON has no infinity. The largest double would be wrong, so it is a text there */
    const char *inf = number > 0 ? "inf" : "-inf", *infinity = number > 0 ? "Infinity" : "-Infinity";
    add_cell(table, is_json(table) ? (struct cell){CELL_TEXT, infinity, inf} : (struct cell){CELL_NUMBER, inf, inf});
    return;
  }
  char digits[40], shown[40] = "";
  for (int precision = 15; precision <= 17; precision++) {
    snprintf(digits, sizeof digits, "%.*g", precision, number);
    if (strtod(digits, NULL) == number)
      break;
  }
  if (decimals < 0)
    text_append(shown, sizeof shown, "%.5g", number);
  else
    text_append_fixed(shown, sizeof shown, number, decimals);
  add_cell(table, (struct cell){CELL_NUMBER, digits, shown});
}

static status verdict(const FILE *out, int write_error, struct error *error) {
  if (write_error == 0 || write_error == EPIPE)
    return STATUS_OK;
  return status_fail(error, STATUS_IO, "cannot write to %s: %s", out == stdout ? "standard output" : "the file",
                     strerror(write_error));
}

status table_flush(FILE *out, struct error *error) {
  errno = 0;
  if (fflush(out) == 0 && !ferror(out))
    return STATUS_OK;
  int code = failure_of(out, errno);
  clearerr(out);
  return verdict(out, code, error);
}

status table_end(struct table *table, struct error *error) {
  if (!table->broken) {
    bool nothing_yet = table->rows == 0 || (table->format == TABLE_TEXT && table->rows <= SAMPLE_ROWS);
    if (nothing_yet)
      header(table);
    if (table->format == TABLE_JSON)
      fputs(table->rows ? "\n]\n" : "]\n", table->out);
    errno = 0;
    (void)fflush(table->out); /* sets the stream's error flag */
    check_output(table);
  }
  table->ended = true;
  clearerr(table->out); /* reported here, once */
  if (table->out_of_memory)
    return status_fail(error, STATUS_MEMORY, "out of memory while printing a table");
  return verdict(table->out, table->write_error, error);
}

void table_drop(struct table **variable) {
  struct table *table = *variable;
  if (!table)
    return;
  if (!table->ended && table->rows > 0)
    (void)table_end(table, NULL);
  for (size_t i = 0; i < table->kept_count; i++)
    free(table->kept[i].text);
  for (size_t c = 0; c < table->column_count; c++) {
    free(table->columns[c].name);
    free(table->columns[c].unit);
  }
  free(table->kept);
  free(table->columns);
  free(table);
}

status table_text_only(enum table_format format, const char *what, struct error *error) {
  if (format != TABLE_TEXT)
    return status_fail(error, STATUS_USAGE, "%s is text, not a table: leave --%s out", what,
                       format == TABLE_CSV ? "csv" : "json");
  return STATUS_OK;
}

/* ---- the rows of a question, with the units of the store's columns ---- */

/* Bytes of a blob shown in the aligned table: an identity fits, a list of masses does not. */
enum { BLOB_SHOWN = 64 };

struct rows {
  struct table *table;
  enum table_format format;
  struct ask_column written[LIMITS_AXES_OF_TABLE]; /* varied inputs, in the campaign's units */
  size_t written_count;
  struct shown {
    const struct ask_column *written; /* the varied input that it is; NULL: shown as stored */
    bool hidden;
    size_t doubtful; /* of a mean: its column _doubtful, behind its column _n; 0: none */
  } * shown;         /* per column */
  size_t n;          /* the column of the number of runs */
};

/* The column of the mean whose number of doubtful runs is in column `i`; 0: none. */
static size_t mean_of(const struct answer *answer, size_t i) {
  const char *name = answer_name(answer, i), *end = strstr(name, "_doubtful");
  for (size_t k = 1; end && !end[strlen("_doubtful")] && k < i; k++)
    if (strncmp(answer_name(answer, k), name, (size_t)(end - name)) == 0 &&
        strcmp(answer_name(answer, k) + (end - name), "_mean") == 0)
      return k;
  return 0;
}

/* People see marks, not the columns that they come from, and the half width of an interval, not its ends. */
static void find_marks(struct rows *rows, const struct answer *answer) {
  const size_t count = answer_count(answer);
  for (size_t i = 1; i < count; i++) {
    const size_t mean = mean_of(answer, i);
    if (mean > 0) {
      rows->shown[mean].doubtful = i;
      rows->shown[i].hidden = rows->shown[i - 1].hidden = true;
    }
    if (strcmp(answer_name(answer, i), "n") == 0)
      rows->n = i;
    const char *end = strrchr(answer_name(answer, i), '_');
    if (end && (strcmp(end, "_low95") == 0 || strcmp(end, "_high95") == 0))
      rows->shown[i].hidden = true;
  }
  rows->shown[count - 1].hidden = true;
}

/* The headings, with the units of the store's columns: people see varied inputs in the campaign's units (`written`). */
static void name_columns(struct rows *rows, const struct answer *answer, bool written) {
  const bool people = rows->format == TABLE_TEXT;
  OWNED struct ask_column *units = NULL;
  size_t unit_count = 0;
  if (people) /* on an error headings have no units, and values stay in SI */
    (void)ask_columns_units(answer->store, &units, &unit_count, NULL);
  if (people && written) {
    find_marks(rows, answer);
    (void)ask_columns_axes(answer->store, true, LIMITS_AXES_OF_TABLE, rows->written, &rows->written_count, NULL);
  }
  for (size_t i = 0; i < answer_count(answer); i++) {
    const char *name = answer_name(answer, i);
    struct shown *shown = &rows->shown[i];
    for (size_t k = 0; k < rows->written_count && !shown->written; k++)
      if (strcmp(rows->written[k].name, name) == 0)
        shown->written = &rows->written[k];
    const char *unit = shown->written ? shown->written->unit : NULL;
    for (size_t k = 0; k < unit_count && !unit; k++)
      if (strcmp(units[k].name, name) == 0)
        unit = units[k].unit;
    if (!shown->hidden)
      table_column(rows->table, name, unit);
  }
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

void table_value(struct table *table, const struct query_value *value) {
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
    const struct shown *shown = &rows->shown[i];
    struct query_value value = answer_value(answer, i);
    if (shown->hidden)
      continue;
    if (shown->written)
      value = ask_columns_value(shown->written, &value);
    if (shown->doubtful) {
      const int64_t doubtful = answer_integer(answer, shown->doubtful), n = answer_integer(answer, rows->n);
      const int64_t withheld = n - answer_integer(answer, shown->doubtful - 1);
      table_rests_on(rows->table, &(struct ask_doubts){.runs = n, .doubtful = doubtful, .withheld = withheld});
    }
    if (value.kind == QUERY_BLOB)
      print_blob(rows, value.blob, value.size);
    else
      table_value(rows->table, &value);
  }
}

status table_answer(struct answer question, bool written, enum table_format format, FILE *out) {
  ANSWER answer = question;
  TRY(answer_status(&answer)); /* the question itself failed: no table */
  TABLE table = table_new(format, out);
  OWNED struct shown *shown = calloc(answer_count(&answer) + 1, sizeof *shown);
  struct rows rows = {.format = format, .table = table, .shown = shown};
  if (!shown)
    return status_fail(answer.error, STATUS_MEMORY, "no memory for a table");
  name_columns(&rows, &answer, written);
  while (!table_broken(table) && answer_next(&answer))
    print_row(&rows, &answer);
  TRY(answer_end(&answer));
  return table_end(table, answer.error);
}
