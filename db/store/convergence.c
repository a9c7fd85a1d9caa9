/* Writes the results of a convergence study. */
#include "db/store/internal.h"

static const char writing[] = "writing a study of convergence";

struct level_key {
  int64_t base_point_id, level, point_id;
  int results_version;
};
#define KEY(name_, kind_, member_)                                                                                     \
  { name_, SQL_COLUMN_##kind_, offsetof(struct level_key, member_) }
static const struct sql_column of_level[] = {KEY("base_point_id", INTEGER, base_point_id),
                                             KEY("results_version", INT, results_version), KEY("level", INTEGER, level),
                                             KEY("point_id", INTEGER, point_id)};
enum { LIMIT_COLUMNS = 2 }; /* the first two columns of of_level */

/* Removes the knob and quantity of this scene from a table. */
static status forget(struct store *store, const char *table, const struct store_convergence *study,
                     struct error *error) {
  return sql_executef(store->db, writing, error,
                      "DELETE FROM \"%w\" WHERE base_point_id = %lld AND results_version = %d AND knob = %Q AND "
                      "quantity = %Q",
                      table, (long long)study->base_point_id, study->results_version, study->limit->knob,
                      study->limit->quantity);
}

static status add_levels(struct store *store, const struct store_convergence *study, struct error *error) {
  struct sql_insert insert = {0};
  status result = sql_insert_prepare(store->db, &insert, "convergence", sizeof of_level / sizeof of_level[0], of_level,
                                     &convergence_table, 1, writing, error);
  for (size_t i = 0; result == STATUS_OK && i < study->count; i++) {
    const struct level_key key = {study->base_point_id, (int64_t)i, study->point_ids[i], study->results_version};
    sql_insert_bind(&insert, 0, &key, &study->rows[i]);
    result = sql_run(insert.statement, writing, error);
  }
  sqlite3_finalize(insert.statement);
  return result;
}

static status add_limit(struct store *store, const struct store_convergence *study, struct error *error) {
  struct sql_insert insert = {0};
  status result = sql_insert_prepare(store->db, &insert, "convergence_limit", LIMIT_COLUMNS, of_level,
                                     &convergence_limit_table, 1, writing, error);
  const struct level_key key = {.base_point_id = study->base_point_id, .results_version = study->results_version};
  if (result == STATUS_OK) {
    sql_insert_bind(&insert, 0, &key, study->limit);
    result = sql_run(insert.statement, writing, error);
  }
  sqlite3_finalize(insert.statement);
  return result;
}

static status replace(struct store *store, const struct store_convergence *study, struct error *error) {
  status result = forget(store, "convergence", study, error);
  if (result == STATUS_OK)
    result = forget(store, "convergence_limit", study, error);
  if (result == STATUS_OK)
    result = add_levels(store, study, error);
  return result == STATUS_OK ? add_limit(store, study, error) : result;
}

status store_convergence_set(struct store *store, const struct store_convergence *study, struct error *error) {
  status result = store_begin(store, error);
  if (result != STATUS_OK)
    return result;
  return store_end(store, replace(store, study, error), (int)study->count + 1, error);
}
