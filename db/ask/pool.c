/* Chooses the points of each pool and reads their runs. */
#include "db/ask/pool.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "db/ask/columns.h"
#include "db/ask/points.h"
#include "db/sql.h"
#include "engine/engine.h"
#include "engine/grow.h"
#include "schemas/text.h"

struct member { /* a point, in the order of the pools */
  int64_t point, version;
  struct query_value input[ASK_POOL_AXES]; /* texts point to `text` */
  char text[ASK_POOL_AXES][ASK_POOL_TEXT];
};

struct members {
  const struct ask_pool_choice *choice;
  size_t axes;
  char column[ASK_POOL_AXES][ASK_GROUP_NAME];
  struct member *list;
  size_t count, room;
};

static status no_memory(struct error *error) {
  return status_fail(error, STATUS_MEMORY, "no memory for a question to the store");
}

/* point_id, results_version, inputs */
static status take_member(void *context, size_t count, const struct query_value *values, struct error *error) {
  struct members *members = context;
  (void)count;
  if (!grow_room(&members->list, &members->room, members->count + 1, sizeof *members->list))
    return no_memory(error);
  struct member *member = &members->list[members->count++];
  *member = (struct member){.point = values[0].integer, .version = values[1].integer};
  for (size_t a = 0; a < members->axes; a++) {
    member->input[a] = values[2 + a];
    if (values[2 + a].kind == QUERY_TEXT)
      snprintf(member->text[a], ASK_POOL_TEXT, "%s", values[2 + a].text);
  }
  return STATUS_OK;
}

static void write_axes(FILE *sql, const struct members *members, bool first) {
  for (size_t a = 0; a < members->axes; a++) {
    fputs(first && a == 0 ? "" : ", ", sql);
    sql_write_name(members->column[a], sql);
  }
}

/* The points with runs, ordered by their inputs. With a condition, the query reads the runs themselves. */
static status find_members(struct store *store, struct members *members, struct error *error) {
  const struct ask_pool_choice *choice = members->choice;
  const struct query_sink sink = {members, NULL, take_member};
  char *text = NULL;
  size_t size = 0;
  FILE *sql = open_memstream(&text, &size);
  if (!sql)
    return no_memory(error);
  fputs("SELECT point_id, max(results_version)", sql);
  write_axes(sql, members, false);
  fputs(choice->where ? " FROM runs WHERE counts = 1" : " FROM points WHERE n > 0", sql);
  if (choice->point)
    fprintf(sql, " AND point_id = %lld", (long long)choice->point);
  if (choice->where)
    fprintf(sql, " AND (%s\n)", choice->where);
  fputs(" GROUP BY point_id", sql);
  write_axes(sql, members, false);
  fputs(" ORDER BY ", sql);
  write_axes(sql, members, true);
  fputs(members->axes ? ", point_id" : "point_id", sql);
  if (!text_close(sql, &text))
    return no_memory(error);
  const status code = query_run(store, text, 0, NULL, 0, &sink, error);
  free(text);
  for (size_t i = 0; i < members->count; i++) /* only now: the list no longer moves in memory */
    for (size_t a = 0; a < members->axes; a++)
      members->list[i].input[a].text = members->list[i].text[a];
  return code;
}

static bool same_input(const struct query_value *a, const struct query_value *b) {
  if (a->kind == QUERY_TEXT || b->kind == QUERY_TEXT)
    return a->kind == b->kind && strcmp(a->text, b->text) == 0;
  return (a->kind == QUERY_NULL && b->kind == QUERY_NULL) || a->real == b->real;
}

/* Index after the last member of the pool that begins at `from`. *version: the newest results_version of the pool. */
static size_t end_of_pool(const struct members *members, size_t from, int64_t *version) {
  *version = members->list[from].version;
  size_t end = from + 1;
  for (; members->choice->by && end < members->count; end++) {
    for (size_t a = 0; a < members->axes; a++)
      if (!same_input(&members->list[from].input[a], &members->list[end].input[a]))
        return end;
    if (members->list[end].version > *version)
      *version = members->list[end].version;
  }
  return end;
}

struct values {
  struct point_data *point;
  double *value;
  int64_t *seed;
  size_t room;
};

static status take_value(void *context, size_t count, const struct query_value *row, struct error *error) {
  struct values *values = context;
  struct point_data *point = values->point;
  (void)count;
  if (point->runs.count == values->room) {
    const size_t room = values->room ? 2 * values->room : 32;
    if (!grow_block(&point->run_id, room * sizeof *point->run_id) ||
        !grow_block(&values->value, room * sizeof *values->value) ||
        !grow_block(&values->seed, room * sizeof *values->seed))
      return no_memory(error);
    values->room = room;
  }
  point->run_id[point->runs.count] = row[0].integer;
  values->seed[point->runs.count] = row[1].integer;
  values->value[point->runs.count++] = row[2].real;
  return STATUS_OK;
}

static status read_values(struct store *store, const struct ask_pool_choice *choice, const char *column,
                          struct point_data *point, struct values *values, struct error *error) {
  *values = (struct values){.point = point};
  const struct query_sink sink = {values, NULL, take_value};
  char *text = NULL;
  size_t size = 0;
  FILE *sql = open_memstream(&text, &size);
  if (!sql)
    return no_memory(error);
  fputs("SELECT run_id, seed, ", sql);
  sql_write_name(column, sql);
  fprintf(sql, " FROM runs WHERE point_id = %lld AND results_version = %lld AND counts = 1", (long long)point->point_id,
          (long long)point->results_version);
  if (choice->where)
    fprintf(sql, " AND (%s\n)", choice->where);
  fputs(" ORDER BY replicate, seed", sql);
  if (!text_close(sql, &text))
    return no_memory(error);
  const status code = query_run(store, text, 0, NULL, 0, &sink, error);
  free(text);
  return code;
}

/* A pool under construction. */
struct growing {
  struct ask_pool pool;
  int64_t *point;
  size_t *first_run;
  double *value;
  int64_t *seed;
};

static void release(struct growing *growing) {
  point_release(&growing->pool.data);
  free(growing->point);
  free(growing->first_run);
  free(growing->value);
  free(growing->seed);
}

/* Appends `count` elements to the array. False: no memory. */
static bool append(void **array, size_t have, const void *more, size_t count, size_t size) {
  if (count == 0)
    return true;
  if (!grow_block(array, (have + count) * size))
    return false;
  memcpy((char *)*array + have * size, more, count * size);
  return true;
}

/* Adds the runs of a point to the pool. `point` and `values` stay the caller's. */
static status add_point(struct growing *growing, const struct point_data *point, const struct values *values,
                        struct error *error) {
  struct point_data *all = &growing->pool.data;
  const size_t have = all->runs.count, more = point->runs.count;
  if (!append((void **)&all->run_id, have, point->run_id, more, sizeof *all->run_id) ||
      (values->value && (!append((void **)&growing->value, have, values->value, more, sizeof *values->value) ||
                         !append((void **)&growing->seed, have, values->seed, more, sizeof *values->seed))))
    return no_memory(error);
  if (point->first) {
    const size_t masses = all->first ? all->first[have] : 0;
    static const size_t zero = 0;
    if ((!all->first && !append((void **)&all->first, 0, &zero, 1, sizeof zero)) ||
        !append((void **)&all->first, have + 1, point->first + 1, more, sizeof *point->first) ||
        !append((void **)&all->masses, masses, point->masses, point->first[more], sizeof *point->masses))
      return no_memory(error);
    for (size_t r = have + 1; r <= have + more; r++)
      all->first[r] += masses;
  }
  all->runs = (struct pooled_runs){have + more, all->first, all->masses};
  all->element_mass = fmax(all->element_mass, point->element_mass); /* fmax ignores a NaN */
  all->complete_mass = fmax(all->complete_mass, point->complete_mass);
  all->dimensions = point->dimensions;
  growing->point[growing->pool.points++] = point->point_id;
  growing->first_run[growing->pool.points] = have + more;
  return STATUS_OK;
}

/* Reads the members from .. end - 1 that have runs of the version. */
static status read_pool(struct store *store, const struct members *members, size_t from, size_t end, int64_t version,
                        const char *column, struct growing *growing, struct error *error) {
  growing->point = calloc(end - from, sizeof *growing->point);
  growing->first_run = calloc(end - from + 1, sizeof *growing->first_run);
  if (!growing->point || !growing->first_run)
    return no_memory(error);
  growing->pool.data = (struct point_data){.results_version = version, .element_mass = NAN, .complete_mass = NAN};
  status code = STATUS_OK;
  for (size_t i = from; i < end && code == STATUS_OK; i++) {
    struct point_data point = {.point_id = members->list[i].point, .results_version = version};
    struct values values = {0};
    if (members->list[i].version != version)
      continue;
    code = column ? read_values(store, members->choice, column, &point, &values, error)
                  : point_read_where(store, point.point_id, version, members->choice->where, &point, error);
    if (code == STATUS_OK && point.runs.count > 0)
      code = add_point(growing, &point, &values, error);
    point_release(&point);
    free(values.value);
    free(values.seed);
  }
  growing->pool.data.point_id = growing->pool.points == 1 ? growing->point[0] : 0;
  return code;
}

/* The pool's label: "strain 0.03, angle 0.0698 rad" from the inputs of `by`; for a single point its varied inputs. */
static status write_label(struct store *store, struct ask_pool *pool, struct error *error) {
  if (pool->points == 1)
    return ask_points_label(store, pool->point[0], pool->label, sizeof pool->label, error);
  size_t used = 0;
  snprintf(pool->label, sizeof pool->label, "all points");
  for (size_t a = 0; a < pool->axes && used < sizeof pool->label; a++) {
    char unit[64] = "", value[ASK_POOL_TEXT] = "off";
    const struct query_value *input = &pool->input[a];
    const status code = ask_columns_unit(store, pool->column[a], unit, sizeof unit, error);
    if (code)
      return code;
    if (input->kind == QUERY_TEXT)
      snprintf(value, sizeof value, "%s", input->text);
    else if (input->kind != QUERY_NULL)
      snprintf(value, sizeof value, "%.3g", input->real);
    const char *word = strrchr(pool->column[a], '_');
    used += (size_t)snprintf(pool->label + used, sizeof pool->label - used, "%s%s %s%s%s", a ? ", " : "",
                             word ? word + 1 : pool->column[a], value, *unit ? " " : "", unit);
  }
  return STATUS_OK;
}

static status give_pools(struct store *store, const struct members *members, const char *column, ask_pool_each each,
                         void *context, struct error *error) {
  status code = STATUS_OK;
  for (size_t from = 0, end = 0; from < members->count && code == STATUS_OK; from = end) {
    int64_t version = 0;
    end = end_of_pool(members, from, &version);
    struct growing growing = {.pool = {.axes = members->axes}};
    code = read_pool(store, members, from, end, version, column, &growing, error);
    growing.pool.point = growing.point;
    growing.pool.first_run = growing.first_run;
    growing.pool.value = growing.value;
    growing.pool.seed = growing.seed;
    memcpy(growing.pool.column, members->column, sizeof growing.pool.column);
    memcpy(growing.pool.input, members->list[from].input, sizeof growing.pool.input);
    if (code == STATUS_OK && growing.pool.points > 0)
      code = write_label(store, &growing.pool, error);
    if (code == STATUS_OK && growing.pool.points > 0)
      code = each(context, &growing.pool, error);
    release(&growing);
  }
  return code;
}

static status ask(struct store *store, const struct ask_pool_choice *choice, const char *column, ask_pool_each each,
                  void *context, struct error *error) {
  struct members members = {.choice = choice};
  status code = choice->by ? ask_group_columns(store, choice->by, ASK_POOL_AXES, members.column, &members.axes, error)
                           : STATUS_OK;
  if (code == STATUS_OK)
    code = find_members(store, &members, error);
  if (code == STATUS_OK)
    code = give_pools(store, &members, column, each, context, error);
  free(members.list);
  return code;
}

status ask_pools(struct store *store, const struct ask_pool_choice *choice, ask_pool_each each, void *context,
                 struct error *error) {
  return ask(store, choice, NULL, each, context, error);
}

status ask_pool_values(struct store *store, const struct ask_pool_choice *choice, const char *quantity,
                       ask_pool_each each, void *context, struct error *error) {
  char column[ASK_GROUP_NAME];
  const status code = ask_group_quantity(store, quantity, column, error);
  return code ? code : ask(store, choice, column, each, context, error);
}

static status take_engine(void *context, size_t count, const struct query_value *values, struct error *error) {
  (void)count, (void)error;
  const struct engine_kind *kind = values[0].kind == QUERY_TEXT ? engine_find(values[0].text, NULL) : NULL;
  *(int *)context = kind && kind->dimensions == 2 ? 2 : 3;
  return STATUS_OK;
}

status ask_pool_dimensions(struct store *store, int *dimensions, struct error *error) {
  const struct query_sink sink = {dimensions, NULL, take_engine};
  *dimensions = 3;
  return query_run(store, "SELECT engine FROM point ORDER BY point_id LIMIT 1", 0, NULL, 0, &sink, error);
}

struct pooled_form ask_pool_form(const struct ask_pool *pool, bool cumulative, double density) {
  return (struct pooled_form){.cumulative = cumulative,
                              .size = {density, pool->data.dimensions},
                              .units = pool->points,
                              .first_run = pool->points > 1 ? pool->first_run : NULL};
}
