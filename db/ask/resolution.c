/* Finds the study of the resolution of a point's scene. */
#include "db/ask/resolution.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "analysis/statistics/estimates.h"
#include "schemas/text.h"

/* With one scene, its name. With several, "SCENE" stays. */
static status take_scene(void *context, size_t count, const struct query_value *values, struct error *error) {
  (void)count, (void)error;
  struct ask_resolution *out = context;
  if (values[0].integer == 1 && values[1].kind == QUERY_TEXT)
    snprintf(out->scene, sizeof out->scene, "%s", values[1].text);
  text_make_plain(out->scene, "");
  return STATUS_OK;
}

static const char of_points[] =
    "SELECT count(*), count(half_width), max(half_width), max(verdict = 'diverges'), max(verdict = 'at-least')"
    " FROM (SELECT point_id, max(results_version) AS results_version FROM point_total"
    "   WHERE runs > 0 AND :point IN (0, point_id) GROUP BY point_id)"
    " LEFT JOIN (SELECT * FROM resolution WHERE quantity = :quantity) USING (point_id, results_version)";

const char *const ask_resolution_names[] = {[ASK_RESOLUTION_NOT_STUDIED] = "not-studied",
                                            [ASK_RESOLUTION_KNOWN] = "known",
                                            [ASK_RESOLUTION_AT_LEAST] = "at-least",
                                            [ASK_RESOLUTION_DIVERGES] = "diverges"};

enum ask_resolution_verdict ask_resolution_verdict(const char *verdict) {
  for (int i = ASK_RESOLUTION_KNOWN; i <= ASK_RESOLUTION_DIVERGES; i++)
    if (verdict && strcmp(verdict, ask_resolution_names[i]) == 0)
      return (enum ask_resolution_verdict)i;
  return ASK_RESOLUTION_NOT_STUDIED;
}

/* The knobs of the studies that a point belongs to. Run only where the view resolution has rows: stores of earlier
 * programs lack the columns. */
static const char of_knobs[] =
    "SELECT group_concat(knob, ', ') FROM (SELECT DISTINCT knob FROM convergence"
    "   WHERE quantity = :quantity AND (resolution IS NOT NULL OR knob = 'settings')"
    "   AND base_point_id IN (SELECT base_point_id FROM convergence WHERE :point IN (0, point_id)) ORDER BY knob)";

static status take_knobs(void *context, size_t count, const struct query_value *values, struct error *error) {
  (void)count, (void)error;
  struct ask_resolution *out = context;
  if (values[0].kind == QUERY_TEXT)
    snprintf(out->knobs, sizeof out->knobs, "%s", values[0].text);
  text_make_plain(out->knobs, "");
  return STATUS_OK;
}

static status take_found(void *context, size_t count, const struct query_value *values, struct error *error) {
  (void)count, (void)error;
  struct ask_resolution *out = context;
  out->points = values[0].integer;
  out->studied = values[1].integer;
  if (out->studied == 0)
    return STATUS_OK;

  out->half_width = values[2].real;
  out->verdict = ASK_RESOLUTION_KNOWN;
  if (values[4].integer)
    out->verdict = ASK_RESOLUTION_AT_LEAST;
  if (values[3].integer)
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
  const struct query_parameter parameters[] = {{"point", id}, {"quantity", estimates_short_name(quantity)}};
  const struct query_sink scene = {.context = out, .row = take_scene}, found = {.context = out, .row = take_found};
  const struct query_sink knobs = {.context = out, .row = take_knobs};
  status code = query_run(store,
                          "SELECT count(DISTINCT scene_name), min(scene_name) FROM point WHERE :point = 0 OR point_id "
                          "= :point",
                          1, parameters, 0, &scene, error);
  if (code != STATUS_OK)
    return code;

  code = query_run(store, of_points, 2, parameters, 0, &found, error);
  if (code != STATUS_OK || out->studied == 0)
    return code;
  return query_run(store, of_knobs, 2, parameters, 0, &knobs, error);
}

status ask_resolution_of_exponents(struct store *store, bool *studied, struct error *error) {
  double count = 0;
  const status code = query_number(store, "SELECT count(*) FROM resolution WHERE quantity GLOB 'beta*'", 0, NULL,
                                   &count, error);
  *studied = count > 0;
  return code;
}
