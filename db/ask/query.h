/* Reading from a store: any read-only SQL, canned queries by name, statistics grouped by varied inputs.
 *
 * Rows go to a sink one by one, with names and types. Commands print them as tables, CSV or JSON; no result is kept in
 * memory. The connection refuses every statement that is not read-only. */
#ifndef CLAST_DB_ASK_QUERY_H
#define CLAST_DB_ASK_QUERY_H

#include <stddef.h>
#include <stdint.h>

#include "db/store/store.h"

enum query_kind { QUERY_NULL, QUERY_INTEGER, QUERY_REAL, QUERY_TEXT, QUERY_BLOB };

struct query_value {
  enum query_kind kind;
  int64_t integer;  /* QUERY_INTEGER */
  double real;      /* QUERY_REAL; also the value of an integer. NaN for NULL */
  const char *text; /* QUERY_TEXT: NUL-terminated, borrowed for the call */
  const void *blob; /* QUERY_BLOB */
  size_t size;      /* bytes of text or blob */
};

struct query_sink {
  void *context;
  /* Called once, before the first row, also when there are no rows. May be NULL. */
  status (*columns)(void *context, size_t count, const char *const *names, struct error *error);
  /* A status other than STATUS_OK ends the query with that status. May be NULL. */
  status (*row)(void *context, size_t count, const struct query_value *values, struct error *error);
};

struct query_parameter { /* fills :name in the SQL; a text that reads as a number is bound as one */
  const char *name, *value;
};

/* Runs one read-only statement. STATUS_USAGE: not read-only, more than one statement, a parameter missing or unknown,
 * an SQL error (SQLite's message and the place). STATUS_STOPPED: longer than time_limit_s (0: no limit). */
status query_run(struct store *store, const char *sql, size_t parameter_count, const struct query_parameter *parameters,
                 double time_limit_s, const struct query_sink *sink, struct error *error);

/* One number: first column of the first row. NaN when there is no row or the value is NULL. */
status query_number(struct store *store, const char *sql, size_t parameter_count,
                    const struct query_parameter *parameters, double *number, struct error *error);

/* Adds SQL functions to this connection only: the aggregates stdev(x), median(x) and hist_sum(masses), which pools mass
 * blobs into the store's bins as a JSON array of [bin, count, mass], and pooled_hw95(runs, count, squares), which is
 * pooled_spectrum_count_hw95(). The views of a store use none of them, so that any tool can read the views. */
status ask_register_functions(struct store *store, struct error *error);

/* points, n, failed, censored, and of each quantity mean, standard deviation, standard error, 95 % half width,
 * resolution error and its verdict (the worst of all points, db/ask/resolution.h), of all runs that share the named
 * axes. A group of one point is a sample of runs (seeds). A group of several points pools over other inputs: its points
 * are the units, each with the mean of its runs, and the interval is that of a mean over such points; the scatter
 * between points includes that of the seeds. `pooled` names these inputs ("threshold.angle, material.m"; "": every
 * group has one point).
 *
 * `by`: comma-separated paths of varied inputs or unique suffixes of one ("m,k"); "" pools everything. `quantities`:
 * comma-separated result columns or unique suffixes; NULL = the main ones. Results of different results_version are
 * different rows. Registers the functions above. STATUS_USAGE names the known axes and quantities. */
enum { ASK_GROUP_POOLED = 512 };
status ask_group(struct store *store, const char *by, const char *quantities, const struct query_sink *sink,
                 char pooled[ASK_GROUP_POOLED], struct error *error);

/* The full name of one result column of the view runs from a unique ending of it. STATUS_USAGE names the known ones. */
enum { ASK_GROUP_NAME = 128 };
status ask_group_quantity(struct store *store, const char *quantity, char name[ASK_GROUP_NAME], struct error *error);

/* The columns of comma-separated varied inputs (paths or unique endings), at most `most`. "" names no input. */
status ask_group_columns(struct store *store, const char *by, size_t most, char (*columns)[ASK_GROUP_NAME],
                         size_t *count, struct error *error);

/* The names of all result columns of the view runs, one row each. */
status ask_group_quantities(struct store *store, const struct query_sink *sink, struct error *error);

/* Pairs of points that share seeds and have no input with different values; each point may have inputs that the other
 * lacks. Such a pair appears when a campaign is computed again by a program with a new input. ask_group counts the runs
 * of both. */
struct ask_group_twins {
  int64_t pairs;    /* number of such pairs; 0: the other members are not set */
  int64_t point[2]; /* one pair */
  char input[256];  /* an input that only one of the two points has */
};
status ask_group_twins(struct store *store, struct ask_group_twins *twins, struct error *error);

/* Canned queries: a name, its question in a sentence, its SQL, the names of its parameters. */
struct query_canned {
  const char *name, *doc, *sql;
  const char *parameters; /* comma-separated, "" for none */
};
size_t ask_canned_count(void);
const struct query_canned *ask_canned_at(size_t index);
/* Finds a canned query by name. NULL: *error lists the known names. */
const struct query_canned *ask_canned_find(const char *name, struct error *error);

#endif
