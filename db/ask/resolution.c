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

status ask_resolution(struct store *store, int64_t point_id, const char *quantity, struct ask_resolution *out,
                      struct error *error) {
  (void)quantity; /* no table of a store holds a study */
  *out = (struct ask_resolution){.verdict = ASK_RESOLUTION_NOT_STUDIED, .half_width = NAN, .scene = "SCENE"};
  if (!store)
    return STATUS_OK;

  char id[32];
  snprintf(id, sizeof id, "%lld", (long long)point_id);
  const struct query_sink sink = {.context = out, .row = take_scene};
  return query_run(store,
                   "SELECT count(DISTINCT scene_name), min(scene_name) FROM point WHERE :point = 0 OR point_id = "
                   ":point",
                   1, &(struct query_parameter){"point", id}, 0, &sink, error);
}
