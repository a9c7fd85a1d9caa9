/* SQL functions on our own connection: SQLite has no median, no standard deviation and none of our statistics. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "db/ask/answer.h"
#include "db/store/internal.h"
#include "engine/grow.h"

/* mean(values): the bits of avg(), but where the sum leaves the range of double. */
struct mean {
  double sum;
  struct sample_moments moments;
};

static void mean_step(sqlite3_context *context, int count, sqlite3_value **values) {
  (void)count;
  struct mean *mean = sqlite3_aggregate_context(context, sizeof *mean);
  if (!mean || sqlite3_value_type(values[0]) == SQLITE_NULL)
    return;
  mean->sum += sqlite3_value_double(values[0]);
  sample_add(&mean->moments, sqlite3_value_double(values[0]));
}

static void mean_final(sqlite3_context *context) {
  const struct mean *mean = sqlite3_aggregate_context(context, 0);
  if (mean && mean->moments.n > 0)
    sqlite3_result_double(context, isfinite(mean->sum) ? mean->sum / (double)mean->moments.n : mean->moments.mean);
}

static void stdev_final(sqlite3_context *context) {
  const struct mean *mean = sqlite3_aggregate_context(context, 0);
  if (mean && mean->moments.n > 1)
    sqlite3_result_double(context, sample_summarise_moments(&mean->moments, 0.95).standard_deviation);
}

/* seeds(seed, value): the values of a point's runs with their seeds, for crossed_...(). */
struct values {
  struct sample_of_seed *value;
  size_t n, capacity;
};

static void values_take(sqlite3_context *context, struct values *to, size_t n, const struct sample_of_seed *value) {
  if (!grow_room(&to->value, &to->capacity, to->n + n, sizeof *to->value)) {
    sqlite3_result_error_nomem(context);
    return;
  }
  memcpy(to->value + to->n, value, n * sizeof *value);
  to->n += n;
}

static void seeds_step(sqlite3_context *context, int count, sqlite3_value **values) {
  (void)count;
  struct values *all = sqlite3_aggregate_context(context, sizeof *all);
  if (all && sqlite3_value_type(values[1]) != SQLITE_NULL)
    values_take(context, all, 1,
                &(struct sample_of_seed){sqlite3_value_int64(values[0]), sqlite3_value_double(values[1])});
}

static void seeds_final(sqlite3_context *context) {
  const struct values *all = sqlite3_aggregate_context(context, 0);
  if (all && all->n > 0 && all->n < INT32_MAX / sizeof *all->value)
    sqlite3_result_blob(context, all->value, (int)(all->n * sizeof *all->value), SQLITE_TRANSIENT);
  if (all)
    free(all->value);
}

/* crossed_units(seeds), crossed_sd(seeds): sample_crossed() of the points of a group. */
struct points {
  struct values values;
  size_t *first; /* of each point, and the end */
  size_t n, capacity;
};

static void crossed_step(sqlite3_context *context, int count, sqlite3_value **values) {
  (void)count;
  struct points *all = sqlite3_aggregate_context(context, sizeof *all);
  if (!all || sqlite3_value_type(values[0]) != SQLITE_BLOB)
    return;
  if (!grow_room(&all->first, &all->capacity, all->n + 2, sizeof *all->first)) {
    sqlite3_result_error_nomem(context);
    return;
  }
  all->first[all->n++] = all->values.n;
  values_take(context, &all->values, (size_t)sqlite3_value_bytes(values[0]) / sizeof(struct sample_of_seed),
              sqlite3_value_blob(values[0]));
  all->first[all->n] = all->values.n;
}

static struct sample_crossed crossed_end(sqlite3_context *context) {
  struct sample_crossed crossed = {NAN, NAN};
  struct points *all = sqlite3_aggregate_context(context, 0);
  if (!all)
    return crossed;
  if (all->n > 0 && !sample_crossed(all->n, all->first, all->values.value, &crossed))
    sqlite3_result_error_nomem(context);
  free(all->values.value);
  free(all->first);
  return crossed;
}

static void crossed_units_final(sqlite3_context *context) {
  const struct sample_crossed crossed = crossed_end(context);
  if (crossed.units > 0)
    sqlite3_result_double(context, crossed.units);
}

static void crossed_sd_final(sqlite3_context *context) {
  const struct sample_crossed crossed = crossed_end(context);
  if (crossed.units > 0)
    sqlite3_result_double(context, crossed.deviation);
}

/* student(units): sample_student_of() at 95 %. */
static void student(sqlite3_context *context, int count, sqlite3_value **values) {
  (void)count;
  sqlite3_result_double(context, sample_student_of(sqlite3_value_double(values[0]) - 1, 0.95));
}

struct sample {
  double *values;
  size_t n, capacity;
};

static void median_step(sqlite3_context *context, int count, sqlite3_value **values) {
  (void)count;
  struct sample *s = sqlite3_aggregate_context(context, sizeof *s);
  if (!s || sqlite3_value_type(values[0]) == SQLITE_NULL)
    return;
  if (!grow_room(&s->values, &s->capacity, s->n + 1, sizeof *s->values)) {
    sqlite3_result_error_nomem(context);
    return;
  }
  s->values[s->n++] = sqlite3_value_double(values[0]);
}

static void median_final(sqlite3_context *context) {
  struct sample *s = sqlite3_aggregate_context(context, 0);
  if (!s || s->n == 0)
    return;
  qsort(s->values, s->n, sizeof *s->values, sample_ascending);
  sqlite3_result_double(context, s->n % 2 ? s->values[s->n / 2] : (s->values[s->n / 2 - 1] + s->values[s->n / 2]) / 2);
  free(s->values);
}

static const char *text_of(sqlite3_value *value) {
  const char *text = (const char *)sqlite3_value_text(value);
  return text ? text : "";
}

static const struct condition *conditions_of(sqlite3_value *engine) {
  const struct engine_kind *kind = engine_find(text_of(engine), NULL);
  return kind ? kind->conditions : NULL;
}

/* withheld(engine, warnings, results): 1 where one of the results is withheld, else 0. */
static void withheld(sqlite3_context *context, int count, sqlite3_value **values) {
  (void)count;
  sqlite3_result_int(context, condition_mark(conditions_of(values[0]), text_of(values[1]), text_of(values[2])) ==
                                  CONDITION_WITHHELD);
}

/* doubts(engine, warnings, results): the words that mark one of the results; NULL: none. */
static void doubts(sqlite3_context *context, int count, sqlite3_value **values) {
  (void)count;
  const struct condition *list = conditions_of(values[0]), *row;
  char text[FIELD_TEXT_SIZE] = "", word[CONDITION_WORD];
  for (const char *words = text_of(values[1]); words[strspn(words, ", ")];)
    if (condition_next(list, &words, text_of(values[2]), word, &row))
      text_append(text, sizeof text, "%s%s", *text ? ", " : "", word);
  if (*text)
    sqlite3_result_text(context, text, -1, SQLITE_TRANSIENT);
}

/* words(texts): all their words, each once. */
struct words {
  char text[FIELD_TEXT_SIZE];
};

static void words_step(sqlite3_context *context, int count, sqlite3_value **values) {
  (void)count;
  struct words *all = sqlite3_aggregate_context(context, sizeof *all);
  const struct condition *row;
  char word[CONDITION_WORD];
  for (const char *words = text_of(values[0]); all && words[strspn(words, ", ")];) {
    (void)condition_next(NULL, &words, "", word, &row);
    if (!condition_has(all->text, word))
      text_append(all->text, sizeof all->text, "%s%s", *all->text ? ", " : "", word);
  }
}

static void words_final(sqlite3_context *context) {
  const struct words *all = sqlite3_aggregate_context(context, 0);
  sqlite3_result_text(context, all ? all->text : "", -1, SQLITE_TRANSIENT);
}

static const struct {
  const char *name;
  int arguments;
  void (*call)(sqlite3_context *, int, sqlite3_value **);
  void (*step)(sqlite3_context *, int, sqlite3_value **); /* of an aggregate */
  void (*final)(sqlite3_context *);
} functions[] = {
    {"mean", 1, NULL, mean_step, mean_final},
    {"stdev", 1, NULL, mean_step, stdev_final},
    {"median", 1, NULL, median_step, median_final},
    {"seeds", 2, NULL, seeds_step, seeds_final},
    {"crossed_units", 1, NULL, crossed_step, crossed_units_final},
    {"crossed_sd", 1, NULL, crossed_step, crossed_sd_final},
    {"student", 1, student, NULL, NULL},
    {"withheld", 3, withheld, NULL, NULL},
    {"doubts", 3, doubts, NULL, NULL},
    {"words", 1, NULL, words_step, words_final},
};

status ask_register_functions(struct store *store, struct error *error) {
  const int flags = SQLITE_UTF8 | SQLITE_DETERMINISTIC | SQLITE_INNOCUOUS;
  if (store->functions)
    return STATUS_OK;
  for (size_t i = 0; i < sizeof functions / sizeof functions[0]; i++) {
    const int code = sqlite3_create_function(store->db, functions[i].name, functions[i].arguments, flags, NULL,
                                             functions[i].call, functions[i].step, functions[i].final);
    if (code != SQLITE_OK)
      return sql_fail(store->db, code, "registering functions", error);
  }
  store->functions = true;
  return STATUS_OK;
}
