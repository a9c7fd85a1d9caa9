/* Reads CSV (RFC 4180) from outside: points of a campaign, measured spectra. One file means one thing:
 *   - The names decide the separator of the whole file: a semicolon if they have one, else a tab, else a comma. Or the
 *     first line is sep=; (of Excel), sep=, or sep= and a tab.
 *   - Every record has as many cells as there are names.
 *   - A decimal comma is read where semicolons separate the cells, or in double quotes. A file has one decimal mark.
 * Cells may be in double quotes, with "" for a quote; blanks around a cell are no part of it. Lines end with LF or
 * CRLF. Empty records are skipped. A line that begins with # is a remark, but not with #N/A. A NUL byte is refused. The
 * apostrophe before =, +, - or @, by which a writer keeps spreadsheets from taking a text as a formula, is no part of
 * the cell. */
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "schemas/status.h"

enum { CSV_CELLS = 1000 }; /* most cells of a record: a study varies at most some hundred inputs */

#define CSV_FORMULA "=+-@" /* a text that begins with one of these is a formula for a spreadsheet */

struct csv_cell {
  char *text; /* may be changed by the caller */
  bool quoted;
};

enum csv_item {
  CSV_END,
  CSV_REMARK, /* cells[0] has the text behind the # */
  CSV_NAMES,  /* the first record */
  CSV_RECORD,
  CSV_WRONG, /* `wrong` says why, and what to do. Reading can go on: the next item is a later line, or the end */
};

struct csv {
  char *bytes; /* the whole file, `size` bytes; cells are parts of it. Owned: csv_close() */
  size_t size;
  int64_t line; /* where the item begins, from 1 */
  size_t count; /* cells of the names, and of every record; 0 before the names */
  struct csv_cell cells[CSV_CELLS];
  char wrong[200];
  /* The rest is private. */
  char *at;
  int64_t next;         /* line of `at` */
  char separator, mark; /* decimal mark; 0: no number had one yet */
  bool told;            /* the first line has the separator */
};

/* Reads the file `what`: a plain file or a pipe. STATUS_MISSING, STATUS_IO, STATUS_MEMORY; STATUS_CONTENT: it has a NUL
 * byte. After an error csv_close() is not necessary. */
status csv_open(struct csv *csv, const char *path, const char *what, struct error *error);
/* The same for a text, which is copied; `name` is for messages. */
status csv_text(struct csv *csv, const char *name, const char *text, size_t size, struct error *error);
void csv_close(struct csv *csv);

/* Goes to the next item. Cells of earlier items stay. */
enum csv_item csv_next(struct csv *csv);

/* Takes "mass (g)" or "mass [g]" apart. The name stays in the cell. "": there is no unit. */
const char *csv_take_unit(char *name);

/* Gives a number, which a unit may follow, a decimal point. False: its marks can mean two things; `wrong` says why. */
bool csv_number(struct csv *csv, struct csv_cell *cell);
