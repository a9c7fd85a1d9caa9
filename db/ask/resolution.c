/* Looks for a study of the resolution of a point's scene. */
#include "db/ask/resolution.h"

#include <math.h>
#include <stdio.h>

/* One scene: its name. Several: "SCENE" stays. */
static status take_scene(void *context, size_t count, const struct query_value *values, struct error *error) {
  (void)count, (void)error;
  struct ask_resolution *out = context;
  if (values[0].integer == 1 && values[1].kind == QUERY_TEXT)
    snprintf(out->scene, sizeof out->scene, "%s", values[1].text);
  return STATUS_OK;
}

/* Sum over knobs of what they leave unknown. A point may be a level of several studies: of each knob counts the one
 * that knows least. Of all points together (0) only when there is one. */
static const char sum_of_knobs[] =
    "WITH newest AS (SELECT point_id, max(results_version) AS results_version FROM run"
    "   WHERE point_id = :point"
    "     OR (:point = 0 AND (SELECT count(*) FROM (SELECT DISTINCT point_id FROM run LIMIT 2)) = 1)"
    "   GROUP BY point_id),"
    " knobs AS (SELECT knob, max(resolution) AS resolution, max(open) AS open, max(verdict = 'no-order') AS diverges"
    "   FROM convergence JOIN newest USING (point_id, results_version)"
    "   LEFT JOIN convergence_limit USING (base_point_id, results_version, knob, quantity)"
    "   WHERE quantity = :quantity AND resolution IS NOT NULL GROUP BY knob)"
    " SELECT sum(resolution), max(open), max(diverges) FROM knobs";

static status take_sum(void *context, size_t count, const struct query_value *values, struct error *error) {
  (void)count, (void)error;
  struct ask_resolution *out = context;
  if (values[0].kind == QUERY_NULL)
    return STATUS_OK; /* no study */
  out->half_width = values[0].real;
  out->verdict = ASK_RESOLUTION_KNOWN;
  if (values[1].integer)
    out->verdict = ASK_RESOLUTION_AT_LEAST;
  if (values[2].integer)
    out->verdict = ASK_RESOLUTION_DIVERGES;
  return STATUS_OK;
}

status ask_resolution(struct store *store, int64_t point_id, const char *quantity, struct ask_resolution *out,
                      struct error *error) {
  *out = (struct ask_resolution){.verdict = ASK_RESOLUTION_NOT_STUDIED, .half_width = NAN, .scene = "SCENE"};
  if (!store)
    return STATUS_OK;

  char id[32];
  snprintf(id, sizeof id, "%lld", (long long)point_id);
  const struct query_parameter parameters[] = {{"point", id}, {"quantity", quantity}};
  const struct query_sink scene = {.context = out, .row = take_scene}, sum = {.context = out, .row = take_sum};
  status code = query_run(store,
                          "SELECT count(DISTINCT scene_name), min(scene_name) FROM point WHERE :point = 0 OR point_id "
                          "= :point",
                          1, parameters, 0, &scene, error);
  if (code != STATUS_OK)
    return code;

  double there = 0; /* a store of an earlier program has no studies */
  code = query_number(store, "SELECT count(*) FROM sqlite_schema WHERE name = 'convergence'", 0, NULL, &there, error);
  return code == STATUS_OK && there > 0 ? query_run(store, sum_of_knobs, 2, parameters, 0, &sum, error) : code;
}
