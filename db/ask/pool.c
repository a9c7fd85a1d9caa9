/* Chooses the points of each pool and reads their runs. */
#include "db/ask/ask.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "db/sql.h"
#include "db/store/views.h"
#include "engine/engine.h"
#include "engine/grow.h"
#include "schemas/limits.h"
#include "schemas/memory.h"
#include "schemas/text.h"

struct ask_pool_member { /* a point, in the order of the pools */
  int64_t point, version;
  struct query_value input[LIMITS_AXES_OF_POOL]; /* texts point to `text` */
  char text[LIMITS_AXES_OF_POOL][ASK_POOL_TEXT];
};

static const char the_pools[] = "a question to the store"; /* there was no memory for it */

static void write_axes(sqlite3_str *sql, const struct ask_pools *pools, bool first) {
  for (size_t a = 0; a < pools->axes; a++)
    sqlite3_str_appendf(sql, "%s\"%w\"", first && a == 0 ? "" : ", ", pools->column[a]);
}

/* The points with runs, ordered by their inputs. */
static status find_members(struct ask_pools *pools, struct error *error) {
  sqlite3_str *sql = sqlite3_str_new(NULL);
  sqlite3_str_appendall(sql, "SELECT point_id, max(results_version)");
  write_axes(sql, pools, false);
  sqlite3_str_appendall(sql, " FROM points WHERE n > 0");
  if (pools->choice.point)
    sqlite3_str_appendf(sql, " AND point_id = %lld", (long long)pools->choice.point);
  sqlite3_str_appendall(sql, " GROUP BY point_id");
  write_axes(sql, pools, false);
  sqlite3_str_appendall(sql, " ORDER BY ");
  write_axes(sql, pools, true);
  sqlite3_str_appendall(sql, pools->axes ? ", point_id" : "point_id");
  ANSWER answer = answer_to(pools->store, error, "%z", sqlite3_str_finish(sql));
  while (answer_next(&answer)) {
    TRY(grow_or_fail(&pools->list, &pools->room, pools->count + 1, sizeof *pools->list, the_pools, error));
    struct ask_pool_member *member = &pools->list[pools->count++];
    *member = (struct ask_pool_member){.point = answer_integer(&answer, 0), .version = answer_integer(&answer, 1)};
    for (size_t a = 0; a < pools->axes; a++) {
      member->input[a] = answer_value(&answer, 2 + a);
      snprintf(member->text[a], ASK_POOL_TEXT, "%s", answer_text(&answer, 2 + a));
    }
  }
  for (size_t i = 0; i < pools->count; i++) /* only now: the list no longer moves in memory */
    for (size_t a = 0; a < pools->axes; a++)
      pools->list[i].input[a].text = pools->list[i].text[a];
  return answer_end(&answer);
}

static bool same_input(const struct query_value *a, const struct query_value *b) {
  if (a->kind == QUERY_TEXT || b->kind == QUERY_TEXT)
    return a->kind == b->kind && strcmp(a->text, b->text) == 0;
  return (a->kind == QUERY_NULL && b->kind == QUERY_NULL) || a->real == b->real;
}

/* Index after the last member of the pool that begins at `from`. *version: the newest results_version of the pool. */
static size_t end_of_pool(const struct ask_pools *pools, size_t from, int64_t *version) {
  *version = pools->list[from].version;
  size_t end = from + 1;
  for (; pools->choice.by && end < pools->count; end++) {
    for (size_t a = 0; a < pools->axes; a++)
      if (!same_input(&pools->list[from].input[a], &pools->list[end].input[a]))
        return end;
    if (pools->list[end].version > *version)
      *version = pools->list[end].version;
  }
  return end;
}

struct values {
  double *value;
  int64_t *seed;
};

static status read_values(const struct ask_pools *pools, struct point_data *point, struct values *values,
                          struct error *error) {
  size_t room[3] = {0};
  ANSWER
  answer = answer_to(pools->store, error,
                     "SELECT run_id, seed, \"%w\" FROM runs WHERE point_id = %lld AND "
                     "results_version = %lld AND "
                     "counts = 1 ORDER BY replicate, seed",
                     pools->quantity, (long long)point->point_id, (long long)point->results_version);
  for (; answer_next(&answer); point->runs.count++) {
    const size_t run = point->runs.count;
    TRY(grow_or_fail(&point->run_id, &room[0], run + 1, sizeof *point->run_id, the_pools, error));
    TRY(grow_or_fail(&values->value, &room[1], run + 1, sizeof *values->value, the_pools, error));
    TRY(grow_or_fail(&values->seed, &room[2], run + 1, sizeof *values->seed, the_pools, error));
    point->run_id[run] = answer_integer(&answer, 0);
    values->seed[run] = answer_integer(&answer, 1);
    values->value[run] = answer_real(&answer, 2);
  }
  return answer_end(&answer);
}

static void release(struct ask_pools *pools) {
  point_release(&pools->pool.data);
  free(pools->point);
  free(pools->first_run);
  free(pools->value);
  free(pools->seed);
  pools->point = NULL;
  pools->first_run = NULL;
  pools->value = NULL;
  pools->seed = NULL;
}

/* Appends `count` elements to the array, whose address is given. */
static status append(void *array, size_t have, const void *more, size_t count, size_t size, struct error *error) {
  size_t room = have; /* of the array, which has no spare room */
  char *block;
  if (count == 0)
    return STATUS_OK;
  TRY(grow_or_fail(array, &room, have + count, size, the_pools, error));
  memcpy(&block, array, sizeof block); /* a pointer of any type */
  memcpy(block + have * size, more, count * size);
  return STATUS_OK;
}

/* Adds the runs of a point to the pool. `point` and `values` stay the caller's. */
static status add_point(struct ask_pools *pools, const struct point_data *point, const struct values *values,
                        struct error *error) {
  struct point_data *all = &pools->pool.data;
  const size_t have = all->runs.count, more = point->runs.count;
  TRY(append(&all->run_id, have, point->run_id, more, sizeof *all->run_id, error));
  if (values->value) {
    TRY(append(&pools->value, have, values->value, more, sizeof *values->value, error));
    TRY(append(&pools->seed, have, values->seed, more, sizeof *values->seed, error));
  }
  if (point->first) {
    const size_t masses = all->first ? all->first[have] : 0;
    static const size_t zero = 0;
    if (!all->first)
      TRY(append(&all->first, 0, &zero, 1, sizeof zero, error));
    TRY(append(&all->first, have + 1, point->first + 1, more, sizeof *point->first, error));
    TRY(append(&all->masses, masses, point->masses, point->first[more], sizeof *point->masses, error));
    for (size_t r = have + 1; r <= have + more; r++)
      all->first[r] += masses;
  }
  all->runs = (struct pooled_runs){have + more, all->first, all->masses};
  all->element_mass = fmax(all->element_mass, point->element_mass); /* fmax ignores a NaN */
  all->complete_mass = fmax(all->complete_mass, point->complete_mass);
  all->dimensions = point->dimensions;
  pools->point[pools->pool.points++] = point->point_id;
  pools->first_run[pools->pool.points] = have + more;
  return STATUS_OK;
}

/* Reads the members from .. end - 1 that have runs of the version. */
static status read_pool(struct ask_pools *pools, size_t from, size_t end, int64_t version, struct error *error) {
  TRY(memory_array(&pools->point, end - from, sizeof *pools->point, the_pools, error));
  TRY(memory_array(&pools->first_run, end - from + 1, sizeof *pools->first_run, the_pools, error));
  pools->pool.data = (struct point_data){.results_version = version, .element_mass = NAN, .complete_mass = NAN};
  status code = STATUS_OK;
  for (size_t i = from; i < end && code == STATUS_OK; i++) {
    struct point_data point = {.point_id = pools->list[i].point, .results_version = version};
    struct values values = {0};
    if (pools->list[i].version != version)
      continue;
    code = pools->of_values ? read_values(pools, &point, &values, error)
                            : point_read(pools->store, point.point_id, version, &point, error);
    const struct ask_doubts_choice runs = {.point = point.point_id};
    if (code == STATUS_OK)
      code = ask_doubts(pools->store, &runs, pools->of_values ? pools->quantity : OUTCOME_NAME(mean_fragment_mass),
                        &pools->pool.doubts, error);
    if (code == STATUS_OK && point.runs.count > 0)
      code = add_point(pools, &point, &values, error);
    point_release(&point);
    free(values.value);
    free(values.seed);
  }
  pools->pool.data.point_id = pools->pool.points == 1 ? pools->point[0] : 0;
  return code;
}

/* The pool's label: "strain 3 %, angle 4 deg" from the inputs of `by`; for a single point its varied inputs. */
static status write_label(struct store *store, struct ask_pool *pool, struct error *error) {
  if (pool->points == 1)
    return ask_points_label(store, pool->point[0], pool->label, sizeof pool->label, error);
  snprintf(pool->label, sizeof pool->label, "%s", pool->axes ? "" : "all points");
  for (size_t a = 0; a < pool->axes; a++) {
    char unit[72] = "", value[ASK_POOL_TEXT] = "off";
    struct ask_column written;
    const struct query_value *input = &pool->input[a];
    TRY(ask_columns_written(store, pool->column[a], &written, error));
    text_unit(written.unit, unit, sizeof unit);
    if (input->kind == QUERY_TEXT)
      snprintf(value, sizeof value, "%s", input->text);
    else if (input->kind != QUERY_NULL)
      snprintf(value, sizeof value, "%.3g", input->real / written.factor);
    text_powers(value, sizeof value);
    char column[sizeof pool->column[a]];
    snprintf(column, sizeof column, "%s", pool->column[a]);
    char *word = strrchr(column, '_');
    if (word && strcmp(word, "_name") == 0) { /* "material" says more */
      *word = '\0';
      word = strrchr(column, '_');
    }
    text_append(pool->label, sizeof pool->label, "%s%s %s%s%s", a ? ", " : "", word ? word + 1 : column, value,
                *unit ? " " : "", unit);
  }
  return STATUS_OK;
}

/* The next pool, also one without runs. */
static status read_next(struct ask_pools *pools, struct error *error) {
  int64_t version = 0;
  const size_t from = pools->next;
  pools->next = end_of_pool(pools, from, &version);
  release(pools);
  pools->pool = (struct ask_pool){.axes = pools->axes};
  memcpy(pools->pool.column, pools->column, sizeof pools->pool.column);
  memcpy(pools->pool.input, pools->list[from].input, sizeof pools->pool.input);
  TRY(read_pool(pools, from, pools->next, version, error));
  pools->pool.point = pools->point;
  pools->pool.first_run = pools->first_run;
  pools->pool.value = pools->value;
  pools->pool.seed = pools->seed;
  return pools->pool.points > 0 ? write_label(pools->store, &pools->pool, error) : STATUS_OK;
}

const struct ask_pool *ask_pools_next(struct ask_pools *pools) {
  while (pools->code == STATUS_OK && pools->next < pools->count) {
    pools->code = read_next(pools, pools->error);
    if (pools->code == STATUS_OK && pools->pool.points > 0)
      return &pools->pool;
  }
  return NULL;
}

status ask_pools_end(struct ask_pools *pools) {
  release(pools);
  free(pools->list);
  pools->list = NULL;
  pools->count = 0;
  return pools->code;
}

static status begin(struct ask_pools *pools, const char *quantity, struct error *error) {
  TRY(ask_register_functions(pools->store, error));
  if (quantity)
    TRY(ask_group_quantity(pools->store, quantity, pools->quantity, error));
  pools->share = views_is_share(pools->quantity);
  if (pools->choice.by)
    TRY(ask_group_columns(pools->store, pools->choice.by, LIMITS_AXES_OF_POOL, pools->column, &pools->axes, error));
  return find_members(pools, error);
}

struct ask_pools ask_pools(struct store *store, const struct ask_pool_choice *choice, const char *quantity,
                           struct error *error) {
  struct ask_pools pools = {.store = store, .error = error, .choice = *choice, .of_values = quantity != NULL};
  pools.code = begin(&pools, quantity, error);
  return pools;
}

status ask_pool_dimensions(struct store *store, int *dimensions, struct error *error) {
  ANSWER answer = answer_to(store, error, "SELECT engine FROM point ORDER BY point_id LIMIT 1");
  const struct engine_kind *kind = answer_next(&answer) ? engine_find(answer_text(&answer, 0), NULL) : NULL;
  *dimensions = kind && kind->dimensions == 2 ? 2 : 3;
  return answer_end(&answer);
}

const char *ask_pool_mass_unit(int dimensions) {
  return dimensions == 2 ? "kg/m" : "kg";
}

struct pooled_form ask_pool_form(const struct ask_pool *pool, bool cumulative, double density) {
  return (struct pooled_form){.cumulative = cumulative,
                              .size = {density, pool->data.dimensions},
                              .units = pool->points,
                              .first_run = pool->points > 1 ? pool->first_run : NULL};
}
