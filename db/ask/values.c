/* Values of one quantity, run by run. */
#include "db/ask/values.h"

#include <stdio.h>
#include <stdlib.h>

#include "db/sql.h"
#include "schemas/text.h"

struct giving {
  ask_values_each each;
  void *context;
};

static status give(void *context, size_t count, const struct query_value *values, struct error *error) {
  (void)count;
  const struct giving *giving = context;
  const struct ask_values_row row = {.inputs = values[0].kind == QUERY_TEXT ? values[0].text : "",
                                     .point_id = values[1].integer,
                                     .replicate = values[2].integer,
                                     .seed = values[3].integer,
                                     .value = values[4].real};
  return giving->each(giving->context, &row, error);
}

static status check_campaign(struct store *store, const struct query_parameter *name, struct error *error) {
  double there = 0;
  const status code = query_number(store, "SELECT count(*) FROM campaign WHERE name = CAST(:name AS TEXT)", 1, name,
                                   &there, error);
  if (code || there > 0)
    return code;
  return status_fail(error, STATUS_USAGE, "the store has no campaign '%.128s'; `clast status` lists them", name->value);
}

status ask_values(struct store *store, const struct ask_values_choice *choice, const char *column, ask_values_each each,
                  void *context, struct error *error) {
  struct giving giving = {each, context};
  const struct query_sink sink = {.context = &giving, .row = give};
  const struct query_parameter name = {"name", choice->campaign};
  char *sql = NULL;
  size_t size = 0;
  status code = choice->campaign ? check_campaign(store, &name, error) : STATUS_OK;
  if (code)
    return code;
  FILE *out = open_memstream(&sql, &size);
  if (!out)
    return status_fail(error, STATUS_MEMORY, "no memory for a question to the store");
  fputs("WITH varied AS MATERIALIZED (SELECT point_id, (SELECT group_concat(v, ', ') FROM (SELECT path || ' = ' || "
        "CAST(value AS TEXT) AS v FROM axis JOIN point_input i USING (path) WHERE i.point_id = p.point_id ORDER BY "
        "path)) AS inputs FROM point p)\nSELECT inputs, point_id, replicate, seed, ",
        out);
  sql_write_name(column, out);
  fputs(" FROM runs JOIN varied USING (point_id) WHERE counts = 1 AND results_version = (SELECT "
        "max(results_version) FROM run WHERE counts = 1)",
        out);
  if (choice->point)
    fprintf(out, " AND point_id = %lld", (long long)choice->point);
  if (choice->campaign)
    fputs(" AND point_id IN (SELECT point_id FROM campaign_point JOIN campaign USING (campaign_id) WHERE name = "
          "CAST(:name AS TEXT))",
          out);
  fputs(" ORDER BY inputs, point_id, seed, replicate", out);
  if (!text_close(out, &sql))
    return status_fail(error, STATUS_MEMORY, "no memory for a question to the store");
  code = query_run(store, sql, choice->campaign ? 1 : 0, &name, 0, &sink, error);
  free(sql);
  return code;
}
