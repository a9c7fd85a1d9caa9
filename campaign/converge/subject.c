/* Loads scenes and the limits of a study. */
#include "campaign/converge/subject.h"

#include <stdlib.h>
#include <string.h>

#include "campaign/document/campaign_walk.h"

void subject_clear(struct subject *subject) {
  study_clear(&subject->study);
  for (size_t i = 0; i < subject->scene_count; i++)
    scene_free(subject->scenes[i]);
  campaign_free(subject->campaign);
}

static status add_scene(struct subject *subject, const struct option_list *set, struct scene *scene,
                        struct error *error) {
  subject->scenes[subject->scene_count++] = scene;
  return option_set_inputs(scene, set, error);
}

/* Every point of the campaign is a scene of its own. */
static status add_points(struct subject *subject, const struct option_list *set, struct error *error) {
  struct campaign_walk walk;
  status code = campaign_walk_begin(&walk, subject->campaign, error);
  while (code == STATUS_OK && campaign_walk_next(&walk)) {
    struct scene *scene = campaign_walk_scene(&walk, error);
    if (!scene)
      code = STATUS_CONTENT;
    else if (subject->scene_count < SUBJECT_SCENES)
      code = add_scene(subject, set, scene, error);
    else {
      scene_free(scene);
      code = status_fail(error, STATUS_CONTENT,
                         "the campaign has more than %d points: study a campaign with fewer points, or one scene",
                         SUBJECT_SCENES);
    }
  }
  campaign_walk_end(&walk);
  return code;
}

static status load_campaign(struct subject *subject, const char *path, const struct option_list *set,
                            struct error *error) {
  TRY(campaign_load(path, &subject->campaign, error));
  const struct campaign *campaign = subject->campaign;
  const char *slash = strrchr(path, '/'), *scene = campaign->scene_reference;
  const bool is_file = strchr(scene, '/') || strchr(scene, '.');
  snprintf(subject->reference, sizeof subject->reference, "%.*s%s",
           slash && is_file && scene[0] != '/' ? (int)(slash + 1 - path) : 0, path, scene);
  subject->study.limits = *campaign;
  return add_points(subject, set, error);
}

static status load_scene(struct subject *subject, const char *reference, const struct option_list *set,
                         struct error *error) {
  struct scene *scene = NULL;
  TRY(scene_load(reference, NULL, &scene, error));
  struct campaign *limits = &subject->study.limits;
  field_defaults(&campaign_table, limits);
  snprintf(limits->name, sizeof limits->name, "%s", scene->name[0] ? scene->name : "scene");
  snprintf(limits->store, sizeof limits->store, "%.200s-converge.db", limits->name);
  for (char *slash = limits->store; (slash = strchr(slash, '/'));)
    *slash = '-'; /* a name must not lead to another folder */
  snprintf(subject->reference, sizeof subject->reference, "%s", reference);
  return add_scene(subject, set, scene, error);
}

/* Only a campaign's document has the key `scene`. A name without a file is a built-in scene. */
static bool is_campaign(const char *path) { /* whoever opens it next notes it as an input */
  bool found = false;
  char line[4096];
  FILE *in = scene_builtin_text(path) ? NULL : fopen(path, "r");
  while (in && !found && fgets(line, sizeof line, in))
    found = strncmp(line, "scene:", 6) == 0 || strstr(line, "\"scene\"");
  if (in)
    fclose(in);
  return found;
}

status subject_load(struct subject *subject, const char *path, const struct option_list *set, struct error *error) {
  TRY(is_campaign(path) ? load_campaign(subject, path, set, error) : load_scene(subject, path, set, error));
  struct campaign *limits = &subject->study.limits;
  /* The study borrows these from the campaign, so they must not be freed twice. */
  limits->axes = NULL;
  limits->axis_count = 0;
  limits->scene = NULL;
  limits->text = NULL;
  limits->independent = false;
  limits->keep = CAMPAIGN_KEEP_NONE;
  subject->study.scene_reference = subject->reference;
  return STATUS_OK;
}
