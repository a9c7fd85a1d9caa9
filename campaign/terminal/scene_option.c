/* --set PATH=VALUE: a scene with other inputs. */
#include "campaign/terminal/scene_option.h"

#include "campaign/document/campaign_change.h"

static status set_input(struct scene *scene, const char *text, struct error *error) {
  char path[FIELD_TEXT_SIZE];
  const char *value = NULL;
  TRY(campaign_change_split(text, path, &value, error));
  status code = scene_set_text(scene, path, value, error);
  return code == STATUS_CONTENT ? STATUS_USAGE : code; /* the wrong content is on the command line */
}

status scene_option_apply(struct scene *scene, const struct option_list *set, struct error *error) {
  status code = STATUS_OK;
  for (size_t i = 0; code == STATUS_OK && i < set->count; i++)
    code = set_input(scene, set->items[i], error);
  return code ? code : scene_check(scene, error);
}

status scene_option_load(const char *name, const struct option_list *set, struct scene **scene, struct error *error) {
  status code = scene_load(name, NULL, scene, error);
  return code ? code : scene_option_apply(*scene, set, error);
}
