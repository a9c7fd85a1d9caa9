/* Finds the study of the resolution of a point's scene. */
#include "db/ask/resolution.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "analysis/statistics/estimates.h"
#include "schemas/text.h"

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

status ask_resolution(struct store *store, int64_t point_id, const char *quantity, struct ask_resolution *out,
                      struct error *error) {
  *out = (struct ask_resolution){.verdict = ASK_RESOLUTION_NOT_STUDIED, .half_width = NAN, .scene = "SCENE"};
  if (!store)
    return STATUS_OK;
  const long long id = point_id;
  quantity = estimates_short_name(quantity);

  ANSWER scenes = answer_to(store, error,
                            "SELECT count(DISTINCT scene_name), min(scene_name) FROM point WHERE %lld IN (0, "
                            "point_id)",
                            id);
  if (answer_next(&scenes) && answer_integer(&scenes, 0) == 1 && answer_value(&scenes, 1).kind == QUERY_TEXT)
    snprintf(out->scene, sizeof out->scene, "%s", answer_text(&scenes, 1));
  text_make_plain(out->scene, "");
  TRY(answer_end(&scenes));

  ANSWER found = answer_to(
      store, error,
      "SELECT count(*), count(half_width), max(half_width), max(verdict = 'diverges'), max(verdict = 'at-least')"
      " FROM (SELECT point_id, max(results_version) AS results_version FROM point_total"
      "   WHERE runs > 0 AND %lld IN (0, point_id) GROUP BY point_id)"
      " LEFT JOIN (SELECT * FROM resolution WHERE quantity = %Q) USING (point_id, results_version)",
      id, quantity);
  if (answer_next(&found)) {
    out->points = answer_integer(&found, 0);
    out->studied = answer_integer(&found, 1);
    out->half_width = answer_real(&found, 2);
    if (out->studied > 0)
      out->verdict = answer_integer(&found, 3)   ? ASK_RESOLUTION_DIVERGES
                     : answer_integer(&found, 4) ? ASK_RESOLUTION_AT_LEAST
                                                 : ASK_RESOLUTION_KNOWN;
  }
  TRY(answer_end(&found));
  if (out->studied == 0) /* a store of an earlier program lacks the columns of the next question */
    return STATUS_OK;

  ANSWER knobs = answer_to(
      store, error,
      "SELECT group_concat(knob, ', ') FROM (SELECT DISTINCT knob FROM convergence"
      "   WHERE quantity = %Q AND (resolution IS NOT NULL OR knob = 'settings')"
      "   AND base_point_id IN (SELECT base_point_id FROM convergence WHERE %lld IN (0, point_id)) ORDER BY knob)",
      quantity, id);
  if (answer_next(&knobs))
    snprintf(out->knobs, sizeof out->knobs, "%s", answer_text(&knobs, 0));
  text_make_plain(out->knobs, "");
  return answer_end(&knobs);
}

status ask_resolution_of_exponents(struct store *store, bool *studied, struct error *error) {
  double count = 0;
  const status code = answer_number(store, &count, error,
                                    "SELECT count(*) FROM resolution WHERE quantity GLOB 'beta*'");
  *studied = count > 0;
  return code;
}
