/* Chooses the points of each pool and reads their runs. */
#include "db/ask/ask.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "db/sql.h"
#include "db/store/views.h"
#include "engine/grow.h"
#include "schemas/memory.h"

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
  if (pools->choice.by && pools->axes) {
    write_axes(sql, pools, true);
    sqlite3_str_appendall(sql, ", ");
  }
  sqlite3_str_appendall(sql, "point_id");
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

/* Adds the values of the runs of a point. */
static status add_values(struct ask_pools *pools, int64_t point, struct error *error) {
  struct ask_pool *pool = &pools->pool;
  size_t have = pool->data.runs.count, room[3] = {have, have, have};
  ANSWER
  answer = answer_to(pools->store, error,
                     "SELECT run_id, seed, \"%w\" FROM runs WHERE point_id = %lld AND "
                     "results_version = %lld AND "
                     "counts = 1 ORDER BY replicate, seed",
                     pools->quantity, (long long)point, (long long)pool->data.results_version);
  for (; answer_next(&answer); have++) {
    TRY(grow_or_fail(&pool->data.run_id, &room[0], have + 1, sizeof *pool->data.run_id, the_pools, error));
    TRY(grow_or_fail(&pool->value, &room[1], have + 1, sizeof *pool->value, the_pools, error));
    TRY(grow_or_fail(&pool->data.seed, &room[2], have + 1, sizeof *pool->data.seed, the_pools, error));
    pool->data.run_id[have] = answer_integer(&answer, 0);
    pool->data.seed[have] = (uint64_t)answer_integer(&answer, 1);
    pool->value[have] = answer_real(&answer, 2);
  }
  pool->data.runs.count = have;
  return answer_end(&answer);
}

static void release(struct ask_pool *pool) {
  point_release(&pool->data);
  free(pool->point);
  free(pool->first_run);
  free(pool->value);
  *pool = (struct ask_pool){0};
}

/* Reads the members from .. end - 1 that have runs of the version. */
static status read_pool(struct ask_pools *pools, size_t from, size_t end, int64_t version, struct error *error) {
  struct ask_pool *pool = &pools->pool;
  TRY(memory_array(&pool->point, end - from, sizeof *pool->point, the_pools, error));
  TRY(memory_array(&pool->first_run, end - from + 1, sizeof *pool->first_run, the_pools, error));
  pool->data = POINT_EMPTY(0, version);
  for (size_t i = from; i < end; i++) {
    const struct ask_doubts_choice runs = {.point = pools->list[i].point};
    const size_t have = pool->data.runs.count;
    if (pools->list[i].version != version)
      continue;
    TRY(pools->of_values ? add_values(pools, runs.point, error)
                         : point_add(pools->store, runs.point, NULL, &pool->data, error));
    TRY(ask_doubts(pools->store, &runs, pools->of_values ? pools->quantity : OUTCOME_NAME(mean_fragment_mass),
                   &pool->doubts, error));
    if (pool->data.runs.count == have)
      continue;
    pool->point[pool->points++] = runs.point;
    pool->first_run[pool->points] = pool->data.runs.count;
  }
  pool->data.point_id = pool->points == 1 ? pool->point[0] : 0;
  return STATUS_OK;
}

/* The pool's label: "strain 3 %, angle 4 deg" from the inputs of `by`; for a single point its varied inputs. */
static status write_label(struct ask_pools *pools, struct error *error) {
  struct ask_pool *pool = &pools->pool;
  if (pool->points == 1)
    return ask_points_label(pools->store, pools->store, pool->point[0], pool->label, sizeof pool->label, error);
  snprintf(pool->label, sizeof pool->label, "%s", pools->axes ? "" : "all points");
  for (size_t a = 0; a < pools->axes; a++) {
    char value[ASK_POOL_TEXT];
    struct ask_column written;
    TRY(ask_columns_written(pools->store, pools->column[a], &written, error));
    ask_columns_show(&written, &pool->input[a], value, sizeof value);
    char column[sizeof pools->column[a]];
    snprintf(column, sizeof column, "%s", pools->column[a]);
    char *word = strrchr(column, '_');
    if (word && strcmp(word, "_name") == 0) { /* "material" says more */
      *word = '\0';
      word = strrchr(column, '_');
    }
    text_append(pool->label, sizeof pool->label, "%s%s %s", a ? ", " : "", word ? word + 1 : column, value);
  }
  return STATUS_OK;
}

/* The next pool, also one without runs. */
static status read_next(struct ask_pools *pools, struct error *error) {
  int64_t version = 0;
  const size_t from = pools->next;
  pools->next = end_of_pool(pools, from, &version);
  release(&pools->pool);
  pools->pool.input = pools->list[from].input;
  TRY(read_pool(pools, from, pools->next, version, error));
  return pools->pool.points > 0 ? write_label(pools, error) : STATUS_OK;
}

const struct ask_pool *ask_pools_next(struct ask_pools *pools) {
  while (pools->code == STATUS_OK && pools->next < pools->count) {
    pools->code = read_next(pools, pools->error);
    if (pools->pool.data.dimensions == 0)
      pools->pool.data.dimensions = pools->choice.dimensions;
    if (pools->code == STATUS_OK && pools->pool.points > 0)
      return &pools->pool;
  }
  return NULL;
}

status ask_pools_end(struct ask_pools *pools) {
  release(&pools->pool);
  free(pools->list);
  pools->list = NULL;
  pools->count = 0;
  return pools->code;
}

static status all_inputs(struct ask_pools *pools, struct error *error) {
  struct ask_column axes[LIMITS_AXES_OF_POOL];
  TRY(ask_columns_axes(pools->store, true, LIMITS_AXES_OF_POOL, axes, &pools->axes, error));
  for (size_t a = 0; a < pools->axes; a++)
    memcpy(pools->column[a], axes[a].name, sizeof pools->column[a]);
  return STATUS_OK;
}

static status begin(struct ask_pools *pools, const char *quantity, struct error *error) {
  TRY(ask_register_functions(pools->store, error));
  if (quantity)
    TRY(ask_group_quantity(pools->store, quantity, pools->quantity, error));
  pools->range = views_range(pools->quantity);
  if (pools->choice.by)
    TRY(ask_group_columns(pools->store, pools->choice.by, LIMITS_AXES_OF_POOL, pools->column, &pools->axes, error));
  else if (pools->choice.inputs)
    TRY(all_inputs(pools, error));
  return find_members(pools, error);
}

struct ask_pools ask_pools(struct store *store, const struct ask_pool_choice *choice, const char *quantity,
                           struct error *error) {
  struct ask_pools pools = {.store = store, .error = error, .choice = *choice, .of_values = quantity != NULL};
  pools.code = begin(&pools, quantity, error);
  return pools;
}

status ask_pool_dimensions(struct store *store, const struct ask_pool_choice *choice, int *dimensions,
                           struct error *error) {
  bool plane = false, other = false;
  ANSWER answer = answer_to(store, error,
                            "SELECT DISTINCT engine FROM point WHERE point_id IN (SELECT point_id FROM run)");
  *dimensions = 3;
  while (answer_next(&answer)) {
    const struct engine_kind *kind = engine_find(answer_text(&answer, 0), NULL);
    *dimensions = kind ? kind->dimensions : 3;
    *(*dimensions == 2 ? &plane : &other) = true;
  }
  if (answer_status(&answer) == STATUS_OK && plane && other)
    return status_fail(
        error, STATUS_USAGE,
        "the store has runs of several engines, some in the plane, with masses in kg/m, and some with masses "
        "in kg: their spectra have no common axis. Choose runs of one kind with --campaign, --point or "
        "--where");
  TRY(answer_end(&answer));
  if (choice->dimensions && *dimensions && choice->dimensions != *dimensions)
    return status_fail(error, STATUS_USAGE, "--dimensions %d: the runs have %d dimensions; leave the option out",
                       choice->dimensions, *dimensions);
  *dimensions = *dimensions ? *dimensions : choice->dimensions;
  return STATUS_OK;
}

const char *ask_pool_mass_unit(int dimensions) {
  return dimensions == 2 ? "kg/m" : "kg";
}

const char *ask_result_unit(const struct field *row, int dimensions) {
  return row->unit && strcmp(row->unit, "kg") == 0 ? ask_pool_mass_unit(dimensions) : row->unit;
}

const char *ask_pool_per_mass_unit(int dimensions) {
  return dimensions == 2 ? "m/kg" : "1/kg";
}

struct pooled_form ask_pool_form(const struct ask_pool *pool, bool cumulative, double density) {
  return (struct pooled_form){.cumulative = cumulative,
                              .size = {density, pool->data.dimensions},
                              .units = pool->points,
                              .first_run = pool->points > 1 ? pool->first_run : NULL,
                              .seed = pool->points > 1 ? pool->data.seed : NULL};
}
