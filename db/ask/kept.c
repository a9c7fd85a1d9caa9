/* Finds runs whose fields are kept. */
#include "db/ask/kept.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "db/ask/columns.h"
#include "db/sql.h"
#include "db/store/internal.h"
#include "db/store/paths.h"
#include "db/store/views_statistics.h"
#include "schemas/text.h"

enum { AXES = 64 };

struct giving {
  struct store *store;
  const struct query_sink *to;
};

static status give_names(void *context, size_t count, const char *const *names, struct error *error) {
  const struct giving *giving = context;
  return giving->to->columns ? giving->to->columns(giving->to->context, count, names, error) : STATUS_OK;
}

/* The store holds the path relative to its own folder. */
static status give_row(void *context, size_t count, const struct query_value *values, struct error *error) {
  const struct giving *giving = context;
  struct query_value *changed = malloc(count * sizeof *changed);
  char *path = paths_of_fields(giving->store->path, values[count - 1].text);
  status code = STATUS_MEMORY;
  if (changed && path) {
    memcpy(changed, values, count * sizeof *changed);
    changed[count - 1].text = path;
    changed[count - 1].size = strlen(path);
    code = giving->to->row(giving->to->context, count, changed, error);
  } else
    status_fail(error, code, "no memory for the runs");
  free(changed);
  free(path);
  return code;
}

status ask_kept(struct store *store, const struct query_sink *sink, struct error *error) {
  struct giving giving = {store, sink};
  const struct query_sink between = {&giving, give_names, give_row};
  struct ask_column axes[AXES];
  const char *results[VIEWS_STATISTICS_MAIN];
  const size_t result_count = views_statistics_main(results);
  size_t axis_count = 0, size = 0;
  char *sql = NULL;
  status code = ask_columns_axes(store, false, AXES, axes, &axis_count, error);
  if (code)
    return code;
  FILE *out = open_memstream(&sql, &size);
  if (!out)
    return status_fail(error, STATUS_MEMORY, "no memory for a question to the store");
  fputs("SELECT run_id, point_id, seed", out);
  for (size_t i = 0; i < axis_count + result_count; i++) {
    fputs(", ", out);
    sql_write_name(i < axis_count ? axes[i].name : results[i - axis_count], out);
  }
  fputs(", fields_path AS fields FROM runs WHERE counts AND typeof(fields_path) = 'text' AND results_version = (SELECT "
        "max(results_version) FROM run AS newest WHERE newest.point_id = runs.point_id) ORDER BY point_id, replicate",
        out);
  if (!text_close(out, &sql))
    return status_fail(error, STATUS_MEMORY, "no memory for a question to the store");
  code = query_run(store, sql, 0, NULL, 0, &between, error);
  free(sql);
  return code;
}
