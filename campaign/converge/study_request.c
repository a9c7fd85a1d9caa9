/* Reads the request of a study: scenes and limits, quantities, when to stop, and knobs with their levels. */
#include "campaign/converge/study.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "schemas/memory.h"

/* ---- the subject ---- */

static status add_scene(struct study_subject *subject, const struct option_list *set, struct scene *scene,
                        struct error *error) {
  subject->scenes[subject->scene_count++] = scene;
  return option_set_inputs(scene, set, error);
}

/* Takes the last scene away when an earlier one has the same inputs: --set has given the inputs one value in which the
 * two points differed. */
static void drop_equal(struct study_subject *subject) {
  struct scene *const last = subject->scenes[subject->scene_count - 1];
  uint8_t own[16], other[16];
  scene_identity(last, 0, own);
  for (size_t i = 0; i + 1 < subject->scene_count; i++) {
    scene_identity(subject->scenes[i], 0, other);
    if (memcmp(own, other, sizeof own) != 0)
      continue;
    subject->scene_count--;
    scene_free(last);
    return;
  }
}

/* Every point of the campaign is a scene of its own. */
static status add_points(struct study_subject *subject, const struct option_list *set, struct error *error) {
  CAMPAIGN_WALK walk = {0};
  TRY(campaign_walk_begin(&walk, subject->campaign, error));
  while (campaign_walk_next(&walk)) {
    if (subject->scene_count == STUDY_SCENES)
      return status_fail(error, STATUS_CONTENT,
                         "the campaign has more than %d points: study a campaign with fewer points, or one scene",
                         STUDY_SCENES);
    struct scene *scene = campaign_walk_scene(&walk, error);
    if (!scene)
      return STATUS_CONTENT;
    TRY(add_scene(subject, set, scene, error));
    drop_equal(subject);
  }
  return STATUS_OK;
}

static status load_campaign(struct study_subject *subject, const char *path, const struct option_list *set,
                            struct error *error) {
  TRY(campaign_load(path, &subject->campaign, error));
  driver_list_reference(subject->campaign, path, subject->reference, sizeof subject->reference);
  subject->study.limits = *subject->campaign;
  return add_points(subject, set, error);
}

static status load_scene(struct study_subject *subject, const char *reference, const struct option_list *set,
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

bool study_is_campaign(const char *path) { /* whoever opens it next notes it as an input */
  bool found = false;
  char line[4096];
  struct stat file; /* a device may never end, and a pipe can be read once */
  const bool plain = !scene_builtin_text(path) && stat(path, &file) == 0 && S_ISREG(file.st_mode);
  FILE *in = plain ? fopen(path, "r") : NULL;
  while (in && !found && fgets(line, sizeof line, in))
    found = strncmp(line, "scene:", 6) == 0 || strstr(line, "\"scene\"");
  if (in)
    fclose(in);
  return found;
}

static status load(struct study_subject *subject, const char *path, const struct option_list *set,
                   struct error *error) {
  TRY(study_is_campaign(path) ? load_campaign(subject, path, set, error) : load_scene(subject, path, set, error));
  struct campaign *limits = &subject->study.limits;
  /* The study borrows these from the campaign, so they must not be freed twice. */
  subject->study.varied = limits->axes;
  subject->study.varied_count = limits->axis_count;
  limits->axes = NULL;
  limits->axis_count = 0;
  limits->scene = NULL;
  limits->text = NULL;
  limits->independent = false;
  limits->keep = CAMPAIGN_KEEP_NONE;
  subject->study.scene_reference = subject->reference;
  return STATUS_OK;
}

/* ---- quantities and rule ---- */

static status read_quantities(struct study *study, const char *names, const struct engine_kind *kind,
                              struct error *error) {
  char name[FIELD_TEXT_SIZE];
  while (ladder_next_word(&names, name, sizeof name)) {
    if (study->quantity_count == LIMITS_STUDY_QUANTITIES)
      return status_fail(error, STATUS_USAGE, "at most %d quantities in one study", LIMITS_STUDY_QUANTITIES);
    if (study_quantity_find(kind, name, &study->quantity[study->quantity_count++], error) != STATUS_OK)
      return STATUS_USAGE;
  }
  return study->quantity_count ? STATUS_OK : status_fail(error, STATUS_USAGE, "--quantity names none");
}

/* Reads a half width, or a share in percent. */
static status read_within(struct study_rule *rule, const char *text, bool several, struct error *error) {
  char *end = NULL;
  if (!text || strcmp(text, "off") == 0)
    return STATUS_OK;
  rule->within = strtod(text, &end);
  rule->relative = strcmp(end + strspn(end, " "), "%") == 0;
  if ((*end && !rule->relative) || !(rule->within > 0))
    return status_fail(error, STATUS_USAGE,
                       "--within %s: expected a width above 0 in the quantity's SI unit, a share of its value such as "
                       "\"5 %%\", or off",
                       text);
  if (!rule->relative && several)
    return status_fail(error, STATUS_USAGE, "--within %s: several quantities need a share of their values (\"5 %%\")",
                       text);
  if (rule->relative)
    rule->within /= 100;
  return STATUS_OK;
}

static status read_rule(struct study *study, const struct study_request *request, struct error *error) {
  struct study_rule *rule = &study->rule;
  const int64_t first = request->first_seeds, most = request->most_seeds;
  *rule = (struct study_rule){.within = NAN,
                              .seconds = HUGE_VAL,
                              .first_seeds = first,
                              .most_seeds = most < first ? first : most};
  if (request->seconds) {
    char *end = NULL;
    rule->seconds = strtod(request->seconds, &end);
    if (*end || !(rule->seconds > 0))
      return status_fail(error, STATUS_USAGE, "--seconds %s: expected a number of seconds above 0", request->seconds);
  }
  return read_within(rule, request->within, study->quantity_count > 1, error);
}

/* ---- knobs ---- */

/* A knob that does not apply is left out with a remark if it comes from a group, and refused if it was named. */
static status add_knob(struct study_subject *subject, const struct scene *scene, const struct knob *knob,
                       const char *settings, bool named, struct error *error) {
  struct ladder levels;
  OWNED char *notes = NULL;
  status code = ladder_make(knob, scene, settings, &levels, &notes, error);
  if (notes && code == STATUS_OK && !subject->quiet && !strstr(subject->told, notes)) {
    text_append(subject->told, sizeof subject->told, "%s\n", notes);
    for (const char *line = notes; *line; line += strcspn(line, "\n") + 1)
      fprintf(stderr, "clast: %.*s\n", (int)strcspn(line, "\n"), line);
  }
  if (code == STATUS_CONTENT && !named) {
    *error = (struct error){0};
    return STATUS_OK;
  }
  if (code == STATUS_OK)
    code = ladder_add_own(&levels, scene, error);
  return code == STATUS_OK ? study_add(&subject->study, scene, &levels, error) : code;
}

/* `name`: a knob, or a group of knobs. */
static status add_named(struct study_subject *subject, const struct scene *scene, const char *name,
                        const char *settings, struct error *error) {
  int group = 0;
  while (group < KNOB_GROUPS && strcmp(name, engine_knob_groups[group]) != 0)
    group++;
  if (group == KNOB_GROUPS) {
    const struct knob *knob = engine_knob(scene->kind, name, error);
    return knob ? add_knob(subject, scene, knob, settings, true, error) : STATUS_USAGE;
  }
  for (const struct knob *knob = scene->kind->knobs; knob && knob->name; knob++)
    if ((int)knob->group == group)
      TRY(add_knob(subject, scene, knob, NULL, false, error));
  return STATUS_OK;
}

/* "particles,time_step" or "particles=1000,3000". */
static status add_item(struct study_subject *subject, const struct scene *scene, const char *item,
                       struct error *error) {
  char name[64];
  const char *equals = strchr(item, '=');
  if (equals) {
    snprintf(name, sizeof name, "%.*s", (int)(equals - item), item);
    return add_named(subject, scene, name, equals + 1, error);
  }
  while (ladder_next_word(&item, name, sizeof name))
    TRY(add_named(subject, scene, name, NULL, error));
  return STATUS_OK;
}

status study_request_read(const struct study_request *request, const char *path, struct study_subject *subject,
                          struct error *error) {
  struct study *study = &subject->study;
  subject->quiet = request->launch.quiet;
  TRY(load(subject, path, &request->set, error));
  if (request->first_seed > 0)
    study->limits.first_seed = request->first_seed;
  if (request->store)
    snprintf(study->limits.store, sizeof study->limits.store, "%s", request->store);
  TRY(read_quantities(study,
                      request->quantity   ? request->quantity
                      : subject->campaign ? study->limits.quantity
                                          : scene_headline(subject->scenes[0]),
                      subject->scenes[0]->kind, error));
  TRY(read_rule(study, request, error));
  for (size_t s = 0; s < subject->scene_count; s++) {
    if (request->knobs.count == 0)
      TRY(add_item(subject, subject->scenes[s], "resolution,settings", error));
    for (size_t i = 0; i < request->knobs.count; i++)
      TRY(add_item(subject, subject->scenes[s], request->knobs.items[i], error));
  }
  if (request->picture && study->ladder_count && !study_stepped(study))
    return status_fail(
        error, STATUS_USAGE,
        "--picture draws the levels of a knob over its step, and none of these has one: leave it out, or "
        "add such a knob (`clast converge --list`)");
  return study->ladder_count
             ? STATUS_OK
             : status_fail(error, STATUS_CONTENT, "no knob applies to this scene (`clast converge --list`)");
}

void study_request_clear(struct study_subject *subject) {
  study_clear(&subject->study);
  for (size_t i = 0; i < subject->scene_count; i++)
    scene_free(subject->scenes[i]);
  campaign_free(subject->campaign);
}
