/* Questions to a store, and their answers: rows that the caller pulls one by one.
 *
 *   ANSWER answer = answer_to(store, error, "SELECT point_id, n FROM points WHERE point_id = %lld", point);
 *   while (answer_next(&answer))
 *     use(answer_integer(&answer, 0), answer_real(&answer, 1));
 *   return answer_end(&answer);
 *
 * An ANSWER closes itself where its block is left, so TRY and return are allowed anywhere. No result is kept in memory.
 * Answers may be nested. A statement that is not read-only is refused. */
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "db/store/store.h"

struct answer {
  struct store *store;
  struct error *error;
  struct sqlite3_stmt *statement; /* NULL: the question failed, or the answer has ended */
  status code;
  bool limited; /* has a time limit */
};
#define ANSWER __attribute__((cleanup(answer_end))) struct answer

/* Asks a question of the program. `format` is that of sqlite3_mprintf(): write what comes from outside with %Q (text)
 * or
 * "%w" (name). An error (no memory, a damaged file) is in the answer and comes out at answer_end(). */
struct answer answer_to(struct store *store, struct error *error, const char *format, ...);

struct query_parameter { /* fills :name in the SQL; a text that reads as a number is bound as one */
  const char *name, *value;
};
/* Asks a question that a user wrote. STATUS_USAGE: not read-only, more than one statement, a parameter missing or
 * unknown, an SQL error (SQLite's message and the place). STATUS_STOPPED: longer than time_limit_s (0: no limit). */
struct answer answer_to_user(struct store *store, const char *sql, size_t parameter_count,
                             const struct query_parameter *parameters, double time_limit_s, struct error *error);
/* An answer that is only this error, for a question that could not be asked. */
struct answer answer_failed(status code, struct error *error);

/* Steps to the next row. False at the end and after an error. */
bool answer_next(struct answer *answer);
/* The last call: frees the answer. The status of the question and of its rows. */
status answer_end(struct answer *answer);
/* The status so far. */
status answer_status(const struct answer *answer);

/* Columns, also before the first row. */
size_t answer_count(const struct answer *answer);
const char *answer_name(const struct answer *answer, size_t column);

/* Values of the current row. */
enum query_kind { QUERY_NULL, QUERY_INTEGER, QUERY_REAL, QUERY_TEXT, QUERY_BLOB };
struct query_value {
  enum query_kind kind;
  int64_t integer;  /* QUERY_INTEGER */
  double real;      /* QUERY_REAL; also the value of an integer. NaN for NULL */
  const char *text; /* QUERY_TEXT: NUL-terminated, borrowed until the next row */
  const void *blob; /* QUERY_BLOB, borrowed until the next row */
  size_t size;      /* bytes of text or blob */
};
struct query_value answer_value(const struct answer *answer, size_t column);
int64_t answer_integer(const struct answer *answer, size_t column);  /* 0 if the value is not an integer */
double answer_real(const struct answer *answer, size_t column);      /* NaN if it is no number */
const char *answer_text(const struct answer *answer, size_t column); /* "" if it is no text; borrowed */
/* Masses of fragments: a blob of float64, little-endian, which is the format of every supported machine. Borrowed, not
 * aligned: read with memcpy. Returns false, and ends the answer with STATUS_CONTENT, if the value is no such blob. `of`
 * names the run or point in the message. */
bool answer_masses(struct answer *answer, size_t column, const char *of, const void **masses, size_t *count);

/* One number: first column of the first row; NaN if there is no row, or no number. `format` as in answer_to(). */
status answer_number(struct store *store, double *number, struct error *error, const char *format, ...);

/* Adds SQL functions to this connection only: the aggregates stdev(x) and median(x). Of the conditions that a run
 * breaks (engine/condition.h): withheld(engine, warnings, results) is 1 where one of the results is withheld,
 * doubts(engine, warnings, results) has the words that mark one of them (NULL: none), and the aggregate words(texts)
 * has each word once. The views of a store use none of them, so that any tool can read the views. */
status ask_register_functions(struct store *store, struct error *error);
