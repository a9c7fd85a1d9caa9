/* Rows on stdout: a table for people; CSV (RFC 4180, but lines end with LF, as shells and Unix tools need), JSON (one
 * array of objects) and JSON Lines (one object on each line) for programs.
 *
 * Cells are added in column order, row after row. Formats for programs are written row by row immediately, with all
 * columns; numbers read back as the same bits. Missing values and NaN: empty in CSV, null in JSON, "-" for people. In
 * CSV a text that a spreadsheet would run as a formula has an apostrophe before it, which readers of schemas/csv.h take
 * off; control characters are spaces but tabs and line ends.
 *
 * The table for people has one rule, whatever it shows. It is 100 characters wide at most (on a terminal, as wide as
 * that; COLUMNS says otherwise). Columns that tell rows apart always stand in it: varied inputs and numbers of points.
 * The half width of an interval (NAME_hw95) stands in the cell of its value, as "0.349 ± 0.003"; both have the
 * digits that it allows; a value that has a range, such as a share, has its interval instead where the half width
 * passes an end of it. Other numbers have five digits. Units are in the headings. If the table is too wide, headings
 * get several lines, then texts, then it leaves columns out, the last ones first. It also leaves out columns that are
 * rarely wanted, and those that have the same cell in all rows (engine, failed: table.c names them). A note on stderr
 * names what is left out. With --all nothing is; the table has several parts if need be. */
#pragma once

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "db/ask/ask.h"

/* TABLE_BARE: as TABLE_TEXT, without a remark on stderr on columns that are not shown (--quiet). */
enum table_format { TABLE_TEXT, TABLE_BARE, TABLE_ALL, TABLE_CSV, TABLE_JSON, TABLE_JSON_LINES };
bool table_for_people(enum table_format format); /* TABLE_TEXT, TABLE_BARE, or with all columns */

struct table;

/* A variable of type TABLE frees itself where its block is left, so that TRY and return are allowed anywhere. Without
 * table_end(), after an error, it prints the rows so far first, and nothing if there is none. */
#define TABLE __attribute__((cleanup(table_drop))) struct table *
void table_drop(struct table **table); /* for TABLE */

/* Never NULL: memory that a cell or a column lacks is remembered and returned by table_end. `out` is borrowed. */
struct table *table_new(enum table_format format, FILE *out);

/* Before the first cell. unit: NULL or "1" for none. Texts are copied. */
void table_column(struct table *table, const char *name, const char *unit);
/* Adds several columns without unit; NULL ends the names. */
void table_columns(struct table *table, const char *const *names);
/* A varied input: people see its short name, its unit, and numbers in that unit. */
void table_key(struct table *table, const struct ask_column *input);
/* The last column is the half width of a mean of values in this range. */
void table_range(struct table *table, struct sample_range range);
/* A value and the ends of its interval: for programs three columns, for people one, as uncertainty_interval(). */
void table_interval_columns(struct table *table, const char *value, const char *low, const char *high);
void table_interval(struct table *table, double value, double low, double high);
/* People see the last column only with --all. */
void table_rare(struct table *table);

void table_text(struct table *table, const char *text); /* NULL: missing */
void table_real(struct table *table, double number);
void table_reals(struct table *table, size_t count, const double *numbers); /* a cell for each */
/* The same with this number of decimals in the table for people. */
void table_fixed(struct table *table, double number, int decimals);
void table_integer(struct table *table, int64_t number);
void table_boolean(struct table *table, bool value);
void table_missing(struct table *table);

/* The next cell rests on these runs: people see "!" behind a number that rests on runs in doubt (uncertainty_mark()).
 */
void table_rests_on(struct table *table, const struct ask_doubts *doubts);
/* The last columns, `doubtful` and `doubts` (number of runs in doubt, and their words), and the cells of a row. For
 * programs only: people see marks. */
void table_doubt_columns(struct table *table);
void table_doubt_cells(struct table *table, const struct ask_doubts *doubts);

/* Writes the remaining rows: the last call. STATUS_IO when writing failed (disk full). A closed pipe (EPIPE: `|
 * head`) is not an error. */
status table_end(struct table *table, struct error *error);

/* After table_end: did people not see this column? */
bool table_hides(const struct table *table, const char *name);

/* True when the pipe is closed or writing has failed: more rows are not needed. */
bool table_broken(const struct table *table);

/* Prints all rows of an answer as a table, and ends the answer. Headings have the units of the store's table
 * column_doc. `written`: the program chose the columns, and varied inputs are in the campaign's units; people see marks
 * instead of the columns _n, _doubtful and doubts of ask_group(). Else the user named the columns: all of them are
 * shown if there is room. A closed pipe is not an error. */
status table_answer(struct answer answer, bool written, enum table_format format, FILE *out);

/* Adds one cell: number, text or missing. Not for QUERY_BLOB. */
void table_value(struct table *table, const struct query_value *value);
/* Adds one cell: the value of a row in its object. */
void table_field(struct table *table, const struct field *row, const void *object);

/* Flushes stdout; returns the same statuses as table_end. For commands that print text. */
status table_flush(FILE *out, struct error *error);

/* For output that is always text: STATUS_USAGE when --json or --csv was given. */
status table_text_only(enum table_format format, const char *what, struct error *error);

/* ---- errors in words ----
 *
 * The two errors of a mean in words: the possible changes by other seeds and by a finer resolution. */

enum { UNCERTAINTY_TEXT = 400 };

/* "0.349 ± 0.003": the error has one digit, or two after a leading 1; the value has as many decimals. Without a half
 * width above 0: "0.349". Below 0.001: "(3.3 ± 0.2)×10^-5". */
void uncertainty_number(double value, double half_width, char text[UNCERTAINTY_TEXT]);

/* The same with the interval, "0.11 (0 to 0.27)", where the half width passes an end of the range. */
void uncertainty_cell(double value, double half_width, const struct sample_range *range, char text[UNCERTAINTY_TEXT]);
/* The same of an interval with its ends: "0.35 ± 0.02" where the value is in its middle. NaN: an end that is not known;
 * without both, three digits. */
void uncertainty_interval(double value, double low, double high, char text[UNCERTAINTY_TEXT]);
/* Writes "1.000 ≥ 0.905" if the value is that of equal runs at the upper end of a share; low: what they bound. False:
 * it is another value. */
#define UNCERTAINTY_ALL_ONE "1.000 \xe2\x89\xa5 a: all runs are 1, and the mean is at least a"
bool uncertainty_all_one(double value, double half_width, double low, const struct sample_range *range,
                         char text[UNCERTAINTY_TEXT]);

/* Says on stderr that so many runs of a store are excluded; nothing for 0. */
void uncertainty_excluded(int64_t count, const char *store);
/* Says on stderr how many of these runs of a store gave no result (ask_run_missing()); nothing for none. wanted: 0 if
 * the number of all is told elsewhere. */
void uncertainty_missing(int64_t missing, int64_t wanted, const char *store);
/* Says on stderr that these campaigns of a store (ask_campaign_namesakes()) have one name; nothing for "". */
void uncertainty_namesakes(const char *numbers, const char *campaign, const char *path);
/* Says on stderr that so many points of studies and searches are left out; nothing for 0. */
void uncertainty_left_out(int64_t points);

/* "0.349 ± 0.003 (seeds, 95 %)", or "(seeds, 95 %, weak)"; "0.11 (0 to 0.27; seeds, 95 %)"; "1 (all 30 runs; 0.905 to
 * 1)" when all values of a share are equal; "0.349" without an interval. */
void uncertainty_seeds(const struct sample_summary *mean, char text[UNCERTAINTY_TEXT]);

/* "± 0.06 (resolution: particles)", "up to ± 0.06 (resolution: particles); studied at 2 of 9 points, `clast converge
 * COMMAND` studies others", ">= 0.06 (resolution: particles)", "resolution: not studied; `clast converge COMMAND`
 * measures it", or "resolution: does not converge (`clast converge COMMAND`)". The knobs are those that were studied.
 */
void uncertainty_resolution(const struct ask_resolution *resolution, char text[UNCERTAINTY_TEXT]);

/* The same for the cell of a table: "0.06", ">= 0.06" where no limit is known, or "not studied". */
void uncertainty_resolution_cell(enum ask_resolution_verdict verdict, double half_width, char text[UNCERTAINTY_TEXT]);

#define UNCERTAINTY_MARK " !"
/* Behind a number: nothing, " !" when it rests on runs in doubt, " (17) !" when the values of others are withheld. */
void uncertainty_mark(const struct ask_doubts *doubts, char text[UNCERTAINTY_TEXT]);

/* A line for each condition that runs break: how many of how many, what it says, and what to do. */
void uncertainty_doubts(const struct ask_doubts *doubts, FILE *out);
